// What the parts of RunnerHost share. Internal to common/host.
#pragma once

#include <common/pluginmanager.h>

#include <QObject>
#include <QSet>

#include "common/host/meshlab_version.h"
#include "common/host/runner_host.h"

namespace meshcomplete {
namespace host {

struct RunnerHost::State {
  struct Action {
    QAction* action = nullptr;
    MeshFilterInterface* plugin = nullptr;
  };

  MeshDocument document;
  PluginManager manager;
  RichParameterList global_parameters;
  std::map<QString, HostFilter> filters;
  std::map<QString, Action> actions;
  QSet<QString> loaded_files;  ///< file names without folder: the same plugin in two folders is loaded once
  bool meshlab_filters_loaded = false;
  bool meshlab_formats_loaded = false;
  std::map<int, int> file_masks;    ///< mesh id -> attributes that its file had, as bits of vcg's io mask
  std::map<int, int> loaded_masks;  ///< mesh id -> MeshLab's data mask right after loading

  /// Loads one plugin file into the manager; returns what is wrong with it, or nothing.
  QString load_plugin(const QString& path);
  /// Loads the plugins of MeshLab's folder whose names start with `prefix`.
  void load_meshlab_plugins(const QString& prefix);
  MeshIOInterface* reader(const QString& extension);
  MeshIOInterface* writer(const QString& extension);

 private:
  void add_filters(MeshFilterInterface& plugin, DeclaredFilters* declared, const QString& file);
  void add_formats(MeshIOInterface& plugin);
};

/// Forwards MeshLab's callback to a receiver while it lives. MeshLab's callbacks are plain functions, so one
/// at a time.
class CallbackScope {
 public:
  explicit CallbackScope(const Progress::Receiver& receiver);
  ~CallbackScope();
  CallbackScope(const CallbackScope&) = delete;
  CallbackScope& operator=(const CallbackScope&) = delete;
  static bool callback(const int percent, const char* text);
};

/// Closes every dialog that MeshLab's plugins open while it lives: without a display nobody could.
class DialogCloser : public QObject {
 public:
  DialogCloser();
  ~DialogCloser() override;
  /// What the dialogs said; empty when there was none.
  QString message() const { return message_; }
  bool eventFilter(QObject* object, QEvent* event) override;

 private:
  QString message_;
};

}  // namespace host
}  // namespace meshcomplete
