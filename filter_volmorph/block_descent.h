// From large cubes of a volume down to its blocks of eight voxels, leaving out what is decided on the way.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "common/core/progress.h"
#include "common/core/threads.h"
#include "filter_volmorph/block_bits.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

constexpr int largest_descent_side = 4096;  ///< of OpenVDB's largest tiles

/// The cubes, aligned to their side, that the box reaches into. Each is a copy of `first` with a `low` of its
/// own.
template <class Cube>
std::vector<Cube> first_descent_cubes(const VoxelBox& box, const Cube& first, int side) {
  const VoxelIndex low = box.low.unaryExpr([&](int x) { return x & ~(side - 1); });
  std::vector<Cube> cubes;
  Cube cube = first;
  for (int x = low.x(); x <= box.high.x(); x += side)
    for (int y = low.y(); y <= box.high.y(); y += side)
      for (int z = low.z(); z <= box.high.z(); z += side) {
        cube.low = {x, y, z};
        cubes.push_back(cube);
      }
  return cubes;
}

/// Every cube in eight, as far as the box reaches into them. Each is a copy of its parent but for its `low`.
template <class Cube>
std::vector<Cube> halved_descent_cubes(const VoxelBox& box, const std::vector<Cube>& cubes, int side,
                                       const Progress& progress) {
  constexpr std::size_t between_checks = 4096;
  std::vector<Cube> result;
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    if (i % between_checks == 0) progress.check();
    Cube half = cubes[i];
    for (int k = 0; k < 8; ++k) {
      half.low = cubes[i].low + side / 2 * VoxelIndex(k >> 2, k >> 1 & 1, k & 1);
      if (!box.common({half.low, half.low + VoxelIndex::Constant(side / 2 - 1)}).empty())
        result.push_back(half);
    }
  }
  return result;
}

/// Starts with cubes as large as the box or OpenVDB's largest tiles, all like `first`, and halves those that
/// are not decided until they are blocks, which it returns, in an order that does not depend on threads.
/// `Cube` has a member `low`, its lowest voxel. `decide(cubes, begin, end, side, undecided)` looks at the
/// cubes of a range, may change them but for `low`, and sets those entries of `undecided` that are to be
/// looked at closer; it is called from many threads.
template <class Cube, class Decide>
std::vector<Cube> descend_to_blocks(const VoxelBox& box, const Cube& first, const Decide& decide,
                                    const Progress& progress) {
  constexpr std::size_t cubes_at_once = 16;
  int side = block_size;
  while (side < largest_descent_side && side < box.size().maxCoeff()) side *= 2;
  std::vector<Cube> cubes = first_descent_cubes(box, first, side);
  for (;; side /= 2) {
    std::vector<char> undecided(cubes.size(), 0);
    for_ranges(cubes.size(), cubes_at_once, progress,
               [&](std::size_t begin, std::size_t end) { decide(cubes, begin, end, side, undecided); });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < cubes.size(); ++i)
      if (undecided[i]) std::swap(cubes[kept++], cubes[i]);
    cubes.resize(kept, first);
    if (side == block_size || cubes.empty()) return cubes;
    cubes = halved_descent_cubes(box, cubes, side, progress);
    progress.update(static_cast<double>(block_size) / side);
  }
}

}  // namespace meshcomplete
