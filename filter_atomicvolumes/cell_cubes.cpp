#include "filter_atomicvolumes/cell_cubes.h"

#include <algorithm>

namespace meshcomplete {
namespace {

constexpr Index none = CellComplex::none;

std::uint64_t directed(Index from, Index to) { return static_cast<std::uint64_t>(from) << 32 | to; }

}  // namespace

void CellCubes::list() {
  for (Index cube = 0; cube < decomposition_.octree.size(); ++cube)
    if (decomposition_.octree.is_leaf(cube) && decomposition_.volumes[cube].kind == VolumeKind::unresolved)
      cubes_.push_back(cube);
  cells_.resize(cubes_.size());
  facets_in_.resize(cubes_.size());
}

void CellCubes::cut(std::size_t i, const std::vector<Index>& squares) {
  cells_[i] = std::make_unique<ConvexCells>(cut_into_cells(mesh_, decomposition_.octree.box(cubes_[i]),
                                                           decomposition_.volumes[cubes_[i]].triangles));
  divide_faces(i, squares);
}

// The facets on the cube's faces are cut where squares of finer neighbours meet.
void CellCubes::divide_faces(std::size_t i, const std::vector<Index>& squares) {
  const LatticeBox box = decomposition_.octree.box(cubes_[i]);
  for (int axis = 0; axis < 3; ++axis)
    for (bool upper : {false, true}) {
      LatticePoint low = box.low;
      if (upper) low[axis] = box.high[axis];
      std::map<LatticePoint, Index> at;
      for (Index s : squares)
        if (squares_[s].axis == axis && squares_[s].low[axis] == low[axis]) at.emplace(squares_[s].low, s);
      std::vector<Index> facets;
      const auto& all = cells_[i]->complex.facets();
      for (Index f = 0; f < all.size(); ++f)
        if (all[f].plane == static_cast<Index>(2 * axis + upper)) facets.push_back(f);
      divide(i, at, low, box.high[0] - box.low[0], axis, std::move(facets));
    }
}

void CellCubes::divide(std::size_t i, const std::map<LatticePoint, Index>& at, const LatticePoint& low,
                       std::int64_t length, int axis, std::vector<Index> facets) {
  if (const auto found = at.find(low); found != at.end() && squares_[found->second].length == length) {
    facets_in_[i][found->second] = std::move(facets);
    return;
  }
  CellComplex& complex = cells_[i]->complex;
  std::vector<std::pair<LatticePoint, std::vector<Index>>> parts = {{low, std::move(facets)}};
  for (int across : {(axis + 1) % 3, (axis + 2) % 3}) {
    const std::int64_t middle = low[across] + length / 2;
    const Index plane =
        complex.add_plane(ExactPlane::across(across, middle - cells_[i]->centre[across])).first;
    std::vector<std::pair<LatticePoint, std::vector<Index>>> halves;
    for (auto& [corner, list] : parts) {
      std::vector<Index> above, below;
      for (Index f : list) {
        if (const Index other = complex.split_facet(f, plane); other != none) {
          above.push_back(f);
          below.push_back(other);
          continue;
        }
        bool up = false;
        for (Index v : complex.facets()[f].corners) up |= complex.side(plane, v) > 0;
        (up ? above : below).push_back(f);
      }
      LatticePoint upper = corner;
      upper[across] = middle;
      halves.emplace_back(corner, std::move(below));
      halves.emplace_back(upper, std::move(above));
    }
    parts.swap(halves);
  }
  for (auto& [corner, list] : parts) divide(i, at, corner, length / 2, axis, std::move(list));
}

// Calls `visit(axis, low)` for the four sides of a square.
template <class Visit>
void CellCubes::visit_sides(const LeafSquare& s, Visit&& visit) const {
  const int i = (s.axis + 1) % 3, j = (s.axis + 2) % 3;
  const std::array<LatticePoint, 4> corners = s.corners();
  visit(i, corners[0]);
  visit(i, corners[3]);
  visit(j, corners[0]);
  visit(j, corners[1]);
}

// Where cuts meet the lines of the octree all squares round the line have to know of it.
void CellCubes::meet() {
  for (std::size_t i = 0; i < cubes_.size(); ++i) {
    const ConvexCells& cells = *cells_[i];
    for (const auto& [square, facets] : facets_in_[i])
      for (Index f : facets)
        for (Index v : cells.complex.facets()[f].corners) {
          const ExactPoint& p = cells.complex.points()[v];
          visit_sides(squares_[square], [&](int axis, const LatticePoint& low) {
            for (int k = 0; k < 3; ++k)
              if (k != axis && compare(p, k, low[k] - cells.centre[k]) != 0) return;
            const std::int64_t from = low[axis] - cells.centre[axis];
            if (compare(p, axis, from) <= 0 || compare(p, axis, from + squares_[square].length) >= 0) return;
            on_line_[line(axis, low)].push_back({&p, cells.centre});
          });
        }
  }
  for (auto& [line, points] : on_line_) {
    const int axis = static_cast<int>(line[0]);
    const auto order = [&](const LinePoint& a, const LinePoint& b) {
      return compare(*a.point, a.origin[axis], *b.point, b.origin[axis], axis);
    };
    std::sort(points.begin(), points.end(),
              [&](const LinePoint& a, const LinePoint& b) { return order(a, b) < 0; });
    points.erase(std::unique(points.begin(), points.end(),
                             [&](const LinePoint& a, const LinePoint& b) { return order(a, b) == 0; }),
                 points.end());
  }
}

// The points strictly between the ends of a square's side.
CellCubes::Range CellCubes::between(const std::vector<LinePoint>& points, int axis, const LatticePoint& low,
                                    std::int64_t length) const {
  const auto below = [&](const LinePoint& p, std::int64_t value) {
    return compare(*p.point, axis, value - p.origin[axis]) < 0;
  };
  const auto first = std::lower_bound(points.begin(), points.end(), low[axis], below);
  const auto past = std::lower_bound(first, points.end(), low[axis] + length, below);
  return {static_cast<std::size_t>(first - points.begin()), static_cast<std::size_t>(past - points.begin())};
}

bool CellCubes::touch(Index square) const {
  if (cubes_.empty()) return false;
  const LeafSquare& s = squares_[square];
  for (Index cube : {s.below, s.above})
    if (cube != Octree::none && decomposition_.volumes[cube].kind == VolumeKind::unresolved) return true;
  bool any = false;
  visit_sides(s, [&](int axis, const LatticePoint& low) {
    const auto found = on_line_.find(line(axis, low));
    if (any || found == on_line_.end()) return;
    const auto [first, past] = between(found->second, axis, low, s.length);
    any = first != past;
  });
  return any;
}

CellSquare CellCubes::triangulate(Index square, const std::vector<Index>& candidates) const {
  const LeafSquare& s = squares_[square];
  SquareOverlay overlay;
  visit_sides(s, [&](int axis, const LatticePoint& low) {
    const auto found = on_line_.find(line(axis, low));
    if (found == on_line_.end()) return;
    const auto [first, past] = between(found->second, axis, low, s.length);
    for (std::size_t i = first; i < past; ++i)
      overlay.points.push_back(
          {found->second[i].point, found->second[i].origin, VertexKey::cut_on(axis, low, i)});
  });
  struct Part {
    int place;
    std::size_t cube;
    const std::vector<Index>* facets;
    std::unordered_map<Index, Index> points, lines;
  };
  std::vector<Part> parts;
  for (int place = 0; place < 2; ++place) {
    const Index cube = place == 0 ? s.below : s.above;
    const auto at = std::lower_bound(cubes_.begin(), cubes_.end(), cube);
    if (at == cubes_.end() || *at != cube) continue;
    const std::size_t i = static_cast<std::size_t>(at - cubes_.begin());
    Part part{place, i, &facets_in_[i].at(square), {}, {}};
    const CellComplex& complex = cells_[i]->complex;
    for (Index f : *part.facets) {
      for (Index v : complex.facets()[f].corners)
        if (part.points.emplace(v, static_cast<Index>(overlay.points.size())).second)
          overlay.points.push_back({&complex.points()[v], cells_[i]->centre, std::nullopt});
      for (Index e : complex.facets()[f].sides)
        if (part.lines.emplace(e, static_cast<Index>(overlay.lines.size())).second)
          overlay.lines.push_back(
              {part.points.at(complex.edges()[e].ends[0]), part.points.at(complex.edges()[e].ends[1])});
    }
    parts.push_back(std::move(part));
  }
  CellSquare result;
  result.triangulation = triangulate_square(mesh_, decomposition_.octree, s, candidates, square, overlay);
  for (const Part& part : parts) {
    for (const auto& [v, i] : part.points) result.points[part.place][v] = overlay.places[i];
    for (const auto& [e, i] : part.lines) result.chains[part.place][e] = overlay.chains[i];
    assign(result, part.place, part.cube, *part.facets);
  }
  return result;
}

// Which cell lies beside each triangle: on the left of a facet's sides, and on from there.
void CellCubes::assign(CellSquare& result, int place, std::size_t i, const std::vector<Index>& facets) const {
  const CellComplex& complex = cells_[i]->complex;
  const auto& triangles = result.triangulation.triangles;
  std::unordered_map<std::uint64_t, Index> left;
  for (Index f : facets) {
    const CellComplex::Facet& facet = complex.facets()[f];
    for (std::size_t k = 0; k < facet.sides.size(); ++k) {
      std::vector<Index> chain = result.chains[place].at(facet.sides[k]);
      if (complex.edges()[facet.sides[k]].ends[0] != facet.corners[k])
        std::reverse(chain.begin(), chain.end());
      for (std::size_t m = 0; m + 1 < chain.size(); ++m)
        left[directed(chain[m], chain[m + 1])] = facet.cells[0] != none ? facet.cells[0] : facet.cells[1];
    }
  }
  std::unordered_map<std::uint64_t, Index> triangle_at;
  for (Index t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) triangle_at[directed(triangles[t][k], triangles[t][(k + 1) % 3])] = t;
  std::vector<Index>& cells = result.cells[place];
  cells.assign(triangles.size(), none);
  std::vector<Index> pending;
  for (const auto& [side, cell] : left)
    if (const auto at = triangle_at.find(side); at != triangle_at.end() && cells[at->second] == none) {
      cells[at->second] = cell;
      pending.push_back(at->second);
    }
  while (!pending.empty()) {
    const Index t = pending.back();
    pending.pop_back();
    for (int k = 0; k < 3; ++k) {
      const Index from = triangles[t][k], to = triangles[t][(k + 1) % 3];
      if (left.count(directed(from, to)) || left.count(directed(to, from))) continue;
      const auto at = triangle_at.find(directed(to, from));
      if (at == triangle_at.end() || cells[at->second] != none) continue;
      cells[at->second] = cells[t];
      pending.push_back(at->second);
    }
  }
}

}  // namespace meshcomplete
