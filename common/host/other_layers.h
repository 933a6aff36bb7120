// Other layers of the project as input of a filter: points, and what was seen from a camera or scanner.
#pragma once

#include <QString>
#include <vector>

#include "common/core/mesh.h"
#include "common/host/filter_declaration.h"

namespace meshcomplete {
namespace host {

/// The vertices of the layer that a layer parameter names, in the coordinates of the current layer:
/// transformation matrices are applied. Empty when it names none. Throws CompletionError when it names the
/// current layer, when the layer has no vertices or some that are not finite, or when the current layer's
/// matrix cannot be inverted.
std::vector<Vector3> other_layer_points(const FilterRun& run, const char* parameter);

/// Throws CompletionError when two of these layer parameters name the same layer.
void refuse_shared_layers(const FilterRun& run, const std::vector<const char*>& parameters);

/// What a layer's camera or scanner saw: its vertices.
struct LayerView {
  QString layer;
  Vector3 from = Vector3::Zero();  ///< where the camera or scanner stood
  std::vector<Vector3> seen;
};

/// All visible layers but the current one that carry a camera (or scanner position) and have vertices, in the
/// coordinates of the current layer, in the project's order. Throws CompletionError like
/// `other_layer_points`.
std::vector<LayerView> layer_views(const FilterRun& run);

}  // namespace host
}  // namespace meshcomplete
