// The octree of the paper's section 3.1: leaves that hold nothing, a trivial piece of the boundary, or
// surface that divides them already.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/octree.h"
#include "common/core/progress.h"
#include "filter_atomicvolumes/lattice_mesh.h"

namespace meshcomplete {

enum class VolumeKind : std::uint8_t {
  blank,       ///< no triangle meets the closed cube
  vertex,      ///< a hole cube round one boundary vertex, met only by triangles and boundary edges at it
  edge,        ///< a hole cube with a piece of one boundary edge, met only by that edge's triangle
  crossed,     ///< inside/outside: met by the mesh, but not by its boundary
  unresolved,  ///< a cube at the greatest depth that is none of these: cut into convex cells
};

struct Volume {
  VolumeKind kind = VolumeKind::blank;
  Index apex = 0;                ///< the boundary vertex, or the boundary half-edge
  std::vector<Index> triangles;  ///< those that meet the closed cube, ascending
};

struct DecompositionOptions {
  int max_depth = Lattice::depth;
  std::size_t cube_budget = 5000000;
  /// Crossed cubes no larger than this are taken as they are, whatever the pieces of the mesh in them say of
  /// each other: sheets so close to each other, away from the boundary, do not matter to the patch.
  std::int64_t least_contradiction = 0;  ///< lattice units
};

struct Decomposition {
  Octree octree;
  std::vector<Volume> volumes;  ///< per cube; meaningful for leaves
};

/// Splits cubes until all are trivial. Cost: O(log faces + triangles nearby) per cube, and every triangle is
/// looked at once for each crossed cube that it meets. Threaded. Throws CompletionError beyond the budget,
/// `Cancelled`.
Decomposition decompose(const LatticeMesh& mesh, const DecompositionOptions& options,
                        const Progress& progress = Progress());

/// Splits these leaves, and what comes of them until it is trivial again. Leaves at the greatest depth stay.
/// Returns whether any was split.
bool split_further(Decomposition& decomposition, const LatticeMesh& mesh, const DecompositionOptions& options,
                   const std::vector<Index>& leaves, const Progress& progress = Progress());

}  // namespace meshcomplete
