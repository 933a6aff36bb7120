#include "common/core/fairing.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "common/core/disjoint_sets.h"
#include "common/core/error.h"

namespace meshcomplete {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;
using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 3>;
using Cholesky = Eigen::SimplicialLDLT<SparseMatrix>;

constexpr const char* stage = "computing the minimum-energy surface";

// Cotangents are bounded as if no angle were outside 3 to 177 degrees: needles of the rim's ring would
// otherwise rule the whole system, and negative weights could make it indefinite.
constexpr double largest_cotangent = 19.0;
// The least weight of an edge, relative to the cotangent weight 1/sqrt(3) of an equilateral mesh's edge:
// about 1 %.
constexpr double smallest_weight = 0.006;

// The descent of the normal variation: its steps, the first one's longest move relative to the surface's
// diagonal, and how often a step that does not lower the energy is halved. After these steps the energy falls
// by less than a percent a step.
constexpr int descent_steps = 30;
constexpr double first_move = 1e-3;
constexpr int most_halvings = 12;

// The same descent from a shape that is not to be forgotten: its steps. Chosen by trial: with 5 more of the
// shape's own flaws remain, from 8 to 30 results hardly differ.
constexpr int near_steps = 10;

double bounded_cotangent(const Vector3& u, const Vector3& v) {
  const double area = u.cross(v).norm();
  const double inner = u.dot(v);
  if (!(area * largest_cotangent > std::abs(inner)))
    return inner > 0 ? largest_cotangent : -largest_cotangent;
  return inner / area;
}

// The symmetric Laplacian L (positive semi-definite) and the lumped masses of a surface.
struct Laplacian {
  SparseMatrix matrix;
  Eigen::VectorXd mass;
};

Laplacian uniform_laplacian(const TriangleMesh& surface) {
  const Eigen::Index n = static_cast<Eigen::Index>(surface.vertices.size());
  Triplets triplets;
  for (const Triangle& t : surface.triangles)
    for (int k = 0; k < 3; ++k) {
      triplets.emplace_back(t[k], t[(k + 1) % 3], 1.0);
      triplets.emplace_back(t[(k + 1) % 3], t[k], 1.0);
    }
  SparseMatrix adjacency(n, n);
  adjacency.setFromTriplets(triplets.begin(), triplets.end(), [](double, double) { return 1.0; });
  Laplacian laplacian;
  laplacian.mass = adjacency * Eigen::VectorXd::Ones(n);
  laplacian.matrix = -adjacency;
  laplacian.matrix += SparseMatrix(laplacian.mass.asDiagonal());
  return laplacian;
}

Laplacian cotangent_laplacian(const TriangleMesh& surface) {
  const Eigen::Index n = static_cast<Eigen::Index>(surface.vertices.size());
  Triplets triplets;
  Laplacian laplacian;
  laplacian.mass = Eigen::VectorXd::Zero(n);
  for (const Triangle& t : surface.triangles) {
    const Vector3 &a = surface.vertices[t[0]], &b = surface.vertices[t[1]], &c = surface.vertices[t[2]];
    const double third = (b - a).cross(c - a).norm() / 6.0;
    for (int k = 0; k < 3; ++k) {
      const Index i = t[k], j = t[(k + 1) % 3], o = t[(k + 2) % 3];
      const double weight = 0.5 * bounded_cotangent(surface.vertices[i] - surface.vertices[o],
                                                    surface.vertices[j] - surface.vertices[o]);
      triplets.emplace_back(i, j, weight);
      triplets.emplace_back(j, i, weight);
      laplacian.mass[i] += third;
    }
  }
  SparseMatrix weights(n, n);
  weights.setFromTriplets(triplets.begin(), triplets.end());
  for (Eigen::Index k = 0; k < weights.nonZeros(); ++k)
    weights.valuePtr()[k] = std::max(weights.valuePtr()[k], smallest_weight);
  const Eigen::VectorXd diagonal = weights * Eigen::VectorXd::Ones(n);
  laplacian.matrix = -weights;
  laplacian.matrix += SparseMatrix(diagonal.asDiagonal());
  // A vertex of needles only would get no mass and infinite stiffness.
  const double mean = laplacian.mass.sum() / static_cast<double>(std::max<Eigen::Index>(n, 1));
  laplacian.mass = laplacian.mass.cwiseMax(1e-3 * mean);
  return laplacian;
}

Laplacian make_laplacian(const TriangleMesh& surface, LaplacianWeights weights) {
  return weights == LaplacianWeights::uniform ? uniform_laplacian(surface) : cotangent_laplacian(surface);
}

// Splits the vertices into unknowns and knowns.
struct Numbering {
  std::vector<Eigen::Index> unknown;  // number among the unknowns, or -1
  std::vector<Index> free_vertices;
  SparseMatrix pick_free, pick_fixed;  // columns of the identity

  explicit Numbering(const std::vector<char>& fixed) : unknown(fixed.size(), -1) {
    Triplets free, known;
    for (Index v = 0; v < fixed.size(); ++v) {
      if (fixed[v]) {
        known.emplace_back(v, static_cast<Eigen::Index>(known.size()), 1.0);
      } else {
        unknown[v] = static_cast<Eigen::Index>(free_vertices.size());
        free.emplace_back(v, unknown[v], 1.0);
        free_vertices.push_back(v);
      }
    }
    const Eigen::Index n = static_cast<Eigen::Index>(fixed.size());
    pick_free.resize(n, static_cast<Eigen::Index>(free.size()));
    pick_free.setFromTriplets(free.begin(), free.end());
    pick_fixed.resize(n, static_cast<Eigen::Index>(known.size()));
    pick_fixed.setFromTriplets(known.begin(), known.end());
  }
};

Coordinates coordinates_of(const TriangleMesh& surface) {
  Coordinates x(static_cast<Eigen::Index>(surface.vertices.size()), 3);
  for (std::size_t v = 0; v < surface.vertices.size(); ++v)
    x.row(static_cast<Eigen::Index>(v)) = surface.vertices[v].transpose();
  return x;
}

void set_free(TriangleMesh& surface, const Numbering& numbering, const Coordinates& solution) {
  for (std::size_t i = 0; i < numbering.free_vertices.size(); ++i)
    surface.vertices[numbering.free_vertices[i]] = solution.row(static_cast<Eigen::Index>(i)).transpose();
}

void factorize(Cholesky& solver, const SparseMatrix& matrix) {
  solver.compute(matrix);
  if (solver.info() != Eigen::Success || !(solver.vectorD().array() > 0).all())
    throw CompletionError(stage, "The equations of the minimum-energy surface have no unique solution.");
}

// Solves energy x' Q x -> min over the free rows of x.
void minimize_quadratic(TriangleMesh& surface, const Numbering& numbering, const SparseMatrix& energy) {
  const SparseMatrix rows = numbering.pick_free.transpose() * energy;
  const SparseMatrix system = rows * numbering.pick_free;
  Coordinates x = coordinates_of(surface);
  for (Index v : numbering.free_vertices) x.row(v).setZero();
  Cholesky solver;
  factorize(solver, system);
  set_free(surface, numbering, solver.solve(-(rows * x)));
}

void minimize_membrane(TriangleMesh& surface, const Numbering& numbering, LaplacianWeights weights) {
  minimize_quadratic(surface, numbering, make_laplacian(surface, weights).matrix);
}

// The thin plate's equations. With one equation U^2 = 0 for every unknown the least sum of squares is zero,
// and these equations, multiplied by the masses, are the rows L M^-1 L of the free vertices. The rows of the
// rim's vertices in the inner L bring in the ring.
struct ThinPlate {
  Laplacian laplacian;
  SparseMatrix weighted;  // M^-1 L, columns of the free vertices
  Cholesky solver;

  ThinPlate(const TriangleMesh& surface, const Numbering& numbering, LaplacianWeights weights)
      : laplacian(make_laplacian(surface, weights)) {
    const SparseMatrix inner = laplacian.matrix * numbering.pick_free;
    // Kept in a vector: Eigen evaluates an expression anew for every column.
    const Eigen::VectorXd inverse_mass = laplacian.mass.cwiseInverse();
    weighted = inverse_mass.asDiagonal() * inner;
    factorize(solver, inner.transpose() * weighted);
  }

  void minimize(TriangleMesh& surface, const Numbering& numbering) const {
    Coordinates x = coordinates_of(surface);
    for (Index v : numbering.free_vertices) x.row(v).setZero();
    const Coordinates right = -(weighted.transpose() * (laplacian.matrix * x));
    set_free(surface, numbering, solver.solve(right));
  }
};

// Two triangles that share an edge, at least one of them with a free corner, and the edge's length.
struct Hinge {
  Index left, right;
  double length;
};

std::vector<Hinge> find_hinges(const TriangleMesh& surface, const std::vector<char>& fixed) {
  struct Side {
    Index low, high, triangle;
  };
  std::vector<Side> sides;
  std::vector<char> still;
  for (Index f = 0; f < surface.triangles.size(); ++f) {
    const Triangle& t = surface.triangles[f];
    still.push_back(fixed[t[0]] && fixed[t[1]] && fixed[t[2]]);
    for (int k = 0; k < 3; ++k)
      sides.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3]), f});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  std::vector<Hinge> hinges;
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const Side &a = sides[i - 1], &b = sides[i];
    if (a.low != b.low || a.high != b.high || (still[a.triangle] && still[b.triangle])) continue;
    hinges.push_back({a.triangle, b.triangle, (surface.vertices[a.low] - surface.vertices[a.high]).norm()});
  }
  return hinges;
}

// The sum over hinges of length times |n - n'|^2 / 2, and its gradient.
class NormalVariation {
 public:
  NormalVariation(const TriangleMesh& surface, const std::vector<char>& fixed)
      : hinges_(find_hinges(surface, fixed)) {}

  double value(const TriangleMesh& surface) {
    update_normals(surface);
    double sum = 0;
    for (const Hinge& hinge : hinges_)
      sum += hinge.length * (1.0 - normals_[hinge.left].dot(normals_[hinge.right]));
    return sum;
  }

  /// One row per vertex, at the positions of the last call of `value`. A normal N / |N| with N = a x b + b x
  /// c + c x a answers to a shift of a by the part of (shift x (b - c)) / |N| across the normal.
  Coordinates gradient(const TriangleMesh& surface) const {
    std::vector<Vector3> by_normal(normals_.size(), Vector3::Zero());
    for (const Hinge& hinge : hinges_) {
      by_normal[hinge.left] -= hinge.length * normals_[hinge.right];
      by_normal[hinge.right] -= hinge.length * normals_[hinge.left];
    }
    Coordinates gradient = Coordinates::Zero(static_cast<Eigen::Index>(surface.vertices.size()), 3);
    for (std::size_t f = 0; f < normals_.size(); ++f) {
      if (!(areas_[f] > 0)) continue;
      const Vector3 across = (by_normal[f] - normals_[f] * normals_[f].dot(by_normal[f])) / areas_[f];
      const Triangle& t = surface.triangles[f];
      for (int k = 0; k < 3; ++k) {
        const Vector3 side = surface.vertices[t[(k + 1) % 3]] - surface.vertices[t[(k + 2) % 3]];
        gradient.row(t[k]) += side.cross(across).transpose();
      }
    }
    return gradient;
  }

 private:
  void update_normals(const TriangleMesh& surface) {
    normals_.clear();
    areas_.clear();
    for (const Triangle& t : surface.triangles) {
      const Vector3 n = (surface.vertices[t[1]] - surface.vertices[t[0]])
                            .cross(surface.vertices[t[2]] - surface.vertices[t[0]]);
      areas_.push_back(n.norm());
      normals_.push_back(areas_.back() > 0 ? Vector3(n / areas_.back()) : Vector3::Zero());
    }
  }

  std::vector<Hinge> hinges_;
  std::vector<Vector3> normals_;
  std::vector<double> areas_;  // twice
};

// How far a descent goes: in steps, and in the longest way from its start.
struct DescentLimits {
  int steps;
  double largest_move;
};

// Gradient descent of the normal variation in the thin plate's own metric, in which steps are smooth and few
// are needed: the two energies agree to first order on a nearly flat patch.
void descend(TriangleMesh& surface, const std::vector<char>& fixed, const Numbering& numbering,
             const Cholesky& metric, const DescentLimits& limits, const Progress& progress) {
  NormalVariation variation(surface, fixed);
  double energy = variation.value(surface), step = 0;
  const Coordinates first = numbering.pick_free.transpose() * coordinates_of(surface);
  for (int i = 0; i < limits.steps; ++i) {
    const Coordinates direction = metric.solve(numbering.pick_free.transpose() * variation.gradient(surface));
    const double longest = direction.rowwise().norm().maxCoeff();
    if (!(longest > 0)) return;
    if (i == 0) step = first_move / longest;
    const TriangleMesh before = surface;
    const Coordinates start = numbering.pick_free.transpose() * coordinates_of(surface);
    double trial = energy;
    bool too_far = false;
    for (int halvings = 0; halvings < most_halvings; ++halvings, step *= 0.5) {
      const Coordinates next = start - step * direction;
      set_free(surface, numbering, next);
      trial = variation.value(surface);
      too_far = (next - first).rowwise().norm().maxCoeff() > limits.largest_move;
      if (trial < energy && !too_far) break;
    }
    if (!(trial < energy) || too_far) {
      surface = before;
      return;
    }
    energy = trial;
    step *= 2;
    progress.update((i + 1.0) / limits.steps);
  }
}

void minimize_normal_variation(TriangleMesh& surface, const std::vector<char>& fixed,
                               const Numbering& numbering, LaplacianWeights weights,
                               const Progress& progress) {
  const ThinPlate plate(surface, numbering, weights);
  plate.minimize(surface, numbering);
  descend(surface, fixed, numbering, plate.solver, {descent_steps, std::numeric_limits<double>::infinity()},
          progress);
}

// Rounding can keep the pivots of a singular system positive, so that its cause has to be looked for.
void expect_anchored(const TriangleMesh& surface, const std::vector<char>& fixed) {
  DisjointSets pieces(fixed.size());
  for (const Triangle& t : surface.triangles) {
    pieces.unite(t[1], t[0]);
    pieces.unite(t[2], t[0]);
  }
  std::vector<char> anchored(fixed.size(), 0);
  for (Index v = 0; v < fixed.size(); ++v)
    if (fixed[v]) anchored[pieces.root(v)] = 1;
  for (Index v = 0; v < fixed.size(); ++v)
    if (!anchored[pieces.root(v)])
      throw CompletionError(stage, "A piece of the surface is joined to nothing that holds it.");
}

// Centre and unit size: the masses' units and the rounding of far-away coordinates drop out of the equations
// that `solve` solves.
template <typename Solve>
void solve_at_unit_size(TriangleMesh& surface, const std::vector<char>& fixed, const Solve& solve) {
  const Numbering numbering(fixed);
  if (numbering.free_vertices.empty()) return;
  expect_anchored(surface, fixed);
  Eigen::AlignedBox3d box;
  for (const Vector3& p : surface.vertices) box.extend(p);
  const Vector3 centre = box.center();
  const double scale = box.diagonal().norm();
  if (!(scale > 0)) throw CompletionError(stage, "All vertices round the hole lie at one point.");
  const std::vector<Vector3> before = surface.vertices;
  for (Vector3& p : surface.vertices) p = (p - centre) / scale;
  solve(numbering);
  for (std::size_t v = 0; v < before.size(); ++v)
    surface.vertices[v] = fixed[v] ? before[v] : Vector3(surface.vertices[v] * scale + centre);
}

}  // namespace

const char* name(SurfaceEnergy energy) {
  switch (energy) {
    case SurfaceEnergy::membrane:
      return "membrane";
    case SurfaceEnergy::thin_plate:
      return "thin plate";
    case SurfaceEnergy::normal_variation:
      return "normal variation";
  }
  return "";
}

void minimize_energy(TriangleMesh& surface, const std::vector<char>& fixed, SurfaceEnergy energy,
                     LaplacianWeights weights, const Progress& progress) {
  solve_at_unit_size(surface, fixed, [&](const Numbering& numbering) {
    progress.check();
    switch (energy) {
      case SurfaceEnergy::membrane:
        minimize_membrane(surface, numbering, weights);
        break;
      case SurfaceEnergy::thin_plate:
        ThinPlate(surface, numbering, weights).minimize(surface, numbering);
        break;
      case SurfaceEnergy::normal_variation:
        minimize_normal_variation(surface, fixed, numbering, weights, progress);
        break;
    }
  });
}

void lower_normal_variation(TriangleMesh& surface, const std::vector<char>& fixed, double largest_move,
                            const Progress& progress) {
  solve_at_unit_size(surface, fixed, [&](const Numbering& numbering) {
    progress.check();
    const ThinPlate plate(surface, numbering, LaplacianWeights::cotangent);
    descend(surface, fixed, numbering, plate.solver, {near_steps, largest_move}, progress);
  });
}

}  // namespace meshcomplete
