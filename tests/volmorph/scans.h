// Range scans of solids that are given by formulas.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "filter_volmorph/scan_merge.h"

namespace meshcomplete {
namespace test {

/// A line of sight starts at the sensor; `direction` is unit.
struct Sight {
  Vector3 sensor, direction;
};

/// Where a line of sight meets a solid first.
struct SolidHit {
  double distance = 0;  ///< from the sensor
  Vector3 normal = Vector3::UnitZ();
};
using Solid = std::function<std::optional<SolidHit>(const Sight&)>;

Solid sphere(const Vector3& centre, double radius);
/// A sphere seen from within.
Solid cavity(const Vector3& centre, double radius);
/// All below a plane; `normal` is unit.
Solid half_space(const Vector3& point, const Vector3& normal);
/// The part of another solid's surface where the condition holds.
Solid part_of(const Solid& solid, const std::function<bool(const Vector3&)>& holds);
Solid both(const Solid& a, const Solid& b);

/// The line of sight through a point; where the lines are parallel the sensor is `far` away from the point.
Sight sight_through(const LineOfSight& line_of_sight, const Vector3& point, double far = 100);

/// A square image of `(2 n + 1)^2` lines of sight `spacing` apart round the one through `middle`,
/// triangulated as range grids are, across depth steps. For a viewpoint `spacing` holds at the distance of
/// `middle`.
RangeScan scan(const Solid& solid, const LineOfSight& line_of_sight, const Vector3& middle, double spacing,
               int n);

/// The same all around a viewpoint, with `n` rings of latitude.
RangeScan scan_all_around(const Solid& solid, const Vector3& viewpoint, int n);

}  // namespace test
}  // namespace meshcomplete
