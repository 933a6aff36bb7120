// What a program that runs filters without MeshLab's window needs from MeshLab: plugins, parameters, files,
// layers. No MeshLab type appears here, so that the runner is the same for every MeshLab release.
#pragma once

#include <QString>
#include <QStringList>
#include <QVariant>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "common/core/patch.h"
#include "common/core/progress.h"
#include "common/host/filter_declaration.h"

namespace meshcomplete {
namespace host {

/// What a parameter's value is, and which QVariant holds it.
enum class ValueKind {
  boolean,        ///< bool
  integer,        ///< int
  real,           ///< double
  length,         ///< double, mesh units
  choice,         ///< int, the position in `choices`
  text,           ///< QString
  layer,          ///< int, the layer's position in the document
  layer_or_none,  ///< int, likewise; -1 is none. Declared parameters only
  open_file,      ///< QString
  save_file,      ///< QString
  numbers,        ///< QVariantList of `count` doubles: a colour (0 to 255), a point, a matrix
  unsupported,    ///< keeps its default
};

/// A parameter of a filter, with the default it has for the document as it stands.
struct HostParameter {
  ValueKind kind = ValueKind::unsupported;
  QString name;
  QString label;
  QString meaning;
  QVariant value;
  QStringList choices;
  double minimum = -std::numeric_limits<double>::infinity();  ///< of a length: what 0 % stands for
  double maximum = std::numeric_limits<double>::infinity();   ///< of a length: what 100 % stands for
  int count = 0;
};

/// A filter of a loaded plugin.
struct HostFilter {
  QString name;
  QString description;  ///< HTML
  QString plugin;       ///< the plugin's file name
  bool needs_opengl = false;
  const FilterDeclaration* declaration = nullptr;  ///< null for MeshLab's own filters
  DeclaredFilters* declared = nullptr;             ///< null for MeshLab's own filters
};

/// What a run of a filter came to.
struct RunOutcome {
  bool done = false;
  QString message;  ///< why it was not done
  CompletionReport report;
};

/// A layer of the document.
struct LayerInfo {
  QString label;
  QString file;  ///< absolute; empty for a layer made by a filter
  std::size_t vertices = 0;
  std::size_t faces = 0;
  bool current = false;
};

/// What is in a layer, in the order in which a writer stores it.
struct LayerGeometry {
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;
};

/// How a layer is saved.
struct SaveOptions {
  /// meshlabserver's two-letter codes ("vc", "fq", ...); absent: what the layer's file had and filters have
  /// added.
  std::optional<QStringList> attributes;
  bool binary = true;
};

/// MeshLab without its window: one document, the plugins, and what can be done with them. Needs a
/// QApplication. Reading and writing throw CompletionError with a message for the user.
class RunnerHost {
 public:
  RunnerHost();
  ~RunnerHost();

  /// The release that the program was built for, e.g. "2020.09".
  static QString release();
  /// Where MeshLab keeps its own plugins: beside the library that this program has loaded.
  static QString meshlab_plugin_folder();
  /// meshlabserver's codes of the attributes that can be saved.
  static QStringList attribute_codes();

  /// Loads every plugin of a folder; returns a message for each file that is not a plugin of this MeshLab.
  QStringList load_plugins(const QString& folder);
  /// Loads MeshLab's own filters, once. Plugins loaded before keep their place when names clash.
  void load_meshlab_filters();
  /// All filters loaded so far, ours first, by name.
  std::vector<const HostFilter*> filters() const;
  const HostFilter* find_filter(const QString& name) const;
  /// The parameters for the current document; for a tetrahedron when the document is empty.
  std::vector<HostParameter> parameters(const HostFilter& filter);
  /// Why the filter cannot run on the current layer; empty when it can.
  QString obstacle(const HostFilter& filter);
  /// Runs a filter; values that are not given have their defaults. Log lines arrive as they are written.
  RunOutcome run(const HostFilter& filter, const std::map<QString, QVariant>& values,
                 const Progress::Receiver& receiver, const std::function<void(const QString&)>& log);

  /// Extensions that can be read and written, lower case.
  QStringList readable_formats();
  QStringList writable_formats();
  /// Adds the mesh of a file as a layer and makes it current, changing nothing of it but what the notes say.
  QStringList load(const QString& path, const Progress::Receiver& receiver);
  /// Writes a layer; the extension chooses the format. Returns what the format could not hold.
  QStringList save(int layer, const QString& path, const SaveOptions& options,
                   const Progress::Receiver& receiver);

  std::vector<LayerInfo> layers() const;
  int current_layer() const;  ///< -1 when there is none
  void set_current_layer(int layer);
  LayerGeometry geometry(int layer) const;
  /// The layer's transformation, row by row.
  std::array<double, 16> transformation(int layer) const;
  void set_transformation(int layer, const std::array<double, 16>& matrix);
  void set_label(int layer, const QString& label);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace host
}  // namespace meshcomplete
