#include "tests/support/loop_families.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

namespace meshcomplete::testing {
namespace {

constexpr double pi = 3.14159265358979323846;

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

Vector3 in_ball(std::mt19937_64& random) {
  while (true) {
    const Vector3 p(2 * uniform(random) - 1, 2 * uniform(random) - 1, 2 * uniform(random) - 1);
    if (p.squaredNorm() <= 1) return p;
  }
}

/// Whether the segment pq passes through the triangle abc or comes so near one of its edges that it may.
bool may_meet(const Vector3& p, const Vector3& q, const Vector3& a, const Vector3& b, const Vector3& c) {
  constexpr double margin = 1e-3;
  // Sampled generously: the segment is walked in steps of half the margin only where its box comes near.
  const Vector3 low = a.cwiseMin(b).cwiseMin(c).array() - margin,
                high = a.cwiseMax(b).cwiseMax(c).array() + margin;
  if ((p.cwiseMin(q).array() > high.array()).any() || (p.cwiseMax(q).array() < low.array()).any())
    return false;
  const Vector3 normal = (b - a).cross(c - a).normalized();
  const auto inside = [&](const Vector3& x) {
    const auto left_of = [&](const Vector3& from, const Vector3& to) {
      return (to - from).normalized().cross(x - from).dot(normal) > -margin;
    };
    return left_of(a, b) && left_of(b, c) && left_of(c, a);
  };
  const double from = (p - a).dot(normal), to = (q - a).dot(normal);
  // The part of the segment within the margin of the triangle's plane, looked at in small steps.
  double first = 0, last = 1;
  if (std::abs(to - from) > 0) {
    const double s = (-margin - from) / (to - from), t = (margin - from) / (to - from);
    first = std::max(0.0, std::min(s, t));
    last = std::min(1.0, std::max(s, t));
  } else if (std::abs(from) > margin) {
    return false;
  }
  if (first > last) return false;
  const int steps = 1 + static_cast<int>(std::ceil((last - first) * (q - p).norm() / (margin / 2)));
  for (int k = 0; k <= steps; ++k) {
    if (inside(p + (first + (last - first) * k / steps) * (q - p))) return true;
  }
  return false;
}

}  // namespace

Loop sampled(int points, const std::function<Vector3(double)>& curve) {
  Loop loop;
  for (int i = 0; i < points; ++i) loop.push_back(curve(2 * pi * i / points));
  return loop;
}

Loop wound_rim(int points, int turns, double height) {
  return sampled(points, [=](double t) {
    const double radius = 1 + 0.35 * std::cos(t);
    return Vector3(radius * std::cos(turns * t), radius * std::sin(turns * t), height * std::sin(t));
  });
}

Loop wound_round_cylinder(int points, int turns) {
  return sampled(points, [=](double t) {
    const double rise = t < pi ? t / pi : 2 - t / pi;
    const double radius = 1 + 0.2 * std::sin(t);
    return Vector3(radius * std::cos(2 * pi * turns * rise), radius * std::sin(2 * pi * turns * rise), rise);
  });
}

Loop closed_helix(int points, int turns) {
  const int back = std::max(4, points / 5), wound = points - back;
  Loop loop;
  for (int i = 0; i < wound; ++i) {
    const double u = static_cast<double>(i) / (wound - 1);
    loop.emplace_back(std::cos(2 * pi * turns * u), std::sin(2 * pi * turns * u), u);
  }
  for (int i = 0; i < back; ++i) {
    const double u = static_cast<double>(i) / (back - 1);
    loop.emplace_back(1.5 + 0.1 * std::sin(pi * u), 0.3 * std::sin(pi * u), 1 - u);
  }
  return loop;
}

Loop saddle(int points, int waves, double height) {
  return sampled(points,
                 [=](double t) { return Vector3(std::cos(t), std::sin(t), height * std::cos(waves * t)); });
}

Loop torus_knot(int points, int p, int q) {
  return sampled(points, [=](double t) {
    const double radius = 2 + std::cos(q * t);
    return Vector3(radius * std::cos(p * t), radius * std::sin(p * t), std::sin(q * t));
  });
}

Loop figure_eight_knot(int points) {
  return sampled(points, [](double t) {
    const double radius = 2 + std::cos(2 * t);
    return Vector3(radius * std::cos(3 * t), radius * std::sin(3 * t), std::sin(4 * t));
  });
}

Loop random_tangle(int points, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Loop loop = {Vector3(1, 0, 0), Vector3(-0.5, 0.8, 0.1), Vector3(-0.5, -0.8, -0.1)};
  double reach = 1;  // how far from its edge a new point may be; shrinks while nothing fits
  while (loop.size() < static_cast<std::size_t>(points)) {
    const std::size_t n = loop.size();
    const std::size_t i = static_cast<std::size_t>(uniform(random) * static_cast<double>(n));
    const Vector3 &a = loop[i], &b = loop[(i + 1) % n];
    const Vector3 target = in_ball(random);
    const Vector3 apex = (a + b) / 2 + reach * (target - (a + b) / 2);
    if ((apex - a).norm() < 0.02 || (apex - b).norm() < 0.02) continue;
    bool clean = (apex - a).cross(b - a).norm() > 1e-2 * (apex - a).norm() * (b - a).norm();
    for (std::size_t j = 0; clean && j < n; ++j) {
      if (j == i) continue;
      Vector3 p = loop[j], q = loop[(j + 1) % n];
      // Neighbours touch the triangle at their common point: their first bit is left out.
      if ((j + 1) % n == i) q += (p - q) * std::min(0.5, 0.01 / (p - q).norm());
      if (j == (i + 1) % n) p += (q - p) * std::min(0.5, 0.01 / (q - p).norm());
      clean = !may_meet(p, q, a, b, apex);
    }
    if (clean) {
      loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(i) + 1, apex);
      reach = 1;
    } else {
      reach = std::max(0.02, reach * 0.97);
    }
  }
  return loop;
}

Loop rough_rim(int points, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const double reach = 2.6 + 1.2 * uniform(random);  // radians of longitude that the hole spans
  const double phase = 2 * pi * uniform(random);
  const double climb = 0.15 + 0.25 * uniform(random);
  const double half_width = 0.2 + 0.1 * uniform(random);
  const double step = 4 * reach / points;
  Loop loop;
  for (int i = 0; i < points; ++i) {
    // Out along one side of the hole's middle line and back along the other.
    const double t = 2.0 * i / points;
    const bool back = t >= 1;
    const double along = (back ? 2 - t : t) + (uniform(random) - 0.5) * 0.6 / points;
    // Odd and even points do not lie in line, as on the rim of a strip of triangles.
    const double zigzag = (i % 2 == 0 ? 1 : -1) * 0.25 * step * uniform(random);
    const double polar =
        pi / 2 + climb * std::sin(2.5 * along * reach + phase) + (back ? 1 : -1) * half_width + zigzag;
    const double around = along * reach;
    const double radius = 1 + 0.15 * (uniform(random) - 0.5);
    loop.push_back(radius * Vector3(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                                    std::cos(polar)));
  }
  return loop;
}

namespace {

struct GridPoint {
  std::int64_t x, y;
};

int orientation(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  // Differences have up to 52 bits: their products need 128.
  const __int128 left = static_cast<__int128>(b.x - a.x) * (c.y - a.y);
  const __int128 right = static_cast<__int128>(b.y - a.y) * (c.x - a.x);
  return left > right ? 1 : left < right ? -1 : 0;
}

bool in_box(const GridPoint& p, const GridPoint& a, const GridPoint& b) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

bool segments_meet(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  const int abc = orientation(a, b, c), abd = orientation(a, b, d);
  const int cda = orientation(c, d, a), cdb = orientation(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && in_box(c, a, b)) || (abd == 0 && in_box(d, a, b)) || (cda == 0 && in_box(a, c, d)) ||
         (cdb == 0 && in_box(b, c, d));
}

}  // namespace

Eigen::Vector2d on_grid(const Eigen::Vector2d& point) {
  return {std::ldexp(std::round(std::ldexp(point.x(), 40)), -40),
          std::ldexp(std::round(std::ldexp(point.y(), 40)), -40)};
}

bool is_simple_by_brute_force(const std::vector<Eigen::Vector2d>& polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) return false;
  std::vector<GridPoint> p;
  for (const Eigen::Vector2d& q : polygon) {
    p.push_back(
        {static_cast<std::int64_t>(std::ldexp(q.x(), 40)), static_cast<std::int64_t>(std::ldexp(q.y(), 40))});
  }
  for (std::size_t i = 0; i < n; ++i) {
    const GridPoint &a = p[i], &b = p[(i + 1) % n], &c = p[(i + 2) % n];
    if (a.x == b.x && a.y == b.y) return false;
    if (orientation(a, b, c) == 0 && (in_box(c, a, b) || in_box(a, b, c))) return false;
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j + 1 == n) continue;
      if (segments_meet(a, b, p[j], p[(j + 1) % n])) return false;
    }
  }
  return true;
}

Loop connected_sum(const Loop& first, const Loop& second) {
  const auto lower = [](const Vector3& a, const Vector3& b) { return a.z() < b.z(); };
  const std::ptrdiff_t low = std::min_element(first.begin(), first.end(), lower) - first.begin();
  const std::ptrdiff_t high = std::max_element(second.begin(), second.end(), lower) - second.begin();
  const Vector3 shift = first[static_cast<std::size_t>(low)] - second[static_cast<std::size_t>(high)];
  Loop result(first.begin() + low + 1, first.end());
  result.insert(result.end(), first.begin(), first.begin() + low);
  std::ptrdiff_t at = high;
  for (std::size_t k = 1; k < second.size(); ++k) {
    at = (at + 1) % static_cast<std::ptrdiff_t>(second.size());
    result.push_back(second[static_cast<std::size_t>(at)] + shift - Vector3(0, 0, 0.01));
  }
  return result;
}

}  // namespace meshcomplete::testing
