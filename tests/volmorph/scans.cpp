#include "tests/volmorph/scans.h"

#include <Eigen/Geometry>
#include <cmath>

namespace meshcomplete {
namespace test {
namespace {

constexpr Index missed = 0xffffffffu;

/// A grid of lines of sight, row by row; the last column may be joined to the first.
RangeScan triangulate(const Solid& solid, const std::vector<Sight>& sights, int columns, bool joined) {
  RangeScan scan;
  std::vector<Index> numbers;
  for (const Sight& sight : sights) {
    const std::optional<SolidHit> hit = solid(sight);
    numbers.push_back(hit ? static_cast<Index>(scan.mesh.vertices.size()) : missed);
    if (hit) scan.mesh.vertices.push_back(sight.sensor + hit->distance * sight.direction);
  }
  const int rows = static_cast<int>(sights.size()) / columns;
  const auto add = [&](Index a, Index b, Index c) {
    if (a != missed && b != missed && c != missed) scan.mesh.triangles.push_back({a, b, c});
  };
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column < columns - (joined ? 0 : 1); ++column) {
      const auto at = [&](int r, int c) { return numbers[std::size_t(r) * columns + c % columns]; };
      const Index a = at(row, column), b = at(row, column + 1), c = at(row + 1, column + 1),
                  d = at(row + 1, column);
      add(a, b, c);
      add(a, c, d);
    }
  }
  return scan;
}

}  // namespace

Solid sphere(const Vector3& centre, double radius) {
  return [=](const Sight& sight) -> std::optional<SolidHit> {
    const Vector3 from = sight.sensor - centre;
    const double half = -from.dot(sight.direction);
    const double square = half * half - from.squaredNorm() + radius * radius;
    if (square < 0) return {};
    const double distance = half - std::sqrt(square);
    return SolidHit{distance, (from + distance * sight.direction) / radius};
  };
}

Solid cavity(const Vector3& centre, double radius) {
  return [=](const Sight& sight) -> std::optional<SolidHit> {
    const Vector3 from = sight.sensor - centre;
    const double half = -from.dot(sight.direction);
    const double distance = half + std::sqrt(half * half - from.squaredNorm() + radius * radius);
    return SolidHit{distance, -(from + distance * sight.direction) / radius};
  };
}

Solid half_space(const Vector3& point, const Vector3& normal) {
  return [=](const Sight& sight) -> std::optional<SolidHit> {
    const double rate = -normal.dot(sight.direction);
    if (rate <= 0) return {};
    return SolidHit{normal.dot(sight.sensor - point) / rate, normal};
  };
}

Solid part_of(const Solid& solid, const std::function<bool(const Vector3&)>& holds) {
  return [=](const Sight& sight) -> std::optional<SolidHit> {
    const std::optional<SolidHit> hit = solid(sight);
    if (!hit || !holds(sight.sensor + hit->distance * sight.direction)) return {};
    return hit;
  };
}

Solid both(const Solid& a, const Solid& b) {
  return [=](const Sight& sight) -> std::optional<SolidHit> {
    const std::optional<SolidHit> first = a(sight), second = b(sight);
    if (!first || (second && second->distance < first->distance)) return second;
    return first;
  };
}

Sight sight_through(const LineOfSight& line_of_sight, const Vector3& point, double far) {
  if (line_of_sight.kind == LineOfSight::Kind::viewpoint) {
    return {line_of_sight.vector, (point - line_of_sight.vector).normalized()};
  }
  const Vector3 towards = line_of_sight.vector.normalized();
  return {point + far * towards, -towards};
}

RangeScan scan(const Solid& solid, const LineOfSight& line_of_sight, const Vector3& middle, double spacing,
               int n) {
  const Vector3 towards = line_of_sight.towards_sensor(middle);
  const Vector3 right = towards.unitOrthogonal(), up = towards.cross(right);
  std::vector<Sight> sights;
  for (int row = -n; row <= n; ++row) {
    for (int column = -n; column <= n; ++column) {
      sights.push_back(sight_through(line_of_sight, middle + spacing * (column * right + row * up)));
    }
  }
  RangeScan result = triangulate(solid, sights, 2 * n + 1, false);
  result.line_of_sight = line_of_sight;
  return result;
}

RangeScan scan_all_around(const Solid& solid, const Vector3& viewpoint, int n) {
  std::vector<Sight> sights;
  for (int row = 0; row <= n; ++row) {
    // The rings next to the poles are small, but no ring is a point.
    const double latitude = M_PI * (0.01 + 0.98 * row / n) - M_PI / 2;
    for (int column = 0; column < 2 * n; ++column) {
      const double longitude = -M_PI * column / n;  // seen from within
      sights.push_back({viewpoint, Vector3(std::cos(latitude) * std::cos(longitude),
                                           std::cos(latitude) * std::sin(longitude), std::sin(latitude))});
    }
  }
  RangeScan result = triangulate(solid, sights, 2 * n, true);
  result.line_of_sight = LineOfSight::from(viewpoint);
  return result;
}

}  // namespace test
}  // namespace meshcomplete
