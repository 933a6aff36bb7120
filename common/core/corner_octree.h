// A balanced octree whose corners are numbered, level by level: what functions on octrees stand on.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/core/lattice.h"
#include "common/core/octree.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// Where the octree is to be fine: the cube of this depth that holds the point, and those round it, are made.
struct WantedCube {
  LatticePoint point;
  int depth;  ///< 0 to `CornerOctree::most_depth`
};

/// Eight cubes that were made by splitting one are a block: block b holds the octree's cubes 1 + 8 b to
/// 8 + 8 b. The blocks of a level are consecutive, in Morton order. The 27 corners of a block's cubes are
/// numbered within the level; number x + 3 y + 9 z of the list is the corner x, y, z (0 to 2) half sides
/// from the block's lowest one. A corner that lies on cubes of several depths has a number in each of these
/// levels.
class CornerOctree {
 public:
  static constexpr int most_depth = 20;
  using BlockCorners = std::array<Index, 27>;

  struct Level {
    Index first_block = 0;
    std::vector<BlockCorners> corners;  ///< of each block of the level
    std::size_t corner_count = 0;
    /// Of each corner: whether all cubes round it have this depth. Cubes outside the root do not count.
    std::vector<char> inner;
    std::vector<char> outside;  ///< of each corner: whether it lies on the outside of the root
    /// The block that owns a corner, counted from the level's first, and the place of the corner in it: every
    /// corner is owned once.
    std::vector<std::pair<Index, std::uint8_t>> owner;
    /// The blocks, counted from the level's first, in eight groups: those of one group have no corner in
    /// common.
    std::array<std::vector<Index>, 8> groups;
  };

  enum class Balance {
    none,        ///< only the wanted cubes are made, not those round them
    two_to_one,  ///< neighbours, over corners too, of a cube that is split have at least its depth
  };

  /// All cubes of depth less than `min_depth` (at least 1) are split. Cost: O(n log n) for n wanted cubes,
  /// threaded. Throws Cancelled.
  CornerOctree(const std::vector<WantedCube>& wanted, int min_depth, Balance balance = Balance::two_to_one,
               const Progress& progress = Progress());

  const Octree& octree() const { return octree_; }
  int depth() const { return static_cast<int>(levels_.size()); }      ///< of the finest cubes
  const Level& level(int depth) const { return levels_[depth - 1]; }  ///< 1 to `depth()`

  static Index block_of(Index cube) { return (cube - 1) / 8; }
  static Index first_cube(Index block) { return 1 + 8 * block; }
  /// The cube that was split to make the block.
  Index parent(Index block) const { return parents_[block]; }
  /// Places in `BlockCorners` of the corners of the block's cube `child`; bit k of a corner's place says
  /// whether it is the upper one along axis k.
  static constexpr int corner_place(int child, int corner) {
    return ((child & 1) + (corner & 1)) + 3 * ((child >> 1 & 1) + (corner >> 1 & 1)) +
           9 * ((child >> 2) + (corner >> 2));
  }
  /// The corners of a cube of depth 1 or more, numbered within its level.
  std::array<Index, 8> corners(Index cube) const {
    const Index block = block_of(cube);
    const Level& at = level(octree_[cube].depth);
    std::array<Index, 8> result;
    for (int c = 0; c < 8; ++c)
      result[c] = at.corners[block - at.first_block][corner_place((cube - 1) % 8, c)];
    return result;
  }

 private:
  void number_corners(Level& level, int depth, const Progress& progress) const;

  Octree octree_;
  std::vector<Index> parents_;
  std::vector<Level> levels_;
};

}  // namespace meshcomplete
