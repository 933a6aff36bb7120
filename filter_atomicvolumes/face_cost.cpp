#include "filter_atomicvolumes/face_cost.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace meshcomplete {
namespace {

// What a face on the zero set costs, as a share of its area: not nothing, so that of two surfaces that are as
// near to it the smaller one is taken, and bubbles do not come for free.
constexpr double least_share = 0.05;

// How far from a face's middle the function is asked, in sizes of the face.
constexpr double reach = 0.5;

}  // namespace

double FaceCost::most(double area) const {
  switch (weight_) {
    case CutWeight::area:
    case CutWeight::poisson:
      return area;
    case CutWeight::balanced:
      return std::sqrt(std::sqrt(area));
    case CutWeight::unit:
      break;
  }
  return 1;
}

double FaceCost::closeness(const Vector3& middle, double size) const {
  if (oracle_ == nullptr) return 1;
  // Value and slope from the corners of a regular tetrahedron: exact for a function that is linear.
  const std::array<Vector3, 4> corners = {Vector3(1, 1, 1), Vector3(1, -1, -1), Vector3(-1, 1, -1),
                                          Vector3(-1, -1, 1)};
  double value = 0;
  Vector3 rise = Vector3::Zero();  // over `size`
  for (const Vector3& corner : corners) {
    const double at = oracle_->value(middle + reach * size * corner);
    value += 0.25 * at;
    rise += 0.25 / reach * at * corner;
  }
  const double steepness = rise.norm();
  const double distance = std::abs(value) < steepness ? std::abs(value) / steepness : 1;  // in sizes
  return least_share + (1 - least_share) * distance * distance;
}

}  // namespace meshcomplete
