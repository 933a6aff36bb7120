#include "filter_atomicvolumes/volume_warp.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

#include "common/core/patch.h"
#include "common/core/threads.h"

namespace meshcomplete {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 point(const Vector3& p) { return Kernel::Point_3(p[0], p[1], p[2]); }

}  // namespace

// Gathers the volumes at the vertices that may move.
class VolumeWarpBuilder {
 public:
  VolumeWarpBuilder(VolumeWarp& warp, const LatticeMesh& mesh, const Decomposition& decomposition,
                    const VolumeComplex& complex, const LabelledSurface& surface)
      : warp_(warp), mesh_(mesh), decomposition_(decomposition), complex_(complex), surface_(surface) {}

  void build(const std::vector<VolumePoint>& points, const Progress& progress) {
    number_surface();
    find_cubes();
    find_squares();
    triangulate_squares(progress);
    sort_points(points);
    for (Index cube : cubes_) {
      progress.check();
      if (decomposition_.volumes[cube].kind == VolumeKind::blank)
        add_blank(cube);
      else
        add_tetrahedra(cube);
    }
    index_faces();
  }

 private:
  using Base = std::array<Index, 3>;

  // A square at one of the cubes, its points numbered as in the warp.
  struct SquareData {
    Index square;
    SquareTriangulation triangulation;
    std::vector<Index> vertex;
  };

  bool is_hole(Index cube) const {
    return cube != Octree::none && (decomposition_.volumes[cube].kind == VolumeKind::vertex ||
                                    decomposition_.volumes[cube].kind == VolumeKind::edge);
  }
  bool may_move_here(Index v) const { return v < warp_.surface_vertices_ && warp_.movable_[v]; }
  void number_surface();
  Index number_of(const VolumeVertex& vertex);
  std::vector<Index> leaves_at(const VolumeVertex& vertex) const;
  void find_cubes();
  void find_squares();
  void triangulate_squares(const Progress& progress);
  void sort_points(const std::vector<VolumePoint>& points);
  void add_blank(Index cube);
  void add_tetrahedra(Index cube);
  Index apex_of(Index cube);
  void add_body(const std::vector<Base>& faces, const Vector3& centroid, const std::vector<Vector3>* points);
  void index_faces();
  std::vector<Base> surface_of(Index cube) const;

  VolumeWarp& warp_;
  const LatticeMesh& mesh_;
  const Decomposition& decomposition_;
  const VolumeComplex& complex_;
  const LabelledSurface& surface_;
  std::unordered_map<VertexKey, Index, VertexKeyHash> number_;
  std::vector<Index> cubes_;  // blank and hole cubes at vertices that may move, ascending
  std::vector<SquareData> squares_;
  std::unordered_map<Index, std::vector<Index>> squares_of_;  // of each of the cubes, in `squares_`
  std::map<Cell, std::vector<Vector3>> points_;
  std::map<std::pair<Index, Base>, Cell> pinned_tetrahedra_;  // by cube and sorted base
};

void VolumeWarpBuilder::number_surface() {
  warp_.surface_vertices_ = surface_.vertices.size();
  for (const VolumeVertex& v : surface_.vertices) {
    number_.emplace(v.key, static_cast<Index>(warp_.positions_.size()));
    warp_.positions_.push_back(is_octree_point(v) ? as_stored(v.position) : v.position);
    warp_.movable_.push_back(is_octree_point(v));
  }
}

Index VolumeWarpBuilder::number_of(const VolumeVertex& vertex) {
  const auto [it, fresh] = number_.try_emplace(vertex.key, static_cast<Index>(warp_.positions_.size()));
  if (fresh)
    warp_.positions_.push_back(is_octree_point(vertex) ? as_stored(vertex.position) : vertex.position);
  return it->second;
}

// The leaves at a point of the octree.
std::vector<Index> VolumeWarpBuilder::leaves_at(const VolumeVertex& vertex) const {
  std::vector<Index> leaves;
  for (int place = 0; place < 8; ++place) {
    LatticePoint p = {static_cast<std::int64_t>(vertex.key.a), static_cast<std::int64_t>(vertex.key.b),
                      static_cast<std::int64_t>(vertex.key.c)};
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
      p[k] -= place >> k & 1;
      inside &= p[k] >= 0 && p[k] < Lattice::steps;
    }
    if (inside) leaves.push_back(decomposition_.octree.find(p));
  }
  return leaves;
}

void VolumeWarpBuilder::find_cubes() {
  for (Index v = 0; v < warp_.surface_vertices_; ++v) {
    if (!is_octree_point(surface_.vertices[v])) continue;
    const std::vector<Index> leaves = leaves_at(surface_.vertices[v]);
    warp_.movable_[v] = std::none_of(leaves.begin(), leaves.end(), [&](Index cube) {
      return decomposition_.volumes[cube].kind == VolumeKind::unresolved;
    });
    if (!warp_.movable_[v]) continue;
    for (Index cube : leaves)
      if (is_hole(cube) || decomposition_.volumes[cube].kind == VolumeKind::blank) cubes_.push_back(cube);
  }
  std::sort(cubes_.begin(), cubes_.end());
  cubes_.erase(std::unique(cubes_.begin(), cubes_.end()), cubes_.end());
}

void VolumeWarpBuilder::find_squares() {
  std::vector<char> marked(decomposition_.octree.size(), 0);
  for (Index cube : cubes_) marked[cube] = 1;
  for (Index i = 0; i < complex_.squares.size(); ++i) {
    const LeafSquare& s = complex_.squares[i];
    bool needed = false;
    for (Index cube : {s.below, s.above})
      if (cube != Octree::none && marked[cube]) {
        squares_of_[cube].push_back(static_cast<Index>(squares_.size()));
        needed = true;
      }
    if (needed) squares_.push_back({i, {}, {}});
  }
}

// The same triangulations as in the complex: a square at a hole cube is crossed by what the cube holds.
void VolumeWarpBuilder::triangulate_squares(const Progress& progress) {
  for_ranges(squares_.size(), 64, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LeafSquare& s = complex_.squares[squares_[i].square];
      const Index cube = is_hole(s.below) ? s.below : s.above;
      squares_[i].triangulation =
          triangulate_square(mesh_, decomposition_.octree, s,
                             is_hole(cube) ? decomposition_.volumes[cube].triangles : std::vector<Index>());
    }
  });
  for (SquareData& data : squares_)
    for (const VolumeVertex& v : data.triangulation.points) data.vertex.push_back(number_of(v));
}

void VolumeWarpBuilder::sort_points(const std::vector<VolumePoint>& points) {
  for (const VolumePoint& p : points) points_[p.node].push_back(p.position);
  for (const auto& [node, unused] : points_) {
    const std::size_t tetrahedron = static_cast<std::size_t>(node) - complex_.blank_nodes;
    if (node < 0 || tetrahedron >= complex_.free_tetrahedra.size()) continue;  // wraps round for blank nodes
    const auto& [cube, apex, corners] = complex_.free_tetrahedra[tetrahedron];
    Base base;
    for (int k = 0; k < 3; ++k) base[k] = number_of(complex_.vertices[corners[k]]);
    std::sort(base.begin(), base.end());
    pinned_tetrahedra_[{cube, base}] = node;
  }
}

// The triangles round a cube, counter-clockwise seen from outside.
std::vector<VolumeWarpBuilder::Base> VolumeWarpBuilder::surface_of(Index cube) const {
  std::vector<Base> surface;
  const auto found = squares_of_.find(cube);
  for (Index i : found->second) {
    const SquareData& data = squares_[i];
    const bool outward_is_up = complex_.squares[data.square].below == cube;
    for (const auto& [a, b, c] : data.triangulation.triangles)
      surface.push_back(
          {data.vertex[a], data.vertex[outward_is_up ? b : c], data.vertex[outward_is_up ? c : b]});
  }
  return surface;
}

void VolumeWarpBuilder::add_body(const std::vector<Base>& faces, const Vector3& centroid,
                                 const std::vector<Vector3>* points) {
  const Index number = static_cast<Index>(warp_.bodies_.size());
  VolumeWarp::Body body;
  body.first_face = static_cast<Index>(warp_.faces_.size());
  for (const Base& face : faces) warp_.faces_.push_back({face, number});
  body.past_face = static_cast<Index>(warp_.faces_.size());
  body.first_centre = static_cast<Index>(warp_.centres_.size());
  body.pinned = points != nullptr;
  if (points)
    warp_.centres_.insert(warp_.centres_.end(), points->begin(), points->end());
  else
    warp_.centres_.push_back(centroid);
  body.past_centre = static_cast<Index>(warp_.centres_.size());
  warp_.bodies_.push_back(body);
}

void VolumeWarpBuilder::add_blank(Index cube) {
  const auto pinned = points_.find(complex_.cube_cells[cube]);
  add_body(surface_of(cube), mesh_.lattice.position(decomposition_.octree.centre(cube)),
           pinned == points_.end() ? nullptr : &pinned->second);
}

Index VolumeWarpBuilder::apex_of(Index cube) {
  const Volume& volume = decomposition_.volumes[cube];
  if (volume.kind == VolumeKind::vertex)
    return number_of(
        {VertexKey::vertex(volume.apex), mesh_.mesh.vertices[volume.apex], volume.apex, VolumeVertex::none});
  // Half-way between the two points where the boundary edge goes through the cube's surface.
  std::map<Index, Vector3> ends;
  for (Index i : squares_of_[cube])
    for (std::size_t k = 0; k < squares_[i].vertex.size(); ++k) {
      const VolumeVertex& one = squares_[i].triangulation.points[k];
      if (one.rim_edge != VolumeVertex::none) ends.emplace(squares_[i].vertex[k], one.position);
    }
  Vector3 sum = Vector3::Zero();
  for (const auto& [unused, position] : ends) sum += position;
  return number_of(
      {VertexKey::apex(cube), sum / static_cast<double>(ends.size()), VolumeVertex::none, volume.apex});
}

void VolumeWarpBuilder::add_tetrahedra(Index cube) {
  const Index apex = apex_of(cube);
  for (const Base& base : surface_of(cube)) {
    if (std::none_of(base.begin(), base.end(), [&](Index v) { return may_move_here(v); })) continue;
    const auto [a, b, c] = base;
    Base sorted = base;
    std::sort(sorted.begin(), sorted.end());
    const auto pinned = pinned_tetrahedra_.find({cube, sorted});
    const auto at = [&](Index v) { return warp_.positions_[v]; };
    add_body({base, {b, a, apex}, {c, b, apex}, {a, c, apex}}, 0.25 * (at(a) + at(b) + at(c) + at(apex)),
             pinned == pinned_tetrahedra_.end() ? nullptr : &points_[pinned->second]);
  }
}

void VolumeWarpBuilder::index_faces() {
  warp_.start_ = warp_.positions_;
  warp_.first_centres_ = warp_.centres_;
  auto& first = warp_.first_at_;
  first.assign(warp_.surface_vertices_ + 1, 0);
  for (const VolumeWarp::Face& face : warp_.faces_)
    for (Index v : face.corners)
      if (may_move_here(v)) ++first[v + 1];
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  warp_.faces_at_.resize(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (Index f = 0; f < warp_.faces_.size(); ++f)
    for (Index v : warp_.faces_[f].corners)
      if (may_move_here(v)) warp_.faces_at_[next[v]++] = f;
}

VolumeWarp::VolumeWarp(const LatticeMesh& mesh, const Decomposition& decomposition,
                       const VolumeComplex& complex, const LabelledSurface& surface,
                       const std::vector<VolumePoint>& points, const Progress& progress) {
  VolumeWarpBuilder(*this, mesh, decomposition, complex, surface).build(points, progress);
}

bool VolumeWarp::is_behind(const Face& face, const Vector3& centre) const {
  return CGAL::orientation(point(positions_[face.corners[0]]), point(positions_[face.corners[1]]),
                           point(positions_[face.corners[2]]), point(centre)) == CGAL::NEGATIVE;
}

bool VolumeWarp::holds(const Face& face) const {
  const Body& body = bodies_[face.volume];
  for (Index i = body.first_centre; i < body.past_centre; ++i)
    if (!is_behind(face, centres_[i])) return false;
  return true;
}

bool VolumeWarp::holds(const Body& body, const Vector3& centre) const {
  for (Index f = body.first_face; f < body.past_face; ++f)
    if (!is_behind(faces_[f], centre)) return false;
  return true;
}

bool VolumeWarp::holds_at(Index vertex) const {
  for (std::size_t i = first_at_[vertex]; i < first_at_[vertex + 1]; ++i)
    if (!holds(faces_[faces_at_[i]])) return false;
  return true;
}

bool VolumeWarp::try_to_place(Index vertex, const Vector3& position) {
  const Vector3 before = positions_[vertex];
  positions_[vertex] = as_stored(position);
  if (holds_at(vertex)) return true;
  positions_[vertex] = before;
  return false;
}

// Of the solid that the faces bound: tetrahedra from one of its points, each with its signed volume.
Vector3 VolumeWarp::centroid(const Body& body) const {
  const Vector3& origin = positions_[faces_[body.first_face].corners[0]];
  Vector3 moment = Vector3::Zero();
  double volume = 0;
  for (Index f = body.first_face; f < body.past_face; ++f) {
    const auto& [i, j, k] = faces_[f].corners;
    const Vector3 a = positions_[i] - origin, b = positions_[j] - origin, c = positions_[k] - origin;
    const double six_fold = a.dot(b.cross(c));
    volume += six_fold;
    moment += 0.25 * six_fold * (a + b + c);
  }
  return origin + moment / volume;
}

void VolumeWarp::follow_centroids() {
  for (const Body& body : bodies_) {
    if (body.pinned) continue;
    bool changed = false;
    for (Index f = body.first_face; f < body.past_face && !changed; ++f)
      for (Index v : faces_[f].corners) changed |= moved(v);
    if (!changed) continue;
    const Vector3 centre = centroid(body);
    if (centre.allFinite() && holds(body, centre)) centres_[body.first_centre] = centre;
  }
}

std::vector<Index> VolumeWarp::put_back(const std::vector<Index>& vertices) {
  std::vector<Index> back;
  const auto put = [&](Index v) {
    if (v >= surface_vertices_ || !moved(v)) return;
    positions_[v] = start_[v];
    back.push_back(v);
  };
  for (Index v : vertices) put(v);
  for (std::size_t i = 0; i < back.size(); ++i)
    for (std::size_t at = first_at_[back[i]]; at < first_at_[back[i] + 1]; ++at) {
      const Face& face = faces_[faces_at_[at]];
      if (holds(face)) continue;
      const Body& body = bodies_[face.volume];
      std::copy(first_centres_.begin() + body.first_centre, first_centres_.begin() + body.past_centre,
                centres_.begin() + body.first_centre);
      for (Index f = body.first_face; f < body.past_face; ++f)
        for (Index v : faces_[f].corners) put(v);
    }
  std::sort(back.begin(), back.end());
  return back;
}

}  // namespace meshcomplete
