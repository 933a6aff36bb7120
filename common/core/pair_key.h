// Unordered pairs of numbers as one: for tables of edges.
#pragma once

#include <algorithm>
#include <cstdint>

#include "common/core/mesh.h"

namespace meshcomplete {

/// The lower of the two above the higher one's 32 bits: the same for both orders, and ordered by the lower.
inline std::uint64_t pair_key(Index a, Index b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
}

}  // namespace meshcomplete
