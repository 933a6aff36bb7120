#include "filter_volmorph/depth_steps.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/core/parameter_checks.h"

namespace meshcomplete {
namespace {

constexpr double default_edges = 4;
constexpr double degree = M_PI / 180;

/// The counter of the reason to drop a face, or of those kept.
std::size_t& judge(const TriangleMesh& scan, const Triangle& t, const LineOfSight& line_of_sight,
                   double longest_edge, double least_cosine, DepthStepCounts& counts) {
  const Vector3 &a = scan.vertices[t[0]], &b = scan.vertices[t[1]], &c = scan.vertices[t[2]];
  const Vector3 normal = (b - a).cross(c - a);
  const double length = normal.norm();
  if (!(length > 0) || !std::isfinite(length)) return counts.degenerate;
  const Vector3 middle = (a + b + c) / 3;
  const double cosine = normal.dot(line_of_sight.towards_sensor(middle)) / length;
  if (!(cosine > 0)) return counts.from_behind;
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  if (longest > longest_edge * longest_edge) return counts.long_edge;
  return cosine < least_cosine ? counts.grazing : counts.kept;
}

[[noreturn]] void throw_nothing_left(const DepthStepCounts& counts, const std::string& name) {
  std::string why;
  if (counts.from_behind >= std::max(counts.long_edge, counts.grazing)) {
    why = counts.from_behind == 0 ? "none of them has an area."
                                  : "nearly all are seen from behind. The line of sight must point from the "
                                    "surface towards the sensor; perhaps it is reversed, or the faces are.";
  } else if (counts.long_edge >= counts.grazing) {
    why = "most have an edge longer than the limit. Raise the longest edge of the depth-step limits.";
  } else {
    why = "most are seen too grazingly. Raise the grazing angle of the depth-step limits.";
  }
  throw CompletionError("dropping depth steps", "No face of " + name + " is left: " + why);
}

}  // namespace

void check_options(const DepthStepOptions& options) {
  require(!options.longest_edge || positive(*options.longest_edge),
          "The longest edge of the depth-step limits must be above 0.");
  require(positive(options.grazing_angle) && options.grazing_angle <= 90,
          "The grazing angle of the depth-step limits must be above 0 and at most 90 degrees.");
}

DepthSteps drop_depth_steps(const TriangleMesh& scan, const LineOfSight& line_of_sight,
                            const std::string& name, const DepthStepOptions& options) {
  check_options(options);
  DepthSteps result;
  result.median_edge = median_edge(scan);
  result.longest_edge = options.longest_edge.value_or(default_edges * result.median_edge);
  const double least_cosine = std::cos(options.grazing_angle * degree);
  result.mesh.vertices = scan.vertices;
  for (const Triangle& t : scan.triangles) {
    std::size_t& counter = judge(scan, t, line_of_sight, result.longest_edge, least_cosine, result.counts);
    ++counter;
    if (&counter == &result.counts.kept) result.mesh.triangles.push_back(t);
  }
  if (result.counts.kept == 0) throw_nothing_left(result.counts, name);
  return result;
}

}  // namespace meshcomplete
