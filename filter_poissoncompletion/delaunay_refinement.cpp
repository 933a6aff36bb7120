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
#include <limits>
#include <queue>
#include <string>
#include <tuple>

#include "common/core/error.h"
#include "common/core/patch.h"
#include "common/core/threads.h"
#include "filter_poissoncompletion/coinciding_points.h"
#include "filter_poissoncompletion/non_manifold_places.h"

namespace meshcomplete {
namespace {

constexpr const char* stage = "refining the surface";

// How far beyond the points the surface is looked for, in half sizes of their box; and where the corners of
// the triangulation are, which have to be further out for their cells' centres to be.
constexpr double box_scale = 3;
constexpr double far_scale = 9;

// How exactly the surface is met, in target edge lengths: far below what a facet's shape shows.
constexpr double crossing_tolerance = 1e-3;

// Over which part of a target edge length the function's slope is measured: it tells which way the surface
// faces where facets are still too coarse to.
constexpr double slope_step = 0.05;

// In target edge lengths, how near the surface may come to the mesh before the mesh's vertices there are
// wanted: balls of good facets reach no further.
constexpr double mesh_in_sight = 1.5;

// Pieces into which a protected edge is divided at most, and the least length of a piece in steps between
// stored numbers: what is not an edge then is no matter of a single vertex nearby any more.
constexpr std::size_t most_pieces = 64;
constexpr double least_piece = 64;

// Rounds in which edges that insertions took away are restored, and in which places that are no manifold are
// refined. Each halves the facets there, so that it takes few.
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

// Not finite where the corners lie in a plane.
Vector3 circumcentre(const CellHandle& cell) {
  const Vector3 p = vector_of(cell->vertex(0)->point());
  const Vector3 a = vector_of(cell->vertex(1)->point()) - p, b = vector_of(cell->vertex(2)->point()) - p,
                c = vector_of(cell->vertex(3)->point()) - p;
  const Vector3 ab = a.cross(b);
  return p + (c.squaredNorm() * ab + a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a)) /
                 (2 * c.dot(ab));
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
      : function_(function),
        initial_(initial),
        options_(options),
        progress_(progress),
        initial_count_(static_cast<Index>(initial.size())) {}

  DelaunayComplex run();

 private:
  void insert_initial();
  VertexInfo info(Index number, const Vector3& position, bool reached) const;
  bool in_ball(const CellHandle& cell, const Vector3& position) const;
  CellHandle conflicting(const Vector3& position, const CellHandle& near, const CellHandle& other) const;
  VertexHandle insert(const Vector3& position, const CellHandle& near, const CellHandle& other, bool reached,
                      Index on_edge, Index mesh_vertex);
  bool insert_mesh_vertex(const Cushion::Nearest& nearest, const Vector3& at, const CellHandle& near,
                          const CellHandle& other);
  bool protect_edges();
  bool protect(std::size_t edge);
  Vector3 division(const std::vector<VertexHandle>& chain, std::size_t piece) const;
  void evaluate(const CellHandle& cell);
  void evaluate_all();
  void stamp(const CellHandle& cell);
  void queue_facets_of(const CellHandle& cell);
  std::optional<double> size_of(const CellHandle& cell, int corner) const;
  void consider(const CellHandle& cell, int corner);
  void consider_crossed_twice(const CellHandle& cell, int corner);
  Vector3 outwards(const CellHandle& cell, int corner) const;
  Vector3 slope(const Vector3& at, double step) const;
  std::optional<Vector3> surface_centre(const CellHandle& cell, int corner) const;
  void refine_queue();
  bool refine(const QueuedFacet& facet);
  bool refine_at(const QueuedFacet& facet, const Vector3& at);
  bool refine_non_manifold_places();
  DelaunayComplex complex() const;
  bool inside(const CellHandle& cell) const { return cell->info().value < 0; }

  const ImplicitFunction& function_;
  const std::vector<Vector3>& initial_;
  const RefinementOptions& options_;
  const Progress& progress_;
  const Index initial_count_;
  Triangulation triangulation_;
  Eigen::AlignedBox3d box_;
  std::vector<VertexHandle> handle_of_;            // of initial points
  std::vector<std::vector<VertexHandle>> chains_;  // of protected edges
  std::vector<Index> lost_edges_;
  std::vector<Vector3> added_;
  std::vector<Index> added_on_edge_, added_mesh_vertex_;
  std::vector<char> inserted_;     // vertices of the protected mesh
  std::vector<char> alive_ = {0};  // by stamp
  std::priority_queue<QueuedFacet> queue_;
  // Scratch.
  std::vector<CellHandle> cells_;
  std::vector<Facet> facets_;
};

VertexInfo Refiner::info(Index number, const Vector3& position, bool reached) const {
  return {number, reached, options_.criteria.edge_length(position)};
}

void Refiner::insert_initial() {
  const std::vector<Index> first = first_at_position(initial_);
  std::vector<char> reached(initial_.size(), 0);
  for (std::size_t i = 0; i < first.size(); ++i)
    reached[first[i]] |= static_cast<char>(options_.seeds.empty() || options_.seeds[i] != 0);
  std::vector<std::pair<Point, VertexInfo>> points;
  Eigen::AlignedBox3d box;
  for (Index i = 0; i < first.size(); ++i) {
    if (first[i] != i) continue;
    points.emplace_back(point_of(initial_[i]), info(i, initial_[i], reached[i] != 0));
    box.extend(initial_[i]);
  }
  const Vector3 middle = box.center(), half = Vector3::Constant(0.5 * box.sizes().maxCoeff());
  box_ = Eigen::AlignedBox3d(middle - box_scale * half, middle + box_scale * half);
  for (Index k = 0; k < DelaunayComplex::far_corners; ++k) {
    const Vector3 way(k & 1 ? half[0] : -half[0], k & 2 ? half[1] : -half[1], k & 4 ? half[2] : -half[2]);
    added_.push_back(middle + far_scale * way);
    added_on_edge_.push_back(DelaunayComplex::none);
    added_mesh_vertex_.push_back(DelaunayComplex::none);
    points.emplace_back(point_of(added_.back()), info(initial_count_ + k, added_.back(), false));
  }
  triangulation_.insert(points.begin(), points.end());
  handle_of_.resize(initial_.size());
  for (auto v = triangulation_.finite_vertices_begin(); v != triangulation_.finite_vertices_end(); ++v)
    if (v->info().number < initial_count_) handle_of_[v->info().number] = v;
  for (std::size_t i = 0; i < handle_of_.size(); ++i) handle_of_[i] = handle_of_[first[i]];
  if (options_.around) {
    inserted_.assign(options_.around->mesh.vertices.size(), 0);
    for (Index v : options_.around->initial) inserted_[v] = 1;
  }
  for (const auto& [a, b] : options_.protected_edges) chains_.push_back({handle_of_[a], handle_of_[b]});
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
  if (added_.size() >= options_.max_points + DelaunayComplex::far_corners)
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
  v->info() = info(initial_count_ + static_cast<Index>(added_.size()), position, reached);
  added_.push_back(position);
  added_on_edge_.push_back(on_edge);
  added_mesh_vertex_.push_back(mesh_vertex);
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

// Where the piece of a protected edge after this vertex of its chain is divided. Pieces that begin at the
// same end of neighbouring edges get powers of two as lengths: then they do not divide each other for ever.
Vector3 Refiner::division(const std::vector<VertexHandle>& chain, std::size_t piece) const {
  const bool from_back = piece + 2 == chain.size();
  const Vector3 a = vector_of(chain[piece]->point()), b = vector_of(chain[piece + 1]->point());
  if (chain.size() == 2 || (piece > 0 && !from_back)) return 0.5 * (a + b);
  const double length = (b - a).norm(), part = std::exp2(std::round(std::log2(0.5 * length))) / length;
  return from_back ? Vector3(b + part * (a - b)) : Vector3(a + part * (b - a));
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
    const Vector3 at = division(chain, piece);
    const Vector3 p = vector_of(a->point());
    const VertexHandle v = chain.size() > most_pieces || (at - p).norm() < least_piece * stored_resolution(p)
                               ? VertexHandle()
                               : insert(at, a->cell(), CellHandle(), a->info().reached && b->info().reached,
                                        static_cast<Index>(edge), DelaunayComplex::none);
    if (v == VertexHandle()) {
      lost_edges_.push_back(static_cast<Index>(edge));
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
  lost_edges_.clear();
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
  info.centre = circumcentre(cell);
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
  const double there = function_.value(axis_foot(facet));
  if ((there < 0) != inside(cell)) queue_.push({bad, cell->info().stamp, other->info().stamp, cell, corner});
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
  double share = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (way[k] == 0) continue;
    const double wall = way[k] > 0 ? box_.max()[k] : box_.min()[k];
    share = std::min(share, (wall - in.centre[k]) / way[k]);
  }
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
  if (options_.around) {
    const Cushion& cushion = options_.around->cushion;
    const std::optional<Cushion::Nearest> nearest = cushion.nearest(stored);
    if (nearest) {
      const double size = options_.criteria.edge_length(stored);
      const bool protect = cushion.reaches(*nearest, slope(stored, slope_step * size));
      const bool near = protect || nearest->distance < mesh_in_sight * size;
      if (near && insert_mesh_vertex(*nearest, stored, facet.cell, other)) return true;
      if (protect) return false;
    }
  }
  if (!in_ball(facet.cell, stored) && !in_ball(other, stored)) return false;
  return insert(stored, facet.cell, other, true, DelaunayComplex::none, DelaunayComplex::none) !=
         VertexHandle();
}

// What the refinement has come near to has to be there in its own resolution, or the surface is taken for
// one with it. Whether there was anything to insert.
bool Refiner::insert_mesh_vertex(const Cushion::Nearest& nearest, const Vector3& at, const CellHandle& near,
                                 const CellHandle& other) {
  const TriangleMesh& mesh = options_.around->mesh;
  Index best = DelaunayComplex::none;
  double least = std::numeric_limits<double>::infinity();
  for (Index v : mesh.triangles[nearest.triangle]) {
    const double squared = (mesh.vertices[v] - at).squaredNorm();
    if (inserted_[v] || squared >= least) continue;
    best = v;
    least = squared;
  }
  if (best == DelaunayComplex::none) return false;
  inserted_[best] = 1;
  return insert(mesh.vertices[best], near, other, false, DelaunayComplex::none, best) != VertexHandle();
}

// The direction in which the function grows.
Vector3 Refiner::slope(const Vector3& at, double step) const {
  Vector3 result;
  for (int k = 0; k < 3; ++k) {
    const Vector3 way = step * Vector3::Unit(k);
    result[k] = function_.value(at + way) - function_.value(at - way);
  }
  return result;
}

void Refiner::refine_queue() {
  for (std::size_t count = 0; !queue_.empty(); ++count) {
    const QueuedFacet facet = queue_.top();
    queue_.pop();
    if (count % insertions_per_check == 0) progress_.check();
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
  const std::size_t before = added_.size();
  for (const QueuedFacet& facet : worst)
    if (alive_[facet.stamp] && alive_[facet.other_stamp]) refine(facet);
  return added_.size() > before;
}

DelaunayComplex Refiner::complex() const {
  DelaunayComplex result;
  result.initial_points = initial_count_;
  result.vertices = initial_;
  result.vertices.insert(result.vertices.end(), added_.begin(), added_.end());
  result.on_edge.assign(initial_.size(), DelaunayComplex::none);
  result.on_edge.insert(result.on_edge.end(), added_on_edge_.begin(), added_on_edge_.end());
  if (options_.around) result.mesh_vertex = options_.around->initial;
  result.mesh_vertex.resize(initial_.size(), DelaunayComplex::none);
  result.mesh_vertex.insert(result.mesh_vertex.end(), added_mesh_vertex_.begin(), added_mesh_vertex_.end());
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
    result.cells.push_back(corners);
    result.neighbours.push_back(neighbours);
    result.inside.push_back(inside(cell));
    result.values.push_back(static_cast<float>(cell->info().value));
  }
  result.lost_edges = lost_edges_;
  return result;
}

DelaunayComplex Refiner::run() {
  if (initial_.empty())
    throw CompletionError(stage, "There is no point on the surface to begin the refinement with.");
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
  return complex();
}

}  // namespace

DelaunayComplex refine_delaunay(const ImplicitFunction& function, const std::vector<Vector3>& initial,
                                const RefinementOptions& options, const Progress& progress) {
  return Refiner(function, initial, options, progress).run();
}

}  // namespace meshcomplete
