// A surface given as the zero set of a function, and where lines cross it.
#pragma once

#include <optional>

#include "common/core/mesh.h"

namespace meshcomplete {

/// A continuous function on the whole of space: negative inside a solid, positive outside. Safe to ask from
/// many threads.
class ImplicitFunction {
 public:
  virtual ~ImplicitFunction() = default;
  virtual double value(const Vector3& position) const = 0;
};

/// Where the function changes its sign between two points, as far as `tolerance` (mesh units, positive); one
/// of the places when there are several. Nothing when the ends have the same sign: an even number of
/// crossings is not seen. A value of zero counts as outside. `at_a` and `at_b` are the function's values
/// there. Cost: about ten values (Alefeld, Potra and Shi's bracketing, ACM TOMS algorithm 748).
std::optional<Vector3> crossing(const ImplicitFunction& function, const Vector3& a, const Vector3& b,
                                double at_a, double at_b, double tolerance);

/// The same; asks for the values at the ends first.
std::optional<Vector3> crossing(const ImplicitFunction& function, const Vector3& a, const Vector3& b,
                                double tolerance);

}  // namespace meshcomplete
