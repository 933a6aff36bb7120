#include "filter_atomicvolumes/square_triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cmath>
#include <optional>

namespace meshcomplete {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using ConstrainedDelaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;
// With crossings, and a record of the points along each constraint.
struct PointNumber {
  Index value = VolumeVertex::none;
};
using NumberedBase = CGAL::Triangulation_vertex_base_with_info_2<PointNumber, Kernel>;
using CrossingDelaunay = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<NumberedBase, FaceBase>, CGAL::Exact_intersections_tag>;
using CrossingTriangulation = CGAL::Constrained_triangulation_plus_2<CrossingDelaunay>;

constexpr Index none = VolumeVertex::none;

using Wide = __int128;

// Exact: in pieces that doubles hold.
Number number(Wide value) {
  constexpr int bits = 48;
  const bool negative = value < 0;
  unsigned __int128 rest =
      negative ? -static_cast<unsigned __int128>(value) : static_cast<unsigned __int128>(value);
  Number sum(0), unit(1);
  const Number base(std::ldexp(1.0, bits));
  while (rest != 0) {
    sum += unit * Number(static_cast<double>(static_cast<std::uint64_t>(rest & ((Wide{1} << bits) - 1))));
    unit *= base;
    rest >>= bits;
  }
  return negative ? -sum : sum;
}

Number number(const ExactInteger& numerator, const ExactInteger& denominator) {
  using Exact = Kernel::Exact_kernel::FT;
  const auto exact = [](const ExactInteger& value) {
    // In halves of limbs, which doubles hold.
    const Exact base(std::ldexp(1.0, 32));
    Exact sum(0);
    for (int limb = ExactInteger::limbs - 1; limb >= 0; --limb)
      for (int shift : {32, 0})
        sum = sum * base + Exact(static_cast<double>(value.magnitude[limb] >> shift & 0xffffffffu));
    return value.negative ? Exact(-sum) : sum;
  };
  return Number(Exact(exact(numerator) / exact(denominator)));
}

int sign(Wide value) { return (value > 0) - (value < 0); }

class SquareTriangulator {
 public:
  SquareTriangulator(const LatticeMesh& mesh, const Octree& octree, const LeafSquare& square)
      : mesh_(mesh), square_(square), k_(square.axis), i_((square.axis + 1) % 3), j_((square.axis + 2) % 3) {
    add_corners(octree);
  }

  void cross(Index triangle);
  SquareTriangulation finish();
  SquareTriangulation finish(Index number, SquareOverlay& overlay);

 private:
  // Where a triangle's side goes through the square's plane.
  struct Through {
    Index half_edge;
    LatticePoint from, to;
  };

  void add_corners(const Octree& octree);
  void add_side(const Octree& octree, const LatticePoint& start, int axis, bool reversed);
  Index point_at(const VertexKey& key);
  void remember(const VertexKey& key, const Number& u, const Number& v, Index rim_edge);
  int compare(const Through& through, int axis, std::int64_t bound) const;
  bool in_square(const Through& through) const;
  Index first_half_edge(Index half_edge) const;
  Index crossing_inside(const Through& through);
  std::optional<Index> crossing_at_side(Index triangle, const LatticeTriangle& corners, const Through& up,
                                        const Through& down, bool entering);
  Index crossing_on_line(Index triangle, const LatticeTriangle& corners, int along, const LatticePoint& start,
                         const LatticePoint& end);
  void plain_triangles();
  void constrained_triangles();
  using Handle = CrossingTriangulation::Vertex_handle;
  void place(CrossingTriangulation& triangulation, Index number, SquareOverlay& overlay);
  std::vector<Index> chain(const CrossingTriangulation& triangulation, Handle from, Handle to,
                           CrossingTriangulation::Constraint_id constraint) const;

  const LatticeMesh& mesh_;
  const LeafSquare& square_;
  const int k_, i_, j_;
  SquareTriangulation result_;
  std::vector<Kernel::Point_2> exact_;  // relative to the square's lowest corner
};

void SquareTriangulator::add_side(const Octree& octree, const LatticePoint& start, int axis, bool reversed) {
  std::vector<LatticePoint> corners = octree.corners_on(start, axis, square_.length);
  if (reversed) std::reverse(corners.begin(), corners.end());
  corners.pop_back();
  for (const LatticePoint& p : corners) {
    result_.points.push_back({VertexKey::at(p), mesh_.lattice.position(p), none, none});
    exact_.emplace_back(static_cast<double>(p[i_] - square_.low[i_]),
                        static_cast<double>(p[j_] - square_.low[j_]));
  }
}

// Counter-clockwise, with the corners of finer leaves on the sides.
void SquareTriangulator::add_corners(const Octree& octree) {
  const std::array<LatticePoint, 4> corners = square_.corners();
  add_side(octree, corners[0], i_, false);
  add_side(octree, corners[1], j_, false);
  add_side(octree, corners[3], i_, true);
  add_side(octree, corners[0], j_, true);
}

Index SquareTriangulator::point_at(const VertexKey& key) {
  for (Index i = 0; i < result_.points.size(); ++i)
    if (result_.points[i].key == key) return i;
  return none;
}

void SquareTriangulator::remember(const VertexKey& key, const Number& u, const Number& v, Index rim_edge) {
  LatticePoint corner = square_.low;
  Vector3 offset = Vector3::Zero();
  offset[i_] = CGAL::to_double(u);
  offset[j_] = CGAL::to_double(v);
  result_.points.push_back(
      {key, mesh_.lattice.position(corner) + mesh_.lattice.step() * offset, none, rim_edge});
  exact_.emplace_back(u, v);
}

// The sign of where the side is in the plane, along `axis`, less `bound`.
int SquareTriangulator::compare(const Through& through, int axis, std::int64_t bound) const {
  const LatticePoint &a = through.from, &b = through.to;
  const std::int64_t rise = b[k_] - a[k_];
  const Wide value = static_cast<Wide>(a[axis] - bound) * rise +
                     static_cast<Wide>(b[axis] - a[axis]) * (square_.low[k_] - a[k_]);
  const int result = sign(value) * sign(rise);
  if (result == 0) throw Coincidence();
  return result;
}

bool SquareTriangulator::in_square(const Through& through) const {
  for (int axis : {i_, j_})
    if (compare(through, axis, square_.low[axis]) < 0 ||
        compare(through, axis, square_.low[axis] + square_.length) > 0)
      return false;
  return true;
}

// The lowest half-edge at the same edge, by which all its faces know it.
Index SquareTriangulator::first_half_edge(Index half_edge) const {
  const Index opposite = mesh_.topology.opposite[half_edge];
  if (opposite == MeshTopology::boundary) return half_edge;
  if (opposite != MeshTopology::non_manifold) return std::min(opposite, half_edge);
  const auto ends = std::minmax<Index>({mesh_.origin(half_edge), mesh_.target(half_edge)});
  for (Index h : mesh_.topology.non_manifold_half_edges)
    if (std::minmax<Index>({mesh_.origin(h), mesh_.target(h)}) == ends) return h;
  return half_edge;
}

Index SquareTriangulator::crossing_inside(const Through& through) {
  const Index opposite = mesh_.topology.opposite[through.half_edge];
  const Index edge = first_half_edge(through.half_edge);
  const VertexKey key = VertexKey::crossing(edge, k_, square_.low[k_]);
  if (const Index known = point_at(key); known != none) return known;
  const LatticePoint &a = through.from, &b = through.to;
  const Number share =
      Number(static_cast<double>(square_.low[k_] - a[k_])) / Number(static_cast<double>(b[k_] - a[k_]));
  const auto coordinate = [&](int axis) {
    return Number(static_cast<double>(a[axis] - square_.low[axis])) +
           Number(static_cast<double>(b[axis] - a[axis])) * share;
  };
  remember(key, coordinate(i_), coordinate(j_), opposite == MeshTopology::boundary ? edge : none);
  return static_cast<Index>(result_.points.size() - 1);
}

Index SquareTriangulator::crossing_on_line(Index triangle, const LatticeTriangle& corners, int along,
                                           const LatticePoint& start, const LatticePoint& end) {
  const VertexKey key = VertexKey::crossing(triangle, along, start);
  if (const Index known = point_at(key); known != none) return known;
  std::array<std::int64_t, 3> u, v;
  for (int axis = 0; axis < 3; ++axis) {
    u[axis] = corners[1][axis] - corners[0][axis];
    v[axis] = corners[2][axis] - corners[0][axis];
  }
  Number to_plane(0), along_line(0);
  for (int axis = 0; axis < 3; ++axis) {
    const int p = (axis + 1) % 3, q = (axis + 2) % 3;
    const Number normal = number(static_cast<Wide>(u[p]) * v[q] - static_cast<Wide>(u[q]) * v[p]);
    to_plane += normal * Number(static_cast<double>(corners[0][axis] - start[axis]));
    along_line += normal * Number(static_cast<double>(end[axis] - start[axis]));
  }
  const Number share = to_plane / along_line;
  const auto coordinate = [&](int axis) {
    return Number(static_cast<double>(start[axis] - square_.low[axis])) +
           Number(static_cast<double>(end[axis] - start[axis])) * share;
  };
  remember(key, coordinate(i_), coordinate(j_), none);
  return static_cast<Index>(result_.points.size() - 1);
}

// Where the line from `up` to `down` enters the square, or leaves it. The line runs along (n_j, -n_i), n the
// triangle's normal, so that signs alone tell which sides it can enter.
std::optional<Index> SquareTriangulator::crossing_at_side(Index triangle, const LatticeTriangle& corners,
                                                          const Through& up, const Through& down,
                                                          bool entering) {
  const std::array<LatticePoint, 4> c = square_.corners();
  const std::array<std::array<LatticePoint, 2>, 4> sides = {
      {{c[0], c[1]}, {c[1], c[2]}, {c[3], c[2]}, {c[0], c[3]}}};
  const int along_i = normal_sign(corners, j_), along_j = -normal_sign(corners, i_);
  const std::array<int, 4> inward = {along_j, -along_i, -along_j, along_i};
  for (int side = 0; side < 4; ++side) {
    if (inward[side] != (entering ? 1 : -1)) continue;
    const int across = side % 2 == 0 ? j_ : i_;
    const auto& [start, end] = sides[side];
    if (compare(up, across, start[across]) == compare(down, across, start[across])) continue;
    const int first = orientation(corners[0], corners[1], corners[2], start);
    const int last = orientation(corners[0], corners[1], corners[2], end);
    if (first == 0 || last == 0) throw Coincidence();
    if (first != last) return crossing_on_line(triangle, corners, side % 2 == 0 ? i_ : j_, start, end);
  }
  return std::nullopt;
}

void SquareTriangulator::cross(Index triangle) {
  const LatticeTriangle corners = mesh_.triangle(triangle);
  std::optional<Through> up, down;
  for (Index k = 0; k < 3; ++k) {
    const LatticePoint &a = corners[k], &b = corners[(k + 1) % 3];
    const bool a_above = a[k_] > square_.low[k_], b_above = b[k_] > square_.low[k_];
    if (a_above == b_above) continue;
    (b_above ? up : down) = Through{3 * triangle + k, a, b};
  }
  if (!up || !down || !meets(corners, square_.box())) return;
  const std::optional<Index> from = in_square(*up) ? std::optional<Index>(crossing_inside(*up))
                                                   : crossing_at_side(triangle, corners, *up, *down, true);
  const std::optional<Index> to = in_square(*down) ? std::optional<Index>(crossing_inside(*down))
                                                   : crossing_at_side(triangle, corners, *up, *down, false);
  if (!from && !to) return;
  if (!from || !to || *from == *to) throw Coincidence();
  result_.segments.push_back({*from, *to, triangle});
}

// Two triangles, or a fan round the centre when there are corners of finer leaves on the sides.
void SquareTriangulator::plain_triangles() {
  const Index n = static_cast<Index>(result_.points.size());
  if (n == 4) {
    result_.triangles = {{0, 1, 2}, {0, 2, 3}};
    return;
  }
  const LatticePoint centre = square_.centre();
  result_.points.push_back({VertexKey::at(centre), mesh_.lattice.position(centre), none, none});
  for (Index i = 0; i < n; ++i) result_.triangles.push_back({i, (i + 1) % n, n});
}

void SquareTriangulator::constrained_triangles() {
  ConstrainedDelaunay triangulation;
  std::vector<ConstrainedDelaunay::Vertex_handle> handles;
  for (Index i = 0; i < exact_.size(); ++i) {
    handles.push_back(triangulation.insert(exact_[i]));
    handles.back()->info() = i;
    // Another position of the octree would not help where faces lie on each other.
    if (triangulation.number_of_vertices() != i + 1) throw TangledCube();
  }
  try {
    for (const SquareTriangulation::Segment& s : result_.segments)
      triangulation.insert_constraint(handles[s.from], handles[s.to]);
  } catch (const ConstrainedDelaunay::Intersection_of_constraints_exception&) {
    throw TangledCube();
  }
  for (auto face = triangulation.finite_faces_begin(); face != triangulation.finite_faces_end(); ++face)
    result_.triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
}

SquareTriangulation SquareTriangulator::finish() {
  if (result_.segments.empty())
    plain_triangles();
  else
    constrained_triangles();
  return std::move(result_);
}

// The points of the overlay among those of the square.
void SquareTriangulator::place(CrossingTriangulation& triangulation, Index number, SquareOverlay& overlay) {
  for (const SquareOverlay::Point& p : overlay.points) {
    std::array<Number, 2> at;
    for (int m = 0; m < 2; ++m) {
      const int axis = m == 0 ? i_ : j_;
      at[m] = meshcomplete::number(p.point->coordinates[axis], p.point->weight) +
              Number(static_cast<double>(p.origin[axis] - square_.low[axis]));
    }
    const Handle handle = triangulation.insert(Kernel::Point_2(at[0], at[1]));
    Index& place = handle->info().value;
    if (place == none) {
      place = static_cast<Index>(result_.points.size());
      remember(p.key ? *p.key : VertexKey{VertexKey::cut_in_square, number, place, 0}, at[0], at[1], none);
    } else if (p.key && result_.points[place].key.kind != VertexKey::lattice_point) {
      result_.points[place].key = *p.key;
    }
    overlay.places.push_back(place);
  }
}

std::vector<Index> SquareTriangulator::chain(const CrossingTriangulation& triangulation, Handle from,
                                             Handle to,
                                             CrossingTriangulation::Constraint_id constraint) const {
  std::vector<Index> points;
  for (auto v = triangulation.vertices_in_constraint_begin(constraint);
       v != triangulation.vertices_in_constraint_end(constraint); ++v)
    points.push_back((*v)->info().value);
  if (points.front() != from->info().value) std::reverse(points.begin(), points.end());
  if (points.front() != from->info().value || points.back() != to->info().value) throw Coincidence();
  return points;
}

SquareTriangulation SquareTriangulator::finish(Index number, SquareOverlay& overlay) {
  CrossingTriangulation triangulation;
  std::vector<Index> same;  // of the square's own points, the first one at each place
  for (Index i = 0; i < exact_.size(); ++i) {
    const Handle handle = triangulation.insert(exact_[i]);
    // Boundary edges of the mesh may lie on each other.
    if (handle->info().value == none) handle->info().value = i;
    same.push_back(handle->info().value);
  }
  place(triangulation, number, overlay);
  std::vector<Handle> handles(result_.points.size());
  for (auto v = triangulation.finite_vertices_begin(); v != triangulation.finite_vertices_end(); ++v)
    handles[v->info().value] = v;
  std::vector<CrossingTriangulation::Constraint_id> segments, lines;
  for (SquareTriangulation::Segment& s : result_.segments) {
    s.from = same[s.from];
    s.to = same[s.to];
    if (s.from == s.to) throw Coincidence();
    segments.push_back(triangulation.insert_constraint(handles[s.from], handles[s.to]));
  }
  for (const auto& [from, to] : overlay.lines)
    lines.push_back(
        triangulation.insert_constraint(handles[overlay.places[from]], handles[overlay.places[to]]));
  for (auto v = triangulation.finite_vertices_begin(); v != triangulation.finite_vertices_end(); ++v) {
    if (v->info().value != none) continue;
    const Index place = v->info().value = static_cast<Index>(result_.points.size());
    remember({VertexKey::cut_in_square, number, place, 0}, v->point().x(), v->point().y(), none);
  }
  for (std::size_t i = 0; i < lines.size(); ++i)
    overlay.chains.push_back(chain(triangulation, handles[overlay.places[overlay.lines[i][0]]],
                                   handles[overlay.places[overlay.lines[i][1]]], lines[i]));
  std::vector<SquareTriangulation::Segment> parts;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const SquareTriangulation::Segment& s = result_.segments[i];
    const std::vector<Index> points = chain(triangulation, handles[s.from], handles[s.to], segments[i]);
    for (std::size_t k = 0; k + 1 < points.size(); ++k)
      parts.push_back({points[k], points[k + 1], s.triangle});
  }
  result_.segments = std::move(parts);
  for (auto face = triangulation.finite_faces_begin(); face != triangulation.finite_faces_end(); ++face)
    result_.triangles.push_back(
        {face->vertex(0)->info().value, face->vertex(1)->info().value, face->vertex(2)->info().value});
  return std::move(result_);
}

}  // namespace

VertexKey VertexKey::at(const LatticePoint& p) {
  return {lattice_point, static_cast<std::uint64_t>(p[0]), static_cast<std::uint64_t>(p[1]),
          static_cast<std::uint64_t>(p[2])};
}

VertexKey VertexKey::crossing(Index edge, int axis, std::int64_t plane) {
  return {edge_in_plane, edge, static_cast<std::uint64_t>(axis), static_cast<std::uint64_t>(plane)};
}

VertexKey VertexKey::crossing(Index triangle, int axis, const LatticePoint& p) {
  return {triangle_on_line, triangle | static_cast<std::uint64_t>(axis) << 32,
          static_cast<std::uint64_t>(p[(axis + 1) % 3]), static_cast<std::uint64_t>(p[(axis + 2) % 3])};
}

VertexKey VertexKey::vertex(Index input_vertex) { return {VertexKey::input_vertex, input_vertex, 0, 0}; }

VertexKey VertexKey::apex(Index cube) { return {edge_in_cube, cube, 0, 0}; }

VertexKey VertexKey::cut_on(int axis, const LatticePoint& p, std::size_t number) {
  return {cut_on_line, number << 2 | static_cast<std::uint64_t>(axis),
          static_cast<std::uint64_t>(p[(axis + 1) % 3]), static_cast<std::uint64_t>(p[(axis + 2) % 3])};
}

std::size_t VertexKeyHash::operator()(const VertexKey& key) const {
  // A multiplicative mix: the coordinates of lattice points end in many zeros.
  std::uint64_t h = key.kind;
  for (std::uint64_t part : {key.a, key.b, key.c}) {
    h = (h ^ part) * 0x9e3779b97f4a7c15ull;
    h ^= h >> 29;
  }
  return static_cast<std::size_t>(h);
}

SquareTriangulation triangulate_square(const LatticeMesh& mesh, const Octree& octree,
                                       const LeafSquare& square, const std::vector<Index>& candidates) {
  SquareTriangulator triangulator(mesh, octree, square);
  for (Index triangle : candidates) triangulator.cross(triangle);
  return triangulator.finish();
}

SquareTriangulation triangulate_square(const LatticeMesh& mesh, const Octree& octree,
                                       const LeafSquare& square, const std::vector<Index>& candidates,
                                       Index number, SquareOverlay& overlay) {
  SquareTriangulator triangulator(mesh, octree, square);
  for (Index triangle : candidates) triangulator.cross(triangle);
  return triangulator.finish(number, overlay);
}

}  // namespace meshcomplete
