// Filters as data: a plugin says what its filters are called, which parameters they take and what they do;
// the adapter (filter_plugin.h) turns that into the virtual functions of the MeshLab release at hand, the
// runner prints it for
// `--describe`, and the documentation is made from it. No MeshLab type appears here except the names of the
// document and of its layers.
#pragma once

#include <QString>
#include <QStringList>
#include <QVariant>
#include <QtPlugin>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/progress.h"

class MeshDocument;
class MeshModel;

namespace meshcomplete {
namespace host {

enum class ParameterType {
  boolean,
  integer,
  real,
  length,  ///< a length in mesh units that the dialog also offers as a percentage of the bounding-box
           ///< diagonal
  choice,  ///< one of `choices`; the value is its position
  text,
  point,  ///< a point or a direction: a list of three numbers
  layer,  ///< a layer of the document, or none, which is the default; MeshLab is given a choice, with none
          ///< in front of the layers
  open_file,
  save_file,
};

/// One parameter: declared once, used by the dialog, the runner and the documentation.
struct ParameterDeclaration {
  ParameterType type = ParameterType::boolean;
  QString name;       ///< in scripts, e.g. "MaxHoleEdges"
  QString label;      ///< in the dialog
  QString meaning;    ///< the tooltip: what it does, for a MeshLab user
  QString unit;       ///< "edges", "mesh units", ...; empty when it has none
  QVariant fallback;  ///< the default where it does not depend on the mesh
  /// The default where it does (a selection, an edge length, the bounding box); may be empty. The document
  /// may hold no mesh.
  std::function<QVariant(const MeshDocument&)> document_default;
  QString default_in_words;  ///< for --describe and the documentation, when document_default is set
  double minimum = -std::numeric_limits<double>::infinity();  ///< allowed values, inclusive
  double maximum = std::numeric_limits<double>::infinity();
  bool above_minimum = false;  ///< the minimum itself is not allowed
  QStringList choices;

  /// Whether a number lies in the range of allowed values.
  bool allows(double value) const {
    return (above_minimum ? value > minimum : value >= minimum) && value <= maximum;
  }
};

/// The values of one run, by parameter name. Asking for an undeclared name is a programming error and throws.
class ParameterValues {
 public:
  virtual ~ParameterValues() = default;
  virtual bool boolean(const char* name) const = 0;
  virtual int integer(const char* name) const = 0;
  virtual double real(const char* name) const = 0;  ///< also for `length`, in mesh units
  virtual int choice(const char* name) const = 0;
  virtual QString text(const char* name) const = 0;  ///< also for files
  virtual Vector3 point(const char* name) const = 0;
  virtual const MeshModel* layer(const char* name) const = 0;  ///< null for none
};

/// What a filter is given when it runs. It may throw anything: the adapter turns it into MeshLab's way of
/// failing.
struct FilterRun {
  MeshDocument& document;
  const ParameterValues& parameters;
  Progress progress;
  std::function<void(const QString&)> log;
  CompletionReport&
      report;  ///< filled by the filter; the runner writes it as JSON and derives its exit code from it
};

enum class MenuPlace {
  remeshing,
  range_map,
  quality
};  ///< "Remeshing, Simplification and Reconstruction", "Range Map", "Quality Measure and Computations"
enum class Arity { one_mesh, visible_meshes, no_mesh };

struct FilterDeclaration {
  QString name;         ///< in the menu and in scripts
  QString python_name;  ///< for later MeshLab releases
  QString description;  ///< MeshLab's style: HTML, ends with the citation
  MenuPlace place = MenuPlace::remeshing;
  Arity arity = Arity::one_mesh;
  std::vector<ParameterDeclaration> parameters;
  std::function<void(FilterRun&)> apply;
  bool changes_mesh = true;  ///< false for filters that only report: MeshLab then redraws nothing
};

/// Implemented by every plugin of the suite, beside MeshLab's own interface, so that the runner can ask for
/// what MeshLab's interface cannot say: ranges and units before a run, the report after it.
class DeclaredFilters {
 public:
  virtual ~DeclaredFilters() = default;
  virtual const std::vector<FilterDeclaration>& declarations() const = 0;
  /// The report of the last run of any filter of this plugin, also of a failed one.
  virtual const CompletionReport& last_report() const = 0;
  /// The progress receiver that replaces MeshLab's callback during the next runs; an empty one restores it.
  virtual void set_progress_receiver(Progress::Receiver receiver) = 0;
};

}  // namespace host
}  // namespace meshcomplete

Q_DECLARE_INTERFACE(meshcomplete::host::DeclaredFilters, "org.meshcomplete.DeclaredFilters/1")
