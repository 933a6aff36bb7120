// A sheet as an editable patch whose boundary is exactly the mesh's: the Steiner points of its rims are taken
// out.
#pragma once

#include <cstddef>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/guarded_patch.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/patch_check.h"
#include "common/core/patch_mesh.h"
#include "common/core/progress.h"
#include "common/core/rim.h"
#include "common/core/sheets.h"

namespace meshcomplete {

/// The rims of a sheet and its triangulation. Vertex i of the mesh, for i below `mesh.rim_size()`, is vertex
/// `rim_vertices[i]` of the input.
struct RimPatch {
  std::vector<BoundaryLoop> loops;  ///< as the patch walks them; a vertex may occur in more than one
  std::vector<Index> rim_vertices;  ///< those of the loops, one after the other
  std::vector<Index> rim_faces;     ///< the mesh's face at the edge from each of them to the next
  Rim rim;
  PatchMesh mesh;
  std::size_t steiner_points = 0;  ///< left on the rims
};

/// `sheet` must be without flaw and have a rim. Edges too short to be stored are collapsed.
RimPatch make_rim_patch(const TriangleMesh& mesh, const MeshTopology& topology, const Sheet& sheet);

/// Moves the Steiner points of the rims onto their rim neighbours, one by one, with exact tests, until the
/// patch meets the mesh's own edges one to one; where that is not possible at once, after flips round them.
/// Without obstacles, points for which there is no such step are then taken out in any way that leaves a
/// manifold: the patch can meet something there. Never makes a chord between two points of one boundary edge,
/// nor an edge that the mesh has. Source: the paper leaves them in; a patch that shares no edges with the
/// mesh is not watertight in floats. Returns how many are left. Cost: O(triangles at rims * triangles near
/// each).
std::size_t remove_steiner_points(RimPatch& patch, const InputNeighbourhood& input,
                                  const std::vector<std::array<Vector3, 3>>& obstacles,
                                  const Progress& progress = Progress());

/// A patch mesh with these rim vertices as the checker and the caller want it. Triangles keep their numbers
/// when the patch mesh has no gaps.
Patch as_patch(const PatchMesh& patch, const std::vector<Index>& rim_vertices, const TriangleMesh& mesh);

}  // namespace meshcomplete
