#include "filter_volmorph/line_of_sight.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

/// Area vectors that sum up to less than this share of the area have no common direction: their sum is what
/// rounding left of a closed surface.
constexpr double least_net_area = 1e-6;

/// Edges of more median edges cross a depth step.
constexpr double step_edges = 4;

/// Fewer edges across depth steps may all belong to one flaw of the scan.
constexpr int least_steps = 32;

/// Edges have a common direction when the mean square of the cosines is at least this: they are within 18
/// degrees of it, as those that are longer than four samples are.
constexpr double least_agreement = 0.9;

/// Sum of the outer products of the unit vectors along edges across depth steps.
Eigen::Matrix3d step_directions(const TriangleMesh& scan, double median, int& count) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  count = 0;
  for (const Triangle& t : scan.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vector3 edge = scan.vertices[t[(k + 1) % 3]] - scan.vertices[t[k]];
      const double square = edge.squaredNorm();
      if (!(square > std::pow(step_edges * median, 2)) || !std::isfinite(square)) continue;
      sum += edge * edge.transpose() / square;
      ++count;
    }
  }
  return sum;
}

}  // namespace

Vector3 estimate_axis(const TriangleMesh& scan) {
  Vector3 sum = Vector3::Zero();
  double area = 0;
  for (const Triangle& t : scan.triangles) {
    const Vector3& a = scan.vertices[t[0]];
    const Vector3 cross = (scan.vertices[t[1]] - a).cross(scan.vertices[t[2]] - a);
    if (!cross.allFinite()) continue;
    sum += cross;
    area += cross.norm();
  }
  if (!(sum.norm() > least_net_area * area)) {
    throw CompletionError("estimating the line of sight",
                          "The scan's own axis cannot be estimated: its faces look in all directions alike. "
                          "Give a direction or a viewpoint as line of sight.");
  }
  int steps = 0;
  const Eigen::Matrix3d directions = step_directions(scan, median_edge(scan), steps);
  if (steps >= least_steps) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(directions);
    if (solver.eigenvalues()[2] >= least_agreement * steps) {
      const Vector3 axis = solver.eigenvectors().col(2);
      return axis.dot(sum) < 0 ? Vector3(-axis) : axis;
    }
  }
  return sum.normalized();
}

double median_edge(const TriangleMesh& mesh) {
  std::vector<double> squares;
  squares.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const double square = (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).squaredNorm();
      if (std::isfinite(square)) squares.push_back(square);
    }
  }
  if (squares.empty()) return 0;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return std::sqrt(*middle);
}

}  // namespace meshcomplete
