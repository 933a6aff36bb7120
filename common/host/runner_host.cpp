#include "common/host/runner_host.h"

#include <dlfcn.h>

#include <QApplication>
#include <QDialog>
#include <QDir>
#include <QEvent>
#include <QFileInfo>
#include <QMessageBox>
#include <QPluginLoader>
#include <QTimer>
#include <algorithm>

#include "common/host/runner_state.h"

namespace meshcomplete {
namespace host {

namespace {

const Progress::Receiver* current_receiver = nullptr;

/// Plugins whose filters draw with OpenGL, which a program without a display does not have.
bool draws(const QString& file) {
  static const QStringList drawing = {"libfilter_ao.so",
                                      "libfilter_color_projection.so",
                                      "libfilter_mutualglobal.so",
                                      "libfilter_mutualinfo.so",
                                      "libfilter_sample_gpu.so",
                                      "libfilter_sdfgpu.so",
                                      "libfilter_img_patch_param.so"};
  return drawing.contains(file);
}

/// A filter's name without the marks and blanks that menus do not show.
QString plain_name(const QString& name) { return QString(name).remove('&').trimmed(); }

}  // namespace

CallbackScope::CallbackScope(const Progress::Receiver& receiver) { current_receiver = &receiver; }

CallbackScope::~CallbackScope() { current_receiver = nullptr; }

bool CallbackScope::callback(const int percent, const char* text) {
  if (current_receiver == nullptr || !*current_receiver) return true;
  const double fraction = std::min(100, std::max(0, percent)) / 100.0;
  return (*current_receiver)(fraction, text == nullptr ? std::string() : std::string(text));
}

DialogCloser::DialogCloser() { qApp->installEventFilter(this); }

DialogCloser::~DialogCloser() { qApp->removeEventFilter(this); }

bool DialogCloser::eventFilter(QObject* object, QEvent* event) {
  QDialog* dialog = event->type() == QEvent::Show ? qobject_cast<QDialog*>(object) : nullptr;
  if (dialog != nullptr) {
    const QMessageBox* box = qobject_cast<QMessageBox*>(dialog);
    message_ +=
        (box != nullptr ? box->text() : dialog->windowTitle()).section("Error details:", -1).simplified();
    QTimer::singleShot(0, dialog, &QDialog::reject);
  }
  return false;
}

RunnerHost::RunnerHost() : state_(new State) {}

RunnerHost::~RunnerHost() = default;

QString RunnerHost::release() {
  return QString::number(MESHCOMPLETE_MESHLAB / 100) + QString::asprintf(".%02d", MESHCOMPLETE_MESHLAB % 100);
}

QString RunnerHost::meshlab_plugin_folder() {
  // Any function of MeshLab's library does: the linker knows the file that it came from.
  Dl_info info;
  const auto function = &PluginManager::getBaseDirPath;
  if (dladdr(reinterpret_cast<void*>(function), &info) == 0 || info.dli_fname == nullptr) return QString();
  return QFileInfo(QString::fromLocal8Bit(info.dli_fname)).canonicalPath() + "/plugins";
}

QString RunnerHost::State::load_plugin(const QString& path) {
  const QString file = QFileInfo(path).fileName();
  if (loaded_files.contains(file)) return QString();
  QPluginLoader loader(path);
  QObject* object = loader.instance();
  if (object == nullptr) return loader.errorString();
  loaded_files.insert(file);
  manager.pluginsLoaded.push_back(file);
  MeshFilterInterface* filter = qobject_cast<MeshFilterInterface*>(object);
  MeshIOInterface* format = qobject_cast<MeshIOInterface*>(object);
  if (filter != nullptr) {
    manager.meshFilterPlug.push_back(filter);
    manager.ownerPlug.push_back(filter);
    add_filters(*filter, qobject_cast<DeclaredFilters*>(object), file);
  }
  if (format != nullptr) {
    manager.meshIOPlug.push_back(format);
    if (filter == nullptr) manager.ownerPlug.push_back(format);
    add_formats(*format);
  }
  return filter == nullptr && format == nullptr ? file + " holds no filter and no file format of MeshLab."
                                                : QString();
}

void RunnerHost::State::add_filters(MeshFilterInterface& plugin, DeclaredFilters* declared,
                                    const QString& file) {
  for (QAction* action : plugin.actions()) {
    HostFilter filter;
    filter.name = plain_name(action->text());
    if (filters.count(filter.name) > 0) continue;
    action->setData(file);
    filter.description = plugin.filterInfo(action);
    filter.plugin = file;
    filter.needs_opengl = draws(file);
    if (declared != nullptr) {
      for (const FilterDeclaration& declaration : declared->declarations())
        if (declaration.name == filter.name) filter.declaration = &declaration;
      if (filter.declaration != nullptr) filter.declared = declared;
    }
    plugin.initGlobalParameterSet(action, global_parameters);
    manager.actionFilterMap.insert(action->text(), action);
    manager.stringFilterMap.insert(action->text(), &plugin);
    filters[filter.name] = filter;
    actions[filter.name] = {action, &plugin};
  }
}

void RunnerHost::State::add_formats(MeshIOInterface& plugin) {
  plugin.initGlobalParameterSet(nullptr, global_parameters);
  for (const MeshIOInterface::Format& format : plugin.importFormats())
    for (const QString& extension : format.extensions)
      if (!manager.allKnowInputFormats.contains(extension.toLower()))
        manager.allKnowInputFormats.insert(extension.toLower(), &plugin);
  for (const MeshIOInterface::Format& format : plugin.exportFormats())
    for (const QString& extension : format.extensions)
      if (!manager.allKnowOutputFormats.contains(extension.toLower()))
        manager.allKnowOutputFormats.insert(extension.toLower(), &plugin);
}

void RunnerHost::State::load_meshlab_plugins(const QString& prefix) {
  const QDir folder(meshlab_plugin_folder());
  for (const QString& file : folder.entryList({prefix + "*.so"}, QDir::Files, QDir::Name))
    load_plugin(folder.absoluteFilePath(file));
}

QStringList RunnerHost::load_plugins(const QString& folder) {
  QStringList complaints;
  const QDir directory(folder);
  for (const QString& file : directory.entryList({"*.so"}, QDir::Files, QDir::Name)) {
    const QString complaint = state_->load_plugin(directory.absoluteFilePath(file));
    if (!complaint.isEmpty()) complaints.append(complaint);
  }
  return complaints;
}

void RunnerHost::load_meshlab_filters() {
  if (state_->meshlab_filters_loaded) return;
  state_->meshlab_filters_loaded = true;
  state_->load_meshlab_plugins("libfilter_");
  state_->load_meshlab_plugins("libglobalregistration");
}

std::vector<const HostFilter*> RunnerHost::filters() const {
  std::vector<const HostFilter*> found;
  for (const bool ours : {true, false})
    for (const auto& entry : state_->filters)
      if ((entry.second.declaration != nullptr) == ours) found.push_back(&entry.second);
  return found;
}

const HostFilter* RunnerHost::find_filter(const QString& name) const {
  const auto found = state_->filters.find(plain_name(name));
  return found == state_->filters.end() ? nullptr : &found->second;
}

std::vector<LayerInfo> RunnerHost::layers() const {
  std::vector<LayerInfo> layers;
  for (const MeshModel* mesh : state_->document.meshList) {
    LayerInfo layer;
    layer.label = mesh->label();
    layer.file = mesh->fullName();
    layer.vertices = static_cast<std::size_t>(mesh->cm.vn);
    layer.faces = static_cast<std::size_t>(mesh->cm.fn);
    layer.current = mesh == state_->document.mm();
    layers.push_back(layer);
  }
  return layers;
}

int RunnerHost::current_layer() const { return state_->document.meshList.indexOf(state_->document.mm()); }

void RunnerHost::set_current_layer(int layer) {
  if (layer >= 0 && layer < state_->document.size())
    state_->document.setCurrentMesh(state_->document.meshList[layer]->id());
}

std::array<double, 16> RunnerHost::transformation(int layer) const {
  std::array<double, 16> matrix{};
  const auto& stored = state_->document.meshList.at(layer)->cm.Tr;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      matrix[std::size_t(4 * row + column)] = stored.ElementAt(row, column);
  return matrix;
}

void RunnerHost::set_transformation(int layer, const std::array<double, 16>& matrix) {
  auto& stored = state_->document.meshList.at(layer)->cm.Tr;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      stored.ElementAt(row, column) = static_cast<float>(matrix[std::size_t(4 * row + column)]);
}

void RunnerHost::set_label(int layer, const QString& label) {
  state_->document.meshList.at(layer)->setLabel(label);
}

}  // namespace host
}  // namespace meshcomplete
