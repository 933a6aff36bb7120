#include "filter_atomicvolumes/convex_cells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

namespace meshcomplete {
namespace {

constexpr Index none = CellComplex::none;

// Cuts between walls that contradict each other, per wall: of two that cannot be separated the first one
// counts.
constexpr std::size_t cuts_per_wall = 4;

// Of the integers that the normal of such a cut is rounded to.
constexpr double direction_units = 1 << 20;

struct PlacedTriangle {
  Index number;
  LatticeTriangle corners;  // relative to the cube's centre
  double area;
  std::array<ExactPoint, 3> points;
  std::vector<ExactPlane> sides;  // through each side, the triangle on the positive side
  Index plane = none;
  bool turned = false;  // the triangle's front is on the plane's negative side
};

class CellCutter {
 public:
  CellCutter(const LatticeMesh& mesh, const LatticeBox& cube, const std::vector<Index>& triangles)
      : mesh_(mesh), result_(centre_of(cube), (cube.high[0] - cube.low[0]) / 2), complex_(result_.complex) {
    place(triangles);
    nodes_.push_back({none, {none, none}, 0});
  }

  ConvexCells run();

 private:
  // Of the tree of cuts: a plane with the nodes on its positive and negative side, or a cell.
  struct Node {
    Index plane;
    std::array<Index, 2> children;
    Index cell;
  };

  static LatticePoint centre_of(const LatticeBox& cube) {
    LatticePoint p;
    for (int k = 0; k < 3; ++k) p[k] = cube.low[k] + (cube.high[k] - cube.low[k]) / 2;
    return p;
  }
  void place(const std::vector<Index>& triangles);
  template <std::size_t n, class Visit>
  void visit_leaves(const std::array<const ExactPoint*, n>& points, Visit&& visit);
  void cut(Index node, Index plane);
  bool meets_interior(const PlacedTriangle& triangle, Index cell);
  bool beyond_a_facet(const ExactPoint* const* points, std::size_t count, Index cell, Index but_plane) const;
  bool reaches_beyond(const ExactPlane& side, Index plane, Index cell);
  bool rests_in(const PlacedTriangle& triangle, Index plane, int k, Index cell);
  void cut_at_boundary(const PlacedTriangle& triangle, int k);
  bool covers(const PlacedTriangle& triangle, Index facet) const;
  void find_walls();
  std::optional<Side> side_at_wall(Index facet, Index cell) const;
  void separate_contradictions();
  std::optional<Index> separating_plane(Index first, Index second);
  Vector3 centre(Index facet) const;
  void find_rims();
  bool on_one_rim(Index a, Index b) const;
  void flood();

  const LatticeMesh& mesh_;
  ConvexCells result_;
  CellComplex& complex_;
  std::vector<PlacedTriangle> triangles_;
  std::vector<Node> nodes_;
};

// The largest first, in every cube alike, so that neighbours tend to be cut by the same planes.
void CellCutter::place(const std::vector<Index>& triangles) {
  for (Index t : triangles) {
    LatticeTriangle c = mesh_.triangle(t);
    for (LatticePoint& p : c)
      for (int k = 0; k < 3; ++k) p[k] -= result_.centre[k];
    ExactPlane plane = ExactPlane::through(c);
    const double area = std::hypot(plane.rounded[0], plane.rounded[1], plane.rounded[2]);
    if (!(area > 0)) continue;
    const LatticePoint direction = rounded_normal(c);
    PlacedTriangle placed{t,  c,    area, {ExactPoint(c[0]), ExactPoint(c[1]), ExactPoint(c[2])},
                          {}, none, false};
    for (int k = 0; k < 3; ++k)
      placed.sides.push_back(ExactPlane::along(c[k], c[(k + 1) % 3], direction, c[(k + 2) % 3]));
    std::tie(placed.plane, placed.turned) = complex_.add_plane(std::move(plane));
    triangles_.push_back(std::move(placed));
  }
  std::sort(triangles_.begin(), triangles_.end(), [](const PlacedTriangle& a, const PlacedTriangle& b) {
    return std::tie(b.area, a.number) < std::tie(a.area, b.number);
  });
}

// Calls `visit(node)` for the cells that the hull of the points may touch.
template <std::size_t n, class Visit>
void CellCutter::visit_leaves(const std::array<const ExactPoint*, n>& points, Visit&& visit) {
  std::vector<Index> pending = {0};
  while (!pending.empty()) {
    const Index node = pending.back();
    pending.pop_back();
    if (nodes_[node].plane == none) {
      visit(node);
      continue;
    }
    bool above = false, below = false;
    for (const ExactPoint* p : points) {
      const int s = side_of(complex_.planes()[nodes_[node].plane], *p);
      above |= s > 0;
      below |= s < 0;
    }
    if (above || !below) pending.push_back(nodes_[node].children[0]);
    if (below || !above) pending.push_back(nodes_[node].children[1]);
  }
}

void CellCutter::cut(Index node, Index plane) {
  const Index first = static_cast<Index>(nodes_.size()), cell = nodes_[node].cell;
  const Index other = complex_.split(cell, plane);
  nodes_[node] = {plane, {first, first + 1}, none};
  nodes_.push_back({none, {none, none}, cell});
  nodes_.push_back({none, {none, none}, other});
}

// Whether the points lie, all of them, on or beyond one facet of the cell, those in one plane left out.
bool CellCutter::beyond_a_facet(const ExactPoint* const* points, std::size_t count, Index cell,
                                Index but_plane) const {
  for (Index f : complex_.cells()[cell].facets) {
    const CellComplex::Facet& facet = complex_.facets()[f];
    if (facet.plane == but_plane) continue;
    const int inward = facet.cells[0] == cell ? 1 : -1;
    bool beyond = true;
    for (std::size_t i = 0; i < count && beyond; ++i)
      beyond = side_of(complex_.planes()[facet.plane], *points[i]) * inward <= 0;
    if (beyond) return true;
  }
  return false;
}

// Whether the part of the cell in the plane has a point on the positive side.
bool CellCutter::reaches_beyond(const ExactPlane& side, Index plane, Index cell) {
  for (Index f : complex_.cells()[cell].facets)
    for (Index e : complex_.facets()[f].sides) {
      const auto [a, b] = complex_.edges()[e].ends;
      const int at_a = complex_.side(plane, a), at_b = complex_.side(plane, b);
      if (at_a * at_b > 0) continue;
      const int side_a = side_of(side, complex_.points()[a]), side_b = side_of(side, complex_.points()[b]);
      if ((at_a == 0 && side_a > 0) || (at_b == 0 && side_b > 0)) return true;
      if (at_a == 0 || at_b == 0 || (side_a <= 0 && side_b <= 0)) continue;
      if (side_a > 0 && side_b > 0) return true;
      const auto [p, q] = complex_.edges()[e].planes;
      const auto& planes = complex_.planes();
      if (side_of(side, ExactPoint(planes[p], planes[q], planes[plane])) > 0) return true;
    }
  return false;
}

// Two convex polygons in one plane, the triangle and the section of the cell, have inner points in common
// unless a side of one separates them.
bool CellCutter::meets_interior(const PlacedTriangle& t, Index cell) {
  const std::array<const ExactPoint*, 3> points = {&t.points[0], &t.points[1], &t.points[2]};
  if (beyond_a_facet(points.data(), 3, cell, none) || !complex_.crosses(t.plane, cell)) return false;
  return std::all_of(t.sides.begin(), t.sides.end(),
                     [&](const ExactPlane& side) { return reaches_beyond(side, t.plane, cell); });
}

// Whether the cell has a face in the triangle's plane of which side k crosses the inside.
bool CellCutter::rests_in(const PlacedTriangle& t, Index plane, int k, Index cell) {
  bool above = false, below = false;
  for (Index f : complex_.cells()[cell].facets) {
    if (complex_.facets()[f].plane != t.plane) continue;
    for (Index v : complex_.facets()[f].corners) {
      const int s = complex_.side(plane, v);
      above |= s > 0;
      below |= s < 0;
    }
  }
  const std::array<const ExactPoint*, 2> ends = {&t.points[k], &t.points[(k + 1) % 3]};
  return above && below && !beyond_a_facet(ends.data(), 2, cell, t.plane);
}

void CellCutter::cut_at_boundary(const PlacedTriangle& t, int k) {
  const Index plane = complex_.add_plane(t.sides[k]).first;
  std::vector<Index> found;
  visit_leaves(std::array<const ExactPoint*, 2>{&t.points[k], &t.points[(k + 1) % 3]}, [&](Index node) {
    if (rests_in(t, plane, k, nodes_[node].cell)) found.push_back(node);
  });
  for (Index node : found) cut(node, plane);
}

// Whether a facet in the triangle's plane lies in the triangle; it does, or has no inner point in common with
// it.
bool CellCutter::covers(const PlacedTriangle& t, Index facet) const {
  const auto& corners = complex_.facets()[facet].corners;
  const auto& points = complex_.points();
  for (const ExactPlane& side : t.sides)
    if (std::none_of(corners.begin(), corners.end(), [&](Index v) { return side_of(side, points[v]) > 0; }))
      return false;
  for (std::size_t place = 0; place < corners.size(); ++place) {
    const ExactPlane& side = complex_.planes()[complex_.plane_through_side(facet, place)];
    int inward = 0;
    for (std::size_t i = 0; i < corners.size() && inward == 0; ++i)
      inward = side_of(side, points[corners[i]]);
    if (std::none_of(t.points.begin(), t.points.end(),
                     [&](const ExactPoint& p) { return side_of(side, p) * inward > 0; }))
      return false;
  }
  return true;
}

void CellCutter::find_walls() {
  std::vector<std::vector<Index>> in_plane(complex_.planes().size());
  for (Index i = 0; i < triangles_.size(); ++i) in_plane[triangles_[i].plane].push_back(i);
  for (Index f = 0; f < complex_.facets().size(); ++f)
    for (Index i : in_plane[complex_.facets()[f].plane])
      if (covers(triangles_[i], f)) {
        complex_.mark(f, triangles_[i].turned ? wall_facing_down : wall_facing_up);
        break;
      }
}

// What a wall makes of a cell beside it.
std::optional<Side> CellCutter::side_at_wall(Index facet, Index cell) const {
  const CellComplex::Facet& f = complex_.facets()[facet];
  if (f.wall == no_wall) return std::nullopt;
  return (f.cells[0] == cell) == (f.wall == wall_facing_up) ? Side::outside : Side::inside;
}

Vector3 CellCutter::centre(Index facet) const {
  Vector3 sum = Vector3::Zero();
  const auto& corners = complex_.facets()[facet].corners;
  for (Index v : corners) sum += complex_.points()[v].rounded;
  return sum / static_cast<double>(corners.size());
}

// A plane with one facet on each side, if one of those tried is such.
std::optional<Index> CellCutter::separating_plane(Index first, Index second) {
  const auto& corners = [&](Index f) -> const auto& { return complex_.facets()[f].corners; };
  const auto plane_normal = [&](Index f) {
    const auto& n = complex_.planes()[complex_.facets()[f].plane].rounded;
    return Vector3(n[0], n[1], n[2]);
  };
  for (Vector3 direction :
       {Vector3(centre(second) - centre(first)), plane_normal(first), plane_normal(second)}) {
    direction *= direction_units / direction.cwiseAbs().maxCoeff();
    std::array<ExactInteger, 3> normal;
    Vector3 rounded;
    for (int k = 0; k < 3; ++k) {
      rounded[k] = std::round(direction[k]);
      normal[k] = static_cast<std::int64_t>(rounded[k]);
    }
    double first_most = -std::numeric_limits<double>::infinity(), first_least = -first_most;
    double second_most = first_most, second_least = first_least;
    for (Index v : corners(first)) {
      const double at = rounded.dot(complex_.points()[v].rounded);
      first_most = std::max(first_most, at);
      first_least = std::min(first_least, at);
    }
    for (Index v : corners(second)) {
      const double at = rounded.dot(complex_.points()[v].rounded);
      second_most = std::max(second_most, at);
      second_least = std::min(second_least, at);
    }
    const double middle =
        first_most < second_least ? 0.5 * (first_most + second_least) : 0.5 * (second_most + first_least);
    const Index plane =
        complex_.add_plane(ExactPlane(normal, ExactInteger(static_cast<std::int64_t>(-std::round(middle)))))
            .first;
    const auto strictly_on = [&](Index f, int side) {
      return std::all_of(corners(f).begin(), corners(f).end(),
                         [&](Index v) { return complex_.side(plane, v) == side; });
    };
    if ((strictly_on(first, 1) && strictly_on(second, -1)) ||
        (strictly_on(first, -1) && strictly_on(second, 1)))
      return plane;
  }
  return std::nullopt;
}

void CellCutter::separate_contradictions() {
  std::size_t walls = 0;
  for (const CellComplex::Facet& f : complex_.facets()) walls += f.wall != no_wall;
  std::size_t left = cuts_per_wall * walls;
  for (Index cell = 0; cell < complex_.cells().size(); ++cell) {
    for (bool again = true; again;) {
      again = false;
      const std::vector<Index> facets = complex_.cells()[cell].facets;
      for (std::size_t i = 0; i < facets.size() && !again; ++i)
        for (std::size_t j = 0; j < i && !again; ++j) {
          const auto a = side_at_wall(facets[i], cell), b = side_at_wall(facets[j], cell);
          if (!a || !b || *a == *b || left == 0) continue;
          if (const std::optional<Index> plane = separating_plane(facets[i], facets[j])) {
            complex_.split(cell, *plane);
            --left;
            again = true;
          }
        }
    }
  }
}

// The boundary of the mesh, vertex by vertex.
void CellCutter::find_rims() {
  const auto& points = complex_.points();
  std::vector<char> at_wall(points.size(), 0);
  for (const CellComplex::Facet& f : complex_.facets())
    if (f.wall != no_wall)
      for (Index v : f.corners) at_wall[v] = 1;
  result_.rims.resize(points.size());
  std::vector<Index> input(points.size(), none);
  for (const PlacedTriangle& t : triangles_)
    for (Index k = 0; k < 3; ++k) {
      const Index half_edge = 3 * t.number + k;
      if (mesh_.topology.opposite[half_edge] != MeshTopology::boundary) continue;
      const LatticePoint &a = t.corners[k], &b = t.corners[(k + 1) % 3];
      int axis = 0;
      for (int m = 1; m < 3; ++m)
        if (std::abs(b[m] - a[m]) > std::abs(b[axis] - a[axis])) axis = m;
      for (Index v = 0; v < points.size(); ++v) {
        if (!at_wall[v] || compare(points[v], axis, a[axis]) * compare(points[v], axis, b[axis]) > 0)
          continue;
        if (side_of(t.sides[k], points[v]) != 0 || complex_.side(t.plane, v) != 0) continue;
        result_.rims[v].push_back(half_edge);
        if (points[v] == t.points[k]) input[v] = mesh_.origin(half_edge);
        if (points[v] == t.points[(k + 1) % 3]) input[v] = mesh_.target(half_edge);
      }
    }
  for (Index v = 0; v < points.size(); ++v)
    if (input[v] != none) result_.rim_vertices.emplace_back(v, input[v]);
}

bool CellCutter::on_one_rim(Index a, Index b) const {
  return std::any_of(result_.rims[a].begin(), result_.rims[a].end(), [&](Index h) {
    return std::find(result_.rims[b].begin(), result_.rims[b].end(), h) != result_.rims[b].end();
  });
}

// Round a vertex or edge of the mesh that is not on its boundary, what the mesh does not separate is on one
// side.
void CellCutter::flood() {
  const auto& facets = complex_.facets();
  std::vector<char> inner_vertex(complex_.points().size(), 0), inner_edge(complex_.edges().size(), 0);
  for (const CellComplex::Facet& f : facets) {
    if (f.wall == no_wall) continue;
    for (Index v : f.corners) inner_vertex[v] = result_.rims[v].empty();
    for (Index e : f.sides) {
      const auto [a, b] = complex_.edges()[e].ends;
      inner_edge[e] = !on_one_rim(a, b);
    }
  }
  std::vector<Index> pending;
  result_.sides.assign(complex_.cells().size(), Side::free);
  for (Index c = 0; c < complex_.cells().size(); ++c) {
    bool contradicting = false;
    for (Index f : complex_.cells()[c].facets) {
      const std::optional<Side> side = side_at_wall(f, c);
      if (!side) continue;
      contradicting |= result_.sides[c] != Side::free && result_.sides[c] != *side;
      if (result_.sides[c] == Side::free) result_.sides[c] = *side;
    }
    result_.contradicting += contradicting;
    if (result_.sides[c] != Side::free) pending.push_back(c);
  }
  while (!pending.empty()) {
    const Index cell = pending.back();
    pending.pop_back();
    for (Index f : complex_.cells()[cell].facets) {
      const CellComplex::Facet& facet = facets[f];
      const Index other = facet.cells[facet.cells[0] == cell ? 1 : 0];
      if (facet.wall != no_wall || other == none || result_.sides[other] != Side::free) continue;
      if (std::none_of(facet.corners.begin(), facet.corners.end(),
                       [&](Index v) { return inner_vertex[v]; }) &&
          std::none_of(facet.sides.begin(), facet.sides.end(), [&](Index e) { return inner_edge[e]; }))
        continue;
      result_.sides[other] = result_.sides[cell];
      pending.push_back(other);
    }
  }
}

ConvexCells CellCutter::run() {
  for (const PlacedTriangle& t : triangles_) {
    for (Index v = 0; v < 8; ++v)
      if (complex_.side(t.plane, v) == 0) throw Coincidence();
    std::vector<Index> found;
    visit_leaves(std::array<const ExactPoint*, 3>{&t.points[0], &t.points[1], &t.points[2]}, [&](Index node) {
      if (meets_interior(t, nodes_[node].cell)) found.push_back(node);
    });
    for (Index node : found) cut(node, t.plane);
  }
  for (const PlacedTriangle& t : triangles_)
    for (int k = 0; k < 3; ++k)
      if (mesh_.topology.opposite[3 * t.number + static_cast<Index>(k)] == MeshTopology::boundary)
        cut_at_boundary(t, k);
  find_walls();
  separate_contradictions();
  find_rims();
  flood();
  return std::move(result_);
}

}  // namespace

ConvexCells cut_into_cells(const LatticeMesh& mesh, const LatticeBox& cube,
                           const std::vector<Index>& triangles) {
  return CellCutter(mesh, cube, triangles).run();
}

std::vector<double> cell_volumes(const ConvexCells& cells) {
  const CellComplex& complex = cells.complex;
  std::vector<double> volumes(complex.cells().size(), 0.0);
  for (const CellComplex::Facet& f : complex.facets())
    for (std::size_t i = 1; i + 1 < f.corners.size(); ++i) {
      const auto at = [&](std::size_t k) -> const Vector3& { return complex.points()[f.corners[k]].rounded; };
      const double part = at(0).cross(at(i)).dot(at(i + 1)) / 6;
      // Seen from the positive side the facet runs counter-clockwise: outward for the cell behind it.
      if (f.cells[1] != CellComplex::none) volumes[f.cells[1]] += part;
      if (f.cells[0] != CellComplex::none) volumes[f.cells[0]] -= part;
    }
  return volumes;
}

}  // namespace meshcomplete
