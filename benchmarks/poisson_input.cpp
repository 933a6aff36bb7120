#include "benchmarks/poisson_input.h"

#include <limits>

namespace meshcomplete::benchmarks {

PoissonOracle oracle_of(const OrientedPoints& set, int depth, const ScreenedPoissonOptions& options) {
  PoissonOracleOptions oracle;
  oracle.poisson = options;
  oracle.max_depth = depth;
  oracle.scale = meshlab_scale;
  const double smallest = std::numeric_limits<double>::min();  // cubes as small as the depth allows
  return make_oracle(nullptr, {{}, set.points, set.normals},
                     {[=](const Vector3&) { return smallest; }, smallest}, oracle);
}

}  // namespace meshcomplete::benchmarks
