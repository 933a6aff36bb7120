#include "tools/meshcomplete/session.h"

#include <QCoreApplication>
#include <QDir>
#include <QElapsedTimer>
#include <QFileInfo>
#include <QSaveFile>

#include "common/core/error.h"
#include "tools/meshcomplete/errors.h"
#include "tools/meshcomplete/guard.h"
#include "tools/meshcomplete/help.h"
#include "tools/meshcomplete/input_check.h"
#include "tools/meshcomplete/project.h"
#include "tools/meshcomplete/script.h"
#include "tools/meshcomplete/suggest.h"
#include "tools/meshcomplete/values.h"

namespace meshcomplete {
namespace runner {

using host::HostFilter;
using host::ParameterDeclaration;

namespace {

double seconds_of(const QElapsedTimer& timer) { return double(timer.nsecsElapsed()) * 1e-9; }

}  // namespace

Session::Session(const Options& options, host::RunnerHost& host, Console& console, SharedRecord& record)
    : options_(options), host_(host), console_(console), record_(record) {}

int Session::run() {
  load_own_plugins();
  const bool answered = answer_questions();
  if (answered && options_.steps.empty() && options_.sources.empty()) return exit_done;
  check_request();
  QElapsedTimer timer;
  timer.start();
  load_sources();
  record_.edit([&](RunRecord& record) { record.load_seconds = seconds_of(timer); });
  for (const Step& step : steps_) run_step(step);
  save();
  return left_open(record_.copy()) ? exit_open_holes : exit_done;
}

void Session::load_own_plugins() {
  const QString beside = QCoreApplication::applicationDirPath() + "/../lib/meshlab/plugins";
  if (QFileInfo(beside).isDir())
    for (const QString& complaint : host_.load_plugins(beside)) console_.warn(complaint);
  for (const QString& folder : options_.plugin_folders) {
    if (!QFileInfo(folder).isDir()) throw UsageError("There is no plugin folder " + folder + ".");
    for (const QString& complaint : host_.load_plugins(folder)) console_.warn(complaint);
  }
}

bool Session::answer_questions() {
  if (options_.list) {
    host_.load_meshlab_filters();
    console_.print(list_text(host_));
  }
  if (!options_.describe.isEmpty()) console_.print(describe_text(host_, filter_called(options_.describe)));
  if (!options_.dump_file.isEmpty()) write_dump();
  return options_.list || !options_.describe.isEmpty() || !options_.dump_file.isEmpty();
}

void Session::write_dump() {
  host_.load_meshlab_filters();
  QSaveFile file(options_.dump_file);
  if (!file.open(QIODevice::WriteOnly))
    throw UsageError(QString("Cannot write %1: %2.").arg(options_.dump_file, file.errorString()));
  for (const HostFilter* filter : host_.filters()) {
    guard::set_activity("describing " + filter->name);
    file.write(describe_text(host_, *filter).toUtf8() + "\n\n");
  }
  if (!file.commit())
    throw Failure(QString("Cannot write %1: %2.").arg(options_.dump_file, file.errorString()));
}

const HostFilter& Session::filter_called(const QString& name) {
  const HostFilter* filter = host_.find_filter(name);
  if (filter == nullptr) {
    host_.load_meshlab_filters();
    filter = host_.find_filter(name);
  }
  if (filter != nullptr) return *filter;
  QStringList names;
  for (const HostFilter* known : host_.filters()) names << known->name;
  throw UsageError("There is no filter \"" + name + "\"." + did_you_mean(name, names) +
                   " --list shows all of them.");
}

void Session::check_request() {
  if (options_.sources.empty() && options_.steps.empty())
    throw UsageError("Nothing to do: give a mesh to read (-i FILE). See --help.");
  if (options_.steps.empty() && options_.outputs.empty() && options_.projects.empty())
    throw UsageError(
        "Nothing to do: give a filter (-f NAME or -s SCRIPT.mlx) or a file to write (-o FILE). See --help.");
  for (const Source& source : options_.sources)
    check_readable(source.path, source.project ? QStringList("mlp") : host_.readable_formats());
  for (const MeshOutput& output : options_.outputs) {
    const QString extension = QFileInfo(output.path).suffix().toLower();
    const QStringList formats = host_.writable_formats();
    if (!formats.contains(extension))
      throw UsageError(QString("MeshLab does not write files like %1. It writes: %2.%3")
                           .arg(output.path, formats.join(' '), did_you_mean(extension, formats)));
    outputs_.claim(output.path);
  }
  for (const ProjectOutput& project : options_.projects) outputs_.claim(project.path);
  for (const StepRequest& request : options_.steps) {
    if (!request.script) {
      add_step(request, false);
      continue;
    }
    for (const StepRequest& scripted : read_script(request.name)) add_step(scripted, true);
  }
}

void Session::add_step(const StepRequest& request, bool scripted) {
  Step step;
  step.scripted = scripted;
  step.filter = &filter_called(request.name);
  step.parameters = request.parameters;
  for (std::size_t i = 0; i < step.parameters.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (step.parameters[i].first == step.parameters[j].first)
        throw UsageError(QString("Parameter \"%1\" of %2 is given twice.")
                             .arg(step.parameters[i].first, step.filter->name));
  if (step.filter->declaration != nullptr) check_declared_parameters(step);
  steps_.push_back(step);
}

void Session::check_declared_parameters(const Step& step) const {
  QStringList names;
  for (const ParameterDeclaration& declaration : step.filter->declaration->parameters)
    names << declaration.name;
  for (const auto& given : step.parameters) {
    const int position = names.indexOf(given.first);
    if (position < 0)
      throw UsageError(QString("%1 has no parameter \"%2\".%3 --describe \"%1\" shows all of them.")
                           .arg(step.filter->name, given.first, did_you_mean(given.first, names)));
    const ParameterDeclaration& declaration = step.filter->declaration->parameters[std::size_t(position)];
    parse_value(as_host_parameter(declaration), &declaration, nullptr, given.second);
  }
}

Progress::Receiver Session::receiver() {
  return [this](double fraction, const std::string& stage) {
    console_.progress(fraction, QString::fromStdString(stage));
    return !guard::cancelled();
  };
}

void Session::load_sources() {
  guard::set_reaction(guard::Reaction::end_at_once);
  for (const Source& source : options_.sources)
    if (source.project)
      load_project(source.path);
    else
      load_mesh(source.path);
}

void Session::load_mesh(const QString& path) {
  guard::set_activity("reading " + path);
  console_.begin("Reading " + QFileInfo(path).fileName());
  if (QFileInfo(path).size() == 0) throw Failure("The file " + path + " is empty.");
  FileRecord file;
  file.file = QFileInfo(path).absoluteFilePath();
  try {
    file.notes = host_.load(path, receiver());
  } catch (const CompletionError& error) {
    QString why = QString::fromStdString(error.what());
    while (why.endsWith('.')) why.chop(1);
    throw Failure(QString("Cannot read %1: %2.").arg(path, why));
  }
  const host::LayerInfo layer = host_.layers().back();
  file.vertices = layer.vertices;
  file.faces = layer.faces;
  console_.log(QString("Read %1: %2.").arg(path, file.counts()));
  for (const QString& note : file.notes) console_.log("  " + note);
  record_.edit([&](RunRecord& record) { record.inputs.push_back(file); });
}

void Session::load_project(const QString& path) {
  bool has_rasters = false;
  for (const ProjectLayer& layer : read_project(path, has_rasters)) {
    check_readable(layer.file, host_.readable_formats());
    load_mesh(layer.file);
    host_.set_transformation(host_.current_layer(), layer.transformation);
    if (!layer.label.isEmpty()) host_.set_label(host_.current_layer(), layer.label);
  }
  if (has_rasters) console_.warn("The photographs of the project " + path + " are left out.");
}

}  // namespace runner
}  // namespace meshcomplete
