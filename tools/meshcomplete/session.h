// One run of the program, from the checked command line to the files written.
#pragma once

#include <map>
#include <vector>

#include "common/host/runner_host.h"
#include "tools/meshcomplete/console.h"
#include "tools/meshcomplete/options.h"
#include "tools/meshcomplete/output.h"
#include "tools/meshcomplete/report.h"

namespace meshcomplete {
namespace runner {

class Session {
 public:
  /// All of them have to outlive the session.
  Session(const Options& options, host::RunnerHost& host, Console& console, SharedRecord& record);

  /// Does what the options ask for. Returns the exit code (0 or 3). Throws UsageError, Failure, Interrupted.
  int run();

 private:
  struct Step {
    const host::HostFilter* filter = nullptr;
    bool scripted = false;  ///< values are those of MeshLab's scripts
    std::vector<std::pair<QString, QString>> parameters;
  };

  void load_own_plugins();
  bool answer_questions();
  void check_request();
  const host::HostFilter& filter_called(const QString& name);
  void add_step(const StepRequest& request, bool scripted);
  void check_declared_parameters(const Step& step) const;

  void load_sources();
  void load_mesh(const QString& path);
  void load_project(const QString& path);

  void run_step(const Step& step);
  std::map<QString, QVariant> values_of(const Step& step, FilterRecord& record);
  void print_open_holes(const CompletionReport& report);

  void save();
  void save_layer(int layer, const QString& path, const host::SaveOptions& save_options);
  void save_project(const ProjectOutput& project);
  QString project_mesh_path(const ProjectOutput& project, const host::LayerInfo& layer) const;
  int layer_for(const MeshOutput& output) const;
  Progress::Receiver receiver();
  void write_dump();

  const Options& options_;
  host::RunnerHost& host_;
  Console& console_;
  SharedRecord& record_;
  OutputSet outputs_;
  std::vector<Step> steps_;
};

}  // namespace runner
}  // namespace meshcomplete
