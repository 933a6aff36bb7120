#include "common/host/close_holes_parameters.h"

#include <algorithm>
#include <limits>

#include "common/core/error.h"
#include "common/host/meshlab_version.h"
#include "common/host/parameter_blocks.h"

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
