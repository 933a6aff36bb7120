// Where parts of the inside only touch, their surfaces are taken apart: every edge gets two faces, every
// vertex one fan.
#pragma once

#include <vector>

#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"

namespace meshcomplete {

/// A vertex of a patch in the making.
struct SheetVertex {
  static constexpr Index none = 0xffffffffu;
  Vector3 position;
  Index input = none;     ///< the boundary vertex that it is
  Index rim_edge = none;  ///< the boundary half-edge whose Steiner point it is
  bool cut = false;  ///< where planes cut convex cells: its neighbours may be finer than single precision
};

/// Triangles between inside and outside, the outside before them. Their edges may have more than two faces
/// where parts of the inside only touch.
struct SeparatingSurface {
  std::vector<SheetVertex> vertices;
  std::vector<Triangle> triangles;
};

/// One connected piece of the patch, manifold, with its boundary on the rims.
struct Sheet {
  std::vector<SheetVertex> vertices;  ///< a boundary vertex that the piece visits twice is there twice
  std::vector<Triangle> triangles;
  /// Boundary half-edges of the mesh that it closes, ascending. Empty for a piece without a rim.
  std::vector<Index> closes;
  /// What keeps it from closing its rims.
  enum class Flaw {
    none,
    open,           ///< its boundary does not lie on rims: a cube there could not be resolved
    joins_vertices  ///< a corner would have to be two rim vertices at the same position
  };
  Flaw flaw = Flaw::none;
};

/// The pieces of a separating surface. Round an edge with more than two faces (the mesh's own triangle counts
/// at a rim) those that bound one inside sector belong together; vertices are doubled for every fan, and the
/// doubles move into their own inside by a small part of their edges. `input` has the same faces as `mesh`
/// and tells the vertices at their corners, where some are one in `mesh`. Cost: O(n log n) for n triangles.
std::vector<Sheet> split_into_sheets(const TriangleMesh& mesh, const MeshTopology& topology,
                                     const SeparatingSurface& surface, const TriangleMesh& input);

}  // namespace meshcomplete
