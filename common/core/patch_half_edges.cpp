#include "common/core/patch_half_edges.h"

#include <algorithm>
#include <array>

namespace meshcomplete {

PatchHalfEdges::PatchHalfEdges(const Patch& patch) : input_vertices_(patch.input_vertices) {
  for (const Triangle& triangle : patch.triangles)
    for (Index v : triangle)
      if (v < input_vertices_) input_used_.push_back(v);
  std::sort(input_used_.begin(), input_used_.end());
  input_used_.erase(std::unique(input_used_.begin(), input_used_.end()), input_used_.end());

  const auto numbered = [&](const Triangle& t) { return Triangle{local(t[0]), local(t[1]), local(t[2])}; };
  const std::size_t vertices = input_used_.size() + patch.vertices.size();
  std::vector<Triangle> triangles;
  triangles.reserve(patch.triangles.size());
  first_.assign(vertices + 1, 0);
  for (const Triangle& triangle : patch.triangles) {
    triangles.push_back(numbered(triangle));
    for (Index v : triangles.back()) ++first_[v + 1];
  }
  for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
  half_edges_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (Index t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Triangle& corner = triangles[t];
      half_edges_[next[corner[k]]++] = {corner[(k + 1) % 3], corner[(k + 2) % 3], t};
    }
  for (std::size_t v = 0; v < vertices; ++v)
    std::sort(half_edges_.begin() + static_cast<std::ptrdiff_t>(first_[v]),
              half_edges_.begin() + static_cast<std::ptrdiff_t>(first_[v + 1]),
              [](const HalfEdge& a, const HalfEdge& b) {
                return a.to != b.to ? a.to < b.to : a.triangle < b.triangle;
              });
}

Index PatchHalfEdges::local(Index vertex) const {
  if (vertex >= input_vertices_) return static_cast<Index>(input_used_.size()) + (vertex - input_vertices_);
  const auto place = std::lower_bound(input_used_.begin(), input_used_.end(), vertex);
  return place != input_used_.end() && *place == vertex ? static_cast<Index>(place - input_used_.begin())
                                                        : none;
}

Index PatchHalfEdges::global(Index v) const {
  return v < input_used_.size() ? input_used_[v]
                                : input_vertices_ + (v - static_cast<Index>(input_used_.size()));
}

PatchHalfEdges::Range PatchHalfEdges::row(Index v) const {
  if (v == none) return {nullptr, nullptr};
  return {half_edges_.data() + first_[v], half_edges_.data() + first_[v + 1]};
}

PatchHalfEdges::Range PatchHalfEdges::between_local(Index from, Index to) const {
  struct ByEnd {
    bool operator()(const HalfEdge& h, Index end) const { return h.to < end; }
    bool operator()(Index end, const HalfEdge& h) const { return end < h.to; }
  };
  const Range all = row(from);
  const auto [first, past] = std::equal_range(all.begin(), all.end(), to, ByEnd());
  return {first, past};
}

void PatchHalfEdges::add_rim(const std::vector<Index>& vertices) {
  const std::size_t n = vertices.size();
  for (std::size_t i = 0; i < n; ++i)
    visits_.push_back({local(vertices[i]), local(vertices[(i + n - 1) % n]), local(vertices[(i + 1) % n])});
  std::sort(visits_.begin(), visits_.end());
}

std::pair<const PatchHalfEdges::Visit*, const PatchHalfEdges::Visit*> PatchHalfEdges::visits_of(
    Index v) const {
  const auto [first, past] =
      std::equal_range(visits_.data(), visits_.data() + visits_.size(), Visit{v, none, none});
  return {first, past};
}

bool PatchHalfEdges::is_rim(Index from, Index to) const {
  const auto [first, past] = visits_of(from);
  return std::any_of(first, past, [&](const Visit& visit) { return visit.goes_to == to; });
}

/// The number of faces from the half-edge v -> start, turning round v, to the one that arrives from `goal`; 0
/// when `goal` is not reached.
std::size_t PatchHalfEdges::fan_size(Index v, Index start, Index goal) const {
  const std::size_t most = row(v).size();
  Index to = start;
  for (std::size_t faces = 1; faces <= most; ++faces) {
    const Range here = between_local(v, to);
    if (here.size() != 1) return 0;
    to = here.begin()->across;
    if (to == goal) return faces;
  }
  return 0;
}

bool PatchHalfEdges::fans_match_rim(Index vertex, bool closed) const {
  const Index v = local(vertex);
  const Range faces = row(v);
  if (closed) return !faces.empty() && fan_size(v, faces.begin()->to, faces.begin()->to) == faces.size();
  std::size_t in_fans = 0;
  const auto [first, past] = visits_of(v);
  for (const Visit* visit = first; visit != past; ++visit) {
    const std::size_t size = fan_size(v, visit->goes_to, visit->came_from);
    if (size == 0) return false;
    in_fans += size;
  }
  return in_fans == faces.size();
}

}  // namespace meshcomplete
