#include "filter_curveunfold/embedding.h"

#include "common/core/patch_mesh.h"
#include "common/core/patch_remeshing.h"

#include <algorithm>

namespace meshcomplete {
namespace {

// After two solves with remeshing in between the triangles no longer change much; a third moves the mean seam angle by
// less than a degree.
constexpr int solves = 2;
constexpr int rounds_between = 2;

// From this many vertices on a single solve has to do: the second one costs most of the time there, and the triangles
// near the rim, which it improves, are few.
constexpr std::size_t vertices_for_one_solve = 20000;

std::vector<double> target_lengths(const Rim& rim, const EmbeddingOptions& options) {
  std::vector<double> target = rim.edge_length;
  if (options.edge_length) std::fill(target.begin(), target.end(), *options.edge_length);
  for (double& length : target) length /= options.resolution;
  return target;
}

// The patch's triangles, followed by the ring's when the energy looks across the rim.
TriangleMesh with_ring(const PatchMesh& patch, const Rim& rim, std::vector<char>& fixed) {
  const Index rim_size = static_cast<Index>(patch.rim_size());
  TriangleMesh surface{patch.positions(), patch.triangles()};
  const Index offset = static_cast<Index>(surface.vertices.size()) - rim_size;
  surface.vertices.insert(surface.vertices.end(), rim.ring.vertices.begin() + rim_size, rim.ring.vertices.end());
  for (Triangle t : rim.ring.triangles) {
    for (Index& corner : t)
      if (corner >= rim_size) corner += offset;
    surface.triangles.push_back(t);
  }
  fixed.assign(surface.vertices.size(), 1);
  std::fill(fixed.begin() + rim_size, fixed.begin() + static_cast<std::ptrdiff_t>(patch.vertex_count()), 0);
  return surface;
}

void solve(PatchMesh& patch, const Rim& rim, SurfaceEnergy energy, LaplacianWeights weights, const Progress& progress) {
  std::vector<char> fixed;
  TriangleMesh surface = with_ring(patch, rim, fixed);
  minimize_energy(surface, fixed, energy, weights, progress);
  for (Index v = static_cast<Index>(patch.rim_size()); v < patch.vertex_count(); ++v)
    patch.move(v, surface.vertices[v]);
}

}  // namespace

PatchMesh embed(const Rim& rim, const std::vector<Triangle>& flat, const EmbeddingOptions& options,
                    const Progress& progress) {
  PatchMesh patch(rim.positions, rim.positions.size(), flat);
  std::vector<double> target = target_lengths(rim, options);
  RemeshOptions remeshing;
  remeshing.forbidden = rim.forbidden;
  remeshing.rounds = rounds_between;
  refine(patch, target, remeshing, progress);
  if (patch.vertex_count() > patch.rim_size()) {
    // The embedded flat triangulation is creased along its chords; the membrane with uniform weights, which cannot fold
    // more than its rim, is a safe start for everything that looks at angles.
    solve(patch, rim, SurfaceEnergy::membrane, LaplacianWeights::uniform, progress);
    const int count = patch.vertex_count() < vertices_for_one_solve ? solves : 1;
    for (int i = 0; i < count; ++i) {
      remesh(patch, target, remeshing, progress);
      solve(patch, rim, options.energy, options.weights, progress.part(0.4 * i + 0.2, 0.4 * i + 0.6, ""));
    }
  }
  progress.update(1.0);
  return patch;
}

}  // namespace meshcomplete
