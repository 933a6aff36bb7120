// Oriented samples of a mesh, as dense as an octree is fine.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "common/core/lattice.h"
#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "common/core/screened_poisson.h"

namespace meshcomplete {

struct SamplingOptions {
  /// The side of the cubes that the octree is to have at a point (mesh units, positive); should change no
  /// faster than the cubes of a balanced octree. Called from many threads.
  std::function<double(const Vector3&)> cube_size;
  int min_depth = 5;   ///< of the octree
  int max_depth = 8;   ///< at least `min_depth`, at most `CornerOctree::most_depth`
  double density = 4;  ///< samples for each face of a cube, positive
  /// More samples of a mesh throw CompletionError: with the octree they would take some 10 GB.
  std::size_t max_samples = 40000000;
};

/// Samples of every part of the surface, of equal areas where the cubes are of one size, with the faces'
/// normals. Every sample's depth is the smallest at which the cubes are no larger than asked for. Faces
/// without area and with coordinates that are not finite are left out. Deterministic whatever the number of
/// threads. Source: the paper, section 3.2. Throws CompletionError (too many samples) and Cancelled. Cost:
/// O(faces + samples), threaded.
std::vector<OrientedSample> sample_surface(const TriangleMesh& mesh, const Lattice& lattice,
                                           const SamplingOptions& options,
                                           const Progress& progress = Progress());

/// Samples for a point set with normals: each stands for the area that its neighbours leave it, so that
/// dense parts do not weigh more, and asks for no cubes that would be mostly without a point. Points with a
/// normal of no length, or coordinates that are not finite, and such of which so many are at one position
/// that no area is left for them, are left out. Cost: O(n log n), threaded.
std::vector<OrientedSample> sample_points(const std::vector<Vector3>& points,
                                          const std::vector<Vector3>& normals, const Lattice& lattice,
                                          const SamplingOptions& options,
                                          const Progress& progress = Progress());

/// The cube round the meshes' vertices that triangles use, and `points`: `scale` (more than 1) times as large
/// as their bounding box, in its middle. Throws CompletionError when they have no extent.
Lattice root_cube(const std::vector<const TriangleMesh*>& meshes, const std::vector<Vector3>& points,
                  double scale);

/// The least depth at which the cubes of a root are no larger than `size` (positive), between the options'
/// limits.
int depth_of(const Lattice& lattice, double size, const SamplingOptions& options);

}  // namespace meshcomplete
