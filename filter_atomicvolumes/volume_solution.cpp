#include "filter_atomicvolumes/volume_solution.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>
#include <random>
#include <utility>

#include "common/core/error.h"
#include "common/core/patch.h"
#include "filter_atomicvolumes/volume_locator.h"
#include "filter_atomicvolumes/volume_smoothing.h"

namespace meshcomplete {
namespace {

constexpr const char* stage = "dividing space";

// The root's side, in longest sides of the bounding box, and the share of it that stays free beside the mesh.
constexpr double least_root = 1.5;
constexpr double most_root = 2.0;
constexpr double margin = 0.05;

// Coincidences are accidents of one position: the chance that so many in a row have one is nil, but for
// meshes that are degenerate themselves.
constexpr int most_restarts = 20;

// Cubes of fewer steps of what can be stored make faces that cannot: so often another position is tried then,
// unless the mesh itself has vertices that close.
constexpr int most_fine_restarts = 1;
constexpr double least_steps = 8;

// Crossed cubes that disagree, and volumes with contradicting constraints, are split so often; then the
// square between the cubes is left to the patch.
constexpr int most_refinements = 8;

// Sheets that contradict each other are told apart down to cubes of this share of the shortest edge of the
// boundary: what is smaller is no matter of the patch, and sheets that lie on each other would have no end.
constexpr double closest_contradiction = 0.25;

// A uniform number from 0 to 1, the same on every platform.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

Lattice place_root(const TriangleMesh& mesh, std::mt19937_64& random) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : mesh.triangles)
    for (Index v : t)
      if (mesh.vertices[v].allFinite()) box.extend(mesh.vertices[v]);
  const Vector3 sizes = box.sizes();
  const double side = sizes.maxCoeff() * (least_root + (most_root - least_root) * uniform(random));
  Vector3 origin = box.min();
  for (int k = 0; k < 3; ++k) {
    const double room = side * (1 - 2 * margin) - sizes[k];
    origin[k] -= margin * side + uniform(random) * room;
  }
  return Lattice(origin, side);
}

double shortest_distance(const TriangleMesh& mesh, const MeshTopology& topology) {
  double shortest = std::numeric_limits<double>::infinity();
  for (Index h : topology.boundary_half_edges) {
    const Triangle& t = mesh.triangles[h / 3];
    shortest = std::min(shortest, (mesh.vertices[t[h % 3]] - mesh.vertices[t[(h % 3 + 1) % 3]]).norm());
  }
  return shortest;
}

double smallest_leaf(const VolumeSolution& solution) {
  int depth = 0;
  const Octree& octree = solution.decomposition.octree;
  for (Index cube = 0; cube < octree.size(); ++cube) depth = std::max(depth, octree[cube].depth);
  return solution.mesh.lattice.step() * static_cast<double>(Octree::side(depth));
}

// The smallest cube in which the faces of volumes can be stored.
double least_leaf(const TriangleMesh& mesh) {
  double most = 0;
  for (const Vector3& p : mesh.vertices)
    if (p.allFinite()) most = std::max(most, stored_resolution(p));
  return least_steps * most;
}

void count_leaves(const VolumeSolution& solution, AtomicVolumesFigures& figures) {
  const Octree& octree = solution.decomposition.octree;
  for (Index cube = 0; cube < octree.size(); ++cube) {
    if (!octree.is_leaf(cube)) continue;
    ++figures.leaves;
    figures.depth = std::max(figures.depth, octree[cube].depth);
    switch (solution.decomposition.volumes[cube].kind) {
      case VolumeKind::blank:
        ++figures.blank_leaves;
        break;
      case VolumeKind::crossed:
        ++figures.crossed_leaves;
        break;
      default:
        ++figures.hole_leaves;
    }
  }
  figures.smallest_leaf = smallest_leaf(solution);
  figures.nodes = solution.complex.nodes;
  figures.tetrahedra = solution.complex.tetrahedra;
  figures.cut_weight = solution.labelling.weight;
}

void check_budget(const VolumeComplex& complex, const AtomicVolumesOptions& options) {
  if (complex.nodes > options.node_budget)
    throw CompletionError(stage, "The graph would have " + std::to_string(complex.nodes) +
                                     " nodes, more than the budget of " +
                                     std::to_string(options.node_budget) +
                                     ". Raise NodeBudget, or close fewer or shorter holes at a time.");
}

// Splits cubes until those that only the mesh divides agree with each other, and constraints are told apart;
// then labels the volumes. `distance` is the shortest between rim vertices; cubes smaller than `least` count
// as a coincidence.
void solve(VolumeSolution& solution, const AtomicVolumesOptions& options,
           const PreparedConstraints& constraints, const FaceCost& cost, double distance, double least,
           const Progress& progress) {
  DecompositionOptions division;
  division.max_depth = options.max_depth.value_or(Lattice::depth);
  division.cube_budget = options.node_budget;
  division.least_contradiction =
      static_cast<std::int64_t>(closest_contradiction * distance / solution.mesh.lattice.step());
  Decomposition& octree = solution.decomposition;
  octree = decompose(solution.mesh, division, progress.part(0, 0.3, stage));
  if (smallest_leaf(solution) < least) throw Coincidence();
  if (!constraints.empty())
    refine_for_constraints(octree, solution.mesh, division, constraints, {}, progress);
  TiedConstraints tied;
  for (int i = 0;; ++i) {
    solution.complex = build_complex(solution.mesh, octree, progress.part(0.3, 0.7, stage));
    check_budget(solution.complex, options);
    if (!constraints.empty())
      tied = tie_constraints(solution.mesh, octree, solution.complex, cost, constraints, progress);
    if (i == most_refinements) break;
    std::vector<Index>& disagreeing = solution.complex.disagreeing;
    const auto too_small = [&](Index cube) {
      return Octree::side(octree.octree[cube].depth) <= division.least_contradiction;
    };
    disagreeing.erase(std::remove_if(disagreeing.begin(), disagreeing.end(), too_small), disagreeing.end());
    bool split = split_further(octree, solution.mesh, division, disagreeing);
    if (!tied.split.empty())
      split |= refine_for_constraints(octree, solution.mesh, division, constraints, tied.split, progress);
    if (!split) break;
  }
  solution.notes = std::move(tied.notes);
  solution.ties = std::move(tied.ties);
  solution.labelling = cut_complex(solution.mesh, solution.complex, cost, solution.ties,
                                   progress.part(0.7, 0.9, "computing the minimum cut"));
  solution.surface = extract(solution.mesh, octree.octree, solution.complex, solution.labelling);
}

// The user's points with the volumes that hold them.
std::vector<VolumePoint> points_in_volumes(const VolumeSolution& solution,
                                           const PreparedConstraints& constraints) {
  std::vector<VolumePoint> points;
  const VolumeConstraints& given = constraints.given();
  if (given.inside.empty() && given.outside.empty()) return points;
  const VolumeLocator locator(solution.mesh, solution.decomposition, solution.complex, constraints.sides());
  for (const std::vector<Vector3>* list : {&given.inside, &given.outside})
    for (const Vector3& point : *list) {
      const VolumePlace place = locator.locate(point);
      if (place.kind == VolumePlace::free) points.push_back({place.node, point});
    }
  return points;
}

}  // namespace

VolumeSolution solve_volumes(const TriangleMesh& mesh, const MeshTopology& topology,
                             const InputNeighbourhood& neighbourhood, const AtomicVolumesOptions& options,
                             const PreparedConstraints& constraints, std::uint64_t seed,
                             const ImplicitFunction* oracle, const Progress& progress) {
  std::mt19937_64 random(seed);
  const double distance = shortest_distance(mesh, topology), leaf = least_leaf(mesh);
  for (int restart = 0; restart <= most_restarts; ++restart) {
    VolumeSolution solution{
        {mesh, topology, neighbourhood, place_root(mesh, random)}, {}, {}, {}, {}, {}, {}, {}};
    try {
      const bool may_be_fine = restart >= most_fine_restarts || closest_contradiction * distance < leaf;
      solve(solution, options, constraints, FaceCost(options.weight, oracle), distance,
            may_be_fine ? 0 : leaf, progress);
    } catch (const Coincidence&) {
      continue;
    }
    count_leaves(solution, solution.figures);
    solution.figures.smallest_distance = distance;
    solution.figures.restarts = restart;
    return solution;
  }
  throw CompletionError(
      stage,
      "Some of the mesh's vertices lie so close to each other's edges or faces that space cannot be "
      "divided between them. Apply 'Merge Close Vertices' or 'Remove Zero Area Faces' first.");
}

void smooth(VolumeSolution& solution, const AtomicVolumesOptions& options,
            const PreparedConstraints& constraints, const ImplicitFunction* oracle,
            const Progress& progress) {
  if (options.smoothing == VolumeSmoothing::none || options.smoothing_iterations == 0) return;
  VolumeSmoothingOptions smoothing;
  smoothing.iterations = options.smoothing_iterations;
  smoothing.moving_centres = options.moving_centres;
  smoothing.cost = FaceCost(options.weight, oracle);
  smoothing.points = points_in_volumes(solution, constraints);
  if (options.smoothing == VolumeSmoothing::two_pass) {
    std::vector<NodeTie> ties = suggest_by_springs(solution.mesh, solution.decomposition, solution.complex,
                                                   solution.surface, smoothing, progress.part(0, 0.3, ""));
    ties.insert(ties.end(), solution.ties.begin(), solution.ties.end());
    solution.labelling =
        cut_complex(solution.mesh, solution.complex, smoothing.cost, ties, progress.part(0.3, 0.5, ""));
    solution.surface =
        extract(solution.mesh, solution.decomposition.octree, solution.complex, solution.labelling);
  }
  smooth_constrained(solution.mesh, solution.decomposition, solution.complex, solution.surface, smoothing,
                     progress.part(0.5, 1, "smoothing the patches"));
}

}  // namespace meshcomplete
