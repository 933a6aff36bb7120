// The exact check that every patch passes before it is appended.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/progress.h"

namespace meshcomplete {

class TriangleBlocks;

/// What can be wrong with a patch, cheapest test first. `none` means: every targeted boundary edge has
/// exactly one new face, walked against the old one; every other edge of the patch has two faces, walked in
/// opposite directions, and none of the input; the faces round every new vertex form one closed fan; no face
/// is degenerate or a duplicate; no two triangles of the patch, and no triangle of the patch and of the
/// input, meet in more than the corners or the side that they share. Decided with exact predicates on the
/// stored (float) positions.
enum class PatchDefect {
  none,
  bad_index,            ///< a corner that is neither an input vertex nor a new one, or a repeated corner
  unused_vertex,        ///< a new vertex without a face
  not_finite,           ///< a coordinate is infinite or not a number, or is not a float
  rim_not_closed,       ///< a targeted boundary edge without exactly one new face in the right direction
  edge_not_manifold,    ///< an edge with more than two faces, with one face only, walked twice in one
                        ///< direction, or inside the patch and yet an edge of the input
  vertex_not_manifold,  ///< the new faces round a vertex do not form one fan between rim edges (or one closed
                        ///< fan)
  detached_piece,       ///< a closed piece of the patch that touches no rim
  degenerate_face,      ///< three collinear corners
  coincident_vertices,  ///< a new vertex where another new one, or a vertex of an input face, is
  meets_itself,         ///< two patch triangles intersect
  meets_input,          ///< a patch triangle intersects a triangle of the input
};

/// What a user is told about a defect.
std::string describe(PatchDefect defect);

/// The first defect found, with the patch triangles that have it (for degenerate faces, coincident vertices
/// and intersections all of them, so that a caller can mend them; of a patch that meets itself also those
/// that meet the input) and the input triangles concerned: those that are met, and those at an edge or a
/// position that the patch wants too. Both lists are ascending.
struct PatchCheck {
  PatchDefect defect = PatchDefect::none;
  std::vector<Index> patch_triangles;
  std::vector<Index> input_triangles;
  bool passed() const { return defect == PatchDefect::none; }
};

/// The input near the holes: what a patch may hit. Built once per run, used for every hole and every try.
/// Refers to the mesh, which must outlive it. Safe to ask from many threads. Triangles with a coordinate that
/// is not finite are not in it.
class InputNeighbourhood {
 public:
  /// Cost: O(faces), threaded, memory one bounding box per 64 triangles. A mesh whose triangles are stored in
  /// an order without any spatial coherence is sorted once (O(faces log faces), 4 bytes per triangle more).
  explicit InputNeighbourhood(const TriangleMesh& mesh);
  ~InputNeighbourhood();
  InputNeighbourhood(InputNeighbourhood&&) noexcept;

  const TriangleMesh& mesh() const;
  /// Indices, ascending, of the input triangles whose bounding box meets the closed box [low, high].
  std::vector<Index> triangles_in_box(const Vector3& low, const Vector3& high) const;
  /// What the check itself searches.
  const TriangleBlocks& blocks() const { return *blocks_; }

 private:
  std::unique_ptr<TriangleBlocks> blocks_;
};

/// Checks `patch` against itself and the input. `rim` is the list of boundary loops that it must close.
/// Thread-safe. Cost: O(patch log patch) plus the input triangles in the patch's neighbourhood; large patches
/// are checked in threads.
PatchCheck check_patch(const InputNeighbourhood& input, const Patch& patch,
                       const std::vector<const BoundaryLoop*>& rim, const Progress& progress = Progress());

/// The input triangles, ascending and at most `limit`, that a triangle with these corners meets improperly:
/// for callers that move or add vertices one at a time (with a limit of 1 it says whether the place is free).
/// Corners at the position of an input vertex count as shared. Degenerate input triangles meet nothing; a
/// degenerate `triangle` meets nothing. Cost: O(log faces + triangles nearby).
std::vector<Index> input_triangles_met(const InputNeighbourhood& input,
                                       const std::array<Vector3, 3>& triangle,
                                       std::size_t limit = static_cast<std::size_t>(-1));

}  // namespace meshcomplete
