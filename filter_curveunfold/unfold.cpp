#include "filter_curveunfold/unfold.h"

#include <chrono>
#include <cmath>

#include "common/core/error.h"
#include "filter_curveunfold/annealing.h"
#include "filter_curveunfold/crossing_removal.h"
#include "filter_curveunfold/knot.h"
#include "filter_curveunfold/loop_geometry.h"
#include "filter_curveunfold/planar_stretch.h"
#include "filter_curveunfold/self_avoiding_descent.h"
#include "filter_curveunfold/triangle_moves.h"

namespace meshcomplete {
namespace {

/// From so many points on crossings are removed one by one where that is enough. The descent unfolds shorter
/// loops within milliseconds, and to more open polygons.
constexpr std::size_t least_long_loop = 128;

/// Steps within the plane when the caller wants a more open polygon: most are nearly convex by then. Long
/// loops flow with as many points as the planar stretch takes at most, where each step costs its full few
/// milliseconds.
constexpr int stretch_steps = 60;
constexpr int long_stretch_steps = 40;

void validate(const std::vector<Vector3>& loop) {
  const char* stage = "unfolding a boundary loop";
  if (loop.size() < 3) throw CompletionError(stage, "A boundary loop needs at least three points.");
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (!loop[i].allFinite()) {
      throw CompletionError(stage, "A boundary loop has a point whose coordinates are not finite numbers.");
    }
    if (loop[i] == loop[(i + 1) % loop.size()]) {
      throw CompletionError(stage, "Two consecutive points of a boundary loop coincide.");
    }
  }
}

void validate(const UnfoldOptions& options) {
  const char* stage = "unfolding a boundary loop";
  if (options.restarts < 1 || options.restarts > 10000) {
    throw CompletionError(stage, "The number of annealing runs must be between 1 and 10000.");
  }
  if (!(options.min_distance >= 1e-9 && options.min_distance <= 1e-2)) {
    throw CompletionError(stage, "The least distance of the annealing must be between 1e-9 and 1e-2.");
  }
  if (!(options.cooling > 0 && options.cooling < 1)) {
    throw CompletionError(stage, "The rate of cooling of the annealing must be above 0 and below 1.");
  }
  if (!(options.start_temperature > 0 && std::isfinite(options.start_temperature))) {
    throw CompletionError(stage, "The start temperature of the annealing must be positive.");
  }
}

/// The loop centred and scaled to a bounding box with a diagonal of 1, so that every later tolerance is
/// relative.
Loop normalised(const std::vector<Vector3>& loop) {
  Vector3 low = loop[0], high = loop[0];
  for (const Vector3& p : loop) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  // Halves and scaled differences: neither the sum of the corners nor the squared diagonal may overflow.
  const Vector3 centre = low / 2 + high / 2;
  const double largest = (high / 2 - low / 2).maxCoeff();
  const double diagonal = 2 * ((high / 2 - low / 2) / largest).norm();
  Loop result(loop.size());
  for (std::size_t i = 0; i < loop.size(); ++i) result[i] = (loop[i] - centre) / largest / diagonal;
  return result;
}

/// Whether an invariant proves the loop knotted; fills in what was found out about it.
bool is_certified_knot(const Loop& loop, Unfolding& result, const Progress& progress) {
  // Fary and Milnor: a knot turns by more than 4 pi. The margin is far above the rounding of the sum of
  // angles.
  if (result.total_curvature < 4 * 3.14159265358979 * (1 - 1e-9)) return false;
  ReducedLoop reduced = unreduced(loop.size());
  reduce(loop, ReductionLimits(), reduced, progress);
  result.knot_determinant =
      reduced.kept.size() < 6 ? 1 : knot_determinant(kept_points(loop, reduced), progress);
  return result.knot_determinant && *result.knot_determinant != 1;
}

void unfold_by_annealing(const Loop& loop, const UnfoldOptions& options, Unfolding& result,
                         const Progress& progress) {
  AnnealingResult annealing = anneal(loop, options, progress);
  result.restarts = annealing.runs;
  result.steps += annealing.steps;
  if (!annealing.polygon) return;
  result.outcome = UnfoldOutcome::annealed;
  result.polygon = std::move(*annealing.polygon);
}

/// Before the test for knots: a loop that comes out of this is none.
void remove_crossings(const Loop& loop, Unfolding& result, const Progress& progress) {
  CrossingRemoval removal = remove_crossings(loop, progress);
  result.steps += removal.moves;
  if (!removal.polygon) return;
  result.outcome = UnfoldOutcome::untangled;
  result.polygon = std::move(*removal.polygon);
}

void untangle(const Loop& loop, Unfolding& result, const Progress& progress) {
  DescentResult descent = descend(loop, progress);
  result.steps += descent.steps;
  if (!descent.polygon) return;
  result.outcome = UnfoldOutcome::untangled;
  result.polygon = std::move(*descent.polygon);
}

}  // namespace

const char* name(UnfoldOutcome outcome) {
  switch (outcome) {
    case UnfoldOutcome::projected:
      return "projected";
    case UnfoldOutcome::annealed:
      return "annealed";
    case UnfoldOutcome::untangled:
      return "untangled";
    case UnfoldOutcome::knotted:
      return "knotted";
    case UnfoldOutcome::not_unfolded:
      return "not unfolded";
  }
  return "";
}

Unfolding unfold(const std::vector<Vector3>& input, const UnfoldOptions& options, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  validate(input);
  validate(options);
  progress.check();
  const Loop loop = normalised(input);
  Unfolding result;
  result.total_curvature = total_curvature(loop);
  if (options.method == UnfoldMethod::automatic) {
    if (std::optional<Polygon> polygon = simple_projection(loop, projection_directions)) {
      result.outcome = UnfoldOutcome::projected;
      result.polygon = std::move(*polygon);
    } else if (loop.size() >= least_long_loop) {
      remove_crossings(loop, result, progress);
    }
  }
  if (result.polygon.empty()) {
    if (is_certified_knot(loop, result, progress)) {
      result.outcome = UnfoldOutcome::knotted;
    } else if (options.method == UnfoldMethod::annealing) {
      unfold_by_annealing(loop, options, result, progress);
    } else {
      untangle(loop, result, progress);
    }
  }
  if (options.stretch && !result.polygon.empty()) {
    const int steps = loop.size() >= least_long_loop ? long_stretch_steps : stretch_steps;
    PlanarStretch opened = stretched(result.polygon, loop, steps, progress);
    result.polygon = std::move(opened.polygon);
    result.steps += opened.steps;
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace meshcomplete
