#include "filter_curveunfold/self_avoiding_descent.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "filter_curveunfold/planar_stretch.h"
#include "filter_curveunfold/repulsive_flow.h"
#include "filter_curveunfold/triangle_moves.h"

namespace meshcomplete {
namespace {

/// Points that the flow works with where the shape allows it. A step costs a few milliseconds then.
constexpr std::size_t flow_points = 96;

/// Where it does not: at most so many, taken out without regard to the shape.
constexpr std::size_t most_flow_points = 160;

/// The quadrature's pieces: long edges are cut to this share of the perimeter.
constexpr double pieces_per_loop = 96;

/// Steps at constant edge lengths; the loops met so far unfold in 1 to 40 or not at all this way.
constexpr int shape_steps = 120;

/// Rounds of reducing and flowing by turns, and steps in each.
constexpr int rounds = 8;
constexpr int round_steps = 60;

/// What a reduction without regard to the shape keeps strands apart by (the loop is about 1 across), so that
/// the flow finds room to move, and the angle in radians that it keeps between neighbouring edges.
constexpr double reduced_clearance = 1e-4;
constexpr double reduced_angle = 1e-3;

/// Steps in the plane that give a polygon whose shape was lost back its edge lengths, more or less.
constexpr int opening_steps = 20;

/// Directions of projection looked at after each step, and when a stage is over.
constexpr int quick_directions = 12;
constexpr int thorough_directions = 48;

double perimeter(const Loop& loop) {
  const std::vector<double> lengths = edge_lengths(loop);
  return std::accumulate(lengths.begin(), lengths.end(), 0.0);
}

/// A loop on its way to the plane: all points' positions, and which of them are there.
struct Traveller {
  Loop position;
  ReducedLoop reduced;

  Loop shape() const { return kept_points(position, reduced); }

  void move_to(const Loop& shape) {
    for (std::size_t k = 0; k < shape.size(); ++k) position[reduced.kept[k]] = shape[k];
  }
};

/// Takes out what the flow does not need. The heights are shares of the loop's size.
void simplify(Traveller& traveller, const Progress& progress) {
  const double length = perimeter(traveller.position);
  ReductionLimits limits;
  limits.least_points = std::min<std::size_t>(flow_points, traveller.position.size() / 2 + 3);
  limits.largest_height = 0.02;
  limits.longest_chord = 2.5 * length / static_cast<double>(flow_points);
  limits.clearance_share = 1;
  limits.least_angle = 0.3;
  // One edge much shorter than the others would dominate the energy and hold every step up.
  limits.shortest_edge = 0.2 * length / static_cast<double>(std::min(traveller.position.size(), flow_points));
  reduce(traveller.position, limits, traveller.reduced, progress);
  if (traveller.reduced.kept.size() <= most_flow_points) return;
  limits.least_points = most_flow_points;
  limits.largest_height = 0.1;
  limits.longest_chord *= 3;
  limits.clearance_share = 0.25;
  limits.least_angle = 0.05;
  reduce(traveller.position, limits, traveller.reduced, progress);
  if (traveller.reduced.kept.size() <= most_flow_points) return;
  limits = ReductionLimits();
  limits.least_points = most_flow_points;
  reduce(traveller.position, limits, traveller.reduced, progress);
}

/// Flows until a projection is simple or the steps are used up.
std::optional<Polygon> flow(Traveller& traveller, FlowConstraint constraint, int steps, DescentResult& result,
                            const Progress& progress) {
  const Loop start = traveller.shape();
  const double piece = perimeter(start) / pieces_per_loop;
  RepulsiveFlow repulsion(start, edge_lengths(start), constraint, piece);
  std::optional<Polygon> polygon;
  for (int k = 0; k < steps; ++k) {
    progress.check();
    polygon = simple_projection(repulsion.loop(), quick_directions);
    if (polygon) break;
    ++result.steps;
    if (!repulsion.step()) break;
  }
  traveller.move_to(repulsion.loop());
  if (!polygon) polygon = simple_projection(repulsion.loop(), thorough_directions);
  return polygon;
}

/// Reduces without regard to the shape, a third of the points at a time, until a projection is simple.
std::optional<Polygon> reduce_until_simple(Traveller& traveller, const Progress& progress) {
  ReductionLimits limits;
  limits.least_clearance = reduced_clearance;
  limits.least_angle = reduced_angle;
  std::size_t before = 0;
  do {
    before = traveller.reduced.kept.size();
    limits.least_points = std::max<std::size_t>(3, before * 2 / 3);
    reduce(traveller.position, limits, traveller.reduced, progress);
    if (std::optional<Polygon> polygon = simple_projection(traveller.shape(), thorough_directions))
      return polygon;
  } while (traveller.reduced.kept.size() < before);
  return std::nullopt;
}

/// The polygon of all points from that of the points kept, when rounding has not spoilt it.
std::optional<Polygon> completed(const Traveller& traveller, const Polygon& polygon) {
  Polygon result = reinserted(polygon, traveller.reduced);
  if (!is_simple(result)) return std::nullopt;
  return result;
}

}  // namespace

DescentResult descend(const Loop& loop, const Progress& progress) {
  DescentResult result;
  Traveller traveller{loop, unreduced(loop.size())};
  simplify(traveller, progress);
  std::optional<Polygon> polygon =
      flow(traveller, FlowConstraint::edge_lengths, shape_steps, result, progress);
  if (polygon) result.polygon = completed(traveller, *polygon);
  if (result.polygon) return result;
  // What follows does not look at the shape: the loop as it was given is the best to start from.
  traveller = {loop, unreduced(loop.size())};
  for (int round = 0; round < rounds && !result.polygon; ++round) {
    progress.update(static_cast<double>(round) / rounds);
    polygon = reduce_until_simple(traveller, progress);
    if (!polygon) polygon = flow(traveller, FlowConstraint::total_length, round_steps, result, progress);
    if (polygon) result.polygon = completed(traveller, *polygon);
  }
  if (result.polygon) {
    PlanarStretch opened = stretched(*result.polygon, loop, opening_steps, progress);
    result.polygon = std::move(opened.polygon);
    result.steps += opened.steps;
  }
  return result;
}

}  // namespace meshcomplete
