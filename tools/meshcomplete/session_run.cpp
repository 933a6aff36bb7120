// Running filters and writing files.
#include <QDir>
#include <QElapsedTimer>
#include <QFile>
#include <QFileInfo>

#include "common/core/error.h"
#include "tools/meshcomplete/errors.h"
#include "tools/meshcomplete/exact_text.h"
#include "tools/meshcomplete/guard.h"
#include "tools/meshcomplete/project.h"
#include "tools/meshcomplete/session.h"
#include "tools/meshcomplete/suggest.h"
#include "tools/meshcomplete/values.h"

namespace meshcomplete {
namespace runner {

using host::HostFilter;
using host::HostParameter;
using host::ParameterDeclaration;

namespace {

/// So many open holes are listed one by one when quiet; the report has them all.
constexpr std::size_t open_holes_listed = 30;

double seconds_of(const QElapsedTimer& timer) { return double(timer.nsecsElapsed()) * 1e-9; }

const ParameterDeclaration* declaration_of(const HostFilter& filter, const QString& name) {
  if (filter.declaration == nullptr) return nullptr;
  for (const ParameterDeclaration& declaration : filter.declaration->parameters)
    if (declaration.name == name) return &declaration;
  return nullptr;
}

}  // namespace

std::map<QString, QVariant> Session::values_of(const Step& step, FilterRecord& record) {
  std::vector<HostParameter> parameters;
  try {
    parameters = host_.parameters(*step.filter);
  } catch (const std::exception& error) {
    throw Failure(QString("%1 cannot run on this mesh: %2.").arg(step.filter->name, error.what()));
  }
  std::map<QString, QVariant> values;
  QStringList names;
  for (const HostParameter& parameter : parameters) names << parameter.name;
  const std::vector<host::LayerInfo> layers = host_.layers();
  for (const auto& given : step.parameters) {
    const int position = names.indexOf(given.first);
    if (position < 0)
      throw UsageError(QString("%1 has no parameter \"%2\".%3 --describe \"%1\" shows all of them.")
                           .arg(step.filter->name, given.first, did_you_mean(given.first, names)));
    const HostParameter& parameter = parameters[std::size_t(position)];
    const ParameterDeclaration* declaration = declaration_of(*step.filter, given.first);
    // To MeshLab a layer parameter of ours is a choice, with none in front of the layers.
    if (declaration != nullptr && declaration->type == host::ParameterType::layer && !step.scripted)
      values[given.first] =
          parse_value(as_host_parameter(*declaration), declaration, &layers, given.second).toInt() + 1;
    else
      values[given.first] = parse_value(parameter, declaration, &layers, given.second);
  }
  for (const HostParameter& parameter : parameters) {
    const auto given = values.find(parameter.name);
    const QVariant& value = given == values.end() ? parameter.value : given->second;
    record.parameters.emplace_back(parameter.name, value_in_words(parameter, value));
  }
  return values;
}

void Session::run_step(const Step& step) {
  const HostFilter& filter = *step.filter;
  guard::set_activity("running " + filter.name);
  FilterRecord record;
  record.name = filter.name;
  const QString obstacle = host_.obstacle(filter);
  if (!obstacle.isEmpty()) throw Failure(filter.name + " cannot run. " + obstacle);
  const std::map<QString, QVariant> values = values_of(step, record);
  // MeshLab's own filters do not stop when asked; nothing is lost when the program ends instead.
  const bool ours = filter.declared != nullptr;
  guard::set_reaction(ours ? guard::Reaction::ask : guard::Reaction::end_at_once);
  console_.begin("Running " + filter.name);
  QElapsedTimer timer;
  timer.start();
  const host::RunOutcome outcome = host_.run(filter, values, receiver(), [&](const QString& text) {
    for (const QString& line : text.split('\n', Qt::SkipEmptyParts)) {
      record.log << line;
      console_.log(line);
    }
  });
  console_.end_progress();
  record.seconds = seconds_of(timer);
  record.done = outcome.done && !guard::cancelled();
  record.message = outcome.message;
  record.report = outcome.report;
  record_.edit([&](RunRecord& all) { all.filters.push_back(record); });
  guard::set_reaction(guard::Reaction::end_at_once);
  if (guard::cancelled()) throw Interrupted();
  if (!outcome.done) {
    const QString why = outcome.message.isEmpty() ? "It gave no reason; its log may." : outcome.message;
    throw Failure(filter.name + " failed: " + why);
  }
  print_open_holes(outcome.report);
}

void Session::print_open_holes(const CompletionReport& report) {
  std::size_t open = 0;
  for (std::size_t number = 0; number < report.holes.size(); ++number) {
    const HoleReport& hole = report.holes[number];
    if (hole.outcome != HoleOutcome::failed) continue;
    // The filter's own log has said the same, unless nobody has seen it.
    if (!options_.quiet || open++ >= open_holes_listed) continue;
    console_.warn(
        QString("hole %1 (%2 edges, near %3, %4, %5) is open: %6.")
            .arg(number + 1)
            .arg(hole.edges)
            .arg(hole.centre.x())
            .arg(hole.centre.y())
            .arg(hole.centre.z())
            .arg(hole.reason.empty() ? "no reason given" : QString::fromStdString(hole.reason).simplified()));
  }
  open = report.count(HoleOutcome::failed);
  if (open > 0) console_.warn(QString("%1 of %2 holes were left open.").arg(open).arg(report.holes.size()));
}

int Session::layer_for(const MeshOutput& output) const {
  const int count = int(host_.layers().size());
  if (count == 0) throw Failure("There is no mesh to write to " + output.path + ".");
  switch (output.layer.kind) {
    case LayerChoice::current:
      return host_.current_layer() < 0 ? count - 1 : host_.current_layer();
    case LayerChoice::last:
      return count - 1;
    case LayerChoice::position:
      break;
  }
  if (output.layer.index >= count)
    throw UsageError(
        QString("There is no layer %1; there are %2 layers, counted from 0. It is asked for by -o ")
            .arg(output.layer.index)
            .arg(count) +
        output.path + ".");
  return output.layer.index;
}

void Session::save() {
  QElapsedTimer timer;
  timer.start();
  for (const MeshOutput& output : options_.outputs) {
    host::SaveOptions save_options;
    save_options.attributes = output.attributes;
    save_options.binary = output.binary;
    save_layer(layer_for(output), output.path, save_options);
  }
  for (const ProjectOutput& project : options_.projects) save_project(project);
  // From here on a Ctrl-C comes too late: either everything is put in place or nothing.
  guard::set_reaction(guard::Reaction::finish);
  outputs_.commit();
  console_.end_progress();
  record_.edit([&](RunRecord& record) { record.save_seconds = seconds_of(timer); });
  for (const FileRecord& file : record_.copy().outputs)
    console_.log(QString("Wrote %1: %2.").arg(file.file, file.counts()));
}

void Session::save_layer(int layer, const QString& path, const host::SaveOptions& save_options) {
  guard::set_activity("writing " + path);
  console_.begin("Writing " + QFileInfo(path).fileName());
  const QString temporary = outputs_.temporary_path(path);
  FileRecord file;
  file.file = QFileInfo(path).absoluteFilePath();
  QStringList lost;
  try {
    lost = host_.save(layer, temporary, save_options, receiver());
  } catch (const CompletionError& error) {
    throw Failure(QString("Cannot write %1: %2.").arg(path, QString::fromStdString(error.what())));
  }
  if (!QFileInfo(temporary).isFile() || QFileInfo(temporary).size() == 0)
    throw Failure(QString("Cannot write %1: MeshLab's writer left no file.").arg(path));
  if (!lost.isEmpty() && save_options.attributes)
    file.notes << QString("%1: this format does not hold the attributes %2.").arg(path, lost.join(' '));
  const QString rounded = restore_coordinates(temporary, host_.geometry(layer), save_options.binary);
  if (!rounded.isEmpty()) file.notes << rounded;
  for (const QString& note : file.notes) console_.warn(note);
  const host::LayerInfo info = host_.layers().at(std::size_t(layer));
  file.vertices = info.vertices;
  file.faces = info.faces;
  record_.edit([&](RunRecord& record) { record.outputs.push_back(file); });
}

QString Session::project_mesh_path(const ProjectOutput& project, const host::LayerInfo& layer) const {
  const QString ending = project.overwrite_meshes ? QString() : QString("_out");
  const QFileInfo file(layer.file);
  if (layer.file.isEmpty() || !file.exists())
    return QFileInfo(project.path).absolutePath() + "/" + QString(layer.label).remove(' ').replace('/', '_') +
           ending + ".ply";
  const bool writable = host_.writable_formats().contains(file.suffix().toLower());
  return file.absolutePath() + "/" + file.completeBaseName() + ending + "." +
         (writable ? file.suffix() : QString("ply"));
}

void Session::save_project(const ProjectOutput& project) {
  std::vector<ProjectLayer> layers;
  const std::vector<host::LayerInfo> infos = host_.layers();
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const QString path = project_mesh_path(project, infos[i]);
    outputs_.claim(path);
    save_layer(int(i), path, host::SaveOptions());
    layers.push_back({path, infos[i].label, host_.transformation(int(i))});
  }
  QFile file(outputs_.temporary_path(project.path));
  if (!file.open(QIODevice::WriteOnly) || file.write(project_as_xml(project.path, layers)) < 0)
    throw Failure(QString("Cannot write %1: %2.").arg(project.path, file.errorString()));
}

}  // namespace runner
}  // namespace meshcomplete
