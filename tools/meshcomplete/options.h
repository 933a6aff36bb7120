// The command line.
#pragma once

#include <QString>
#include <QStringList>
#include <optional>
#include <utility>
#include <vector>

namespace meshcomplete {
namespace runner {

/// A mesh or a project to load, in the order of the command line.
struct Source {
  QString path;
  bool project = false;
};

/// A filter with its parameters as text, or a script of filters.
struct StepRequest {
  bool script = false;
  QString name;  ///< the filter's name or the script's path
  std::vector<std::pair<QString, QString>> parameters;
};

/// Which layer a mesh file gets.
struct LayerChoice {
  enum Kind { current, last, position } kind = current;
  int index = 0;
};

struct MeshOutput {
  QString path;
  LayerChoice layer;
  std::optional<QStringList> attributes;
  bool binary = true;
};

struct ProjectOutput {
  QString path;
  bool overwrite_meshes = false;
};

struct Options {
  std::vector<Source> sources;
  std::vector<StepRequest> steps;
  std::vector<MeshOutput> outputs;
  std::vector<ProjectOutput> projects;
  QString report;
  QString log_file;
  QString dump_file;
  QString describe;
  QStringList plugin_folders;
  std::optional<int> threads;
  bool list = false;
  bool help = false;
  bool version = false;
  bool quiet = false;
};

/// Throws UsageError with the nearest option when one is misspelt.
Options parse_options(const QStringList& arguments);

}  // namespace runner
}  // namespace meshcomplete
