// Faces of a triangulated range grid that join what the scanner saw before and behind a depth step.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "common/core/mesh.h"
#include "filter_volmorph/line_of_sight.h"

namespace meshcomplete {

struct DepthStepOptions {
  /// Faces with a longer edge are dropped; mesh units, above 0. Absent: four times the median edge of the
  /// scan. Neighbours in a range grid are one sample apart across the line of sight, so an edge of four
  /// samples stands at 1 / cos = 4, about 75 degrees: the same limit as that of the angle.
  std::optional<double> longest_edge;
  /// Faces whose normal makes a larger angle with the line of sight are dropped; degrees, above 0, up to 90
  /// (then only those seen from behind are).
  double grazing_angle = 75;
};

/// Faces dropped, each counted once, for the first reason that holds.
struct DepthStepCounts {
  std::size_t degenerate = 0;   ///< no area, or a coordinate that is not a number
  std::size_t from_behind = 0;  ///< the normal looks away from the sensor
  std::size_t long_edge = 0;
  std::size_t grazing = 0;
  std::size_t kept = 0;
  std::size_t dropped() const { return degenerate + from_behind + long_edge + grazing; }
};

struct DepthSteps {
  TriangleMesh mesh;  ///< the faces kept, in their order; all vertices, with their numbers
  DepthStepCounts counts;
  double median_edge = 0;   ///< of all faces of the scan, mesh units
  double longest_edge = 0;  ///< the limit that was used, mesh units
};

/// Throws CompletionError on options out of range.
void check_options(const DepthStepOptions& options);

/// The faces of a scan that the scanner saw as surface. `line_of_sight` is parallel or a viewpoint; `name`
/// is what messages call the scan. Source: Curless and Levoy 1996 (tessellation of range images).
/// Throws CompletionError when no face is left, saying which limit dropped most. Cost: O(faces).
DepthSteps drop_depth_steps(const TriangleMesh& scan, const LineOfSight& line_of_sight,
                            const std::string& name, const DepthStepOptions& options = {});

}  // namespace meshcomplete
