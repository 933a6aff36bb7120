#include "common/core/screened_poisson.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <utility>

#include "common/core/error.h"
#include "common/core/threads.h"

namespace meshcomplete {
namespace {

using Level = CornerOctree::Level;
using Values = std::vector<double>;
using Vectors = std::vector<Vector3>;
using CubeMatrix = std::array<double, 36>;  // symmetric, the upper half by rows

constexpr std::size_t grain = 1024;      // corners or samples in one go of a thread
constexpr std::size_t block_grain = 64;  // blocks: as much work
// Samples between two looks whether the user wants to stop: about a millisecond.
constexpr std::size_t samples_per_check = 16384;
constexpr double jump = 0.5;  // of the function to either side of the surface: V has the length 1

// A number for each child of a block: the same arithmetic for all eight at once.
using Octet = Eigen::Array<double, 8, 1>;

// Walsh-Hadamard transform of the values at the corners of cubes, which makes their stiffness matrix
// diagonal.
void transform(std::array<Octet, 8>& v) {
  for (int stride = 1; stride < 8; stride *= 2)
    for (int i = 0; i < 8; ++i)
      if (!(i & stride)) {
        const Octet difference = v[i] - v[i + stride];
        v[i] += v[i + stride];
        v[i + stride] = difference;
      }
}

// Of the stiffness matrix of the unit cube, over 8 for the two transforms: along an axis the derivative has
// the values 0 and 2, the mass 1/2 and 1/6, for the sum and the difference of the ends.
std::array<double, 8> stiffness_values() {
  std::array<double, 8> values{};
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 3; ++k) {
      if (!(i >> k & 1)) continue;
      double product = 2;
      for (int other : {(k + 1) % 3, (k + 2) % 3}) product *= i >> other & 1 ? 1.0 / 6 : 1.0 / 2;
      values[i] += product / 8;
    }
  return values;
}

// The integral over the unit cube of trilinear V_j times the derivative along `axis` of corner i's function.
double divergence_entry(int i, int j, int axis) {
  double product = i >> axis & 1 ? 0.5 : -0.5;
  for (int other : {(axis + 1) % 3, (axis + 2) % 3})
    product *= (i >> other & 1) == (j >> other & 1) ? 1.0 / 3 : 1.0 / 6;
  return product;
}

// Trilinear weights of the eight corners at a place in the unit cube.
std::array<double, 8> corner_weights(const std::array<double, 3>& x) {
  std::array<double, 8> weights;
  for (int c = 0; c < 8; ++c)
    weights[c] = (c & 1 ? x[0] : 1 - x[0]) * (c >> 1 & 1 ? x[1] : 1 - x[1]) * (c >> 2 ? x[2] : 1 - x[2]);
  return weights;
}

// How much each corner of a cube counts at the 27 places of its eight children.
std::array<std::array<double, 8>, 27> prolongation() {
  std::array<std::array<double, 8>, 27> weights;
  for (int place = 0; place < 27; ++place)
    weights[place] = corner_weights({place % 3 / 2.0, place / 3 % 3 / 2.0, place / 9 / 2.0});
  return weights;
}

// Calls `body(block)` for all blocks of a level in threads, never at once for two that have a corner in
// common, and for those round one corner always in the same order.
template <class Body>
void for_blocks(const Level& level, const Progress& progress, const Body& body) {
  for (const std::vector<Index>& group : level.groups)
    for_each(group.size(), block_grain, progress, [&](std::size_t i) { body(group[i]); });
}

class Solver {
 public:
  Solver(const Lattice& lattice, const std::vector<OrientedSample>& samples,
         const ScreenedPoissonOptions& options, const Progress& progress)
      : lattice_(lattice), samples_(samples), options_(options) {
    std::vector<WantedCube> wanted;
    for (const OrientedSample& s : samples) wanted.push_back({lattice.snap(s.position), s.depth});
    octree_ = std::make_shared<CornerOctree>(wanted, options.min_depth, CornerOctree::Balance::two_to_one,
                                             progress);
    cube_of_.assign(wanted.size(), 0);
    points_.reserve(wanted.size());
    for (const WantedCube& one : wanted) points_.push_back(one.point);
  }

  PoissonSolution run(const Progress& progress);

 private:
  struct Place {
    Index cube;
    std::array<double, 8> weights;
  };
  int depth() const { return octree_->depth(); }
  double side(int depth) const { return lattice_.side() / static_cast<double>(std::int64_t{1} << depth); }
  void to_root() { std::fill(cube_of_.begin(), cube_of_.end(), Index(0)); }
  void descend(int depth, const Progress& progress);
  Place place_of(std::size_t sample) const;
  std::array<Index, 8> parent_corners(int depth, Index block) const;

  template <class Value>
  void add_interpolated(int depth, const std::vector<Value>& coarse, std::vector<Value>& fine,
                        const Progress& progress) const;

  Vectors spread_normals(int depth, const Progress& progress) const;
  std::vector<Values> right_hand_sides(const Progress& progress);
  void screen(int depth, std::vector<Index>& matrix_of, std::vector<CubeMatrix>& matrices,
              const Progress& progress) const;
  PoissonLevelFigures solve_level(int depth, const Values& right, Values& u, const Progress& progress) const;
  double mean_at_samples(const std::vector<Values>& values) const;

  const Lattice& lattice_;
  const std::vector<OrientedSample>& samples_;
  const ScreenedPoissonOptions& options_;
  std::shared_ptr<CornerOctree> octree_;
  std::vector<LatticePoint> points_;  // of the samples
  std::vector<Index> cube_of_;        // that holds each sample, at the depth that is looked at
  const std::array<std::array<double, 8>, 27> prolongation_ = prolongation();
};

// To the cubes of at most this depth, from such of any smaller one.
void Solver::descend(int depth, const Progress& progress) {
  const Octree& octree = octree_->octree();
  for_each(cube_of_.size(), grain, progress, [&](std::size_t s) {
    Index& cube = cube_of_[s];
    while (!octree.is_leaf(cube) && octree[cube].depth < depth) {
      const LatticePoint middle = octree.centre(cube);
      Index child = octree[cube].children;
      for (int k = 0; k < 3; ++k) child += points_[s][k] >= middle[k] ? 1u << k : 0;
      cube = child;
    }
  });
}

Solver::Place Solver::place_of(std::size_t sample) const {
  const Octree::Cube& cube = octree_->octree()[cube_of_[sample]];
  const double side = static_cast<double>(Octree::side(cube.depth));
  std::array<double, 3> x;
  for (int k = 0; k < 3; ++k) x[k] = static_cast<double>(points_[sample][k] - cube.low[k]) / side;
  return {cube_of_[sample], corner_weights(x)};
}

std::array<Index, 8> Solver::parent_corners(int depth, Index block) const {
  return octree_->corners(octree_->parent(octree_->level(depth).first_block + block));
}

// Adds to a level's values those of the coarser level between its corners.
template <class Value>
void Solver::add_interpolated(int depth, const std::vector<Value>& coarse, std::vector<Value>& fine,
                              const Progress& progress) const {
  const Level& level = octree_->level(depth);
  for_each(level.corner_count, grain, progress, [&](std::size_t i) {
    const auto [block, place] = level.owner[i];
    const std::array<Index, 8> parents = parent_corners(depth, block);
    for (int c = 0; c < 8; ++c) fine[i] += prolongation_[place][c] * coarse[parents[c]];
  });
}

// The area normals that are spread from this depth, as a density at the corners: spread over the corners
// round them and once more over the neighbours of these.
Vectors Solver::spread_normals(int depth, const Progress& progress) const {
  const Level& level = octree_->level(depth);
  Vectors density(level.corner_count, Vector3::Zero());
  const double volume = std::pow(side(depth), 3);
  for (std::size_t s = 0; s < samples_.size(); ++s) {
    if (s % samples_per_check == 0) progress.check();
    if (samples_[s].depth - samples_[s].coarsening != depth) continue;
    const Place place = place_of(s);
    const std::array<Index, 8> corners = octree_->corners(place.cube);
    for (int c = 0; c < 8; ++c) density[corners[c]] += place.weights[c] / volume * samples_[s].area_normal;
  }
  Vectors smooth(level.corner_count, Vector3::Zero());
  for_blocks(level, progress, [&](Index block) {
    const CornerOctree::BlockCorners& corners = level.corners[block];
    for (int child = 0; child < 8; ++child)
      for (int i = 0; i < 8; ++i) {
        Vector3 sum = Vector3::Zero();
        for (int j = 0; j < 8; ++j) {
          double mass = 1;
          for (int k = 0; k < 3; ++k) mass *= (i >> k & 1) == (j >> k & 1) ? 1.0 / 3 : 1.0 / 6;
          sum += mass * density[corners[CornerOctree::corner_place(child, j)]];
        }
        smooth[corners[CornerOctree::corner_place(child, i)]] += sum;
      }
  });
  return smooth;
}

// Of every level the integrals of V times the gradients of the corners' functions.
std::vector<Values> Solver::right_hand_sides(const Progress& progress) {
  std::vector<Vectors> density(depth());
  to_root();
  for (int d = 1; d <= depth(); ++d) {
    descend(d, progress);
    density[d - 1] = spread_normals(d, progress);
    if (d > 1) add_interpolated(d, density[d - 2], density[d - 1], progress);
  }
  double entry[8][8][3];
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      for (int k = 0; k < 3; ++k) entry[i][j][k] = divergence_entry(i, j, k);
  std::vector<Values> right(depth());
  for (int d = depth(); d >= 1; --d) {
    const Level& level = octree_->level(d);
    Values& sums = right[d - 1];
    sums.resize(level.corner_count, 0.0);
    const double area = side(d) * side(d);
    for_blocks(level, progress, [&](Index block) {
      const CornerOctree::BlockCorners& corners = level.corners[block];
      for (int child = 0; child < 8; ++child) {
        if (!octree_->octree().is_leaf(CornerOctree::first_cube(level.first_block + block) + child)) continue;
        for (int j = 0; j < 8; ++j) {
          const Vector3& v = density[d - 1][corners[CornerOctree::corner_place(child, j)]];
          if (v.isZero(0)) continue;
          for (int i = 0; i < 8; ++i)
            sums[corners[CornerOctree::corner_place(child, i)]] +=
                area * (entry[i][j][0] * v[0] + entry[i][j][1] * v[1] + entry[i][j][2] * v[2]);
        }
      }
    });
    if (d == 1) break;
    Values& coarse = right[d - 2];
    coarse.assign(octree_->level(d - 1).corner_count, 0.0);
    for (std::size_t i = 0; i < level.corner_count; ++i) {
      if (sums[i] == 0) continue;
      const auto [block, place] = level.owner[i];
      const std::array<Index, 8> parents = parent_corners(d, block);
      for (int c = 0; c < 8; ++c) coarse[parents[c]] += prolongation_[place][c] * sums[i];
    }
  }
  return right;
}

// The samples' part of the equations of a level: a matrix for every cube with samples. `matrix_of` is by
// 8 * block + child.
void Solver::screen(int depth, std::vector<Index>& matrix_of, std::vector<CubeMatrix>& matrices,
                    const Progress& progress) const {
  const Level& level = octree_->level(depth);
  matrix_of.assign(8 * level.corners.size(), Octree::none);
  const double weight =
      options_.screening * (depth < this->depth() ? options_.coarse_screening : 1) / side(depth);
  const Index first = CornerOctree::first_cube(level.first_block);
  for (std::size_t s = 0; s < samples_.size(); ++s) {
    if (s % samples_per_check == 0) progress.check();
    const Place place = place_of(s);
    if (octree_->octree()[place.cube].depth != depth) continue;
    Index& number = matrix_of[place.cube - first];
    if (number == Octree::none) {
      number = static_cast<Index>(matrices.size());
      matrices.emplace_back();
      matrices.back().fill(0);
    }
    const double scale = weight * samples_[s].area_normal.norm();
    double* entry = matrices[number].data();
    for (int i = 0; i < 8; ++i)
      for (int j = i; j < 8; ++j) *entry++ += scale * place.weights[i] * place.weights[j];
  }
}

// The equations of one level.
class LevelEquations {
 public:
  LevelEquations(const Level& level, double side, const std::vector<Index>& matrix_of,
                 const std::vector<CubeMatrix>& matrices, std::vector<char> free)
      : level_(level), matrix_of_(matrix_of), matrices_(matrices), free_(std::move(free)) {
    values_ = stiffness_values();
    for (double& v : values_) v *= side;
  }

  const std::vector<char>& free() const { return free_; }

  // result = A u, at free corners; 0 at the others.
  void apply(const Values& u, Values& result, const Progress& progress) const {
    std::fill(result.begin(), result.end(), 0.0);
    for_blocks(level_, progress, [&](Index block) {
      const CornerOctree::BlockCorners& corners = level_.corners[block];
      std::array<double, 27> in, out{};
      for (int i = 0; i < 27; ++i) in[i] = u[corners[i]];
      std::array<Octet, 8> v;
      for (int c = 0; c < 8; ++c)
        for (int child = 0; child < 8; ++child) v[c][child] = in[CornerOctree::corner_place(child, c)];
      transform(v);
      for (int c = 0; c < 8; ++c) v[c] *= values_[c];
      transform(v);
      for (int child = 0; child < 8; ++child) {
        const Index number = matrix_of_[8 * block + child];
        if (number != Octree::none) add_product(matrices_[number], child, in, v);
        for (int c = 0; c < 8; ++c) out[CornerOctree::corner_place(child, c)] += v[c][child];
      }
      for (int i = 0; i < 27; ++i)
        if (free_[corners[i]]) result[corners[i]] += out[i];
    });
  }

  Values diagonal(const Progress& progress) const {
    Values result(free_.size(), 0.0);
    double own = 0;
    for (double v : values_) own += v;
    for_blocks(level_, progress, [&](Index block) {
      for (int child = 0; child < 8; ++child) {
        const Index number = matrix_of_[8 * block + child];
        int entry = 0;
        for (int c = 0; c < 8; ++c) {
          double& sum = result[level_.corners[block][CornerOctree::corner_place(child, c)]];
          sum += own;
          if (number != Octree::none) sum += matrices_[number][entry];
          entry += 8 - c;
        }
      }
    });
    return result;
  }

 private:
  static void add_product(const CubeMatrix& matrix, int child, const std::array<double, 27>& in,
                          std::array<Octet, 8>& sum) {
    const double* entry = matrix.data();
    for (int i = 0; i < 8; ++i) {
      const double own = in[CornerOctree::corner_place(child, i)];
      double total = *entry++ * own;
      for (int j = i + 1; j < 8; ++j, ++entry) {
        total += *entry * in[CornerOctree::corner_place(child, j)];
        sum[j][child] += *entry * own;
      }
      sum[i][child] += total;
    }
  }

  const Level& level_;
  const std::vector<Index>& matrix_of_;
  const std::vector<CubeMatrix>& matrices_;
  std::vector<char> free_;
  std::array<double, 8> values_;
};

double dot(const Values& a, const Values& b) {
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(0, a.size(), 16 * grain), 0.0,
      [&](const tbb::blocked_range<std::size_t>& range, double sum) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) sum += a[i] * b[i];
        return sum;
      },
      std::plus<double>());
}

// Conjugate gradients with the diagonal as preconditioner.
PoissonLevelFigures minimise(const LevelEquations& equations, const Values& right, Values& u,
                             int most_iterations, double tolerance, const Progress& progress) {
  const std::vector<char>& free = equations.free();
  const std::size_t n = u.size();
  PoissonLevelFigures figures;
  Values r(n), z(n, 0.0), p(n, 0.0), q(n), masked(n, 0.0);
  const Values diagonal = equations.diagonal(progress);
  equations.apply(u, q, progress);
  for (std::size_t i = 0; i < n; ++i) {
    figures.unknowns += free[i] != 0;
    masked[i] = free[i] ? right[i] : 0;
    r[i] = masked[i] - q[i];
  }
  const double scale = std::sqrt(dot(masked, masked));
  double rz = 0;
  for (; figures.iterations <= most_iterations; ++figures.iterations) {
    figures.residual = scale > 0 ? std::sqrt(dot(r, r)) / scale : 0;
    if (figures.residual <= tolerance || figures.iterations == most_iterations) break;
    for (std::size_t i = 0; i < n; ++i) z[i] = free[i] ? r[i] / diagonal[i] : 0;
    const double next = dot(r, z), keep = figures.iterations == 0 ? 0 : next / rz;
    if (!(next > 0)) break;
    rz = next;
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + keep * p[i];
    equations.apply(p, q, progress);
    const double step = rz / dot(p, q);
    for (std::size_t i = 0; i < n; ++i) {
      u[i] += step * p[i];
      r[i] -= step * q[i];
    }
  }
  return figures;
}

PoissonLevelFigures Solver::solve_level(int depth, const Values& right, Values& u,
                                        const Progress& progress) const {
  const Level& level = octree_->level(depth);
  std::vector<char> free(level.corner_count);
  const bool dirichlet = options_.boundary == PoissonBoundary::dirichlet;
  for (std::size_t i = 0; i < free.size(); ++i) free[i] = level.inner[i] && !(dirichlet && level.outside[i]);
  std::vector<Index> matrix_of;
  std::vector<CubeMatrix> matrices;
  screen(depth, matrix_of, matrices, progress);
  const LevelEquations equations(level, side(depth), matrix_of, matrices, std::move(free));
  return minimise(equations, right, u, options_.iterations, options_.tolerance, progress);
}

// Weighted by the area.
double Solver::mean_at_samples(const std::vector<Values>& values) const {
  double sum = 0, weights = 0;
  for (std::size_t s = 0; s < samples_.size(); ++s) {
    const Place place = place_of(s);
    const Values& level = values[octree_->octree()[place.cube].depth - 1];
    const std::array<Index, 8> corners = octree_->corners(place.cube);
    const double weight = samples_[s].area_normal.norm();
    for (int c = 0; c < 8; ++c) sum += weight * place.weights[c] * level[corners[c]];
    weights += weight;
  }
  return sum / weights;
}

PoissonSolution Solver::run(const Progress& progress) {
  const char* const stage = "solving the Poisson equation";
  const std::vector<Values> right = right_hand_sides(progress.part(0, 0.2, stage));
  std::vector<Values> values(depth());
  std::vector<PoissonLevelFigures> figures;
  to_root();
  for (int d = 1; d <= depth(); ++d) {
    // A level has about four times the cubes of the one before.
    const Progress part =
        progress.part(0.2 + 0.8 * std::pow(4, d - 1 - depth()), 0.2 + 0.8 * std::pow(4, d - depth()), stage);
    Values& u = values[d - 1];
    u.assign(octree_->level(d).corner_count,
             d == 1 && options_.boundary == PoissonBoundary::dirichlet ? jump : 0.0);
    if (d > 1) add_interpolated(d, values[d - 2], u, part);
    descend(d, part);
    figures.push_back(solve_level(d, right[d - 1], u, part));
    part.update(1);
  }
  const double iso = mean_at_samples(values);
  return {OctreeField(lattice_, octree_, std::move(values), iso), std::move(figures)};
}

}  // namespace

PoissonSolution solve_screened_poisson(const Lattice& lattice, const std::vector<OrientedSample>& samples,
                                       const ScreenedPoissonOptions& options, const Progress& progress) {
  if (samples.empty())
    throw CompletionError("solving the Poisson equation", "There is no surface to start from.");
  return Solver(lattice, samples, options, progress).run(progress);
}

}  // namespace meshcomplete
