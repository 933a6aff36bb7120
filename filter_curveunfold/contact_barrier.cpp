#include "filter_curveunfold/contact_barrier.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "filter_curveunfold/loop_tree.h"

namespace meshcomplete {
namespace {

constexpr double strength = 7.4;  // 3/4 pi^2

}  // namespace

ContactBarrier::ContactBarrier(const std::vector<double>& edge_lengths, double reach)
    : position_(1, 0.0), reach_(reach) {
  for (const double length : edge_lengths) position_.push_back(position_.back() + length);
}

/// Calls `visit(i, j, closest, reach)` for the pairs of segments within reach.
template <typename Visit>
void ContactBarrier::for_each_contact(const Loop& loop, Visit&& visit) const {
  const std::size_t n = loop.size();
  const LoopTree tree(loop);
  for (std::size_t i = 0; i + 2 < n; ++i) {
    const LoopTree::Box box = LoopTree::grown(LoopTree::box_of(loop[i], loop[i + 1]), reach_);
    tree.for_each_in_box(box, [&](std::size_t j) {
      if (j < i + 2 || (i == 0 && j + 1 == n)) return true;
      const double one_way = position_[j] - position_[i + 1];
      const double other_way = position_[n] - position_[j + 1] + position_[i];
      const double reach = std::min(reach_, std::min(one_way, other_way) / 2);
      const ClosestPoints closest = closest_points(loop[i], loop[i + 1], loop[j], loop[(j + 1) % n]);
      if (closest.difference.squaredNorm() < reach * reach) visit(i, j, closest, reach);
      return true;
    });
  }
}

double ContactBarrier::value(const Loop& loop) const {
  double sum = 0;
  for_each_contact(loop, [&](std::size_t, std::size_t, const ClosestPoints& closest, double reach) {
    const double d = closest.difference.norm();
    sum += strength * (reach - d) * (reach - d) / (reach * reach * d);
  });
  return sum;
}

double ContactBarrier::add_derivatives(const Loop& loop, Eigen::MatrixX3d& gradient,
                                       Eigen::MatrixXd& inner_product) const {
  const std::size_t n = loop.size();
  double sum = 0;
  for_each_contact(loop, [&](std::size_t i, std::size_t j, const ClosestPoints& closest, double reach) {
    const double d = closest.difference.norm();
    sum += strength * (reach - d) * (reach - d) / (reach * reach * d);
    const double slope = -strength * (reach * reach - d * d) / (reach * reach * d * d);
    const double curvature = 2 * strength / (d * d * d);
    const std::array<Eigen::Index, 4> points = {
        static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i + 1), static_cast<Eigen::Index>(j),
        static_cast<Eigen::Index>((j + 1) % n)};
    const std::array<double, 4> weights = {1 - closest.first, closest.first, closest.second - 1,
                                           -closest.second};
    for (std::size_t a = 0; a < 4; ++a) {
      gradient.row(points[a]) += (slope * weights[a] / d) * closest.difference.transpose();
      for (std::size_t b = 0; b < 4; ++b) {
        inner_product(points[a], points[b]) += curvature * weights[a] * weights[b];
      }
    }
  });
  return sum;
}

}  // namespace meshcomplete
