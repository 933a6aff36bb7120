#include "common/host/hole_log.h"

#include <algorithm>

namespace meshcomplete {
namespace host {
namespace {

constexpr std::size_t most_single_lines = 30;
constexpr int most_open_lines = 100;
constexpr std::size_t most_listed = 100;  // numbers of faces or vertices

QString counted(std::size_t number, const char* singular, const char* plural) {
  return QString("%1 %2").arg(number).arg(number == 1 ? singular : plural);
}

QString where(const HoleReport& hole) {
  return QString("%1, perimeter %2, near (%3, %4, %5)")
      .arg(counted(hole.edges, "edge", "edges"), QString::number(hole.perimeter, 'g', 4),
           QString::number(hole.centre.x(), 'g', 5), QString::number(hole.centre.y(), 'g', 5),
           QString::number(hole.centre.z(), 'g', 5));
}

QString describe_hole(std::size_t number, const HoleReport& hole) {
  const QString start = QString("Hole %1 (%2): ").arg(number).arg(where(hole));
  const QString route = hole.route.empty() ? QString() : ", " + QString::fromStdString(hole.route);
  const QString reason = hole.reason.empty() ? QString() : ": " + QString::fromStdString(hole.reason);
  switch (hole.outcome) {
    case HoleOutcome::closed:
      return start + QString("closed with %1%2").arg(counted(hole.faces_added, "face", "faces"), route);
    case HoleOutcome::partial:
      return start +
             QString("closed in part with %1%2").arg(counted(hole.faces_added, "face", "faces"), route) +
             reason;
    case HoleOutcome::skipped:
      return start + "left open" + reason;
    case HoleOutcome::failed:
      return start + "NOT closed" + route + reason;
  }
  return start;
}

QString describe_closed(const CompletionReport& report) {
  std::size_t holes = 0, faces = 0, least = 0, most = 0;
  for (const HoleReport& hole : report.holes) {
    if (hole.outcome != HoleOutcome::closed) continue;
    least = holes == 0 ? hole.edges : std::min(least, hole.edges);
    most = std::max(most, hole.edges);
    faces += hole.faces_added;
    ++holes;
  }
  return QString("Closed %1 of %2 to %3 edges with %4")
      .arg(counted(holes, "hole", "holes"))
      .arg(least)
      .arg(most)
      .arg(counted(faces, "face", "faces"));
}

QString listed(const std::vector<Index>& elements) {
  QStringList numbers;
  for (std::size_t i = 0; i < std::min(most_listed, elements.size()); ++i)
    numbers << QString::number(elements[i]);
  QString line = numbers.join(", ");
  if (elements.size() > most_listed) line += QString(" and %1 more").arg(elements.size() - most_listed);
  return line;
}

QString describe_removed(const std::vector<Index>& faces) {
  return QString("The new layer lacks %1 of the input, counted from 0: %2")
      .arg(counted(faces.size(), "face", "faces"), listed(faces));
}

QString describe_split(const std::vector<Index>& vertices) {
  return QString("The new layer has %1 of vertices of the input, counted from 0: %2")
      .arg(counted(vertices.size(), "copy", "copies"), listed(vertices));
}

QString describe_figures(const CompletionReport& report) {
  QStringList figures;
  for (const auto& figure : report.figures)
    figures << QString("%1 %2").arg(QString::fromStdString(figure.first),
                                    QString::number(figure.second, 'g', 7));
  return "Figures: " + figures.join(", ");
}

QString summary(const CompletionReport& report) {
  if (report.holes.empty()) return "The mesh has no holes: there is nothing to close.";
  QString line = QString("Closed %1 of %2")
                     .arg(report.count(HoleOutcome::closed))
                     .arg(counted(report.holes.size(), "hole", "holes"));
  const auto also = [&](HoleOutcome outcome, const char* words) {
    if (report.count(outcome) > 0) line += QString(", %1 %2").arg(report.count(outcome)).arg(words);
  };
  also(HoleOutcome::partial, "in part");
  also(HoleOutcome::failed, "could not be closed");
  also(HoleOutcome::skipped, "left open as asked or for the reason given");
  return line + ".";
}

}  // namespace

QStringList describe_holes(const CompletionReport& report) {
  QStringList lines;
  const bool sum_up = report.holes.size() > most_single_lines;
  if (sum_up && report.count(HoleOutcome::closed) > 0) lines << describe_closed(report);
  int open = 0;
  for (std::size_t i = 0; i < report.holes.size(); ++i) {
    const HoleReport& hole = report.holes[i];
    if (hole.outcome == HoleOutcome::closed) {
      if (!sum_up) lines << describe_hole(i + 1, hole);
    } else if (++open <= most_open_lines) {
      lines << describe_hole(i + 1, hole);
    }
  }
  if (open > most_open_lines)
    lines << QString("... and %1 more that are not closed").arg(open - most_open_lines);
  for (const std::string& note : report.notes) lines << QString::fromStdString(note);
  if (!report.removed_faces.empty()) lines << describe_removed(report.removed_faces);
  if (!report.split_vertices.empty()) lines << describe_split(report.split_vertices);
  if (!report.figures.empty()) lines << describe_figures(report);
  return lines << summary(report);
}

}  // namespace host
}  // namespace meshcomplete
