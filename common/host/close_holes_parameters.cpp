#include "common/host/close_holes_parameters.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/core/error.h"
#include "common/host/meshlab_version.h"

namespace meshcomplete {
namespace host {
namespace {

bool anything_selected(const MeshDocument& document) {
  const MeshModel* model = document.mm();
  if (model == nullptr) return false;
  const auto selected = [](const auto& element) { return !element.IsD() && element.IsS(); };
  return std::any_of(model->cm.face.begin(), model->cm.face.end(), selected) ||
         std::any_of(model->cm.vert.begin(), model->cm.vert.end(), selected);
}

ParameterDeclaration parameter(ParameterType type, const char* name, const char* label, const char* meaning) {
  ParameterDeclaration result;
  result.type = type;
  result.name = name;
  result.label = label;
  result.meaning = meaning;
  return result;
}

ParameterDeclaration selected_parameter() {
  ParameterDeclaration selected = switch_parameter("Selected", "Close only selected holes",
                                                   "Only holes with at least one selected face or vertex at "
                                                   "their boundary are closed. On by default when something "
                                                   "is selected.",
                                                   false);
  selected.document_default = [](const MeshDocument& document) { return anything_selected(document); };
  selected.default_in_words = "on when something is selected";
  return selected;
}

}  // namespace

ParameterDeclaration switch_parameter(const char* name, const char* label, const char* meaning, bool on) {
  ParameterDeclaration result = parameter(ParameterType::boolean, name, label, meaning);
  result.fallback = on;
  return result;
}

ParameterDeclaration choice_parameter(const char* name, const char* label, const char* meaning,
                                      QStringList choices, int fallback) {
  ParameterDeclaration result = parameter(ParameterType::choice, name, label, meaning);
  result.fallback = fallback;
  result.minimum = 0;
  result.maximum = static_cast<double>(choices.size() - 1);
  result.choices = std::move(choices);
  return result;
}

ParameterDeclaration integer_parameter(const char* name, const char* label, const char* meaning,
                                       const char* unit, int fallback, int minimum, int maximum) {
  ParameterDeclaration result = parameter(ParameterType::integer, name, label, meaning);
  result.unit = unit;
  result.fallback = fallback;
  result.minimum = minimum;
  result.maximum = maximum;
  return result;
}

ParameterDeclaration length_parameter(const char* name, const char* label, const char* meaning) {
  ParameterDeclaration result = parameter(ParameterType::length, name, label, meaning);
  result.unit = "mesh units";
  result.fallback = 0.0;
  result.minimum = 0;
  return result;
}

ParameterDeclaration positive_parameter(const char* name, const char* label, const char* meaning,
                                        const char* unit, double fallback) {
  ParameterDeclaration result = parameter(ParameterType::real, name, label, meaning);
  result.unit = unit;
  result.fallback = fallback;
  result.minimum = 0;
  result.above_minimum = true;
  return result;
}

ParameterDeclaration point_parameter(const char* name, const char* label, const char* meaning,
                                     const Vector3& fallback) {
  ParameterDeclaration result = parameter(ParameterType::point, name, label, meaning);
  result.fallback = QVariantList{fallback.x(), fallback.y(), fallback.z()};
  return result;
}

ParameterDeclaration centre_parameter(const char* name, const char* label, const char* meaning) {
  ParameterDeclaration result = point_parameter(name, label, meaning, Vector3::Zero());
  result.document_default = [](const MeshDocument& document) {
    const MeshModel* model = document.mm();
    if (model == nullptr || model->cm.bbox.IsNull()) return QVariant();
    const Point3m centre = model->cm.bbox.Center();
    return QVariant(QVariantList{double(centre[0]), double(centre[1]), double(centre[2])});
  };
  result.default_in_words = "the centre of the bounding box";
  return result;
}

ParameterDeclaration layer_parameter(const char* name, const char* label, const char* meaning) {
  ParameterDeclaration result = parameter(ParameterType::layer, name, label, meaning);
  result.default_in_words = "none";
  return result;
}

std::vector<ParameterDeclaration> close_holes_parameters() {
  return {selected_parameter(),
          integer_parameter("MaxHoleEdges", "Max hole size (edges)",
                            "Holes whose boundary has more edges than this stay open. 0 means any size.",
                            "edges", 0, 0, std::numeric_limits<int>::max()),
          length_parameter("MaxHolePerimeter", "Max hole perimeter",
                           "Holes whose boundary is longer than this stay open. 0 means any length."),
          switch_parameter(
              "KeepLargest", "Keep the largest hole open",
              "The hole with the longest boundary stays open: for open sheets, such as a scan of one side "
              "or a terrain, whose outer border is not a hole.",
              false),
          switch_parameter(
              "NewFaceSelected", "Select the new faces",
              "The faces that close the holes become the face selection, for example to smooth or colour "
              "them afterwards; a previous face selection is lost. When off, the selection stays as it is.",
              true),
          switch_parameter(
              "AsNewLayer", "Result as new layer",
              "The closed mesh becomes a layer of its own and the current layer stays as it is, since "
              "MeshLab cannot undo a filter.",
              false)};
}

HoleSelectionOptions hole_selection_options(const ParameterValues& parameters) {
  HoleSelectionOptions options;
  options.selected_only = parameters.boolean("Selected");
  const int edges = parameters.integer("MaxHoleEdges");
  if (edges > 0 && edges < 3)
    throw CompletionError(
        "reading the parameters",
        "Parameter \"MaxHoleEdges\" must be 0, for any size, or at least 3: no hole has fewer edges.");
  if (edges > 0) options.max_edges = static_cast<std::size_t>(edges);
  const double perimeter = parameters.real("MaxHolePerimeter");
  if (perimeter > 0) options.max_perimeter = perimeter;
  options.keep_largest = parameters.boolean("KeepLargest");
  return options;
}

}  // namespace host
}  // namespace meshcomplete
