#include "filter_poissoncompletion/surface_fitting.h"

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/core/patch.h"
#include "common/core/threads.h"
#include "common/core/triangle_intersection.h"

namespace meshcomplete {
namespace {

// In shortest edges of a vertex, how far it moves at most: its faces stay as well shaped as they are, nearly.
constexpr double longest_way = 0.2;

// Over which part of a face's longest edge the function's slope is measured, and how far from the face the
// surface may be to count.
constexpr double slope_step = 0.05, farthest = 0.25;

// The equations are as good as masses: they take some ten iterations.
constexpr double tolerance = 1e-3;

// Rounds in which vertices of faces that meet go back. What meets then goes back as a whole.
constexpr int most_rounds = 10;

constexpr std::size_t faces_per_task = 512;  // about a millisecond

// Dunavant's rule of degree 4: each number is the share of one corner, the rest is halved between the others.
constexpr std::array<double, 2> corner_share = {0.108103018168070, 0.816847572980459};
constexpr std::array<double, 2> weight = {0.223381589678011, 0.109951743655322};

// Of a face: its area, its unit normal, and for each corner the integral of its share times the distance to
// the surface along the normal.
struct FaceFit {
  double area = 0;
  Vector3 normal = Vector3::Zero();
  std::array<double, 3> moment = {0, 0, 0};
};

class Fitting {
 public:
  Fitting(const ImplicitFunction& function, TriangleMesh& mesh) : function_(function), mesh_(mesh) {}

  void run(const Progress& progress) {
    measure_faces(progress.part(0, 0.6, "fitting the surface"));
    find_normals();
    const std::vector<Vector3> before = mesh_.vertices;
    const Eigen::VectorXd ways = solve();
    for (Index v = 0; v < before.size(); ++v) {
      const double limit = longest_way * shortest_[v];
      mesh_.vertices[v] = as_stored(before[v] + std::clamp(ways[v], -limit, limit) * normals_[v]);
    }
    progress.update(0.7);
    take_back(before, progress);
  }

 private:
  const Vector3& corner(const Triangle& t, int k) const {
    return mesh_.vertices[t[static_cast<std::size_t>(k)]];
  }

  FaceFit measured(const Triangle& t) const {
    FaceFit fit;
    const Vector3 &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
    const Vector3 normal = (b - a).cross(c - a);
    fit.area = 0.5 * normal.norm();
    if (!(fit.area > 0)) return fit;
    fit.normal = normal.normalized();
    const double longest =
        std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    const Vector3 step = slope_step * longest * fit.normal;
    for (std::size_t rule = 0; rule < 2; ++rule)
      for (int k = 0; k < 3; ++k) {
        std::array<double, 3> share;
        share.fill(0.5 - 0.5 * corner_share[rule]);
        share[static_cast<std::size_t>(k)] = corner_share[rule];
        const Vector3 at = share[0] * a + share[1] * b + share[2] * c;
        const double rise = function_.value(at + step) - function_.value(at - step);
        if (!(rise > 0)) continue;  // no surface that faces this way
        const double distance = -2 * slope_step * longest * function_.value(at) / rise;
        if (std::abs(distance) > farthest * longest) continue;
        for (std::size_t i = 0; i < 3; ++i) fit.moment[i] += weight[rule] * fit.area * share[i] * distance;
      }
    return fit;
  }

  void measure_faces(const Progress& progress) {
    faces_.resize(mesh_.triangles.size());
    for_each(faces_.size(), faces_per_task, progress,
             [&](std::size_t f) { faces_[f] = measured(mesh_.triangles[f]); });
  }

  void find_normals() {
    normals_.assign(mesh_.vertices.size(), Vector3::Zero());
    shortest_.assign(mesh_.vertices.size(), std::numeric_limits<double>::infinity());
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const Triangle& t = mesh_.triangles[f];
      for (int k = 0; k < 3; ++k) {
        const Vector3 u = corner(t, (k + 1) % 3) - corner(t, k), v = corner(t, (k + 2) % 3) - corner(t, k);
        normals_[t[static_cast<std::size_t>(k)]] +=
            std::atan2(u.cross(v).norm(), u.dot(v)) * faces_[f].normal;
        for (std::size_t end : {static_cast<std::size_t>(k), static_cast<std::size_t>((k + 1) % 3)})
          shortest_[t[end]] = std::min(shortest_[t[end]], u.norm());
      }
    }
    for (Vector3& n : normals_) n.normalize();  // leaves zero as it is
  }

  // How far each vertex moves along its normal: the least squares.
  Eigen::VectorXd solve() const {
    const auto count = static_cast<Eigen::Index>(mesh_.vertices.size());
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const Triangle& t = mesh_.triangles[f];
      std::array<double, 3> along;
      for (std::size_t i = 0; i < 3; ++i) along[i] = faces_[f].normal.dot(normals_[t[i]]);
      for (std::size_t i = 0; i < 3; ++i) {
        right[t[i]] += along[i] * faces_[f].moment[i];
        for (std::size_t j = 0; j < 3; ++j)
          entries.emplace_back(t[i], t[j], faces_[f].area / (i == j ? 6 : 12) * along[i] * along[j]);
      }
    }
    Eigen::SparseMatrix<double> matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
    solver.setTolerance(tolerance);
    solver.compute(matrix);
    return solver.solve(right);
  }

  // Vertices of faces that meet go back to where they were.
  void take_back(const std::vector<Vector3>& before, const Progress& progress) {
    for (int round = 0; round < most_rounds; ++round) {
      progress.check();
      std::vector<std::array<Vector3, 3>> corners;
      for (const Triangle& t : mesh_.triangles) corners.push_back({corner(t, 0), corner(t, 1), corner(t, 2)});
      const auto pairs = improper_pairs(corners);
      if (pairs.empty()) return;
      bool any = false;
      for (const auto& [a, b] : pairs)
        for (const auto face : {a, b})
          for (Index v : mesh_.triangles[face]) {
            any |= mesh_.vertices[v] != before[v];
            mesh_.vertices[v] = before[v];
          }
      if (!any) return;  // they met before
    }
    mesh_.vertices = before;
  }

  const ImplicitFunction& function_;
  TriangleMesh& mesh_;
  std::vector<FaceFit> faces_;
  std::vector<Vector3> normals_;
  std::vector<double> shortest_;  // edge of each vertex
};

}  // namespace

void fit_to_surface(const ImplicitFunction& function, TriangleMesh& mesh, const Progress& progress) {
  Fitting(function, mesh).run(progress);
}

}  // namespace meshcomplete
