// The oracle of the completion: a screened Poisson reconstruction that is fine near the rims and coarse
// elsewhere.
#pragma once

#include <optional>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/octree_field.h"
#include "common/core/progress.h"
#include "common/core/screened_poisson.h"

namespace meshcomplete {

class EdgeLengthField;

/// What a user adds to the mesh to say how it goes on: further surfaces and points, which are not completed
/// themselves. Source: the paper, sections 3.2 and 4.5.
struct PoissonGuides {
  std::vector<TriangleMesh> surfaces;
  std::vector<Vector3> points;   ///< with `normals`, outward
  std::vector<Vector3> normals;  ///< one for each point
  bool empty() const { return surfaces.empty() && points.empty(); }
};

struct PoissonOracleOptions {
  ScreenedPoissonOptions poisson;
  /// Of the octree, up to 16; absent: as deep as the edges at the rims are long.
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
  PoissonOracleFigures figures;
};

/// `cubes` says how long edges are at the rims: cubes there are no larger, and grow with the distance. Throws
/// CompletionError when there is nothing to sample, and `Cancelled`. Cost: O(faces) and near-linear in the
/// octree's cubes.
PoissonOracle make_oracle(const TriangleMesh& mesh, const PoissonGuides& guides, const EdgeLengthField& cubes,
                          const PoissonOracleOptions& options, const Progress& progress = Progress());

/// The side of the cubes that the oracle has at a point of the surface, or less.
double wanted_cube(const EdgeLengthField& cubes, const Vector3& point);

}  // namespace meshcomplete
