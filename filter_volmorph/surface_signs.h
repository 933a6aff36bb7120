// On which side of a mesh a point lies, from the nearest point of the mesh.
#pragma once

#include <optional>
#include <vector>

#include "common/core/closest_point.h"
#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// What a point of a mesh lies on.
enum class SurfacePlace { surface, rim, ambiguous };

/// The normals of a mesh's faces, edges and vertices, and which of these are at a rim, or have no side:
/// edges with three faces or more or with faces that are not oriented alike, and their vertices. Refers to
/// the mesh and its topology. Source: Baerentzen and Aanaes 2005.
class SurfaceSigns {
 public:
  /// Throws `Cancelled`. Cost: O(faces).
  SurfaceSigns(const TriangleMesh& mesh, const MeshTopology& topology, const Progress& progress = Progress());

  SurfacePlace place(Index triangle, const ClosestPoint& point) const;
  /// Unit, for places on the surface; zero when it has none there.
  Vector3 normal(Index triangle, const ClosestPoint& point) const;

 private:
  SurfacePlace edge_place(Index half_edge) const;

  const TriangleMesh& mesh_;
  const MeshTopology& topology_;
  std::vector<Vector3> faces_, vertices_;
  std::vector<SurfacePlace> vertex_places_;
};

}  // namespace meshcomplete
