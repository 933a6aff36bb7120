// The oracle of the completion: a screened Poisson reconstruction that is fine near the rims and coarse
// elsewhere.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/octree_field.h"
#include "common/core/progress.h"
#include "common/core/screened_poisson.h"

namespace meshcomplete {

/// Triangles and points with normals that a reconstruction goes through.
struct OrientedSurfaces {
  std::vector<TriangleMesh> meshes;
  std::vector<Vector3> points;
  std::vector<Vector3> normals;  ///< one for each point, outward, of any length
  bool empty() const { return meshes.empty() && points.empty(); }
};

/// How fine the octree is to be.
struct CubeSizes {
  /// The side of the cubes at a point of the surface (mesh units, positive). Called from many threads.
  std::function<double(const Vector3&)> at;
  double smallest = 0;  ///< what `at` does not go below: what the automatic depth is for
};

struct PoissonOracleOptions {
  ScreenedPoissonOptions poisson;
  /// Of the octree, up to 16; absent: as deep as the smallest cubes ask for.
  std::optional<int> max_depth;
  double scale = 2.2;  ///< side of the octree's cube over the longest side of the bounding box, above 1
  double density = 4;  ///< samples for each face of a cube, positive
  FieldInterpolation interpolation = FieldInterpolation::trilinear;
};

struct PoissonOracleFigures {
  std::size_t samples = 0, cubes = 0;
  int depth = 0;
  std::vector<PoissonLevelFigures> levels;
};

struct PoissonOracle {
  OctreeField field;
  std::vector<OrientedSample> samples;
  PoissonOracleFigures figures;
};

/// Throws CompletionError on options out of range.
void check_options(const PoissonOracleOptions& options);

/// The reconstruction of `mesh` (may be null) and `others`. Throws CompletionError when there is nothing to
/// sample, and `Cancelled`. Cost: O(faces) and near-linear in the octree's cubes.
PoissonOracle make_oracle(const TriangleMesh* mesh, const OrientedSurfaces& others, const CubeSizes& cubes,
                          const PoissonOracleOptions& options, const Progress& progress = Progress());

}  // namespace meshcomplete
