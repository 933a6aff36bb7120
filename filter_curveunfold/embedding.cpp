#include "filter_curveunfold/embedding.h"

#include <algorithm>
#include <cmath>

#include "common/core/patch_fairing.h"
#include "common/core/patch_mesh.h"
#include "common/core/patch_remeshing.h"

namespace meshcomplete {
namespace {

// After two solves with remeshing in between the triangles no longer change much; a third moves the mean seam
// angle by less than a degree.
constexpr int solves = 2;
constexpr int rounds_between = 2;

// The first of the two solves only has to bring the triangles near to where they will be: on large patches,
// from this many vertices on, it is done on a patch of edges so many times longer.
constexpr double vertices_for_coarse_start = 1000;
constexpr double coarsening = 2.0;

// Of well-shaped triangles with the target lengths at their corners.
double triangles_to_cover(const std::vector<Vector3>& positions, const std::vector<Triangle>& triangles,
                          const std::vector<double>& target) {
  double count = 0;
  for (const Triangle& c : triangles) {
    const Vector3 normal = (positions[c[1]] - positions[c[0]]).cross(positions[c[2]] - positions[c[0]]);
    const double side = (target[c[0]] + target[c[1]] + target[c[2]]) / 3;
    count += 0.5 * normal.norm() / (0.25 * std::sqrt(3.0) * side * side);
  }
  return count;
}

}  // namespace

std::vector<double> target_lengths(const Rim& rim, const EmbeddingOptions& options) {
  std::vector<double> target = rim.edge_length;
  if (options.edge_length) std::fill(target.begin(), target.end(), *options.edge_length);
  for (double& length : target) length /= options.resolution;
  return target;
}

double expected_triangles(const Rim& rim, const std::vector<Triangle>& flat,
                          const EmbeddingOptions& options) {
  return triangles_to_cover(rim.positions, flat, target_lengths(rim, options));
}

PatchMesh embed(const Rim& rim, const std::vector<Triangle>& flat, const EmbeddingOptions& options,
                const Progress& progress) {
  PatchMesh patch(rim.positions, rim.positions.size(), flat);
  std::vector<double> target = target_lengths(rim, options);
  RemeshOptions remeshing;
  remeshing.forbidden = rim.forbidden;
  remeshing.rounds = rounds_between;
  // A patch that would be too large is refined at once, and refused.
  const double expected =
      0.5 * triangles_to_cover(patch.positions(), flat, target);  // two triangles per vertex
  const bool coarse =
      expected > vertices_for_coarse_start && expected < static_cast<double>(remeshing.max_vertices);
  if (coarse)
    for (double& length : target) length *= coarsening;
  refine(patch, target, remeshing, progress);
  if (patch.vertex_count() > patch.rim_size()) {
    // The embedded flat triangulation is creased along its chords; the membrane with uniform weights, which
    // cannot fold more than its rim, is a safe start for everything that looks at angles.
    fair(patch, rim, SurfaceEnergy::membrane, LaplacianWeights::uniform, progress);
    for (int i = 0; i < solves; ++i) {
      if (coarse && i == solves - 1)
        for (double& length : target) length /= coarsening;
      remesh(patch, target, remeshing, progress);
      fair(patch, rim, options.energy, options.weights, progress.part(0.4 * i + 0.2, 0.4 * i + 0.6, ""));
    }
  }
  progress.update(1.0);
  return patch;
}

}  // namespace meshcomplete
