// The tangent-point energy of a closed polygon, its gradient, and the fractional Sobolev inner product that
// makes steps along the gradient large. Source: Yu, Schumacher, Crane, "Repulsive Curves", ACM TOG 40(2),
// 2021.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "filter_curveunfold/loop_geometry.h"

namespace meshcomplete {

/// Discrete tangent-point energy with exponents (3, 6): large when strands that are far apart along the loop
/// come near each other in space. Every edge is cut into equal pieces for the quadrature, so that a strand is
/// felt along the whole length of a long edge and not only at its ends; the points of the loop stay the only
/// unknowns.
class TangentPointEnergy {
 public:
  /// Cuts each edge of `loop` so that no piece is longer than `longest_piece`; later loops must be as many
  /// points.
  TangentPointEnergy(const Loop& loop, double longest_piece);

  /// Cost of all three: quadratic in `pieces()`.
  double value(const Loop& loop) const;

  /// Value and, row per point, the gradient.
  double gradient(const Loop& loop, Eigen::MatrixX3d& result) const;

  /// The inner product of order s = 5/3 (paper, section 4.2.2 and 5.2), the same for each coordinate, plus a
  /// little mass so that it is positive definite.
  Eigen::MatrixXd inner_product(const Loop& loop) const;

  std::size_t pieces() const { return pieces_.size(); }

 private:
  struct Piece {
    std::size_t edge;
    double from;  // the share of the edge at which the piece starts
  };
  struct Fine;
  Fine refine(const Loop& loop) const;

  std::vector<Piece> pieces_;  // also the fine points: each piece starts at one
  std::size_t points_;
};

}  // namespace meshcomplete
