#include "filter_poissoncompletion/refinement_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meshcomplete {

Vector3 circumcentre(const std::array<Vector3, 4>& corners) {
  const Vector3& p = corners[0];
  const Vector3 a = corners[1] - p, b = corners[2] - p, c = corners[3] - p, ab = a.cross(b);
  return p + (c.squaredNorm() * ab + a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a)) /
                 (2 * c.dot(ab));
}

double share_to_wall(const Eigen::AlignedBox3d& box, const Vector3& from, const Vector3& way) {
  double share = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (way[k] == 0) continue;
    const double wall = way[k] > 0 ? box.max()[k] : box.min()[k];
    share = std::min(share, (wall - from[k]) / way[k]);
  }
  return share;
}

Vector3 edge_division(const Vector3& a, const Vector3& b, bool a_is_end, bool b_is_end) {
  if (a_is_end == b_is_end) return 0.5 * (a + b);
  const double length = (b - a).norm(), part = std::exp2(std::round(std::log2(0.5 * length))) / length;
  return b_is_end ? Vector3(b + part * (a - b)) : Vector3(a + part * (b - a));
}

}  // namespace meshcomplete
