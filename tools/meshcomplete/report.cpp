#include "tools/meshcomplete/report.h"

#include <sys/resource.h>

#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <cmath>

#include "common/host/runner_host.h"
#include "tools/meshcomplete/errors.h"

namespace meshcomplete {
namespace runner {

namespace {

QJsonValue number(double value) {
  return std::isfinite(value) ? QJsonValue(value) : QJsonValue(QJsonValue::Null);
}

QJsonValue number(std::size_t value) { return QJsonValue(static_cast<qint64>(value)); }

QJsonValue text(const std::string& value) { return QJsonValue(QString::fromStdString(value)); }

QJsonObject file_as_json(const FileRecord& file) {
  return {{"file", file.file},
          {"vertices", number(file.vertices)},
          {"faces", number(file.faces)},
          {"notes", QJsonArray::fromStringList(file.notes)}};
}

QJsonObject hole_as_json(const HoleReport& hole, const QString& filter) {
  QJsonArray loops;
  for (const std::size_t loop : hole.loops) loops.append(number(loop));
  return {{"filter", filter},
          {"loops", loops},
          {"edges", number(hole.edges)},
          {"perimeter", number(hole.perimeter)},
          {"centre", QJsonArray{number(hole.centre.x()), number(hole.centre.y()), number(hole.centre.z())}},
          {"outcome", name(hole.outcome)},
          {"route", text(hole.route)},
          {"reason", text(hole.reason)},
          {"vertices_added", number(hole.vertices_added)},
          {"faces_added", number(hole.faces_added)}};
}

QJsonObject filter_as_json(const FilterRecord& filter) {
  QJsonObject parameters;
  for (const auto& parameter : filter.parameters) parameters.insert(parameter.first, parameter.second);
  QJsonArray notes;
  for (const std::string& note : filter.report.notes) notes.append(text(note));
  QJsonObject figures;
  for (const auto& figure : filter.report.figures)
    figures.insert(QString::fromStdString(figure.first), number(figure.second));
  QJsonArray removed, split;
  for (const Index face : filter.report.removed_faces) removed.append(number(std::size_t{face}));
  for (const Index vertex : filter.report.split_vertices) split.append(number(std::size_t{vertex}));
  return {{"name", filter.name},
          {"parameters", parameters},
          {"done", filter.done},
          {"message", filter.message},
          {"seconds", number(filter.seconds)},
          {"notes", notes},
          {"figures", figures},
          {"removed_faces", removed},
          {"split_vertices", split},
          {"log", QJsonArray::fromStringList(filter.log)}};
}

QJsonObject totals_as_json(const RunRecord& record) {
  std::size_t holes = 0, vertices = 0, faces = 0;
  QJsonObject totals;
  for (const HoleOutcome outcome :
       {HoleOutcome::closed, HoleOutcome::partial, HoleOutcome::skipped, HoleOutcome::failed}) {
    std::size_t count = 0;
    for (const FilterRecord& filter : record.filters)
      for (const HoleReport& hole : filter.report.holes) count += hole.outcome == outcome;
    totals.insert(name(outcome), number(count));
  }
  for (const FilterRecord& filter : record.filters) {
    holes += filter.report.holes.size();
    for (const HoleReport& hole : filter.report.holes) {
      vertices += hole.vertices_added;
      faces += hole.faces_added;
    }
  }
  totals.insert("holes", number(holes));
  totals.insert("vertices_added", number(vertices));
  totals.insert("faces_added", number(faces));
  return totals;
}

QJsonArray stages_as_json(const RunRecord& record) {
  const auto stage = [](const QString& filter, const QString& name, double seconds) {
    return QJsonObject{{"filter", filter}, {"stage", name}, {"seconds", number(seconds)}};
  };
  QJsonArray stages = {stage(QString(), "load", record.load_seconds)};
  for (const FilterRecord& filter : record.filters) {
    for (const auto& timed : filter.report.stage_seconds)
      stages.append(stage(filter.name, QString::fromStdString(timed.first), timed.second));
    if (filter.report.stage_seconds.empty()) stages.append(stage(filter.name, "run", filter.seconds));
  }
  stages.append(stage(QString(), "save", record.save_seconds));
  return stages;
}

QString status_in_words(int exit_code) {
  switch (exit_code) {
    case exit_done:
      return "done";
    case exit_usage:
      return "wrong usage";
    case exit_open_holes:
      return "holes left open";
    case exit_cancelled:
      return "cancelled";
    default:
      return "failed";
  }
}

}  // namespace

double peak_memory_mb() {
  QFile status("/proc/self/status");
  if (status.open(QIODevice::ReadOnly)) {
    for (const QByteArray& line : status.readAll().split('\n'))
      if (line.startsWith("VmHWM:")) return line.mid(6).simplified().split(' ').value(0).toDouble() / 1024;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;
}

bool left_open(const RunRecord& record) {
  for (const FilterRecord& filter : record.filters)
    for (const HoleReport& hole : filter.report.holes)
      if (hole.outcome == HoleOutcome::failed) return true;
  return false;
}

QByteArray as_json(const RunRecord& record, int exit_code, const QString& message) {
  QJsonArray inputs, filters, outputs, holes;
  double filter_seconds = 0;
  for (const FileRecord& file : record.inputs) inputs.append(file_as_json(file));
  for (const FileRecord& file : record.outputs) outputs.append(file_as_json(file));
  for (const FilterRecord& filter : record.filters) {
    filters.append(filter_as_json(filter));
    filter_seconds += filter.seconds;
    for (const HoleReport& hole : filter.report.holes) holes.append(hole_as_json(hole, filter.name));
  }
  const QJsonObject seconds = {{"load", number(record.load_seconds)},
                               {"filters", number(filter_seconds)},
                               {"save", number(record.save_seconds)},
                               {"total", number(record.total_seconds)}};
  const QJsonObject object = {{"program", "meshcomplete"},
                              {"version", MESHCOMPLETE_VERSION},
                              {"meshlab", host::RunnerHost::release()},
                              {"exit_code", exit_code},
                              {"status", status_in_words(exit_code)},
                              {"message", message},
                              {"inputs", inputs},
                              {"filters", filters},
                              {"holes", holes},
                              {"totals", totals_as_json(record)},
                              {"outputs", outputs},
                              {"seconds", seconds},
                              {"stages", stages_as_json(record)},
                              {"peak_memory_mb", number(peak_memory_mb())}};
  return QJsonDocument(object).toJson(QJsonDocument::Indented);
}

RunRecord SharedRecord::copy() {
  const bool locked = mutex_.try_lock_for(std::chrono::seconds(1));
  if (!locked) return RunRecord();
  const RunRecord copy = record_;
  mutex_.unlock();
  return copy;
}

}  // namespace runner
}  // namespace meshcomplete
