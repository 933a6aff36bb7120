#include "filter_curveunfold/knot.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "filter_curveunfold/loop_tree.h"

namespace meshcomplete {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// The two largest primes below 2^31: products fit 64 bits, and together they tell all values up to 2^61
/// apart.
constexpr std::array<std::uint64_t, 2> primes = {2147483647u, 2147483629u};

/// Directions of projection that are tried; the one with the fewest crossings is used.
constexpr int tried_directions = 12;

/// More would take longer than a user waits for a hole.
constexpr std::size_t most_crossings = 1000;

/// Crossings along an edge nearer than this share of the edge are not told apart: the direction is not
/// generic.
constexpr double least_parameter_gap = 1e-11;

/// Rotating a loop of size 1 moves its points by some 1e-16; strands this far apart cannot pass through each
/// other.
constexpr double least_strand_distance = 1e-13;

/// One passage of an edge through a crossing.
struct Passage {
  std::size_t edge;
  double parameter;
  std::size_t crossing;
  bool over;
};

struct Diagram {
  std::size_t crossings = 0;
  std::vector<Passage> passages;  // in the order of the loop
};

Kernel::Point_2 flat(const Vector3& p) { return {p.x(), p.y()}; }
Kernel::Point_3 exact_point(const Vector3& p) { return {p.x(), p.y(), p.z()}; }

/// The knot diagram seen along the z axis; absent when it is not generic or has too many crossings.
std::optional<Diagram> diagram_along_z(const Loop& loop, std::size_t limit) {
  const std::size_t n = loop.size();
  Loop shadow = loop;
  for (Vector3& p : shadow) p.z() = 0;
  Diagram diagram;
  const bool generic = LoopTree(shadow).for_each_overlapping_pair([&](std::size_t i, std::size_t j) {
    const Vector3 &a = loop[i], &b = loop[(i + 1) % n], &c = loop[j], &d = loop[(j + 1) % n];
    if (j == i + 1) return CGAL::orientation(flat(a), flat(b), flat(d)) != CGAL::COLLINEAR;
    if (i == 0 && j + 1 == n) return CGAL::orientation(flat(c), flat(d), flat(b)) != CGAL::COLLINEAR;
    const auto ab_c = CGAL::orientation(flat(a), flat(b), flat(c));
    const auto ab_d = CGAL::orientation(flat(a), flat(b), flat(d));
    const auto cd_a = CGAL::orientation(flat(c), flat(d), flat(a));
    const auto cd_b = CGAL::orientation(flat(c), flat(d), flat(b));
    if (ab_c == ab_d && ab_c != CGAL::COLLINEAR) return true;
    if (cd_a == cd_b && cd_a != CGAL::COLLINEAR) return true;
    if (ab_c == CGAL::COLLINEAR || ab_d == CGAL::COLLINEAR || cd_a == CGAL::COLLINEAR ||
        cd_b == CGAL::COLLINEAR) {
      return false;
    }
    const auto volume = CGAL::orientation(exact_point(a), exact_point(b), exact_point(c), exact_point(d));
    if (volume == CGAL::COPLANAR) return false;
    const bool second_over = (volume == CGAL::POSITIVE) != (ab_d == CGAL::LEFT_TURN);
    const Vector3 u = b - a, v = d - c, w = c - a;
    const double denominator = u.x() * v.y() - u.y() * v.x();
    const double s = (w.x() * v.y() - w.y() * v.x()) / denominator;
    const double t = (w.x() * u.y() - w.y() * u.x()) / denominator;
    diagram.passages.push_back({i, s, diagram.crossings, !second_over});
    diagram.passages.push_back({j, t, diagram.crossings, second_over});
    return ++diagram.crossings < limit;
  });
  if (!generic) return std::nullopt;
  std::sort(diagram.passages.begin(), diagram.passages.end(), [](const Passage& a, const Passage& b) {
    return std::tie(a.edge, a.parameter) < std::tie(b.edge, b.parameter);
  });
  for (std::size_t k = 1; k < diagram.passages.size(); ++k) {
    const Passage &a = diagram.passages[k - 1], &b = diagram.passages[k];
    if (a.edge == b.edge && b.parameter - a.parameter < least_parameter_gap) return std::nullopt;
  }
  return diagram;
}

std::uint64_t power(std::uint64_t base, std::uint64_t exponent, std::uint64_t prime) {
  std::uint64_t result = 1;
  for (; exponent > 0; exponent /= 2, base = base * base % prime) {
    if (exponent % 2 == 1) result = result * base % prime;
  }
  return result;
}

using ColouringMatrix = std::vector<std::vector<std::int8_t>>;

/// A minor of the colouring matrix: the last crossing and the last arc left out.
ColouringMatrix colouring_minor(const Diagram& diagram) {
  const std::size_t c = diagram.crossings;
  ColouringMatrix matrix(c, std::vector<std::int8_t>(c, 0));
  std::size_t arc = 0;  // an arc ends where it passes below another
  for (const Passage& passage : diagram.passages) {
    std::vector<std::int8_t>& row = matrix[passage.crossing];
    if (passage.over) {
      row[arc] = static_cast<std::int8_t>(row[arc] + 2);
      continue;
    }
    --row[arc];
    arc = (arc + 1) % c;
    --row[arc];
  }
  matrix.pop_back();
  for (std::vector<std::int8_t>& row : matrix) row.pop_back();
  return matrix;
}

std::uint64_t determinant_modulo(const ColouringMatrix& matrix, std::uint64_t prime,
                                 const Progress& progress) {
  const std::size_t n = matrix.size();
  std::vector<std::vector<std::uint64_t>> m(n, std::vector<std::uint64_t>(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      m[i][j] = matrix[i][j] < 0 ? prime - static_cast<std::uint64_t>(-matrix[i][j])
                                 : static_cast<std::uint64_t>(matrix[i][j]);
    }
  }
  std::uint64_t determinant = 1;
  for (std::size_t k = 0; k < n; ++k) {
    progress.check();
    std::size_t pivot = k;
    while (pivot < n && m[pivot][k] == 0) ++pivot;
    if (pivot == n) return 0;
    if (pivot != k) {
      std::swap(m[pivot], m[k]);
      determinant = (prime - determinant) % prime;
    }
    determinant = determinant * m[k][k] % prime;
    const std::uint64_t inverse = power(m[k][k], prime - 2, prime);
    for (std::size_t i = k + 1; i < n; ++i) {
      if (m[i][k] == 0) continue;
      const std::uint64_t factor = prime - m[i][k] * inverse % prime;
      for (std::size_t j = k; j < n; ++j) m[i][j] = (m[i][j] + factor * m[k][j]) % prime;
    }
  }
  return determinant;
}

/// The absolute value of a number that is `first` and `second` modulo the two primes, when it fits an int.
int smallest_magnitude(std::uint64_t first, std::uint64_t second) {
  constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
  // Chinese remainders: x = first + primes[0] * k with k = (second - first) / primes[0] modulo primes[1].
  const std::uint64_t p = primes[0], q = primes[1];
  const std::uint64_t difference = (second + q - first % q) % q;
  const std::uint64_t x = first + p * (difference * power(p % q, q - 2, q) % q);
  return static_cast<int>(std::min({x, p * q - x, most}));
}

}  // namespace

std::optional<int> knot_determinant(const Loop& loop, const Progress& progress) {
  if (LoopTree(loop).least_distance(loop, 1.0) < least_strand_distance) return std::nullopt;
  std::optional<Diagram> best;
  for (const Vector3& normal : half_sphere_directions(tried_directions)) {
    const ProjectionPlane plane = plane_with_normal(normal);
    Loop turned(loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i) {
      turned[i] = Vector3(loop[i].dot(plane.u), loop[i].dot(plane.v), loop[i].dot(plane.normal));
    }
    // Diagrams that have no fewer crossings are not looked at to their end.
    std::optional<Diagram> diagram = diagram_along_z(turned, best ? best->crossings : most_crossings);
    if (diagram) best = std::move(diagram);
    if (best && best->crossings < 3) return 1;
  }
  if (!best) return std::nullopt;
  const ColouringMatrix matrix = colouring_minor(*best);
  const std::uint64_t first = determinant_modulo(matrix, primes[0], progress);
  const std::uint64_t second = determinant_modulo(matrix, primes[1], progress);
  return smallest_magnitude(first, second);
}

}  // namespace meshcomplete
