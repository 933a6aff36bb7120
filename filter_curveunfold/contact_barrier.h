// A barrier between the segments of a closed polygon: what keeps a self-repelling polygon apart where the
// quadrature of the tangent-point energy is too coarse to feel that two strands are near each other.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "filter_curveunfold/loop_geometry.h"

namespace meshcomplete {

/// Sum over the pairs of segments without a common point of 7 (r - d)^2 / (r^2 d), d their distance and r the
/// reach, 0 beyond it. The factor makes it for small d what the tangent-point energy with exponents (3, 6)
/// gives for two straight lines at a right angle, 3/4 pi^2 / d, so that the two energies go over into each
/// other.
class ContactBarrier {
 public:
  /// `reach` in the loop's units. Pairs that are joined by a short piece of the loop have a shorter reach,
  /// half the length of that piece, or they would push against each other all the time.
  ContactBarrier(const std::vector<double>& edge_lengths, double reach);

  /// Cost of all: near-linear while few segments are within reach of each other.
  double value(const Loop& loop) const;

  /// Adds the gradient to `gradient` (a row per point), and to `inner_product` the curvature of the barrier
  /// across each pair, taken alike in all directions. Returns the value.
  double add_derivatives(const Loop& loop, Eigen::MatrixX3d& gradient, Eigen::MatrixXd& inner_product) const;

 private:
  template <typename Visit>
  void for_each_contact(const Loop& loop, Visit&& visit) const;

  std::vector<double> position_;  // of each point along the loop, and the perimeter at the end
  double reach_;
};

}  // namespace meshcomplete
