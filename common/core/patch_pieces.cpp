#include "common/core/patch_pieces.h"

#include <algorithm>
#include <utility>

#include "common/core/disjoint_sets.h"

namespace meshcomplete {
namespace {

void sort_out(std::vector<std::size_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

LoopNumbers::LoopNumbers(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops) {
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (std::size_t k = 0; k < loops[i].faces.size(); ++k) loop_.emplace(half_edge_at(mesh, loops[i], k), i);
}

std::optional<std::size_t> LoopNumbers::of(Index half_edge) const {
  const auto found = loop_.find(half_edge);
  return found == loop_.end() ? std::nullopt : std::optional<std::size_t>(found->second);
}

std::vector<PatchPiece> make_pieces(std::vector<Sheet> sheets, const MeshTopology& topology,
                                    const LoopNumbers& loops) {
  std::vector<PatchPiece> pieces;
  for (Sheet& sheet : sheets) {
    PatchPiece piece;
    for (Index h : sheet.closes) {
      if (topology.opposite[h] != MeshTopology::boundary) sheet.flaw = Sheet::Flaw::open;
      if (const auto loop = loops.of(h)) piece.loops.push_back(*loop);
    }
    if (piece.loops.empty()) continue;
    sort_out(piece.loops);
    piece.sheet = std::move(sheet);
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

std::vector<std::vector<std::size_t>> group_by_loops(const std::vector<PatchPiece>& pieces) {
  DisjointSets sets(pieces.size());
  std::map<std::size_t, Index> first;  // piece of each loop
  for (Index i = 0; i < pieces.size(); ++i)
    for (std::size_t loop : pieces[i].loops) {
      const auto [it, fresh] = first.try_emplace(loop, i);
      if (!fresh) sets.unite(i, it->second);
    }
  std::map<Index, std::vector<std::size_t>> by_root;
  for (Index i = 0; i < pieces.size(); ++i) by_root[sets.root(i)].push_back(i);
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [top, members] : by_root) groups.push_back(std::move(members));
  return groups;
}

std::vector<std::size_t> loops_of(const std::vector<PatchPiece>& pieces,
                                  const std::vector<std::size_t>& group) {
  std::vector<std::size_t> loops;
  for (std::size_t i : group) loops.insert(loops.end(), pieces[i].loops.begin(), pieces[i].loops.end());
  sort_out(loops);
  return loops;
}

Sheet::Flaw flaw_of(const std::vector<PatchPiece>& pieces, const std::vector<std::size_t>& group,
                    const std::vector<BoundaryLoop>& loops) {
  Sheet::Flaw flaw = Sheet::Flaw::none;
  std::size_t edges = 0, closed = 0;
  for (std::size_t i : group) {
    flaw = std::max(flaw, pieces[i].sheet.flaw);
    closed += pieces[i].sheet.closes.size();
  }
  for (std::size_t loop : loops_of(pieces, group)) edges += loops[loop].faces.size();
  if (flaw == Sheet::Flaw::none && closed < edges) flaw = Sheet::Flaw::open;
  return flaw;
}

}  // namespace meshcomplete
