#include "common/core/piece_results.h"

#include <algorithm>
#include <map>
#include <utility>

#include "common/core/hole_targets.h"

namespace meshcomplete {
namespace {

// Why a group with these loops is not to be closed; empty when it is.
std::string obstacle(const std::vector<std::size_t>& group_loops, const std::vector<BoundaryLoop>& loops,
                     const std::vector<HoleReport>& holes) {
  for (std::size_t loop : group_loops) {
    const HoleReport& hole = holes[loop];
    if (is_targeted(hole) || may_join(loops[loop], hole)) continue;
    return hole.outcome == HoleOutcome::skipped
               ? "one patch closes this hole and another that is to stay open (" + hole.reason + ")"
               : "one patch closes this hole and another that cannot be closed (" + hole.reason + ")";
  }
  return "";
}

// Makes the first of these loops' holes stand for all.
HoleReport& merge_holes(const std::vector<std::size_t>& loops, std::vector<HoleReport>& holes,
                        std::vector<char>& merged) {
  HoleReport& hole = holes[loops.front()];
  Vector3 centre = hole.centre * static_cast<double>(hole.edges);
  for (std::size_t k = 1; k < loops.size(); ++k) {
    const HoleReport& other = holes[loops[k]];
    hole.loops.push_back(loops[k]);
    hole.edges += other.edges;
    hole.perimeter += other.perimeter;
    centre += other.centre * static_cast<double>(other.edges);
    merged[loops[k]] = 1;
  }
  hole.centre = centre / static_cast<double>(hole.edges);
  return hole;
}

}  // namespace

bool any_left_open(const std::vector<HoleReport>& holes) {
  return std::any_of(holes.begin(), holes.end(),
                     [](const HoleReport& hole) { return hole.outcome == HoleOutcome::skipped; });
}

std::string describe(Sheet::Flaw flaw, const std::string& open) {
  switch (flaw) {
    case Sheet::Flaw::none:
      break;
    case Sheet::Flaw::open:
      return open;
    case Sheet::Flaw::joins_vertices:
      return "vertices of this rim lie at the same position, and the patch would have to join them; apply "
             "'Merge Close Vertices' first";
  }
  return "";
}

std::vector<char> choose_pieces(std::vector<PatchPiece>& pieces, const std::vector<BoundaryLoop>& loops,
                                std::vector<HoleReport>& holes, const std::string& open) {
  std::vector<char> blocked(loops.size(), 0);
  std::map<std::size_t, std::string> reasons;
  for (const std::vector<std::size_t>& group : group_by_loops(pieces)) {
    const std::vector<std::size_t> group_loops = loops_of(pieces, group);
    if (std::none_of(group_loops.begin(), group_loops.end(),
                     [&](std::size_t loop) { return is_targeted(holes[loop]); }))
      continue;
    std::string reason = obstacle(group_loops, loops, holes);
    for (std::size_t loop : group_loops) blocked[loop] = !reason.empty() && is_targeted(holes[loop]);
    if (reason.empty()) reason = describe(flaw_of(pieces, group, loops), open);
    for (std::size_t i : group) pieces[i].wanted = reason.empty();
    for (std::size_t loop : group_loops)
      if (!reason.empty()) reasons[loop] = reason;
  }
  for (const auto& [loop, reason] : reasons)
    if (is_targeted(holes[loop])) holes[loop].reason = reason;
  return blocked;
}

Completion gather_pieces(const TriangleMesh& mesh, const std::vector<PatchPiece>& pieces,
                         CompletionReport report) {
  Completion result;
  result.patch.input_vertices = static_cast<Index>(mesh.vertices.size());
  std::vector<HoleReport> holes;
  std::vector<char> merged(report.holes.size(), 0);
  for (const std::vector<std::size_t>& group : group_by_loops(pieces)) {
    if (!pieces[group.front()].wanted) continue;
    bool closed = true;
    std::string part, defect;
    for (std::size_t i : group) {
      closed &= pieces[i].defect.empty();
      if (part.empty()) part = pieces[i].part;
      if (defect.empty()) defect = pieces[i].defect;
    }
    HoleReport& hole = merge_holes(loops_of(pieces, group), report.holes, merged);
    hole.outcome = !closed ? HoleOutcome::failed : part.empty() ? HoleOutcome::closed : HoleOutcome::partial;
    hole.reason = closed ? part : defect;
    for (std::size_t i : group) {
      if (!closed) break;
      hole.route = pieces[i].route;
      hole.vertices_added += pieces[i].patch.vertices.size();
      hole.faces_added += pieces[i].patch.triangles.size();
      append(result.patch, pieces[i].patch);
    }
  }
  const char* const unreached = any_left_open(report.holes)
                                    ? "no patch reaches this rim; close the holes beside it, too"
                                    : "no patch reaches this rim";
  for (std::size_t i = 0; i < report.holes.size(); ++i) {
    HoleReport& hole = report.holes[i];
    if (hole.outcome == HoleOutcome::failed && hole.reason.empty()) hole.reason = unreached;
    if (!merged[i]) holes.push_back(std::move(hole));
  }
  report.holes = std::move(holes);
  result.report = std::move(report);
  return result;
}

}  // namespace meshcomplete
