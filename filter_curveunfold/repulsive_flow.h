// A closed polygon that repels itself: descent of the tangent-point energy without ever passing through
// itself.
#pragma once

#include <cstddef>
#include <vector>

#include "filter_curveunfold/contact_barrier.h"
#include "filter_curveunfold/loop_geometry.h"
#include "filter_curveunfold/tangent_point.h"

namespace meshcomplete {

/// What the flow keeps while it moves the points.
enum class FlowConstraint {
  edge_lengths,  ///< every edge as long as `rest_lengths` says, approached where the loop starts elsewhere
  total_length,  ///< only the sum of the lengths: polygons of a few long edges need the freedom
};

/// Descends the tangent-point energy in the fractional Sobolev metric (Yu, Schumacher, Crane 2021, sections 4
/// and 5): a few dozen steps change the whole shape. Every step is certified by `safe_fraction`, so that all
/// the loops it passes through are isotopic. Deterministic.
class RepulsiveFlow {
 public:
  /// `loop` should be about as large as 1 across. `longest_piece` bounds the pieces of the energy's
  /// quadrature.
  RepulsiveFlow(Loop loop, std::vector<double> rest_lengths, FlowConstraint constraint, double longest_piece);

  /// One step. Returns false when no step that is worth having lowers the energy any more.
  /// Cost: cubic in the points, quadratic in the quadrature's pieces.
  bool step();

  const Loop& loop() const { return loop_; }

 private:
  struct Constraints;
  Constraints constraints(const Loop& loop) const;
  bool restore_lengths(const Eigen::VectorXd& violation, const Eigen::MatrixXd& inverse);
  Loop corrected(const Loop& loop, const Eigen::MatrixXd& inverse, const Eigen::VectorXd& allowed) const;

  Loop loop_;
  std::vector<double> rest_;
  FlowConstraint constraint_;
  TangentPointEnergy energy_;
  ContactBarrier barrier_;
};

}  // namespace meshcomplete
