#include "common/core/partial_fill.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

// Selections at ragged rims are full of gaps. Longer ones than this are meant.
constexpr std::size_t most_interrupted = 6;

// Shorter ones are left out where their loop has longer ones.
constexpr std::size_t shortest_stretch = 3;

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

// Those of one loop, from an edge on that is not selected.
std::vector<RimStretch> runs_of(std::size_t loop, const std::vector<char>& selected) {
  const std::size_t count = selected.size();
  const auto start =
      static_cast<std::size_t>(std::find(selected.begin(), selected.end(), 0) - selected.begin());
  if (start == count) return {{loop, 0, count}};
  std::vector<RimStretch> runs;
  for (std::size_t k = start + 1; k < start + count; ++k) {
    if (!selected[k % count]) continue;
    if (selected[(k - 1) % count])
      ++runs.back().edges;
    else
      runs.push_back({loop, k, 1});
  }
  return runs;
}

// Whether what is between two runs counts for nothing: short, and no longer than one of them.
bool interrupted(const RimStretch& run, const RimStretch& next, std::size_t between) {
  return between <= std::min(most_interrupted, std::max(run.edges, next.edges));
}

std::vector<RimStretch> stretches_of(const std::vector<RimStretch>& runs, std::size_t count) {
  std::vector<RimStretch> stretches;
  for (const RimStretch& run : runs) {
    RimStretch* last = stretches.empty() ? nullptr : &stretches.back();
    if (last != nullptr && interrupted(*last, run, run.first - last->first - last->edges))
      last->edges = run.first + run.edges - last->first;
    else
      stretches.push_back(run);
  }
  if (stretches.empty() || stretches.front().edges == count) return stretches;
  RimStretch &first = stretches.front(), &last = stretches.back();
  const std::size_t between = first.first + count - last.first - last.edges;
  if (interrupted(last, first, between)) {
    if (stretches.size() == 1) return {{first.loop, 0, count}};
    last.edges += between + first.edges;
    stretches.erase(stretches.begin());
  }
  const auto is_short = [](const RimStretch& stretch) { return stretch.edges < shortest_stretch; };
  if (!std::all_of(stretches.begin(), stretches.end(), is_short))
    stretches.erase(std::remove_if(stretches.begin(), stretches.end(), is_short), stretches.end());
  for (RimStretch& stretch : stretches) stretch.first %= count;
  return stretches;
}

}  // namespace

std::vector<RimStretch> selected_stretches(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops,
                                           const MeshSelection& selection) {
  const std::vector<char> touched = touched_vertices(mesh, selection);
  std::vector<RimStretch> stretches;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const std::vector<Index>& vertices = loops[i].vertices;
    std::vector<char> selected(vertices.size());
    for (std::size_t k = 0; k < vertices.size(); ++k)
      selected[k] = touched[vertices[k]] && touched[vertices[(k + 1) % vertices.size()]];
    const std::vector<RimStretch> more = stretches_of(runs_of(i, selected), vertices.size());
    stretches.insert(stretches.end(), more.begin(), more.end());
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
