#include "filter_atomicvolumes/constraints.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <utility>

#include "common/core/counted.h"
#include "common/core/threads.h"
#include "filter_atomicvolumes/volume_locator.h"

namespace meshcomplete {
namespace {

// By how much the image of a mesh under a symmetry may lie beside it, relative to the diagonal of the
// bounding box: what the detection of symmetries tolerates, too.
constexpr double misfit_share = SymmetryDetectionOptions().tolerance;

// Points and nodes per task.
constexpr std::size_t grain = 256;

constexpr double no_price = std::numeric_limits<double>::infinity();

// Marks of a node.
constexpr std::uint8_t inside_point = 1, outside_point = 2;

std::string written(const Vector3& p) {
  std::ostringstream text;
  text << '(' << p[0] << ", " << p[1] << ", " << p[2] << ')';
  return text.str();
}

bool precedes(const Vector3& a, const Vector3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

double mean_boundary_edge(const TriangleMesh& mesh, const MeshTopology& topology) {
  double sum = 0;
  for (Index h : topology.boundary_half_edges) {
    const Triangle& t = mesh.triangles[h / 3];
    sum += (mesh.vertices[t[(h % 3 + 1) % 3]] - mesh.vertices[t[h % 3]]).norm();
  }
  return topology.boundary_half_edges.empty()
             ? 0
             : sum / static_cast<double>(topology.boundary_half_edges.size());
}

Eigen::AlignedBox3d bounds(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : mesh.triangles)
    for (Index v : t)
      if (mesh.vertices[v].allFinite()) box.extend(mesh.vertices[v]);
  return box;
}

// Ties the nodes of one complex.
class Tier {
 public:
  Tier(const LatticeMesh& mesh, const Decomposition& decomposition, const VolumeComplex& complex,
       const FaceCost& cost, const PreparedConstraints& constraints)
      : mesh_(mesh),
        decomposition_(decomposition),
        complex_(complex),
        cost_(cost),
        constraints_(constraints) {}

  TiedConstraints run(const Progress& progress);

 private:
  std::vector<VolumePlace> places_of(const std::vector<Vector3>& points, const Progress& progress) const;
  void mark(const std::vector<Vector3>& points, bool inside, const Progress& progress);
  bool is_large_hole_leaf(Index leaf) const {
    const VolumeKind kind = decomposition_.volumes[leaf].kind;
    const double side =
        static_cast<double>(Octree::side(decomposition_.octree[leaf].depth)) * mesh_.lattice.step();
    return (kind == VolumeKind::vertex || kind == VolumeKind::edge) && side > constraints_.finest_leaf();
  }
  void tie_marked();
  void carve(const Progress& progress);
  void tie_hints(const std::vector<Vector3>& points, bool inside, const Progress& progress);
  void tie_images(const Progress& progress);
  std::vector<Vector3> middles() const;

  const LatticeMesh& mesh_;
  const Decomposition& decomposition_;
  const VolumeComplex& complex_;
  const FaceCost cost_;
  const PreparedConstraints& constraints_;
  std::vector<std::uint8_t> marks_;                   // per node
  std::vector<std::pair<Cell, VolumePlace>> marked_;  // every node that a point lies in, with duplicates
  FaceMeasure faces_;
  TiedConstraints result_;
};

std::vector<VolumePlace> Tier::places_of(const std::vector<Vector3>& points, const Progress& progress) const {
  std::vector<VolumePlace> places(points.size());
  const VolumeLocator locator(mesh_, decomposition_, complex_, constraints_.sides());
  for_ranges(points.size(), grain, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) places[i] = locator.locate(points[i]);
  });
  return places;
}

void Tier::mark(const std::vector<Vector3>& points, bool inside, const Progress& progress) {
  if (points.empty()) return;
  std::size_t contradicted = 0, unknown = 0;
  Vector3 first = Vector3::Zero();
  const std::vector<VolumePlace> places = places_of(points, progress);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const VolumePlace& place = places[i];
    unknown += place.kind == VolumePlace::unknown;
    if (place.kind == VolumePlace::free) {
      marks_[static_cast<std::size_t>(place.node)] |= inside ? inside_point : outside_point;
      marked_.emplace_back(place.node, place);
    } else if (inside ? place.kind == VolumePlace::outside || place.kind == VolumePlace::beyond
                      : place.kind == VolumePlace::inside) {
      if (contradicted++ == 0) first = points[i];
      if (place.leaf != Octree::none && is_large_hole_leaf(place.leaf)) result_.split.push_back(place.leaf);
    }
  }
  const std::string given = inside ? " given as inside" : " given as outside";
  const std::string opposite = (inside ? " outside" : " inside") + std::string(" according to the mesh, ");
  const auto note = [&](std::size_t count, const std::string& one, const std::string& many) {
    if (count > 0)
      result_.notes.push_back(counted_of(count, points.size(), "point" + given, "points" + given,
                                         one + "; it has no effect.", many + "; they have no effect."));
  };
  note(contradicted, "is" + opposite + "at " + written(first),
       "are" + opposite + "the first at " + written(first));
  note(unknown, "lies on the mesh", "lie on the mesh");
}

void Tier::tie_marked() {
  std::size_t both = 0;
  for (std::size_t node = 0; node < marks_.size(); ++node) {
    if (marks_[node] == (inside_point | outside_point))
      ++both;
    else if (marks_[node])
      result_.ties.push_back({static_cast<Cell>(node), marks_[node] == inside_point, no_price});
  }
  for (const auto& [node, place] : marked_)
    if (marks_[static_cast<std::size_t>(node)] == (inside_point | outside_point))
      result_.split.push_back(place.leaf);
  std::sort(result_.split.begin(), result_.split.end());
  result_.split.erase(std::unique(result_.split.begin(), result_.split.end()), result_.split.end());
  if (both > 0)
    result_.notes.push_back(
        counted(both, "volume holds", "volumes hold") +
        " points given as inside and points given as outside; neither has an effect there.");
}

void Tier::carve(const Progress& progress) {
  if (constraints_.lines().empty()) return;
  const std::vector<char> seen =
      nodes_seen_through(mesh_.lattice, decomposition_, complex_, constraints_.lines(), progress);
  std::size_t kept = 0;
  for (std::size_t node = 0; node < seen.size(); ++node) {
    if (!seen[node]) continue;
    if (marks_[node] & inside_point)
      ++kept;
    else if (!marks_[node])
      result_.ties.push_back({static_cast<Cell>(node), false, no_price});
  }
  if (kept > 0)
    result_.notes.push_back(
        counted(kept, "volume that was seen through holds a point given as inside and was not carved.",
                "volumes that were seen through hold a point given as inside and were not carved."));
}

void Tier::tie_hints(const std::vector<Vector3>& points, bool inside, const Progress& progress) {
  if (points.empty()) return;
  double price = constraints_.given().hint_price * constraints_.diagonal() * constraints_.diagonal();
  if (cost_.weight() != CutWeight::area) price *= faces_.mean_cost / faces_.mean_area;
  for (const VolumePlace& place : places_of(points, progress))
    if (place.kind == VolumePlace::free) result_.ties.push_back({place.node, inside, price});
}

// Of every node.
std::vector<Vector3> Tier::middles() const {
  std::vector<Vector3> middles(complex_.nodes);
  const Octree& octree = decomposition_.octree;
  for (Index cube = 0; cube < octree.size(); ++cube)
    if (const Cell node = complex_.cube_cells[cube]; node >= 0)
      middles[static_cast<std::size_t>(node)] = mesh_.lattice.position(octree.centre(cube));
  std::size_t node = complex_.blank_nodes;
  for (const VolumeComplex::Tetrahedron& t : complex_.free_tetrahedra) {
    const std::array<Vector3, 4> corners = corners_of(complex_, t);
    middles[node++] = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
  }
  for (const VolumeComplex::ConvexCell& cell : complex_.convex_cells)
    if (cell.cell >= 0) middles[static_cast<std::size_t>(cell.cell)] = cell.centre;
  return middles;
}

void Tier::tie_images(const Progress& progress) {
  const SymmetryHints* hints = constraints_.symmetries();
  if (!hints) return;
  const std::vector<Vector3> middles = this->middles();
  for (std::size_t s = 0; s < hints->symmetries(); ++s) {
    std::vector<double> inside(complex_.nodes);
    for_ranges(complex_.nodes, grain, progress, [&](std::size_t begin, std::size_t end) {
      SymmetryHints::Starts starts;
      for (std::size_t node = begin; node < end; ++node)
        inside[node] = hints->suggest(s, middles[node], starts).inside;
    });
    for (std::size_t node = 0; node < inside.size(); ++node)
      if (inside[node] != 0)
        result_.ties.push_back(
            {static_cast<Cell>(node), inside[node] > 0,
             std::abs(inside[node]) * constraints_.given().symmetry_price * faces_.of_node[node]});
  }
}

TiedConstraints Tier::run(const Progress& progress) {
  const VolumeConstraints& given = constraints_.given();
  marks_.assign(complex_.nodes, 0);
  mark(given.inside, true, progress);
  mark(given.outside, false, progress);
  tie_marked();
  progress.update(0.2);
  carve(progress);
  progress.update(0.4);
  faces_ = measure_faces(mesh_, complex_, cost_, progress);
  tie_hints(given.hinted_inside, true, progress);
  tie_hints(given.hinted_outside, false, progress);
  progress.update(0.5);
  tie_images(progress);
  progress.update(1);
  return std::move(result_);
}

}  // namespace

PreparedConstraints::PreparedConstraints(const TriangleMesh& mesh, const MeshTopology& topology,
                                         const InputNeighbourhood& neighbourhood,
                                         const VolumeConstraints& constraints, const Progress& progress)
    : given_(constraints), spacing_(mean_boundary_edge(mesh, topology)) {
  const TriangleBlocks& blocks = neighbourhood.blocks();
  const Eigen::AlignedBox3d box = bounds(mesh);
  diagonal_ = box.isEmpty() ? 0 : box.diagonal().norm();
  lines_ = lines_of_sight(blocks, constraints.views, spacing_, progress);
  given_.views.clear();
  leave_out_useless_points();
  const bool points = !given_.inside.empty() || !given_.outside.empty() || !given_.hinted_inside.empty() ||
                      !given_.hinted_outside.empty();
  if (points || !given_.symmetries.empty()) sides_ = std::make_unique<SideFinder>(mesh, topology);
  if (!given_.symmetries.empty() && spacing_ > 0)
    symmetries_ = std::make_unique<SymmetryHints>(*sides_, given_.symmetries, box.center(), diagonal_,
                                                  misfit_share * diagonal_);
  progress.update(1);
}

bool PreparedConstraints::empty() const {
  return given_.inside.empty() && given_.outside.empty() && given_.hinted_inside.empty() &&
         given_.hinted_outside.empty() && lines_.lines.empty() && !symmetries_;
}

void PreparedConstraints::leave_out_useless_points() {
  std::size_t left_out = 0;
  for (auto* points : {&given_.inside, &given_.outside, &given_.hinted_inside, &given_.hinted_outside}) {
    const auto end =
        std::remove_if(points->begin(), points->end(), [](const Vector3& p) { return !p.allFinite(); });
    left_out += static_cast<std::size_t>(points->end() - end);
    points->erase(end, points->end());
  }
  if (left_out > 0)
    lines_.notes.push_back(counted(left_out, "point has coordinates that are not finite and was left out.",
                                   "points have coordinates that are not finite and were left out."));
  std::vector<Vector3> inside = given_.inside, outside = given_.outside, both;
  std::sort(inside.begin(), inside.end(), precedes);
  std::sort(outside.begin(), outside.end(), precedes);
  inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
  std::set_intersection(inside.begin(), inside.end(), outside.begin(), outside.end(),
                        std::back_inserter(both), precedes);
  if (both.empty()) return;
  for (auto* points : {&given_.inside, &given_.outside})
    points->erase(std::remove_if(points->begin(), points->end(),
                                 [&](const Vector3& p) {
                                   return std::binary_search(both.begin(), both.end(), p, precedes);
                                 }),
                  points->end());
  const std::string where = written(both.front());
  lines_.notes.push_back(
      counted(both.size(), "point is given as inside and as outside, at " + where + "; it has no effect.",
              "points are given as inside and as outside, the first at " + where + "; they have no effect."));
}

TiedConstraints tie_constraints(const LatticeMesh& mesh, const Decomposition& decomposition,
                                const VolumeComplex& complex, const FaceCost& cost,
                                const PreparedConstraints& constraints, const Progress& progress) {
  if (constraints.empty()) return {};
  return Tier(mesh, decomposition, complex, cost, constraints).run(progress);
}

}  // namespace meshcomplete
