#include "filter_volmorph/surroundings.h"

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/threads.h"
#include "filter_volmorph/block_bits.h"
#include "filter_volmorph/block_descent.h"
#include "filter_volmorph/filler_distances.h"
#include "filter_volmorph/small_components.h"
#include "filter_volmorph/surface_extraction.h"
#include "filter_volmorph/surface_sides.h"
#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using StateReader = openvdb::BoolGrid::ConstAccessor;

constexpr std::size_t cubes_at_once = 16;

/// Cubes are as large as OpenVDB's tiles or divide them: at this depth and above a value holds for all of
/// the cube.
int deepest_tile(int side) { return side > 128 ? 0 : side > block_size ? 1 : 2; }

/// A cube of a descent.
struct Cube {
  VoxelIndex low = VoxelIndex::Zero();
  Index start = 0;  ///< a face near its parent's middle
};

/// A cube whose unseen voxels become empty.
struct CubeChange {
  Coord low;
  int side;
};

/// Voxels of a block that become empty.
struct BlockChange {
  Coord lowest;
  BlockBits bits;
};

/// The surface that the scanners observed, in voxels.
TriangleMesh deciding_surface(const RangeVolume& volume, const Progress& progress) {
  ExtractionOptions options;
  options.observed_only = true;
  TriangleMesh surface =
      extract_surface(volume, options, progress.part(0, 0.7, "extracting the observed surface"));
  const double noise =
      std::max(widest_noise_ramps * volume.frame().ramp, widest_noise_voxels * volume.frame().voxel_size);
  surface =
      without_narrow_components(std::move(surface), noise, progress.part(0.7, 1, "finding small components"));
  for (Vector3& vertex : surface.vertices) vertex = volume.frame().voxel(vertex);
  return surface;
}

/// The unseen voxels of a block.
BlockBits unseen_in_block(const StateReader& states, const Coord& lowest) {
  if (const auto* leaf = states.probeConstLeaf(lowest)) return unseen_bits(*leaf);
  bool empty = true;
  BlockBits bits;
  bits.fill(!states.probeValue(lowest, empty) && !empty ? ~std::uint64_t(0) : 0);
  return bits;
}

/// False where all of the cube is known to be seen or empty.
bool may_be_unseen(const StateReader& states, const Coord& low, int side) {
  if (states.getValueDepth(low) <= deepest_tile(side)) {
    bool empty = true;
    return !states.probeValue(low, empty) && !empty;
  }
  return side > block_size || any_bit(unseen_in_block(states, low));
}

/// Decides which unseen voxels lie before the surface.
class Sides {
 public:
  Sides(const RangeVolume& volume, const SurfaceSides& sides) : volume_(volume), sides_(sides) {}

  /// Cubes whose unseen voxels become empty, and voxels beside them; they do not overlap.
  std::vector<CubeChange> cubes;  // in no certain order
  std::vector<BlockChange> blocks;

  void run(const Progress& progress) {
    const Progress descent = progress.part(0, 0.4, "finding what lies before the surface");
    const std::vector<Cube> undecided = descend_to_blocks(
        volume_.frame().box, Cube(),
        [&](std::vector<Cube>& all, std::size_t begin, std::size_t end, int side, std::vector<char>& left) {
          const StateReader states = volume_.grids().state->getConstAccessor();
          for (std::size_t i = begin; i < end; ++i) {
            descent.check();
            left[i] = !decide_cube(states, all[i], side);
          }
        },
        descent);
    const Progress rest = progress.part(0.4, 1, "finding what lies before the surface");
    std::vector<BlockChange> changes(undecided.size());
    for_ranges(undecided.size(), cubes_at_once, rest, [&](std::size_t begin, std::size_t end) {
      const StateReader states = volume_.grids().state->getConstAccessor();
      for (std::size_t i = begin; i < end; ++i) {
        rest.check();
        changes[i] = decide_voxels(states, undecided[i]);
      }
      rest.advance(static_cast<double>(end - begin) / static_cast<double>(undecided.size()));
    });
    for (const BlockChange& change : changes)
      if (any_bit(change.bits)) blocks.push_back(change);
  }

 private:
  std::optional<bool> before(const Coord& low, int side, Index& start) const {
    const double half = (side - 1) / 2.0;
    const Vector3 middle = to_voxel(low).cast<double>().array() + half;
    return sides_.before(middle, std::sqrt(3) * half, start);
  }

  /// Whether it is sure of the cube. Keeps it when it lies before the surface.
  bool decide_cube(const StateReader& states, Cube& cube, int side) {
    const Coord low = to_coord(cube.low);
    if (!may_be_unseen(states, low, side)) return true;
    const std::optional<bool> known = before(low, side, cube.start);
    if (known && *known) {
      const std::lock_guard<std::mutex> lock(mutex_);
      cubes.push_back({low, side});
    }
    return known.has_value();
  }

  BlockChange decide_voxels(const StateReader& states, const Cube& block) const {
    BlockChange change{to_coord(block.low), {}};
    Index start = block.start;
    decide_part(unseen_in_block(states, change.lowest), {0, 0, 0}, block_size / 2, start, change);
    return change;
  }

  /// Eight cubes of a block that begin at a voxel, as wholes or each in turn in eight.
  void decide_part(const BlockBits& unseen, const VoxelIndex& low, int side, Index start,
                   BlockChange& change) const {
    for (int k = 0; k < 8; ++k) {
      const VoxelIndex at = low + side * VoxelIndex(k >> 2, k >> 1 & 1, k & 1);
      const BlockBits own =
          unseen & bits_in_box(VoxelIndex::Zero(), {at, at + VoxelIndex::Constant(side - 1)});
      if (!any_bit(own)) continue;
      const Coord first = change.lowest + to_coord(at);
      Index near = start;
      if (side == 1) {
        if (sides_.before(to_voxel(first).cast<double>(), near)) set(own, change);
        start = near;
        continue;
      }
      const std::optional<bool> all = count_bits(own) > side ? before(first, side, near) : std::nullopt;
      if (!all) decide_part(own, at, side / 2, near, change);
      if (all && *all) set(own, change);
    }
  }

  static void set(const BlockBits& bits, BlockChange& change) {
    for (int x = 0; x < block_size; ++x) change.bits[x] |= bits[x];
  }

  const RangeVolume& volume_;
  const SurfaceSides& sides_;
  std::mutex mutex_;  // of `cubes`
};

/// Makes the unseen voxels of a cube empty; returns how many there were.
std::uint64_t empty_cube(openvdb::BoolGrid& grid, const Coord& low, int side) {
  auto states = grid.getAccessor();
  if (states.getValueDepth(low) <= deepest_tile(side)) {
    bool empty = true;
    if (states.probeValue(low, empty) || empty) return 0;
    grid.tree().sparseFill(CoordBBox::createCube(low, side), true, false);
    return static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side) *
           static_cast<std::uint64_t>(side);
  }
  std::uint64_t count = 0;
  if (side > block_size) {
    for (int k = 0; k < 8; ++k)
      count += empty_cube(
          grid, low.offsetBy(side / 2 * (k >> 2), side / 2 * (k >> 1 & 1), side / 2 * (k & 1)), side / 2);
    return count;
  }
  const BlockBits unseen = unseen_in_block(grid.getConstAccessor(), low);
  std::uint64_t* empty = grid.tree().touchLeaf(low)->buffer().data();
  for (int x = 0; x < block_size; ++x) empty[x] |= unseen[x];
  return static_cast<std::uint64_t>(count_bits(unseen));
}

}  // namespace

SurroundingsResult empty_surroundings(const RangeVolume& volume, const Progress& progress) {
  prepare_openvdb();
  if (volume.frame().box.empty()) return {volume, 0};
  const TriangleMesh surface = deciding_surface(volume, progress.part(0, 0.3, "observed surface"));
  if (surface.triangles.empty()) return {volume, 0};
  const SurfaceSides surface_sides(surface, progress.part(0.3, 0.4, "preparing the surface"));
  Sides sides(volume, surface_sides);
  sides.run(progress.part(0.4, 0.9, "finding what lies before the surface"));
  if (sides.cubes.empty() && sides.blocks.empty()) return {volume, 0};

  const Progress changing = progress.part(0.9, 0.95, "emptying the surroundings");
  const openvdb::BoolGrid::Ptr states = volume.grids().state->deepCopy();
  std::uint64_t emptied = 0;
  for (const CubeChange& cube : sides.cubes) {
    changing.check();
    emptied += empty_cube(*states, cube.low, cube.side);
  }
  for (const BlockChange& change : sides.blocks) {
    std::uint64_t* empty = states->tree().touchLeaf(change.lowest)->buffer().data();
    for (int x = 0; x < block_size; ++x) empty[x] |= change.bits[x];
    emptied += static_cast<std::uint64_t>(count_bits(change.bits));
  }
  if (emptied == 0) return {volume, 0};
  openvdb::tools::prune(states->tree());
  changing.update(1);
  VolumeGrids grids = volume.grids();
  grids.state = states;
  reset_filler_distances(volume.grids(), grids, progress.part(0.95, 1, "emptying the surroundings"));
  progress.update(1);
  return {RangeVolume(volume.frame(), std::make_shared<const VolumeGrids>(std::move(grids))), emptied};
}

}  // namespace meshcomplete
