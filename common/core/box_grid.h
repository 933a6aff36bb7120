// Boxes that come and go, and which of them meet a given one: for patches that are being edited.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/core/box_tree.h"

namespace meshcomplete {

/// A hierarchy of grids, each for boxes of about its cells' size, so that a patch may have triangles of very
/// unlike sizes. Cost: O(1) to change a box; a question costs a few cells for every size of boxes that there
/// is, and the boxes near.
class BoxGrid {
 public:
  /// Adds a box or replaces the one with this number. Numbers should be small: they index a vector.
  void set(Index number, const Box& box);
  void remove(Index number);
  bool holds(Index number) const { return number < entries_.size() && entries_[number].held; }

  /// Calls `visit(number)`, in no particular order, for every box that meets `box`, until it returns false.
  /// Returns whether it never did.
  template <class Visit>
  bool visit(const Box& box, Visit&& visit) const {
    for (const auto& [size, level] : levels_)
      if (level.count > 0 && !visit_level(level, std::ldexp(1.0, size), box, visit)) return false;
    return true;
  }

 private:
  struct Cell {
    std::array<std::int64_t, 3> at;
    bool operator==(const Cell& other) const { return at == other.at; }
  };
  struct CellHash {
    std::size_t operator()(const Cell& cell) const;
  };
  struct Level {
    std::unordered_map<Cell, std::vector<Index>, CellHash> cells;
    std::size_t count = 0;
  };
  struct Entry {
    Box box;
    int size = 0;  // its level's cells have sides of 2^size
    Cell cell{};
    bool held = false;
  };

  static Cell cell_at(const std::array<double, 3>& p, double side);

  // A box lies in the cell of its centre and reaches over that cell's sides by at most half a cell.
  template <class Visit>
  bool visit_level(const Level& level, double side, const Box& box, Visit& visit) const {
    std::array<double, 3> low, high;
    double cells = 1;
    for (int k = 0; k < 3; ++k) {
      low[k] = box.low[k] - 0.5 * side;
      high[k] = box.high[k] + 0.5 * side;
      cells *= std::floor((high[k] - low[k]) / side) + 2;
    }
    const auto visit_cell = [&](const std::vector<Index>& numbers) {
      for (Index number : numbers)
        if (entries_[number].box.meets(box) && !visit(number)) return false;
      return true;
    };
    if (cells > static_cast<double>(level.cells.size())) {
      for (const auto& one : level.cells)
        if (!visit_cell(one.second)) return false;
      return true;
    }
    const Cell first = cell_at(low, side), last = cell_at(high, side);
    for (std::int64_t x = first.at[0]; x <= last.at[0]; ++x)
      for (std::int64_t y = first.at[1]; y <= last.at[1]; ++y)
        for (std::int64_t z = first.at[2]; z <= last.at[2]; ++z) {
          const auto found = level.cells.find(Cell{{x, y, z}});
          if (found != level.cells.end() && !visit_cell(found->second)) return false;
        }
    return true;
  }

  std::vector<Entry> entries_;
  std::unordered_map<int, Level> levels_;
};

}  // namespace meshcomplete
