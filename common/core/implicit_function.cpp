#include "common/core/implicit_function.h"

#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>

namespace meshcomplete {
namespace {

// More than bisection takes from the size of the world to the last bit.
constexpr std::uintmax_t most_steps = 100;

}  // namespace

std::optional<Vector3> crossing(const ImplicitFunction& function, const Vector3& a, const Vector3& b,
                                double at_a, double at_b, double tolerance) {
  if ((at_a < 0) == (at_b < 0)) return std::nullopt;
  if (at_a == 0) return a;
  if (at_b == 0) return b;
  const double length = (b - a).norm();
  std::uintmax_t steps = most_steps;
  const auto at = [&](double share) -> Vector3 { return a + share * (b - a); };
  const auto [low, high] = boost::math::tools::toms748_solve(
      [&](double share) { return function.value(at(share)); }, 0.0, 1.0, at_a, at_b,
      [&](double from, double to) { return (to - from) * length <= tolerance; }, steps);
  return at(0.5 * (low + high));
}

std::optional<Vector3> crossing(const ImplicitFunction& function, const Vector3& a, const Vector3& b,
                                double tolerance) {
  return crossing(function, a, b, function.value(a), function.value(b), tolerance);
}

}  // namespace meshcomplete
