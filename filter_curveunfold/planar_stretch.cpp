#include "filter_curveunfold/planar_stretch.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "filter_curveunfold/repulsive_flow.h"
#include "filter_curveunfold/triangle_moves.h"

namespace meshcomplete {
namespace {

/// Points that the flow works with at most: a step takes some three milliseconds then, and its cost is cubic.
constexpr std::size_t most_points = 96;

/// The quadrature's pieces along the polygon.
constexpr double pieces_per_loop = 64;

/// Edges this near to their length, as a share of it, are long enough.
constexpr double length_tolerance = 0.05;

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Points of the polygon, in the plane z = 0, taken out until few enough are left: flat ones first.
ReducedLoop reduced_in_plane(const Loop& flat, double perimeter, const Progress& progress) {
  ReducedLoop reduced = unreduced(flat.size());
  ReductionLimits limits;
  limits.least_points = most_points;
  limits.clearance_share = 0.5;
  // Tiny edges would hold every step up; their points come back with the right length later on.
  limits.shortest_edge = 0.1 * perimeter / static_cast<double>(std::min(flat.size(), most_points));
  limits.longest_chord = 10 * perimeter / static_cast<double>(most_points);
  reduce(flat, limits, reduced, progress);
  return reduced;
}

bool is_convex_and_long_enough(const Loop& flat, const std::vector<double>& rest) {
  const std::size_t n = flat.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3 u = flat[(i + 1) % n] - flat[i], v = flat[(i + 2) % n] - flat[(i + 1) % n];
    if (u.x() * v.y() - u.y() * v.x() < 0) return false;
    if (std::abs(u.norm() - rest[i]) > length_tolerance * rest[i]) return false;
  }
  return true;
}

}  // namespace

PlanarStretch stretched(const Polygon& polygon, const Loop& loop, int steps, const Progress& progress) {
  Loop flat(polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i) flat[i] = Vector3(polygon[i].x(), polygon[i].y(), 0);
  const double perimeter = sum(edge_lengths(flat));
  const ReducedLoop reduced = reduced_in_plane(flat, perimeter, progress);
  Loop start = kept_points(flat, reduced);
  std::vector<double> rest = edge_lengths(kept_points(loop, reduced));
  // The flow counts on sizes of about 1, and on lengths that are right on the whole.
  const double scale = sum(edge_lengths(start)) / sum(rest);
  for (double& length : rest) length *= scale;
  RepulsiveFlow flow(start, rest, FlowConstraint::edge_lengths, sum(rest) / pieces_per_loop);
  PlanarStretch result{polygon, 0};
  int made = 0;
  while (made < steps && !is_convex_and_long_enough(flow.loop(), rest)) {
    progress.check();
    if (!flow.step()) break;
    ++made;
  }
  Polygon opened(flow.loop().size());
  for (std::size_t i = 0; i < opened.size(); ++i) opened[i] = flow.loop()[i].head<2>() / scale;
  opened = reinserted(opened, reduced);
  // Rounding may spoil a bump that had next to no room; the polygon as it was is simple for certain.
  if (made > 0 && is_simple(opened) && signed_area(opened) > 0)
    result = {opened, static_cast<std::size_t>(made)};
  return result;
}

}  // namespace meshcomplete
