// Other layers of the project as input of a filter: points, and what was seen from a camera or scanner.
#pragma once

#include <QString>
#include <utility>
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

/// A layer as a surface: triangles, or where it has none oriented points.
struct LayerSurface {
  TriangleMesh mesh;             ///< without triangles for a point set
  std::vector<Vector3> points;   ///< of a point set
  std::vector<Vector3> normals;  ///< one for each point
};

/// The surface of a layer in the coordinates of another. Faces and normals are turned round where the change
/// of coordinates mirrors. Throws CompletionError when it has no vertices or some that are not finite, is a
/// point set with a point without normal, or when the matrix of the layer `in` cannot be inverted.
LayerSurface layer_surface(const MeshModel& layer, const MeshModel& in);

/// The same in the coordinates of the project: the layer's matrix is applied.
LayerSurface layer_surface(const MeshModel& layer);

/// A point or a direction of a layer in the coordinates of the project.
Vector3 point_in_project(const MeshModel& layer, const Vector3& point);
Vector3 direction_in_project(const MeshModel& layer, const Vector3& direction);

/// The surface of the layer that a layer parameter names, in the coordinates of the current layer; empty when
/// it names none. Throws CompletionError as `layer_surface`, and when it names the current layer.
LayerSurface other_layer_surface(const FilterRun& run, const char* parameter);

/// The surfaces of all visible layers but the current one and `left_out` (may be null), in the current one's
/// coordinates, with their names, in the project's order. Empty layers are left out. Throws CompletionError
/// as `layer_surface`.
std::vector<std::pair<QString, LayerSurface>> visible_layer_surfaces(const FilterRun& run,
                                                                     const MeshModel* left_out = nullptr);

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
