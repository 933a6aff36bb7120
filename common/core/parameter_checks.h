// What algorithms check of the options that a user gave.
#pragma once

#include <cmath>

#include "common/core/error.h"

namespace meshcomplete {

/// Throws CompletionError with the message, which names the parameter, when the condition does not hold.
inline void require(bool condition, const char* message) {
  if (!condition) throw CompletionError("reading the parameters", message);
}

/// Whether a number is finite and greater than 0.
inline bool positive(double x) { return std::isfinite(x) && x > 0; }

}  // namespace meshcomplete
