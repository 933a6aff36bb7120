#include "common/core/box_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <cmath>
#include <cstdint>

namespace meshcomplete {
namespace {

constexpr int morton_bits = 21;  // per axis: three fit a 64-bit key
constexpr std::size_t worth_threads = 1 << 14;

/// Spreads the lowest 21 bits so that two zero bits follow each.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffffull;
  x = (x | x << 16) & 0x001f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

/// Runs `body(begin, end)` over [0, n), in threads when that pays.
template <class Body>
void in_blocks(std::size_t n, const Body& body) {
  if (n < worth_threads) {
    body(std::size_t{0}, n);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, worth_threads / 4),
                    [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); });
}

struct Keyed {
  std::uint64_t key;
  Index number;
  bool operator<(const Keyed& other) const {
    return key != other.key ? key < other.key : number < other.number;
  }
};

}  // namespace

std::vector<Index> spatial_order(const std::vector<Box>& boxes) {
  Box all;
  for (const Box& box : boxes) all.include(box);
  std::array<double, 3> scale;
  for (int k = 0; k < 3; ++k) {
    // Halves first: the difference of two finite doubles may overflow.
    const double extent = all.high[k] / 2 - all.low[k] / 2;
    scale[k] = extent > 0 && std::isfinite(extent) ? ((1 << morton_bits) - 1) / extent / 2 : 0;
  }
  std::vector<Keyed> keyed(boxes.size());
  in_blocks(boxes.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::uint64_t key = 0;
      for (int k = 0; k < 3; ++k) {
        const double centre =
            (boxes[i].low[k] / 2 - all.low[k] / 2) + (boxes[i].high[k] / 2 - all.low[k] / 2);
        // An empty box has no centre (the comparison is false); where it goes is of no consequence.
        const double cell = centre * scale[k];
        if (cell > 0 && cell < (1 << morton_bits)) key |= spread(static_cast<std::uint64_t>(cell)) << k;
      }
      keyed[i] = {key, static_cast<Index>(i)};
    }
  });
  if (keyed.size() < worth_threads)
    std::sort(keyed.begin(), keyed.end());
  else
    tbb::parallel_sort(keyed.begin(), keyed.end());
  std::vector<Index> order(keyed.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = keyed[i].number;
  return order;
}

BoxTree::BoxTree(std::vector<Box> leaves) {
  if (leaves.empty()) return;
  levels_.push_back(std::move(leaves));
  while (levels_.back().size() > (std::size_t{1} << fan_out_bits)) {
    const std::vector<Box>& below = levels_.back();
    std::vector<Box> level((below.size() + (std::size_t{1} << fan_out_bits) - 1) >> fan_out_bits);
    in_blocks(level.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t past = std::min((i + 1) << fan_out_bits, below.size());
        for (std::size_t child = i << fan_out_bits; child < past; ++child) level[i].include(below[child]);
      }
    });
    levels_.push_back(std::move(level));
  }
}

}  // namespace meshcomplete
