#include "filter_curveunfold/repulsive_flow.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "filter_curveunfold/safe_motion.h"

namespace meshcomplete {
namespace {

/// Armijo's condition: the share of the linear prediction that a step has to achieve.
constexpr double sufficient_decrease = 1e-3;

/// Halvings of a step before the flow counts as stuck.
constexpr int most_halvings = 12;

/// No step moves a point by more than this (the loop is about 1 across): beyond it the linear model means
/// nothing.
constexpr double longest_move = 0.25;

/// The most that one step changes an edge's length in order to approach its rest length, as a share of that
/// length.
constexpr double most_length_change = 0.2;

/// Edges that are off by more than this share of their rest length are mended before the energy is looked at.
constexpr double restored_violation = 0.1;

/// The share of such a step that has to be free of contact; otherwise the energy has to make room first.
constexpr double least_restoration = 0.3;

Loop added(const Loop& loop, const Eigen::MatrixX3d& direction, double t) {
  Loop result(loop.size());
  for (std::size_t i = 0; i < loop.size(); ++i) {
    result[i] = loop[i] + t * direction.row(static_cast<Eigen::Index>(i)).transpose();
  }
  return result;
}

Loop interpolated(const Loop& from, const Loop& to, double t) {
  Loop result(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) result[i] = from[i] + t * (to[i] - from[i]);
  return result;
}

}  // namespace

/// Linearised constraints: row k of the Jacobian is `tangent[k]` times the difference of the displacements at
/// the ends of edge k; for the total length there is one row, the sum of them.
struct RepulsiveFlow::Constraints {
  FlowConstraint kind;
  std::vector<Vector3> tangent;
  Eigen::VectorXd violation;

  Eigen::VectorXd apply(const Eigen::MatrixX3d& x) const {
    const auto n = static_cast<Eigen::Index>(tangent.size());
    Eigen::VectorXd result(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      result[k] = (x.row((k + 1) % n) - x.row(k)).dot(tangent[static_cast<std::size_t>(k)]);
    }
    if (kind == FlowConstraint::total_length) return Eigen::VectorXd::Constant(1, result.sum());
    return result;
  }

  Eigen::MatrixX3d apply_transposed(const Eigen::VectorXd& multipliers) const {
    const auto n = static_cast<Eigen::Index>(tangent.size());
    Eigen::MatrixX3d result = Eigen::MatrixX3d::Zero(n, 3);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double multiplier = multipliers[kind == FlowConstraint::total_length ? 0 : k];
      const Eigen::RowVector3d force = multiplier * tangent[static_cast<std::size_t>(k)].transpose();
      result.row((k + 1) % n) += force;
      result.row(k) -= force;
    }
    return result;
  }

  /// The matrix C B C' for the inverse B of the inner product.
  Eigen::MatrixXd schur_complement(const Eigen::MatrixXd& inverse) const {
    const auto n = static_cast<Eigen::Index>(tangent.size());
    Eigen::MatrixXd result(n, n);
    for (Eigen::Index e = 0; e < n; ++e) {
      const Eigen::Index e1 = (e + 1) % n;
      for (Eigen::Index f = 0; f < n; ++f) {
        const Eigen::Index f1 = (f + 1) % n;
        const double coupling = inverse(e1, f1) - inverse(e1, f) - inverse(e, f1) + inverse(e, f);
        result(e, f) =
            coupling * tangent[static_cast<std::size_t>(e)].dot(tangent[static_cast<std::size_t>(f)]);
      }
    }
    if (kind == FlowConstraint::total_length) return Eigen::MatrixXd::Constant(1, 1, result.sum());
    // Straight runs make the constraints nearly dependent; a little compliance keeps the system solvable.
    result.diagonal().array() += 1e-10 * result.diagonal().mean();
    return result;
  }
};

RepulsiveFlow::RepulsiveFlow(Loop loop, std::vector<double> rest_lengths, FlowConstraint constraint,
                             double longest_piece)
    : loop_(std::move(loop)),
      rest_(std::move(rest_lengths)),
      constraint_(constraint),
      energy_(loop_, longest_piece),
      barrier_(rest_, longest_piece) {}

RepulsiveFlow::Constraints RepulsiveFlow::constraints(const Loop& loop) const {
  const std::size_t n = loop.size();
  Constraints result;
  result.kind = constraint_;
  result.tangent.resize(n);
  result.violation.resize(static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3 edge = loop[(i + 1) % n] - loop[i];
    const double length = edge.norm();
    result.tangent[i] = edge / length;
    result.violation[static_cast<Eigen::Index>(i)] = length - rest_[i];
  }
  if (constraint_ == FlowConstraint::total_length) {
    result.violation = Eigen::VectorXd::Constant(1, result.violation.sum());
  }
  return result;
}

/// The nearest loop in the metric, to first order, that violates the constraints by no more than `allowed`.
Loop RepulsiveFlow::corrected(const Loop& loop, const Eigen::MatrixXd& inverse,
                              const Eigen::VectorXd& allowed) const {
  const Constraints c = constraints(loop);
  Eigen::VectorXd violation = c.violation - allowed;
  if (constraint_ == FlowConstraint::edge_lengths) {
    for (Eigen::Index k = 0; k < violation.size(); ++k) {
      const double most = most_length_change * (rest_[static_cast<std::size_t>(k)] + violation[k]);
      violation[k] = std::clamp(violation[k], -most, most);
    }
  }
  const Eigen::VectorXd multipliers = c.schur_complement(inverse).ldlt().solve(violation);
  const Eigen::MatrixX3d correction = inverse * c.apply_transposed(multipliers);
  return added(loop, correction, -1);
}

/// A step towards the rest lengths alone, whatever it does to the energy, when they are far off and it has
/// room.
bool RepulsiveFlow::restore_lengths(const Eigen::VectorXd& violation, const Eigen::MatrixXd& inverse) {
  if (constraint_ != FlowConstraint::edge_lengths) return false;
  double worst = 0;
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    worst = std::max(worst, std::abs(violation[static_cast<Eigen::Index>(i)]) / rest_[i]);
  }
  if (worst < restored_violation) return false;
  const Loop target = corrected(loop_, inverse, Eigen::VectorXd::Zero(violation.size()));
  const double fraction = safe_fraction(loop_, target);
  if (!(fraction > least_restoration)) return false;
  loop_ = interpolated(loop_, target, fraction);
  return true;
}

bool RepulsiveFlow::step() {
  Eigen::MatrixX3d gradient;
  double before = energy_.gradient(loop_, gradient);
  Eigen::MatrixXd inner = energy_.inner_product(loop_);
  before += barrier_.add_derivatives(loop_, gradient, inner);
  const Eigen::MatrixXd inverse = inner.llt().solve(Eigen::MatrixXd::Identity(inner.rows(), inner.cols()));
  const Constraints c = constraints(loop_);
  if (restore_lengths(c.violation, inverse)) return true;
  Eigen::MatrixX3d direction = -inverse * gradient;
  const Eigen::VectorXd multipliers = c.schur_complement(inverse).ldlt().solve(c.apply(direction));
  direction -= inverse * c.apply_transposed(multipliers);
  const double slope = (gradient.array() * direction.array()).sum();
  const double largest = std::sqrt(direction.rowwise().squaredNorm().maxCoeff());
  if (!(slope < 0) || !std::isfinite(largest) || !(largest > 0)) return false;
  double t = longest_move / largest;
  double share =
      1;  // of the violation that is mended: in step with t, or mending alone might raise the energy
  for (int k = 0; k < most_halvings; ++k, t /= 2, share /= 2) {
    Loop target = corrected(added(loop_, direction, t), inverse, (1 - share) * c.violation);
    const double fraction = safe_fraction(loop_, target);
    if (fraction < 0.5) continue;
    if (fraction < 1) target = interpolated(loop_, target, fraction);
    const double after = energy_.value(target) + barrier_.value(target);
    if (!(after <= before + sufficient_decrease * t * fraction * slope)) continue;
    loop_ = std::move(target);
    return true;
  }
  return false;
}

}  // namespace meshcomplete
