#include "common/core/corner_octree.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <utility>

#include "common/core/threads.h"

namespace meshcomplete {
namespace {

using Code = std::uint64_t;  // Morton code: bit 3 i + k is bit i of coordinate k

// Puts two zero bits before every bit of a number of 21 bits.
Code spread(Code x) {
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

Code gather(Code x) {
  x &= 0x1249249249249249;
  x = (x ^ x >> 2) & 0x10c30c30c30c30c3;
  x = (x ^ x >> 4) & 0x100f00f00f00f00f;
  x = (x ^ x >> 8) & 0x1f0000ff0000ff;
  x = (x ^ x >> 16) & 0x1f00000000ffff;
  x = (x ^ x >> 32) & 0x1fffff;
  return x;
}

Code encode(const std::array<std::int64_t, 3>& x) {
  return spread(static_cast<Code>(x[0])) | spread(static_cast<Code>(x[1])) << 1 |
         spread(static_cast<Code>(x[2])) << 2;
}

std::array<std::int64_t, 3> decode(Code code) {
  return {static_cast<std::int64_t>(gather(code)), static_cast<std::int64_t>(gather(code >> 1)),
          static_cast<std::int64_t>(gather(code >> 2))};
}

void sort_out(std::vector<Code>& codes) {
  tbb::parallel_sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
}

// The cubes one level up that hold a cube of this depth and its 26 neighbours.
void add_parents_around(Code cube, int depth, std::vector<Code>& parents) {
  const std::array<std::int64_t, 3> x = decode(cube);
  const std::int64_t side = std::int64_t{1} << (depth - 1);
  std::array<std::array<std::int64_t, 2>, 3> candidates;
  for (int k = 0; k < 3; ++k) candidates[k] = {x[k] >> 1, (x[k] & 1) ? (x[k] >> 1) + 1 : (x[k] >> 1) - 1};
  for (int i = 0; i < 8; ++i) {
    const std::array<std::int64_t, 3> p = {candidates[0][i & 1], candidates[1][i >> 1 & 1],
                                           candidates[2][i >> 2]};
    if (std::all_of(p.begin(), p.end(), [&](std::int64_t c) { return c >= 0 && c < side; }))
      parents.push_back(encode(p));
  }
}

// Cubes and blocks between two looks whether the user wants to stop: about a millisecond.
constexpr std::size_t cubes_per_check = 16384;
constexpr Index blocks_per_check = 1024;

// Per depth the cubes that have to be split, ascending; below `min_depth` all are, and not listed.
std::vector<std::vector<Code>> cubes_to_split(const std::vector<WantedCube>& wanted, int min_depth,
                                              CornerOctree::Balance balance, const Progress& progress) {
  std::size_t count = 0;
  const auto look = [&] {
    if (++count % cubes_per_check == 0) progress.check();
  };
  int depth = min_depth;
  for (const WantedCube& one : wanted) depth = std::max(depth, one.depth);
  std::vector<std::vector<Code>> holding(depth + 1), split(depth);
  for (const WantedCube& one : wanted) {
    look();
    std::array<std::int64_t, 3> x;
    for (int k = 0; k < 3; ++k) x[k] = one.point[k] / Octree::side(one.depth);
    holding[one.depth].push_back(encode(x));
  }
  for (int d = depth; d > min_depth; --d) {
    sort_out(holding[d]);
    std::vector<Code>& parents = split[d - 1];
    for (Code cube : holding[d]) {
      look();
      if (balance == CornerOctree::Balance::two_to_one)
        add_parents_around(cube, d, parents);
      else
        parents.push_back(cube >> 3);
      holding[d - 1].push_back(cube >> 3);
    }
    if (d < depth && balance == CornerOctree::Balance::two_to_one)
      for (Code cube : split[d]) {
        look();
        add_parents_around(cube, d, parents);
      }
    sort_out(parents);
  }
  return split;
}

// Numbers corners by their coordinates.
class CornerTable {
 public:
  explicit CornerTable(std::size_t expected) {
    while (slots_.size() < 2 * expected) slots_.resize(std::max<std::size_t>(64, 2 * slots_.size()));
  }
  // The corner's number, and whether it is new.
  std::pair<Index, bool> number(Code key) {
    if (2 * count_ > slots_.size()) grow();
    Slot& slot = find(key);
    if (slot.key == key) return {slot.number, false};
    slot = {key, static_cast<Index>(count_++)};
    return {slot.number, true};
  }
  std::size_t size() const { return count_; }

 private:
  static constexpr Code empty = ~Code{0};
  struct Slot {
    Code key = empty;
    Index number = 0;
  };
  Slot& find(Code key) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = (key * 0x9e3779b97f4a7c15ull >> 20) & mask;
    while (slots_[i].key != empty && slots_[i].key != key) i = (i + 1) & mask;
    return slots_[i];
  }
  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.key != empty) find(slot.key) = slot;
  }

  std::vector<Slot> slots_;
  std::size_t count_ = 0;
};

}  // namespace

CornerOctree::CornerOctree(const std::vector<WantedCube>& wanted, int min_depth, Balance balance,
                           const Progress& progress) {
  const std::vector<std::vector<Code>> split = cubes_to_split(wanted, min_depth, balance, progress);
  std::vector<std::pair<Code, Index>> cubes = {{0, 0}};  // of one depth, with their codes, ascending
  for (int depth = 0; depth < static_cast<int>(split.size()); ++depth) {
    progress.check();
    levels_.emplace_back();
    levels_.back().first_block = static_cast<Index>(parents_.size());
    std::vector<std::pair<Code, Index>> children;
    auto next = split[depth].begin();
    for (const auto& [code, cube] : cubes) {
      while (next != split[depth].end() && *next < code) ++next;
      if (depth >= min_depth && (next == split[depth].end() || *next != code)) continue;
      parents_.push_back(cube);
      const Index first = octree_.split(cube);
      for (Index k = 0; k < 8; ++k) children.emplace_back(code << 3 | k, first + k);
    }
    cubes = std::move(children);
  }
  for_each(levels_.size(), 1, progress,
           [&](std::size_t d) { number_corners(levels_[d], static_cast<int>(d + 1), progress); });
}

void CornerOctree::number_corners(Level& level, int depth, const Progress& progress) const {
  const Index past = depth < this->depth() ? levels_[depth].first_block : static_cast<Index>(parents_.size());
  const std::int64_t half = Octree::side(depth), side = std::int64_t{1} << depth;
  CornerTable table(8 * (past - level.first_block));
  std::vector<std::uint8_t> cubes;  // of this depth, round each corner
  level.corners.resize(past - level.first_block);
  for (Index b = 0; b < level.corners.size(); ++b) {
    if (b % blocks_per_check == 0) progress.check();
    const LatticePoint low = octree_[parents_[level.first_block + b]].low;
    const std::array<std::int64_t, 3> x = {low[0] / half, low[1] / half, low[2] / half};
    for (int place = 0; place < 27; ++place) {
      const std::array<int, 3> at = {place % 3, place / 3 % 3, place / 9};
      const auto [number, fresh] =
          table.number(static_cast<Code>(x[0] + at[0]) | static_cast<Code>(x[1] + at[1]) << 21 |
                       static_cast<Code>(x[2] + at[2]) << 42);
      level.corners[b][place] = number;
      int inside = 1, all = 1;  // cubes of the block and of the root round the corner
      bool outside = false;
      for (int k = 0; k < 3; ++k) {
        const bool at_side = x[k] + at[k] == 0 || x[k] + at[k] == side;
        inside *= at[k] == 1 ? 2 : 1;
        all *= at_side ? 1 : 2;
        outside |= at_side;
      }
      if (fresh) {
        level.owner.emplace_back(b, static_cast<std::uint8_t>(place));
        level.outside.push_back(outside);
        cubes.push_back(static_cast<std::uint8_t>(all));
      }
      cubes[number] = static_cast<std::uint8_t>(cubes[number] - inside);
    }
    const std::int64_t group = (x[0] >> 1 & 1) + 2 * (x[1] >> 1 & 1) + 4 * (x[2] >> 1 & 1);
    level.groups[group].push_back(b);
  }
  level.corner_count = table.size();
  level.inner.resize(cubes.size());
  for (std::size_t i = 0; i < cubes.size(); ++i) level.inner[i] = cubes[i] == 0;
}

}  // namespace meshcomplete
