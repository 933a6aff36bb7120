#include "common/core/partial_fill.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

constexpr const char* not_selected = "not selected";

using Bounds = Eigen::AlignedBox3d;

Bounds bounds_of(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  Bounds bounds;
  for (Index v : loop.vertices) bounds.extend(mesh.vertices[v]);
  return bounds;
}

void skip(HoleReport& hole) {
  hole.outcome = HoleOutcome::skipped;
  hole.reason = not_selected;
}

std::vector<char> loops_with(const std::vector<RimStretch>& stretches, std::size_t loops) {
  std::vector<char> with(loops, 0);
  for (const RimStretch& stretch : stretches) with[stretch.loop] = 1;
  return with;
}

}  // namespace

std::vector<RimStretch> selected_stretches(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops,
                                           const MeshSelection& selection) {
  const std::vector<char> touched = touched_vertices(mesh, selection);
  std::vector<RimStretch> stretches;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const std::vector<Index>& vertices = loops[i].vertices;
    const std::size_t count = vertices.size();
    const auto selected = [&](std::size_t k) {
      return touched[vertices[k % count]] && touched[vertices[(k + 1) % count]];
    };
    std::size_t gap = 0;  // an edge that is not selected
    while (gap < count && selected(gap)) ++gap;
    if (gap == count) {
      stretches.push_back({i, 0, count});
      continue;
    }
    for (std::size_t k = gap + 1; k < gap + count; ++k) {
      if (!selected(k)) continue;
      if (selected(k - 1))
        ++stretches.back().edges;
      else
        stretches.push_back({i, k % count, 1});
    }
  }
  if (stretches.empty())
    throw CompletionError(
        "choosing the holes",
        "PartialFill fills along selected parts of the boundary, but no edge of the boundary "
        "is selected. Select the faces or vertices along it.");
  return stretches;
}

void target_stretches(const TriangleMesh& mesh, const std::vector<RimStretch>& stretches, OpenMesh& open) {
  const std::vector<char> with = loops_with(stretches, open.loops.size());
  std::vector<Bounds> all;
  for (std::size_t i = 0; i < with.size(); ++i)
    if (with[i]) all.push_back(bounds_of(mesh, open.loops[i]));
  for (std::size_t i = 0; i < with.size(); ++i) {
    if (with[i] || open.holes[i].outcome != HoleOutcome::failed) continue;
    const Bounds bounds = bounds_of(mesh, open.loops[i]);
    if (std::none_of(all.begin(), all.end(), [&](const Bounds& other) { return other.intersects(bounds); }))
      skip(open.holes[i]);
  }
}

void keep_pieces_at(const std::vector<RimStretch>& stretches, std::vector<PatchPiece>& pieces,
                    std::vector<HoleReport>& holes) {
  const std::vector<char> with = loops_with(stretches, holes.size());
  std::vector<char> kept = with;
  for (const std::vector<std::size_t>& group : group_by_loops(pieces)) {
    const std::vector<std::size_t> loops = loops_of(pieces, group);
    const bool at_stretch = std::any_of(loops.begin(), loops.end(), [&](std::size_t i) { return with[i]; });
    for (std::size_t i : group) pieces[i].wanted &= at_stretch;
    if (pieces[group.front()].wanted)
      for (std::size_t loop : loops) kept[loop] = 1;
  }
  for (std::size_t i = 0; i < holes.size(); ++i)
    if (!kept[i] && holes[i].outcome == HoleOutcome::failed) skip(holes[i]);
}

void cut_strips(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops,
                const std::vector<RimStretch>& stretches, std::vector<PatchPiece>& pieces,
                const Progress& progress) {
  for (const std::vector<std::size_t>& group : group_by_loops(pieces)) {
    PatchPiece& piece = pieces[group.front()];
    if (!piece.wanted || !piece.defect.empty()) continue;
    if (group.size() > 1) {
      piece.defect = "several patches share this rim: it cannot be filled in part";
      continue;
    }
    Strip strip = cut_strip(mesh, loops, piece.loops, stretches, piece.patch, progress);
    piece.defect = std::move(strip.reason);
    if (!piece.defect.empty() || strip.edges == strip.of) continue;
    piece.part =
        "as asked, along " + std::to_string(strip.edges) + " of " + std::to_string(strip.of) + " edges";
    piece.patch = std::move(strip.patch);
  }
}

}  // namespace meshcomplete
