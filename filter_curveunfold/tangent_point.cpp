#include "filter_curveunfold/tangent_point.h"

#include <algorithm>
#include <cmath>

namespace meshcomplete {
namespace {

// The kernel is |T x (p - q)|^3 / |p - q|^6. With these exponents its powers are square roots and products,
// and the matching Sobolev order is s = (6 - 1) / 3 = 5/3, sigma = s - 1 = 2/3.

/// r^(2 sigma + 1) for the squared distance.
double metric_distance_power(double squared) { return squared * std::cbrt(std::sqrt(squared)); }

/// |e x d|^2.
double squared_cross(double ee, double dd, double ed) { return std::max(0.0, ee * dd - ed * ed); }

}  // namespace

/// The cut loop: points, edge vectors and lengths.
struct TangentPointEnergy::Fine {
  std::vector<Vector3> point;
  std::vector<Vector3> edge;
  std::vector<double> length;
};

TangentPointEnergy::TangentPointEnergy(const Loop& loop, double longest_piece) : points_(loop.size()) {
  for (std::size_t i = 0; i < points_; ++i) {
    const double length = (loop[(i + 1) % points_] - loop[i]).norm();
    const int cuts = std::max(1, static_cast<int>(std::ceil(length / longest_piece - 1e-9)));
    for (int k = 0; k < cuts; ++k) pieces_.push_back({i, static_cast<double>(k) / cuts});
  }
}

TangentPointEnergy::Fine TangentPointEnergy::refine(const Loop& loop) const {
  const std::size_t n = pieces_.size();
  Fine fine;
  fine.point.resize(n);
  fine.edge.resize(n);
  fine.length.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3& a = loop[pieces_[i].edge];
    const Vector3& b = loop[(pieces_[i].edge + 1) % points_];
    fine.point[i] = a + pieces_[i].from * (b - a);
  }
  for (std::size_t i = 0; i < n; ++i) {
    fine.edge[i] = fine.point[(i + 1) % n] - fine.point[i];
    fine.length[i] = fine.edge[i].norm();
  }
  return fine;
}

double TangentPointEnergy::value(const Loop& loop) const {
  const Fine fine = refine(loop);
  const std::size_t n = pieces_.size();
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3& e = fine.edge[i];
    const double ee = fine.length[i] * fine.length[i];
    double inner = 0;
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i || j == (i + 1) % n || i == (j + 1) % n) continue;
      double kernel = 0;
      for (const std::size_t p : {i, (i + 1) % n}) {
        for (const std::size_t q : {j, (j + 1) % n}) {
          const Vector3 d = fine.point[p] - fine.point[q];
          const double dd = d.squaredNorm();
          const double cross = squared_cross(ee, dd, e.dot(d));
          kernel += cross * std::sqrt(cross) / (dd * dd * dd);
        }
      }
      inner += kernel * fine.length[j];
    }
    sum += inner / ee;
  }
  return sum / 4;
}

double TangentPointEnergy::gradient(const Loop& loop, Eigen::MatrixX3d& result) const {
  const Fine fine = refine(loop);
  const std::size_t n = pieces_.size();
  std::vector<Vector3> at_point(n, Vector3::Zero());
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t i_next = (i + 1) % n;
    const Vector3& e = fine.edge[i];
    const double ee = fine.length[i] * fine.length[i];
    Vector3 by_edge = Vector3::Zero();  // derivative by the edge vector e, the points p and q fixed
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t j_next = (j + 1) % n;
      if (j == i || j == i_next || i == j_next) continue;
      const double weight = fine.length[j] / ee / 4;
      double kernel = 0;
      for (const std::size_t p : {i, i_next}) {
        for (const std::size_t q : {j, j_next}) {
          const Vector3 d = fine.point[p] - fine.point[q];
          const double dd = d.squaredNorm(), ed = e.dot(d);
          const double cross = squared_cross(ee, dd, ed);
          const double root = std::sqrt(cross);
          const double inverse = 1 / (dd * dd * dd);
          const double term = cross * root * inverse;
          kernel += term;
          const double by_cross =
              1.5 * root * inverse * weight;  // derivative of the term by |e x d|^2, weighted
          by_edge += 2 * by_cross * (e * dd - d * ed);
          const Vector3 by_d = 2 * by_cross * (d * ee - e * ed) - d * (6 * weight * term / dd);
          at_point[p] += by_d;
          at_point[q] -= by_d;
        }
      }
      sum += kernel * weight;
      // The weight length_j / length_i^2 depends on the two lengths.
      const Vector3 by_other = fine.edge[j] * (kernel * weight / (fine.length[j] * fine.length[j]));
      at_point[j_next] += by_other;
      at_point[j] -= by_other;
      by_edge -= e * (2 * kernel * weight / ee);
    }
    at_point[i_next] += by_edge;
    at_point[i] -= by_edge;
  }
  result = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(points_), 3);
  for (std::size_t i = 0; i < n; ++i) {
    const auto a = static_cast<Eigen::Index>(pieces_[i].edge);
    const auto b = static_cast<Eigen::Index>((pieces_[i].edge + 1) % points_);
    result.row(a) += (1 - pieces_[i].from) * at_point[i].transpose();
    result.row(b) += pieces_[i].from * at_point[i].transpose();
  }
  return sum;
}

Eigen::MatrixXd TangentPointEnergy::inner_product(const Loop& loop) const {
  const Fine fine = refine(loop);
  const auto n = static_cast<Eigen::Index>(pieces_.size());
  std::vector<Vector3> middle(pieces_.size()), tangent(pieces_.size());
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    middle[i] = fine.point[i] + fine.edge[i] / 2;
    tangent[i] = fine.edge[i] / fine.length[i];
  }
  // With one quadrature point per piece the product is u' P u over the pieces' derivatives plus u' Q u over
  // their means, P and Q weighted graph Laplacians of all pairs.
  Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(n, n), mean = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i + 2; j < n; ++j) {
      if (i == 0 && j + 1 == n) continue;
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      const Vector3 d = middle[a] - middle[b];
      const double dd = d.squaredNorm();
      const double high = 2 * fine.length[a] * fine.length[b] / metric_distance_power(dd);
      const double low =
          high * (tangent[a].cross(d).squaredNorm() + tangent[b].cross(d).squaredNorm()) / (2 * dd * dd);
      derivative(i, i) += high;
      derivative(j, j) += high;
      derivative(i, j) = derivative(j, i) = -high * tangent[a].dot(tangent[b]);
      mean(i, i) += low;
      mean(j, j) += low;
      mean(i, j) = mean(j, i) = -low;
    }
  }
  // Every piece's derivative and mean are combinations of the two ends of the edge that the piece lies on.
  const auto points = static_cast<Eigen::Index>(points_);
  Eigen::MatrixXd half_derivative = Eigen::MatrixXd::Zero(n, points),
                  half_mean = Eigen::MatrixXd::Zero(n, points);
  std::vector<double> start_share(pieces_.size()), slope(pieces_.size());
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const std::size_t next = (i + 1) % pieces_.size();
    const double to = next != 0 && pieces_[next].edge == pieces_[i].edge ? pieces_[next].from : 1.0;
    start_share[i] = 1 - (pieces_[i].from + to) / 2;
    slope[i] = (to - pieces_[i].from) / fine.length[i];
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto a = static_cast<Eigen::Index>(pieces_[k].edge), b = (a + 1) % points;
    half_derivative.col(a) -= slope[k] * derivative.col(i);
    half_derivative.col(b) += slope[k] * derivative.col(i);
    half_mean.col(a) += start_share[k] * mean.col(i);
    half_mean.col(b) += (1 - start_share[k]) * mean.col(i);
  }
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(points, points);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto a = static_cast<Eigen::Index>(pieces_[k].edge), b = (a + 1) % points;
    result.row(a) += start_share[k] * half_mean.row(i) - slope[k] * half_derivative.row(i);
    result.row(b) += (1 - start_share[k]) * half_mean.row(i) + slope[k] * half_derivative.row(i);
  }
  // Translations cost nothing in the product above. A mass that is small against its diagonal makes it
  // invertible without slowing any other motion down.
  result.diagonal().array() += 1e-3 * result.diagonal().mean() / static_cast<double>(points);
  return (result + result.transpose()) / 2;
}

}  // namespace meshcomplete
