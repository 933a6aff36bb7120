// How much the vertices of a range scan are trusted.
#pragma once

#include <vector>

#include "common/core/mesh.h"
#include "filter_volmorph/line_of_sight.h"

namespace meshcomplete {

struct ScanWeightOptions {
  /// The weight falls off as the cosine between normal and line of sight to this power, at least 0; 0: not.
  double grazing_power = 1;
  /// How far from the scan's boundary the weight reaches its full value, mesh units, at least 0; 0:
  /// everywhere.
  double boundary_falloff = 0;
};

/// Per vertex; 0 for vertices without faces.
struct ScanWeights {
  std::vector<Eigen::Vector3f> normals;  ///< unit, mean of the faces' weighted with their areas
  std::vector<float> weights;            ///< above 0, up to 1
};

/// Throws CompletionError on options out of range.
void check_options(const ScanWeightOptions& options);

/// Weights and normals of a scan's vertices. The distance to the boundary (edges that have not exactly two
/// faces) is that along edges. Weights do not fall to 0 at the boundary but to a twentieth, so that a strip
/// one face wide is not lost. Source: Curless and Levoy 1996, section 3. Cost: O(faces log faces).
ScanWeights weigh_scan(const TriangleMesh& scan, const LineOfSight& line_of_sight,
                       const ScanWeightOptions& options);

}  // namespace meshcomplete
