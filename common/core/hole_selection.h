// Which holes a "Close Holes" filter works on: the options that all of them share.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"

namespace meshcomplete {

/// The caller's selection, one flag per vertex and per triangle of the snapshot; empty vectors mean "nothing
/// selected".
struct MeshSelection {
  std::vector<char> vertices;
  std::vector<char> faces;
};

struct HoleSelectionOptions {
  bool selected_only = false;            ///< only holes that touch a selected vertex or face
  std::optional<std::size_t> max_edges;  ///< leave longer loops open (number of edges, at least 3)
  std::optional<double> max_perimeter;   ///< leave longer loops open (mesh units, positive)
  bool keep_largest = false;             ///< leave the loop with the greatest perimeter open
};

/// The reason of holes that the selection leaves out.
inline constexpr const char* not_selected = "not selected";

/// For every vertex, whether it is selected or a corner of a selected face. Cost: O(vertices + faces).
std::vector<char> touched_vertices(const TriangleMesh& mesh, const MeshSelection& selection);

/// One report per loop. `skipped` with a reason: not asked for, or nothing that a patch should close (the rim
/// of a single triangle or of an open sheet). `failed` with a reason: asked for, but the loop has a defect.
/// `failed` without a reason: to be worked on. Throws `CompletionError` when the options contradict each
/// other or the selection is asked for and empty. Cost: O(boundary + faces when a selection is used).
std::vector<HoleReport> select_holes(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops,
                                     const MeshSelection& selection, const HoleSelectionOptions& options);

}  // namespace meshcomplete
