#include "filter_atomicvolumes/cell_complex.h"

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

namespace meshcomplete {

CellComplex::CellComplex(std::int64_t half) {
  for (int axis = 0; axis < 3; ++axis)
    for (std::int64_t value : {-half, half}) add_plane(ExactPlane::across(axis, value));
  for (Index v = 0; v < 8; ++v) {
    const auto along = [&](int k) { return v >> k & 1 ? half : -half; };
    points_.emplace_back(LatticePoint{along(0), along(1), along(2)});
    last_side_.emplace_back(none, 0);
  }
  std::array<std::array<Index, 8>, 8> edge;
  for (Index v = 0; v < 8; ++v)
    for (Index k = 0; k < 3; ++k) {
      const Index to = v | 1u << k, i = (k + 1) % 3, j = (k + 2) % 3;
      if (to == v) continue;
      edge[v][to] = edge[to][v] = static_cast<Index>(edges_.size());
      edges_.push_back({{v, to}, {2 * i + (v >> i & 1), 2 * j + (v >> j & 1)}, {}});
    }
  cells_.emplace_back();
  for (Index f = 0; f < 6; ++f) {
    const Index k = f / 2, low = (f & 1) << k, i = 1u << (k + 1) % 3, j = 1u << (k + 2) % 3;
    Facet facet{f, {low, low | i, low | i | j, low | j}, {}, {f & 1 ? none : 0, f & 1 ? 0 : none}};
    for (std::size_t place = 0; place < 4; ++place) {
      facet.sides.push_back(edge[facet.corners[place]][facet.corners[(place + 1) % 4]]);
      edges_[facet.sides.back()].facets.push_back(f);
    }
    facets_.push_back(std::move(facet));
    cells_[0].facets.push_back(f);
  }
}

std::pair<Index, bool> CellComplex::add_plane(ExactPlane plane) {
  const bool turned = plane.normalise();
  const auto [it, fresh] = plane_number_.try_emplace(plane, static_cast<Index>(planes_.size()));
  if (fresh) planes_.push_back(std::move(plane));
  return {it->second, turned};
}

Index CellComplex::plane_through_side(Index facet, std::size_t place) const {
  const Edge& edge = edges_[facets_[facet].sides[place]];
  return edge.planes[0] != facets_[facet].plane ? edge.planes[0] : edge.planes[1];
}

int CellComplex::side(Index plane, Index vertex) {
  auto& [known, side] = last_side_[vertex];
  if (known != plane) {
    known = plane;
    side = side_of(planes_[plane], points_[vertex]);
  }
  return side;
}

bool CellComplex::crosses(Index plane, Index cell) {
  bool above = false, below = false;
  for (Index f : cells_[cell].facets)
    for (Index v : facets_[f].corners) {
      const int s = side(plane, v);
      above |= s > 0;
      below |= s < 0;
      if (above && below) return true;
    }
  return false;
}

bool CellComplex::crosses_facet(Index facet, Index plane) {
  bool above = false, below = false;
  for (Index v : facets_[facet].corners) {
    const int s = side(plane, v);
    above |= s > 0;
    below |= s < 0;
  }
  return above && below;
}

void CellComplex::split_edge(Index edge, Index plane) {
  const Index middle = static_cast<Index>(points_.size()), second = static_cast<Index>(edges_.size());
  const auto [p, q] = edges_[edge].planes;
  points_.emplace_back(planes_[p], planes_[q], planes_[plane]);
  last_side_.emplace_back(plane, 0);
  Edge rest = edges_[edge];
  rest.ends[0] = edges_[edge].ends[1] = middle;
  for (Index f : rest.facets) {
    Facet& facet = facets_[f];
    const auto place = std::find(facet.sides.begin(), facet.sides.end(), edge) - facet.sides.begin();
    const bool forward = facet.corners[static_cast<std::size_t>(place)] == edges_[edge].ends[0];
    facet.corners.insert(facet.corners.begin() + place + 1, middle);
    facet.sides.insert(facet.sides.begin() + place + (forward ? 1 : 0), second);
  }
  edges_.push_back(std::move(rest));
}

void CellComplex::split_sides(Index facet, Index plane) {
  const std::vector<Index> sides = facets_[facet].sides;
  for (Index e : sides)
    if (side(plane, edges_[e].ends[0]) * side(plane, edges_[e].ends[1]) < 0) split_edge(e, plane);
}

// The plane crosses the facet, and meets its boundary in two corners. The facet keeps the positive side.
Index CellComplex::cut_facet(Index facet, Index plane) {
  std::vector<Index> corners = facets_[facet].corners, sides = facets_[facet].sides;
  const std::size_t n = corners.size();
  // The positive side first: from the corner on the plane after which it begins.
  std::size_t begin = 0;
  while (!(side(plane, corners[begin]) == 0 && side(plane, corners[(begin + 1) % n]) > 0)) ++begin;
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(begin), corners.end());
  std::rotate(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(begin), sides.end());
  std::size_t end = 1;
  while (side(plane, corners[end]) != 0) ++end;
  const Index between = static_cast<Index>(edges_.size()), other = static_cast<Index>(facets_.size());
  const auto at = [](std::vector<Index>& list, std::size_t i) {
    return list.begin() + static_cast<std::ptrdiff_t>(i);
  };
  Facet negative = facets_[facet];
  negative.corners.assign(at(corners, end), corners.end());
  negative.corners.push_back(corners[0]);
  negative.sides.assign(at(sides, end), sides.end());
  negative.sides.push_back(between);
  for (std::size_t i = end; i < n; ++i)
    std::replace(edges_[sides[i]].facets.begin(), edges_[sides[i]].facets.end(), facet, other);
  edges_.push_back({{corners[0], corners[end]}, {negative.plane, plane}, {facet, other}});
  corners.resize(end + 1);
  sides.resize(end);
  sides.push_back(between);
  facets_[facet].corners = std::move(corners);
  facets_[facet].sides = std::move(sides);
  for (Index cell : negative.cells)
    if (cell != none) cells_[cell].facets.push_back(other);
  facets_.push_back(std::move(negative));
  return other;
}

Index CellComplex::split_facet(Index facet, Index plane) {
  if (facets_[facet].plane == plane || !crosses_facet(facet, plane)) return none;
  split_sides(facet, plane);
  return cut_facet(facet, plane);
}

// The facet between the two halves of a cell: its sides are the edges at which facets of both meet.
void CellComplex::close(Index positive, Index negative, Index plane) {
  const Index number = static_cast<Index>(facets_.size());
  Facet facet{plane, {}, {}, {positive, negative}};
  std::unordered_map<Index, std::pair<Index, Index>> next;  // from a corner: the next one and the edge to it
  for (Index f : cells_[positive].facets) {
    const Facet& beside = facets_[f];
    const std::size_t n = beside.corners.size();
    for (std::size_t i = 0; i < n; ++i) {
      Index from = beside.corners[i], to = beside.corners[(i + 1) % n];
      if (side(plane, from) != 0 || side(plane, to) != 0) continue;
      // Seen from outside the positive half the new facet runs the other way; that is from the negative side.
      if (beside.cells[1] != positive) std::swap(from, to);
      next[from] = {to, beside.sides[i]};
    }
  }
  const Index start = next.begin()->first;
  for (Index v = start; facet.corners.empty() || v != start;) {
    const auto found = next.find(v);
    if (found == next.end() || facet.corners.size() > next.size())
      throw std::logic_error("A cut through a cell is not closed.");
    facet.corners.push_back(v);
    facet.sides.push_back(found->second.second);
    v = found->second.first;
  }
  for (Index e : facet.sides) edges_[e].facets.push_back(number);
  facets_.push_back(std::move(facet));
  cells_[positive].facets.push_back(number);
  cells_[negative].facets.push_back(number);
}

Index CellComplex::split(Index cell, Index plane) {
  const std::vector<Index> whole = cells_[cell].facets;
  for (Index f : whole) split_sides(f, plane);
  for (Index f : whole)
    if (crosses_facet(f, plane)) cut_facet(f, plane);
  const Index other = static_cast<Index>(cells_.size());
  cells_.emplace_back();
  std::vector<Index> all;
  all.swap(cells_[cell].facets);
  for (Index f : all) {
    bool below = false;
    for (Index v : facets_[f].corners) below |= side(plane, v) < 0;
    cells_[below ? other : cell].facets.push_back(f);
    if (below) std::replace(facets_[f].cells.begin(), facets_[f].cells.end(), cell, other);
  }
  close(cell, other, plane);
  return other;
}

}  // namespace meshcomplete
