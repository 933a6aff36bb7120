#include <algorithm>
#include <cstdint>

#include "common/core/threads.h"
#include "filter_atomicvolumes/constraints.h"
#include "filter_atomicvolumes/volume_locator.h"

namespace meshcomplete {
namespace {

// Leaves that an image crosses are split until they are this large, in mean boundary edges: the patch is
// remeshed to that length anyway.
constexpr double finest_image_leaf = 1.0;
// The share of what is left of the cube budget that images may use, and the most they may use: enough for a
// patch of some ten thousand such leaves, and cut in a second.
constexpr double image_budget_share = 0.5;
constexpr std::size_t most_image_cubes = 400000;

// The share of what is left of the cube budget, and the most cubes, that points which the mesh contradicts
// may use: layers that are not aligned have many.
constexpr double point_budget_share = 0.25;
constexpr std::size_t most_point_cubes = 200000;

constexpr std::size_t grain = 256;

constexpr std::uint8_t inside_point = 1, outside_point = 2;

class Refiner {
 public:
  Refiner(Decomposition& decomposition, const LatticeMesh& mesh, const DecompositionOptions& options,
          const PreparedConstraints& constraints, const Progress& progress)
      : decomposition_(decomposition),
        mesh_(mesh),
        options_(options),
        constraints_(constraints),
        progress_(progress) {}

  bool run(const std::vector<Index>& leaves);

 private:
  std::vector<std::uint8_t> marks() const;
  bool split(const std::vector<Index>& leaves) {
    return !leaves.empty() && split_further(decomposition_, mesh_, options_, leaves, progress_);
  }
  bool separate_points(std::size_t first_new);
  bool separate_from_mesh();
  bool separate_from_lines();
  std::vector<Vector3> contradicted() const;
  double side(Index leaf) const {
    return static_cast<double>(Octree::side(decomposition_.octree[leaf].depth)) * mesh_.lattice.step();
  }
  bool has_kind(Index leaf, VolumeKind kind) const { return decomposition_.volumes[leaf].kind == kind; }

  Decomposition& decomposition_;
  const LatticeMesh& mesh_;
  const DecompositionOptions& options_;
  const PreparedConstraints& constraints_;
  const Progress& progress_;
};

// Which kinds of points each cube holds.
std::vector<std::uint8_t> Refiner::marks() const {
  const Octree& octree = decomposition_.octree;
  std::vector<std::uint8_t> marks(octree.size(), 0);
  const auto add = [&](const std::vector<Vector3>& points, std::uint8_t mark) {
    std::vector<Index> leaf(points.size(), Octree::none);
    for_ranges(points.size(), grain, progress_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        if (const auto at = find_leaf(mesh_.lattice, octree, points[i])) leaf[i] = at->leaf;
    });
    for (Index cube : leaf)
      if (cube != Octree::none) marks[cube] |= mark;
  };
  add(constraints_.given().inside, inside_point);
  add(constraints_.given().outside, outside_point);
  return marks;
}

// Blank leaves, and hole leaves numbered `first_new` and up, with points of both kinds.
bool Refiner::separate_points(std::size_t first_new) {
  if (constraints_.given().inside.empty() || constraints_.given().outside.empty()) return false;
  bool any = false;
  for (;;) {
    const std::vector<std::uint8_t> marked = marks();
    std::vector<Index> leaves;
    for (Index leaf = 0; leaf < marked.size(); ++leaf) {
      if (marked[leaf] != (inside_point | outside_point)) continue;
      const bool hole = has_kind(leaf, VolumeKind::vertex) || has_kind(leaf, VolumeKind::edge);
      if (has_kind(leaf, VolumeKind::blank) || (hole && leaf >= first_new)) leaves.push_back(leaf);
    }
    if (!split(leaves)) return any;
    any = true;
  }
}

// The points in crossed leaves that are on the other side of the mesh.
std::vector<Vector3> Refiner::contradicted() const {
  std::vector<Vector3> found;
  for (const bool inside : {true, false}) {
    const std::vector<Vector3>& points = inside ? constraints_.given().inside : constraints_.given().outside;
    std::vector<char> against(points.size(), 0);
    for_each(points.size(), grain, progress_, [&](std::size_t i) {
      const auto at = find_leaf(mesh_.lattice, decomposition_.octree, points[i]);
      if (!at || !has_kind(at->leaf, VolumeKind::crossed)) return;
      const auto side = side_in_leaf(mesh_, decomposition_, constraints_.sides(), *at, points[i]);
      against[i] = side && *side != inside;
    });
    for (std::size_t i = 0; i < points.size(); ++i)
      if (against[i]) found.push_back(points[i]);
  }
  return found;
}

// In a large crossed leaf the mesh decides far beyond its faces.
bool Refiner::separate_from_mesh() {
  const std::vector<Vector3> points = contradicted();
  const std::size_t size = decomposition_.octree.size(), budget = std::max(options_.cube_budget, size) - size;
  const std::size_t most =
      size +
      std::min(most_point_cubes, static_cast<std::size_t>(point_budget_share * static_cast<double>(budget)));
  bool any = false;
  for (;;) {
    std::vector<Index> leaves;
    for (const Vector3& point : points)
      if (const auto at = find_leaf(mesh_.lattice, decomposition_.octree, point))
        if (has_kind(at->leaf, VolumeKind::crossed) && side(at->leaf) > constraints_.finest_leaf())
          leaves.push_back(at->leaf);
    std::sort(leaves.begin(), leaves.end());
    leaves.erase(std::unique(leaves.begin(), leaves.end()), leaves.end());
    if (decomposition_.octree.size() + 8 * leaves.size() > most || !split(leaves)) return any;
    any = true;
  }
}

bool Refiner::separate_from_lines() {
  if (constraints_.lines().empty() || constraints_.given().inside.empty()) return false;
  bool any = false;
  for (;;) {
    const std::vector<std::uint8_t> marked = marks();
    std::vector<Index> leaves;
    for (Index leaf = 0; leaf < marked.size(); ++leaf) {
      if ((marked[leaf] & inside_point) && has_kind(leaf, VolumeKind::blank) &&
          side(leaf) > constraints_.finest_leaf())
        leaves.push_back(leaf);
    }
    if (leaves.empty()) return any;
    const std::vector<char> seen =
        leaves_seen_through(mesh_.lattice, decomposition_, constraints_.lines(), progress_);
    leaves.erase(std::remove_if(leaves.begin(), leaves.end(), [&](Index leaf) { return !seen[leaf]; }),
                 leaves.end());
    if (!split(leaves)) return any;
    any = true;
  }
}

bool Refiner::run(const std::vector<Index>& leaves) {
  const std::size_t first_new = decomposition_.octree.size();
  bool any = split(leaves);
  any |= separate_from_mesh();
  any |= separate_points(first_new);
  any |= separate_from_lines();
  if (constraints_.symmetries() && options_.cube_budget > decomposition_.octree.size()) {
    const double left = static_cast<double>(options_.cube_budget - decomposition_.octree.size());
    any |= refine_near_images(decomposition_, mesh_, options_, *constraints_.symmetries(),
                              finest_image_leaf * constraints_.spacing(),
                              std::min(most_image_cubes, static_cast<std::size_t>(image_budget_share * left)),
                              progress_);
  }
  return any;
}

}  // namespace

bool refine_for_constraints(Decomposition& decomposition, const LatticeMesh& mesh,
                            const DecompositionOptions& options, const PreparedConstraints& constraints,
                            const std::vector<Index>& leaves, const Progress& progress) {
  if (constraints.empty()) return false;
  return Refiner(decomposition, mesh, options, constraints, progress).run(leaves);
}

}  // namespace meshcomplete
