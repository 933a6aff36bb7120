#include <algorithm>
#include <optional>
#include <utility>

#include "common/core/boundary_loops.h"
#include "common/core/error.h"
#include "common/core/hole_targets.h"
#include "common/core/reduced_mesh.h"
#include "filter_atomicvolumes/offending_faces.h"
#include "filter_atomicvolumes/volume_solution.h"

namespace meshcomplete {
namespace {

constexpr const char* stage = "removing faces";

// Where removing comes to an end at all it takes a few rounds; where edges are shorter than the smallest
// cubes every round lays bare a rim as bad as the last.
constexpr int most_rounds = 24;

// A mesh that loses more of its faces than this is not completed but made anew.
constexpr double most_removed = 0.25;

// One division of space, and the mesh as far as it is left.
class Remover {
 public:
  Remover(const TriangleMesh& mesh, const MeshSelection& selection, const AtomicVolumesOptions& options,
          std::uint64_t seed)
      : options_(options), rest_(unreduced(mesh, selection)), seed_(seed) {}

  /// Absent when there is no end, or not before as many faces as `limit` are gone.
  std::optional<FaceRemoval> run(std::size_t limit, const Progress& progress);

 private:
  std::vector<Index> offending(const Progress& progress) const;

  const AtomicVolumesOptions& options_;
  ReducedMesh rest_;
  const std::uint64_t seed_;
};

// Marks the half-edges of the loops that are to be closed; empty when there are none.
std::vector<char> targeted_rims(const TriangleMesh& mesh, const OpenMesh& open) {
  std::vector<char> rims;
  for (std::size_t i = 0; i < open.loops.size(); ++i) {
    if (!is_targeted(open.holes[i])) continue;
    rims.resize(3 * mesh.triangles.size(), 0);
    for (std::size_t k = 0; k < open.loops[i].faces.size(); ++k)
      rims[half_edge_at(mesh, open.loops[i], k)] = 1;
  }
  return rims;
}

// By the mesh itself, also where faces intersect or vertices touch: those are in the way, too, and without
// them the completion needs no other mesh to divide space by.
std::vector<Index> Remover::offending(const Progress& progress) const {
  const TriangleMesh& mesh = rest_.mesh;
  const OpenMesh open = find_holes(mesh, rest_.selection, options_.holes, progress);
  const std::vector<char> rims = targeted_rims(mesh, open);
  if (rims.empty()) return {};
  const InputNeighbourhood neighbourhood(mesh);
  const PreparedConstraints constraints(mesh, open.topology, neighbourhood, options_.constraints, progress);
  const VolumeSolution solution =
      solve_volumes(mesh, open.topology, neighbourhood, options_, constraints, seed_, nullptr, progress);
  return offending_faces(solution.mesh, solution.decomposition, rims);
}

std::optional<FaceRemoval> Remover::run(std::size_t limit, const Progress& progress) {
  for (int rounds = 0;; ++rounds) {
    const std::vector<Index> faces = offending(progress.part(0, 0, stage));
    if (faces.empty())
      return FaceRemoval{std::move(rest_.removed), seed_, rounds, std::move(rest_.mesh),
                         std::move(rest_.selection)};
    if (rounds == most_rounds || rest_.removed.size() + faces.size() >= limit) return std::nullopt;
    remove_faces(rest_, faces, options_.holes.selected_only);
    progress.update((rounds + 1.0) / most_rounds);
  }
}

}  // namespace

FaceRemoval remove_offending_faces(const TriangleMesh& mesh, const MeshSelection& selection,
                                   const AtomicVolumesOptions& options, const Progress& progress) {
  check_options(options);
  if (!options.max_depth)
    throw CompletionError(stage,
                          "Faces are removed at the depth limit only, and there is none: set MaxDepth to a "
                          "number between 3 and 30.");
  const auto most = static_cast<std::size_t>(most_removed * static_cast<double>(mesh.triangles.size())) + 1;
  std::optional<FaceRemoval> best;
  for (int i = 0; i < options.shifts && !(best && best->faces.empty()); ++i) {
    const double from = static_cast<double>(i) / options.shifts, to = (i + 1.0) / options.shifts;
    Remover remover(mesh, selection, options, seed_of_division(options, i));
    std::optional<FaceRemoval> one =
        remover.run(best ? best->faces.size() : most, progress.part(from, to, stage));
    if (one) best = std::move(one);
  }
  if (!best)
    throw CompletionError(stage,
                          "However many faces are removed, those that come to lie at the rims are in the way "
                          "too (given up after " +
                              std::to_string(most_rounds) +
                              " rounds, or a quarter of the mesh): MaxDepth is too small for edges as short "
                              "as these. Raise it, or choose to cut the cubes at the depth limit.");
  progress.update(1);
  return std::move(*best);
}

ReducedCompletion fill_without_offending_faces(const TriangleMesh& mesh, const MeshSelection& selection,
                                               const AtomicVolumesOptions& options,
                                               const Progress& progress) {
  FaceRemoval removal = remove_offending_faces(mesh, selection, options, progress.part(0, 0.5, stage));
  AtomicVolumesOptions rest = options;
  rest.seed = removal.seed;
  rest.shifts = 1;
  return {
      fill_by_atomic_volumes(removal.mesh, removal.selection, rest, progress.part(0.5, 1, "closing holes")),
      std::move(removal.faces)};
}

}  // namespace meshcomplete
