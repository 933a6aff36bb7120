#include "filter_poissoncompletion/delaunay_refinement.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <queue>
#include <string>
#include <tuple>
#include <utility>

#include "common/core/error.h"
#include "common/core/patch.h"
#include "common/core/threads.h"
#include "filter_poissoncompletion/coinciding_points.h"
#include "filter_poissoncompletion/mesh_guard.h"
#include "filter_poissoncompletion/non_manifold_places.h"
#include "filter_poissoncompletion/refinement_geometry.h"

namespace meshcomplete {
namespace {

constexpr const char* stage = "refining the surface";

// How far beyond the points the surface is looked for, in half sizes of their box; and where the corners of
// the triangulation are, which have to be further out for their cells' centres to be.
constexpr double box_scale = 3;
constexpr double far_scale = 9;

// How exactly the surface is met, in target edge lengths: far below what a facet's shape shows.
constexpr double crossing_tolerance = 1e-3;

// Pieces into which a protected edge is divided at most, and the least length of a piece in steps between
// stored numbers: what is not an edge then is no matter of a single vertex nearby any more.
constexpr std::size_t most_pieces = 64;
constexpr double least_piece = 64;

// Rounds in which lost edges are restored, or places that are no manifold refined: each halves facets.
constexpr int most_rounds = 30;

// Insertions between two looks whether the user wants to stop: about 5 ms.
constexpr std::size_t insertions_per_check = 128;

// Cells for whose centres the function is asked in one task: about a millisecond.
constexpr std::size_t cells_per_task = 4096;

struct VertexInfo {
  Index number = 0;
  bool reached = false;
  double size = 0;  // target edge length here
};

// Every cell that comes to be has a stamp of its own, although its memory may be that of an earlier one.
struct CellInfo {
  Index stamp = 0;  // 0: not looked at yet
  Vector3 centre;
  double value = 1;
  bool in_box = false;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<VertexInfo, Kernel>;
using CellBase = CGAL::Triangulation_cell_base_with_info_3<CellInfo, Kernel,
                                                           CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Triangulation =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
using VertexHandle = Triangulation::Vertex_handle;
using CellHandle = Triangulation::Cell_handle;
using Facet = Triangulation::Facet;
using Point = Kernel::Point_3;

Vector3 vector_of(const Point& p) { return {p.x(), p.y(), p.z()}; }
Point point_of(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

Vector3 centre_of(const CellHandle& cell) {
  return circumcentre({vector_of(cell->vertex(0)->point()), vector_of(cell->vertex(1)->point()),
                       vector_of(cell->vertex(2)->point()), vector_of(cell->vertex(3)->point())});
}

// The facet across from a corner of a cell; it looks counter-clockwise from there.
std::array<Vector3, 3> facet_towards(const CellHandle& cell, int corner) {
  std::array<Vector3, 3> p;
  for (int k = 0; k < 3; ++k)
    p[static_cast<std::size_t>(k)] =
        vector_of(cell->vertex(Triangulation::vertex_triple_index(corner, k))->point());
  return p;
}

struct QueuedFacet {
  double badness;
  Index stamp, other_stamp;
  CellHandle cell;
  int corner;
  bool operator<(const QueuedFacet& o) const {  // of equally bad ones the older first
    return std::tie(badness, o.stamp, o.other_stamp) < std::tie(o.badness, stamp, other_stamp);
  }
};

class Refiner {
 public:
  Refiner(const ImplicitFunction& function, const std::vector<Vector3>& initial,
          const RefinementOptions& options, const Progress& progress)
      : function_(function), options_(options), progress_(progress) {
    complex_.vertices = initial;
    complex_.initial_points = static_cast<Index>(initial.size());
    complex_.on_edge.assign(initial.size(), DelaunayComplex::none);
    if (options.around) {
      complex_.mesh_vertex = options.around->initial;
      guard_.emplace(*options.around, function);
    }
    complex_.mesh_vertex.resize(initial.size(), DelaunayComplex::none);
  }

  DelaunayComplex run();

 private:
  void insert_initial();
  VertexInfo add(const Vector3& position, bool reached, Index on_edge, Index mesh_vertex);
  bool in_ball(const CellHandle& cell, const Vector3& position) const;
  CellHandle conflicting(const Vector3& position, const CellHandle& near, const CellHandle& other) const;
  VertexHandle insert(const Vector3& position, const CellHandle& near, const CellHandle& other, bool reached,
                      Index on_edge, Index mesh_vertex);
  bool protect_edges();
  bool protect(std::size_t edge);
  void evaluate(const CellHandle& cell);
  void evaluate_all();
  void stamp(const CellHandle& cell);
  void queue_facets_of(const CellHandle& cell);
  std::optional<double> size_of(const CellHandle& cell, int corner) const;
  void consider(const CellHandle& cell, int corner);
  void consider_crossed_twice(const CellHandle& cell, int corner);
  Vector3 outwards(const CellHandle& cell, int corner) const;
  std::optional<Vector3> surface_centre(const CellHandle& cell, int corner) const;
  void refine_queue();
  bool refine(const QueuedFacet& facet);
  bool refine_at(const QueuedFacet& facet, const Vector3& at);
  bool refine_non_manifold_places();
  void collect_cells();
  bool inside(const CellHandle& cell) const { return cell->info().value < 0; }
  std::size_t inserted() const { return complex_.vertices.size() - complex_.first_inserted(); }

  const ImplicitFunction& function_;
  const RefinementOptions& options_;
  const Progress& progress_;
  Triangulation triangulation_;
  Eigen::AlignedBox3d box_;
  std::vector<std::vector<VertexHandle>> chains_;  // of protected edges
  DelaunayComplex complex_;                        // without its cells, until there is nothing to refine
  std::optional<MeshGuard> guard_;
  std::vector<char> alive_ = {0};  // by stamp
  std::priority_queue<QueuedFacet> queue_;
  std::vector<CellHandle> cells_;  // scratch, as the next
  std::vector<Facet> facets_;
};

// Numbers a vertex that is none of the initial points.
VertexInfo Refiner::add(const Vector3& position, bool reached, Index on_edge, Index mesh_vertex) {
  const auto number = static_cast<Index>(complex_.vertices.size());
  complex_.vertices.push_back(position);
  complex_.on_edge.push_back(on_edge);
  complex_.mesh_vertex.push_back(mesh_vertex);
  return {number, reached, options_.criteria.edge_length(position)};
}

void Refiner::insert_initial() {
  const std::vector<Index> first = first_at_position(complex_.vertices);
  std::vector<char> reached(first.size(), 0);
  for (std::size_t i = 0; i < first.size(); ++i)
    reached[first[i]] |= static_cast<char>(options_.seeds.empty() || options_.seeds[i] != 0);
  std::vector<std::pair<Point, VertexInfo>> points;
  Eigen::AlignedBox3d box;
  for (Index i = 0; i < first.size(); ++i) {
    if (first[i] != i) continue;
    const Vector3& at = complex_.vertices[i];
    points.emplace_back(point_of(at), VertexInfo{i, reached[i] != 0, options_.criteria.edge_length(at)});
    box.extend(at);
  }
  if (!(box.sizes().maxCoeff() > 0)) throw CompletionError(stage, "No two points of the surface were found.");
  const Vector3 middle = box.center(), half = Vector3::Constant(0.5 * box.sizes().maxCoeff());
  box_ = Eigen::AlignedBox3d(middle - box_scale * half, middle + box_scale * half);
  for (Index k = 0; k < DelaunayComplex::far_corners; ++k) {
    const Vector3 way(k & 1 ? half[0] : -half[0], k & 2 ? half[1] : -half[1], k & 4 ? half[2] : -half[2]);
    const Vector3 corner = middle + far_scale * way;
    points.emplace_back(point_of(corner), add(corner, false, DelaunayComplex::none, DelaunayComplex::none));
  }
  triangulation_.insert(points.begin(), points.end());
  std::vector<VertexHandle> handle_of(first.size());
  for (auto v = triangulation_.finite_vertices_begin(); v != triangulation_.finite_vertices_end(); ++v)
    if (v->info().number < first.size()) handle_of[v->info().number] = v;
  for (const auto& [a, b] : options_.protected_edges)
    chains_.push_back({handle_of[first[a]], handle_of[first[b]]});
}

bool Refiner::in_ball(const CellHandle& cell, const Vector3& position) const {
  return !triangulation_.is_infinite(cell) &&
         triangulation_.side_of_sphere(cell, point_of(position)) == CGAL::ON_BOUNDED_SIDE;
}

// A cell with the position in its ball; null when there is none because a vertex is there.
CellHandle Refiner::conflicting(const Vector3& position, const CellHandle& near,
                                const CellHandle& other) const {
  const Point p = point_of(position);
  for (const CellHandle& cell : {near, other})
    if (cell != CellHandle() && in_ball(cell, position)) return cell;
  Triangulation::Locate_type type;
  int i, j;
  const CellHandle found = triangulation_.locate(p, type, i, j, near);
  return type == Triangulation::VERTEX ? CellHandle() : found;
}

VertexHandle Refiner::insert(const Vector3& position, const CellHandle& near, const CellHandle& other,
                             bool reached, Index on_edge, Index mesh_vertex) {
  if (inserted() >= options_.max_points)
    throw CompletionError(stage, "The surface would need more than " + std::to_string(options_.max_points) +
                                     " vertices. Choose a greater edge length.");
  const CellHandle start = conflicting(position, near, other);
  if (start == CellHandle()) return VertexHandle();
  const Point p = point_of(position);
  cells_.clear();
  facets_.clear();
  triangulation_.find_conflicts(p, start, std::back_inserter(facets_), std::back_inserter(cells_));
  for (const CellHandle& cell : cells_) alive_[cell->info().stamp] = 0;
  const VertexHandle v = triangulation_.insert_in_hole(p, cells_.begin(), cells_.end(), facets_.front().first,
                                                       facets_.front().second);
  v->info() = add(position, reached, on_edge, mesh_vertex);
  if (alive_.size() == 1) return v;  // nothing has been evaluated yet
  cells_.clear();
  triangulation_.incident_cells(v, std::back_inserter(cells_));
  for (const CellHandle& cell : cells_) {
    stamp(cell);
    evaluate(cell);
  }
  for (const CellHandle& cell : cells_) queue_facets_of(cell);
  return v;
}

// Whether anything had to be done.
bool Refiner::protect(std::size_t edge) {
  std::vector<VertexHandle>& chain = chains_[edge];
  bool any = false;
  for (std::size_t piece = 0; piece + 1 < chain.size();) {
    const VertexHandle &a = chain[piece], &b = chain[piece + 1];
    CellHandle cell;
    int i, j;
    if (a == b || triangulation_.is_edge(a, b, cell, i, j)) {
      ++piece;
      continue;
    }
    const Vector3 p = vector_of(a->point());
    const Vector3 at = edge_division(p, vector_of(b->point()), piece == 0, piece + 2 == chain.size());
    const VertexHandle v = chain.size() > most_pieces || (at - p).norm() < least_piece * stored_resolution(p)
                               ? VertexHandle()
                               : insert(at, a->cell(), CellHandle(), a->info().reached && b->info().reached,
                                        static_cast<Index>(edge), DelaunayComplex::none);
    if (v == VertexHandle()) {
      complex_.lost_edges.push_back(static_cast<Index>(edge));
      return any;
    }
    chain.insert(chain.begin() + static_cast<std::ptrdiff_t>(piece + 1), v);
    any = true;
  }
  return any;
}

// Whether any edge had to be restored.
bool Refiner::protect_edges() {
  bool any = false;
  complex_.lost_edges.clear();
  for (std::size_t edge = 0; edge < chains_.size(); ++edge) {
    any |= protect(edge);
    if (edge % insertions_per_check == 0) progress_.check();
  }
  return any;
}

void Refiner::stamp(const CellHandle& cell) {
  cell->info().stamp = static_cast<Index>(alive_.size());
  alive_.push_back(1);
}

void Refiner::evaluate(const CellHandle& cell) {
  CellInfo& info = cell->info();
  info.in_box = false;
  info.value = 1;
  if (triangulation_.is_infinite(cell)) return;
  info.centre = centre_of(cell);
  info.in_box = info.centre.allFinite() && box_.contains(info.centre);
  if (info.in_box) info.value = function_.value(info.centre);
}

void Refiner::evaluate_all() {
  std::vector<CellHandle> cells;
  cells.reserve(triangulation_.number_of_cells());
  for (auto c = triangulation_.all_cells_begin(); c != triangulation_.all_cells_end(); ++c) {
    cells.push_back(c);
    stamp(c);
  }
  for_ranges(cells.size(), cells_per_task, progress_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) evaluate(cells[i]);
  });
  for (const CellHandle& cell : cells) queue_facets_of(cell);
}

// The facets between the cell and older ones: each facet is seen once, by the younger of its cells.
void Refiner::queue_facets_of(const CellHandle& cell) {
  for (int corner = 0; corner < 4; ++corner) {
    const CellHandle other = cell->neighbor(corner);
    if (other->info().stamp > cell->info().stamp) continue;
    if (inside(cell) != inside(other))
      consider(cell, corner);
    else if (options_.around)
      consider_crossed_twice(cell, corner);
  }
}

// The target edge length at a facet; nothing if it is not to be refined.
std::optional<double> Refiner::size_of(const CellHandle& cell, int corner) const {
  bool reached = false;
  double size = 0;
  for (int k = 0; k < 4; ++k) {
    if (k == corner) continue;
    if (triangulation_.is_infinite(cell->vertex(k))) return std::nullopt;
    reached |= cell->vertex(k)->info().reached;
    size += cell->vertex(k)->info().size / 3;
  }
  return reached ? std::optional(size) : std::nullopt;
}

void Refiner::consider(const CellHandle& cell, int corner) {
  const std::optional<double> size = size_of(cell, corner);
  if (!size) return;
  const double bad = badness(facet_towards(cell, corner), *size, options_.criteria,
                             [&] { return surface_centre(cell, corner); });
  if (bad > 0) queue_.push({bad, cell->info().stamp, cell->neighbor(corner)->info().stamp, cell, corner});
}

// A large facet whose axis meets the surface twice: both sides of a wall, one of which has no points yet.
void Refiner::consider_crossed_twice(const CellHandle& cell, int corner) {
  const std::optional<double> size = size_of(cell, corner);
  const CellHandle other = cell->neighbor(corner);
  if (!size || !cell->info().in_box || !other->info().in_box) return;
  const std::array<Vector3, 3> facet = facet_towards(cell, corner);
  const double bad = length_ratio(facet, *size, options_.criteria);
  if (bad <= 1) return;
  const Vector3 foot = axis_foot(facet);
  if (foot.allFinite() && (function_.value(foot) < 0) != inside(cell))
    queue_.push({bad, cell->info().stamp, other->info().stamp, cell, corner});
}

// Where the surface crosses the line between the centres of the facet's cells.
std::optional<Vector3> Refiner::surface_centre(const CellHandle& cell, int corner) const {
  const CellHandle other = cell->neighbor(corner);
  const bool turned = !inside(cell);
  const CellInfo &in = turned ? other->info() : cell->info(), &out = turned ? cell->info() : other->info();
  const double tolerance =
      crossing_tolerance * cell->vertex((corner + 1) % 4)->info().size;  // a corner of the facet
  if (out.in_box) return crossing(function_, in.centre, out.centre, in.value, out.value, tolerance);
  // The outer centre is far away, or there is none: go as far as the box does.
  Vector3 way = out.centre - in.centre;
  if (triangulation_.is_infinite(turned ? cell : other) || !way.allFinite()) way = outwards(cell, corner);
  const double share = share_to_wall(box_, in.centre, way);
  if (!std::isfinite(share)) return std::nullopt;
  return crossing(function_, in.centre, in.centre + share * way, tolerance);
}

// The normal of a facet that points out of the surface.
Vector3 Refiner::outwards(const CellHandle& cell, int corner) const {
  const std::array<Vector3, 3> p = facet_towards(cell, corner);
  const Vector3 normal = (p[1] - p[0]).cross(p[2] - p[0]);
  return inside(cell) ? Vector3(-normal) : normal;
}

// Whether that made any difference.
bool Refiner::refine(const QueuedFacet& facet) {
  const CellHandle other = facet.cell->neighbor(facet.corner);
  if (inside(facet.cell) != inside(other)) {
    const std::optional<Vector3> at = surface_centre(facet.cell, facet.corner);
    return at && refine_at(facet, *at);
  }
  const Vector3 foot = axis_foot(facet_towards(facet.cell, facet.corner));
  const double tolerance = crossing_tolerance * facet.cell->vertex((facet.corner + 1) % 4)->info().size;
  const Vector3 centres[] = {facet.cell->info().centre, other->info().centre};
  for (const Vector3& centre : centres) {
    const std::optional<Vector3> at = crossing(function_, centre, foot, tolerance);
    if (at && refine_at(facet, *at)) return true;
  }
  return false;
}

// Not where a centre is so inexact that the facet would stay: there would be no end.
bool Refiner::refine_at(const QueuedFacet& facet, const Vector3& at) {
  const CellHandle other = facet.cell->neighbor(facet.corner);
  const Vector3 stored = as_stored(at);
  if (guard_) {
    const MeshGuard::Answer answer = guard_->ask(stored, options_.criteria.edge_length(stored));
    if (answer.vertex && insert(options_.around->mesh.vertices[*answer.vertex], facet.cell, other, false,
                                DelaunayComplex::none, *answer.vertex) != VertexHandle())
      return true;
    if (answer.in_cushion) return false;
  }
  if (!in_ball(facet.cell, stored) && !in_ball(other, stored)) return false;
  return insert(stored, facet.cell, other, true, DelaunayComplex::none, DelaunayComplex::none) !=
         VertexHandle();
}

void Refiner::refine_queue() {
  for (std::size_t count = 0; !queue_.empty(); ++count) {
    const QueuedFacet facet = queue_.top();
    queue_.pop();
    if (count % insertions_per_check == 0) progress_.check();
    if (facet.badness < bad_shape && inserted() >= options_.points_for_distance) continue;
    if (alive_[facet.stamp] && alive_[facet.other_stamp]) refine(facet);
  }
}

// The largest facet at each place where the surface is no manifold. Whether there was any.
bool Refiner::refine_non_manifold_places() {
  std::vector<Facet> facets;
  std::vector<Triangle> triangles;
  for (auto c = triangulation_.finite_cells_begin(); c != triangulation_.finite_cells_end(); ++c) {
    if (!inside(c)) continue;
    for (int corner = 0; corner < 4; ++corner) {
      if (inside(c->neighbor(corner))) continue;
      Triangle t;
      for (int k = 0; k < 3; ++k)
        t[k] = c->vertex(Triangulation::vertex_triple_index(corner, k))->info().number;
      facets.emplace_back(c, corner);
      triangles.push_back(t);
    }
  }
  const std::vector<std::vector<Index>> places = non_manifold_places(triangles);
  const auto size = [&](Index facet) {
    const auto& [cell, corner] = facets[facet];
    return triangulation_.triangle(cell, corner).squared_area();
  };
  std::vector<QueuedFacet> worst;
  for (const std::vector<Index>& place : places) {
    const Index largest = *std::max_element(place.begin(), place.end(), [&](Index a, Index b) {
      return std::make_pair(size(a), b) < std::make_pair(size(b), a);
    });
    const auto& [cell, corner] = facets[largest];
    worst.push_back({0, cell->info().stamp, cell->neighbor(corner)->info().stamp, cell, corner});
  }
  const std::size_t before = complex_.vertices.size();
  for (const QueuedFacet& facet : worst)
    if (alive_[facet.stamp] && alive_[facet.other_stamp]) refine(facet);
  return complex_.vertices.size() > before;
}

void Refiner::collect_cells() {
  std::vector<Index> number(alive_.size(), DelaunayComplex::none);  // by stamp
  std::vector<CellHandle> cells;
  for (auto c = triangulation_.finite_cells_begin(); c != triangulation_.finite_cells_end(); ++c) {
    number[c->info().stamp] = static_cast<Index>(cells.size());
    cells.push_back(c);
  }
  for (const CellHandle& cell : cells) {
    DelaunayComplex::Cell corners, neighbours;
    for (int k = 0; k < 4; ++k) {
      corners[k] = cell->vertex(k)->info().number;
      neighbours[k] = number[cell->neighbor(k)->info().stamp];
    }
    complex_.cells.push_back(corners);
    complex_.neighbours.push_back(neighbours);
    complex_.inside.push_back(inside(cell));
    complex_.values.push_back(static_cast<float>(cell->info().value));
  }
}

DelaunayComplex Refiner::run() {
  insert_initial();
  protect_edges();
  progress_.check();
  evaluate_all();
  for (int round = 0; round < most_rounds; ++round) {
    refine_queue();
    const bool restored = protect_edges();
    if (!(options_.manifold && refine_non_manifold_places()) && !restored) break;
  }
  refine_queue();
  progress_.update(1);
  collect_cells();
  return std::move(complex_);
}

}  // namespace

DelaunayComplex refine_delaunay(const ImplicitFunction& function, const std::vector<Vector3>& initial,
                                const RefinementOptions& options, const Progress& progress) {
  return Refiner(function, initial, options, progress).run();
}

}  // namespace meshcomplete
