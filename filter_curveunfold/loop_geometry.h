// Geometry of closed polygons: planes, projections, simplicity, distances between segments.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete {

using Vector2 = Eigen::Vector2d;

/// A closed polygon in space; edge i goes from point i to point i + 1, the last one back to point 0.
using Loop = std::vector<Vector3>;

/// A closed polygon in the plane, numbered like a loop.
using Polygon = std::vector<Vector2>;

/// The area that the polygon winds round, positive when counter-clockwise.
double signed_area(const Polygon& polygon);

/// Whether no two edges of the polygon meet except neighbours in their common point: no crossings, no
/// touching, no repeated points, no edge folded back on its neighbour. Exact. Cost: near-linear in the number
/// of points for polygons that are simple; stops at the first crossing.
bool is_simple(const Polygon& polygon);

/// Whether the segments ab and cd have a point in common. Exact.
bool segments_meet(const Vector2& a, const Vector2& b, const Vector2& c, const Vector2& d);

/// Whether the edges from b to a and from b to c have more than b in common. Exact.
bool folds_back(const Vector2& a, const Vector2& b, const Vector2& c);

/// The number of pairs of edges that keep the polygon from being simple, counted up to `most`. Exact.
std::size_t count_crossings(const Polygon& polygon, std::size_t most);

/// The plane of an orthogonal projection; `u`, `v` and `normal` are a right-handed orthonormal frame.
struct ProjectionPlane {
  Vector3 u;
  Vector3 v;
  Vector3 normal;
};

/// A frame round a unit normal, always the same for the same normal.
ProjectionPlane plane_with_normal(const Vector3& normal);

/// Orthogonal projection along the plane's normal.
Polygon project(const Loop& loop, const ProjectionPlane& plane);

/// The normal of the plane that minimises the sum of squared distances of the loop's points (least principal
/// axis).
Vector3 best_fitting_normal(const Loop& loop);

/// Square root of the least and of the greatest eigenvalue of the points' covariance.
struct PrincipalSpread {
  double least;
  double greatest;
};
PrincipalSpread principal_spread(const Loop& loop);

/// The vector whose length is the area that the loop's projection along it winds round (Newell); zero when
/// there is no such direction.
Vector3 area_vector(const Loop& loop);

/// `count` unit vectors spread evenly over a half sphere, none of them along an axis.
std::vector<Vector3> half_sphere_directions(int count);

/// The normals of the best-fitting plane and of that with the greatest projected area (if there is one), and
/// of `directions` others: in both groups those first that shorten the edges least.
std::vector<Vector3> fitted_normals(const Loop& loop);
std::vector<Vector3> spread_normals(const Loop& loop, int directions);

/// As many directions as are worth a try where it matters: about 23 degrees from one to the next.
constexpr int projection_directions = 48;

/// A simple projection of the loop, counter-clockwise. The best-fitting plane and the plane with the greatest
/// projected area first, then `directions` others, each time those first that shorten the edges least; the
/// first simple projection is taken.
///
/// Moving the loop's points to the plane along straight lines (all along the normal, in step) is free of
/// crossings exactly when the projection is simple: the positions along the plane never change during the
/// motion, so two points of the loop can meet only if they have the same projection, and those that have do
/// meet at the end. The projection being simple is therefore the whole of the paper's acceptance test
/// (section 3.1).
///
/// Cost: a simplicity test per direction tried.
std::optional<Polygon> simple_projection(const Loop& loop, int directions);

/// Where two segments ab and cd are nearest to each other.
struct ClosestPoints {
  double first;        ///< position on ab, 0 at a, 1 at b
  double second;       ///< position on cd
  Vector3 difference;  ///< from the point on cd to the point on ab
};
ClosestPoints closest_points(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

/// Squared distance between the segments ab and cd.
double squared_distance(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

/// Squared distance between the segment pq and the triangle abc; 0 when they meet.
double squared_distance_to_triangle(const Vector3& p, const Vector3& q, const Vector3& a, const Vector3& b,
                                    const Vector3& c);

/// The angle between two vectors, 0 to pi, accurate for all angles; 0 when one of them is zero.
double angle_between(const Vector3& a, const Vector3& b);

/// The lengths of the edges; edge i goes from point i to the next.
std::vector<double> edge_lengths(const Loop& loop);

/// The sum of the angles by which the loop turns at its points, radians; below 4 pi certifies an unknot
/// (Fary, Milnor).
double total_curvature(const Loop& loop);

}  // namespace meshcomplete
