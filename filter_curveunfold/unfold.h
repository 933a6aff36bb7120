// Unfolding a closed polygon in space to a simple polygon in the plane without crossing itself (paper,
// section 3.1).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/progress.h"

namespace meshcomplete {

enum class UnfoldMethod {
  automatic,  ///< projection when it is simple, else without its crossings if they are few, else the
              ///< self-avoiding descent
  annealing,  ///< the paper's simulated annealing, also for loops whose projection is simple already
  descent,    ///< the self-avoiding descent, also for loops whose projection is simple already
};

enum class UnfoldOutcome {
  projected,     ///< the best-fitting plane's projection was simple: nothing to unfold
  annealed,      ///< unfolded by simulated annealing
  untangled,     ///< unfolded by moving a few crossings out of the way, or by the self-avoiding descent
  knotted,       ///< an invariant certifies a knot: no patch without self-intersection exists that is a disk
  not_unfolded,  ///< every try was used up
};

const char* name(UnfoldOutcome outcome);  ///< "projected", "annealed", and so on

struct UnfoldOptions {
  UnfoldMethod method = UnfoldMethod::automatic;
  int restarts = 100;      ///< annealing runs before giving up, 1 to 10000 (paper: 100)
  std::uint64_t seed = 1;  ///< of the annealing
  double min_distance =
      1e-5;              ///< the paper's epsilon, relative to the loop's bounding-box diagonal, 1e-9 to 1e-2
  double cooling = 0.9;  ///< the paper's k, above 0 and below 1
  double start_temperature = 0.5;  ///< the paper's T in radians, positive
  bool stretch =
      false;  ///< second try: keep unfolding past the first simple projection, towards a convex polygon
};

struct Unfolding {
  UnfoldOutcome outcome = UnfoldOutcome::not_unfolded;
  std::vector<Eigen::Vector2d> polygon;  ///< simple, counter-clockwise, one point per loop vertex in the
                                         ///< loop's order; empty unless unfolded
  int restarts = 0;                      ///< annealing runs used (paper's d)
  std::size_t steps = 0;  ///< steps tried in all runs; points moved out of the way count as one each
  double seconds = 0;
  std::optional<int> knot_determinant;  ///< set when the loop was tested for being knotted
  double total_curvature = 0;           ///< radians; below 4 pi certifies an unknot (Fary-Milnor)
};

/// Unfolds the closed polygon `loop` (at least 3 points, no two consecutive ones equal; else throws
/// CompletionError). Deterministic for equal options. Throws `Cancelled`.
Unfolding unfold(const std::vector<Vector3>& loop, const UnfoldOptions& options = UnfoldOptions(),
                 const Progress& progress = Progress());

}  // namespace meshcomplete
