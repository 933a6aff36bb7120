// How good a facet of a surface is, and what bad is.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "common/core/mesh.h"

namespace meshcomplete {

/// What a good facet is. Source: the paper's Q, section 2.1; Boissonnat and Oudot (2006).
struct RefinementCriteria {
  /// Target length of the edges at a point (mesh units, positive). Required.
  std::function<double(const Vector3&)> edge_length;
  /// A facet whose longest edge is longer than this many target lengths is refined. With this default the
  /// mean edge of a surface comes out at the target length.
  double longest = 1.5;
  /// A facet with a smaller angle is refined (degrees, 0 to 30; above 30 there may be no end).
  double smallest_angle = 27;
  /// A facet further from the surface than this, measured along its axis, is refined (mesh units, positive).
  /// Absent: no matter.
  std::optional<double> distance;
};

/// Facets that are less bad are so for their distance only.
constexpr double bad_shape = 0.5;

/// How bad a facet is: above 1 for edges that are too long, from `bad_shape` on for too small an angle, or
/// else below for too great a distance; 0 for a good one. `size` is the target edge length there;
/// `surface_centre` gives the point of the surface on the facet's axis, and is asked only when the distance
/// matters.
double badness(const std::array<Vector3, 3>& facet, double size, const RefinementCriteria& criteria,
               const std::function<std::optional<Vector3>()>& surface_centre);

/// The longest edge in parts of the longest that is allowed.
double length_ratio(const std::array<Vector3, 3>& facet, double size, const RefinementCriteria& criteria);

/// The centre of the circle through a facet's corners, where its plane meets its axis. Not finite for corners
/// on one line.
Vector3 axis_foot(const std::array<Vector3, 3>& facet);

}  // namespace meshcomplete
