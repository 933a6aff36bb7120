#include "filter_curveunfold/annealing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "filter_curveunfold/loop_tree.h"
#include "filter_curveunfold/safe_motion.h"

namespace meshcomplete {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Random steps at one temperature. Longer runs find no more: what unfolds does so while the loop is still
/// hot.
constexpr std::size_t steps_per_level = 60;

/// Accepted steps from one try of the projection to the next. A low energy does not make a projection simple
/// (a rim that winds twice has almost none), so that waiting for the end of the run would miss most
/// successes.
constexpr std::size_t steps_per_projection = 2;

/// The same for the projections in all directions, which take as much time as that many steps.
constexpr std::size_t steps_per_wide_projection = 64;

/// A run ends at this share of the start temperature: nothing is accepted any more that does not lower the
/// energy.
constexpr double end_temperature_share = 1e-3;

/// After a step that lowered the energy the next directions stay within this angle of the last (paper: 10
/// degrees).
constexpr double cone_angle = 10 * pi / 180;

/// Steps use no more than this share of the distance at which segments could touch, so that rounding cannot
/// matter.
constexpr double safety = 0.9;

/// Steps that take more than this share of the greatest room that the run has had so far are rejected. The
/// length of a step is proportional to the room: without this the walk shrinks its own steps and freezes on
/// the constraint.
constexpr double kept_room = 0.5;

/// Random numbers that are the same with every standard library (whose distributions are not).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// Evenly distributed on the unit sphere within `angle` of the unit vector `axis`.
  Vector3 direction_near(const Vector3& axis, double angle) {
    const double along = 1 - uniform() * (1 - std::cos(angle));
    const double across = std::sqrt(std::max(0.0, 1 - along * along));
    const double turn = 2 * pi * uniform();
    const ProjectionPlane frame = plane_with_normal(axis);
    return along * axis + across * (std::cos(turn) * frame.u + std::sin(turn) * frame.v);
  }

  Vector3 direction() { return direction_near(Vector3::UnitZ(), pi); }

 private:
  std::mt19937_64 engine_;
};

/// How much room a loop has to move.
struct Room {
  double distance;  ///< between the closest segments without a common point, the paper's d
  double folding;   ///< displacement at which two neighbouring segments could fold onto each other
};

Room room_of(const Loop& loop, const LoopTree& tree, double distance_bound) {
  const std::size_t n = loop.size();
  Room room{tree.least_distance(loop, distance_bound), std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < n; ++i) {
    room.folding = std::min(room.folding, folding_bound(loop[(i + n - 1) % n], loop[i], loop[(i + 1) % n]));
  }
  return room;
}

/// One run. Returns the polygon when it succeeded.
std::optional<Polygon> run(const Loop& start, const UnfoldOptions& options, Random& random,
                           std::size_t& steps, const Progress& progress, const AnnealingObserver& observer) {
  const std::size_t n = start.size();
  Loop loop = start, candidate(n);
  double energy = planarity_energy(loop);
  LoopTree tree(loop);
  Room room = room_of(loop, tree, 1.0);
  Room widest = room;
  std::vector<Vector3> direction(n);
  bool lowered = false;
  std::size_t accepted = 0;
  const double end_temperature = end_temperature_share * options.start_temperature;
  for (double temperature = options.start_temperature; temperature > end_temperature;
       temperature *= options.cooling) {
    for (std::size_t k = 0; k < steps_per_level; ++k, ++steps) {
      const double bound = safety * std::min((room.distance - options.min_distance) / 2, room.folding);
      if (!(bound > 0)) return std::nullopt;
      const double length = bound * (1 - random.uniform());
      for (std::size_t i = 0; i < n; ++i) {
        direction[i] = lowered ? random.direction_near(direction[i], cone_angle) : random.direction();
        candidate[i] = loop[i] + length * direction[i];
      }
      const double changed = planarity_energy(candidate);
      lowered = changed < energy;
      if (!lowered && random.uniform() >= std::exp((energy - changed) / temperature)) continue;
      tree.refit(candidate);
      // No distance grows by more than both segments move: a bound that cuts the search short.
      const Room left = room_of(candidate, tree, std::min(1.0, room.distance + 2.1 * length));
      if (left.distance < kept_room * widest.distance || left.folding < kept_room * widest.folding) {
        lowered = false;
        continue;
      }
      if (observer) observer(loop, candidate);
      loop.swap(candidate);
      energy = changed;
      room = left;
      widest.distance = std::max(widest.distance, room.distance);
      widest.folding = std::max(widest.folding, room.folding);
      if (++accepted % steps_per_projection != 0) continue;
      const bool wide = accepted % steps_per_wide_projection == 0;
      if (std::optional<Polygon> polygon = simple_projection(loop, wide ? projection_directions : 0))
        return polygon;
    }
    progress.check();
  }
  return std::nullopt;
}

}  // namespace

double planarity_energy(const Loop& loop) {
  const std::size_t n = loop.size();
  const auto normal = [&](std::size_t i) -> Vector3 {
    const Vector3 &p = loop[i % n], &q = loop[(i + 1) % n], &r = loop[(i + 2) % n];
    return (p - q).cross(r - q);
  };
  double energy = 0;
  Vector3 previous = normal(0);
  for (std::size_t i = 1; i <= n; ++i) {
    const Vector3 next = normal(i);
    energy += angle_between(previous, next);
    previous = next;
  }
  return energy;
}

AnnealingResult anneal(const Loop& loop, const UnfoldOptions& options, const Progress& progress,
                       const AnnealingObserver& observer) {
  AnnealingResult result;
  Random random(options.seed);
  while (result.runs < options.restarts && !result.polygon) {
    progress.update(static_cast<double>(result.runs) / options.restarts);
    ++result.runs;
    result.polygon = simple_projection(loop, 0);  // what is simple already needs no step
    if (!result.polygon) result.polygon = run(loop, options, random, result.steps, progress, observer);
  }
  return result;
}

}  // namespace meshcomplete
