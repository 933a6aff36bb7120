#include "common/core/box_grid.h"

#include <algorithm>

namespace meshcomplete {
namespace {

// Boxes of points, and smaller ones than this power of two, share a level.
constexpr int smallest_size = -60;

// What 64 bits hold without overflow, the next one included.
constexpr double last_cell = 0x1p62;

}  // namespace

std::size_t BoxGrid::CellHash::operator()(const Cell& cell) const {
  std::uint64_t hash = 0;
  for (std::int64_t c : cell.at) {
    hash = (hash ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15ull;
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash);
}

// Points far away share the last cell: the order along an axis is kept, and that is all that is needed.
BoxGrid::Cell BoxGrid::cell_at(const std::array<double, 3>& p, double side) {
  Cell cell;
  for (int k = 0; k < 3; ++k)
    cell.at[k] = static_cast<std::int64_t>(std::clamp(std::floor(p[k] / side), -last_cell, last_cell));
  return cell;
}

void BoxGrid::set(Index number, const Box& box) {
  if (number >= entries_.size()) entries_.resize(number + 1);
  double longest = 0;
  std::array<double, 3> centre;
  for (int k = 0; k < 3; ++k) {
    longest = std::max(longest, box.high[k] - box.low[k]);
    centre[k] = 0.5 * (box.low[k] + box.high[k]);
  }
  int size = smallest_size;
  if (longest > std::ldexp(1.0, smallest_size)) std::frexp(longest, &size);
  const Cell cell = cell_at(centre, std::ldexp(1.0, size));
  Entry& entry = entries_[number];
  entry.box = box;
  if (entry.held && entry.size == size && entry.cell == cell) return;
  remove(number);
  entry.size = size;
  entry.cell = cell;
  entry.held = true;
  Level& level = levels_[size];
  level.cells[cell].push_back(number);
  ++level.count;
}

void BoxGrid::remove(Index number) {
  if (!holds(number)) return;
  Entry& entry = entries_[number];
  Level& level = levels_[entry.size];
  const auto at = level.cells.find(entry.cell);
  std::vector<Index>& numbers = at->second;
  numbers.erase(std::find(numbers.begin(), numbers.end(), number));
  if (numbers.empty()) level.cells.erase(at);
  --level.count;
  entry.held = false;
}

}  // namespace meshcomplete
