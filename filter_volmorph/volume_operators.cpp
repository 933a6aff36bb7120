#include "filter_volmorph/volume_operators.h"

#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "common/core/threads.h"
#include "filter_volmorph/block_bits.h"
#include "filter_volmorph/filler_distances.h"
#include "filter_volmorph/volume_box.h"
#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using StateReader = openvdb::BoolGrid::ConstAccessor;

constexpr std::size_t blocks_per_range = 256;
constexpr std::uint64_t all_bits = ~std::uint64_t(0);
static_assert(openvdb::BoolTree::LeafNodeType::DIM == block_size);

Coord shifted(Coord at, int axis, int by) {
  at[axis] += by;
  return at;
}

CoordBBox grown(CoordBBox box, int by) {
  box.expand(by);
  return box;
}

CoordBBox common_box(CoordBBox a, const CoordBBox& b) {
  a.intersect(b);
  return a;
}

VoxelState state_of(bool active, bool empty) {
  if (active) return VoxelState::seen;
  return empty ? VoxelState::empty : VoxelState::unseen;
}

/// The voxels of a block that have the state; not `seen`.
BlockBits state_bits(const StateReader& states, const Coord& lowest, VoxelState state) {
  BlockBits bits;
  if (const auto* leaf = states.probeConstLeaf(lowest)) {
    const std::uint64_t* empty = leaf->buffer().data();
    for (int x = 0; x < block_size; ++x)
      bits[x] =
          ~leaf->valueMask().getWord<std::uint64_t>(x) & (state == VoxelState::empty ? empty[x] : ~empty[x]);
    return bits;
  }
  bool empty = true;
  const bool active = states.probeValue(lowest, empty);
  bits.fill(state_of(active, empty) == state ? all_bits : 0);
  return bits;
}

/// What is active in a block of any grid.
template <class Reader>
BlockBits active_bits(const Reader& grid, const Coord& lowest) {
  BlockBits bits;
  if (const auto* leaf = grid.probeConstLeaf(lowest)) {
    for (int x = 0; x < block_size; ++x) bits[x] = leaf->valueMask().template getWord<std::uint64_t>(x);
  } else {
    bits.fill(grid.isValueOn(lowest) ? all_bits : 0);
  }
  return bits;
}

/// Blocks by the numbers of their lowest voxels divided by the block's size.
class BlockSet {
 public:
  void add(const Coord& voxel) { set_.setValueOn(voxel >> 3); }

  void dilate(openvdb::tools::NearestNeighbors neighbours) {
    openvdb::tools::dilateActiveValues(set_, 1, neighbours, openvdb::tools::IGNORE_TILES);
  }

  /// The lowest voxels of those that meet the box, always in the same order.
  std::vector<Coord> blocks_in(const CoordBBox& box) const {
    std::vector<Coord> blocks;
    for (auto block = set_.cbeginValueOn(); block; ++block) {
      const Coord lowest = block.getCoord() << 3;
      if (box.hasOverlap(CoordBBox::createCube(lowest, block_size))) blocks.push_back(lowest);
    }
    return blocks;
  }

 private:
  openvdb::MaskTree set_;
};

/// Adds the blocks of the leaves that meet the box.
template <class Tree>
void add_leaves(const Tree& tree, const CoordBBox& box, BlockSet& blocks) {
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf)
    if (box.hasOverlap(leaf->getNodeBoundingBox())) blocks.add(leaf->origin());
}

/// Runs `work(block, results)` for all blocks in threads; the results are in the order of the blocks.
template <class Result, class Work>
std::vector<Result> for_blocks(const std::vector<Coord>& blocks, const Progress& progress, Work&& work) {
  std::vector<std::vector<Result>> parts((blocks.size() + blocks_per_range - 1) / blocks_per_range);
  for_ranges(blocks.size(), blocks_per_range, progress, [&](std::size_t begin, std::size_t end) {
    work(begin, end, parts[begin / blocks_per_range]);
    progress.advance(double(end - begin) / double(blocks.size()));
  });
  progress.update(1);
  std::vector<Result> results;
  for (std::vector<Result>& part : parts)
    results.insert(results.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
  return results;
}

/// Finds where uniform tiles of unseen voxels touch uniform tiles of empty ones. Between leaves nothing has
/// to be found: they are looked at in any case.
class TileBoundaries {
 public:
  /// Of the pairs that meet the box, it collects the blocks on the side of the given state.
  TileBoundaries(const openvdb::BoolGrid& states, const CoordBBox& volume, const CoordBBox& box,
                 VoxelState side)
      : states_(states.getConstAccessor()), region_(common_box(grown(box, 1), volume)), side_(side) {}

  /// All boundaries of one tile of unseen voxels.
  void add_tile(const CoordBBox& tile, std::vector<Coord>& blocks) {
    if (!grown(region_, 1).hasOverlap(tile)) return;
    for (axis_ = 0; axis_ < 3; ++axis_) {
      for (const bool behind : {false, true}) {
        CoordBBox layer = tile;
        layer.min()[axis_] = layer.max()[axis_] = behind ? tile.max()[axis_] + 1 : tile.min()[axis_] - 1;
        layer.intersect(region_);
        to_side_ = side_ == VoxelState::unseen ? (behind ? -1 : 1) : 0;
        if (!layer.empty()) walk(layer, 0, blocks);
      }
    }
  }

 private:
  /// A layer of voxels just outside the tile. It is cut along the nodes that may stand at the depth: cubes of
  /// 4096, 128 and 8 voxels.
  void walk(const CoordBBox& layer, int depth, std::vector<Coord>& blocks) {
    const int size = std::array<int, 3>{4096, 128, block_size}[depth];
    const Coord first = layer.min() & ~(size - 1);
    Coord at;
    for (at.x() = first.x(); at.x() <= layer.max().x(); at.x() += size)
      for (at.y() = first.y(); at.y() <= layer.max().y(); at.y() += size)
        for (at.z() = first.z(); at.z() <= layer.max().z(); at.z() += size)
          look(common_box(layer, CoordBBox::createCube(at, size)), depth, blocks);
  }

  void look(const CoordBBox& layer, int depth, std::vector<Coord>& blocks) {
    if (states_.getValueDepth(layer.min()) > depth) {
      if (depth < 2) walk(layer, depth + 1, blocks);
      return;
    }
    bool empty = true;
    if (states_.probeValue(layer.min(), empty) || !empty) return;
    const Coord first = layer.min() & ~(block_size - 1);
    Coord at;
    for (at.x() = first.x(); at.x() <= layer.max().x(); at.x() += block_size)
      for (at.y() = first.y(); at.y() <= layer.max().y(); at.y() += block_size)
        for (at.z() = first.z(); at.z() <= layer.max().z(); at.z() += block_size)
          blocks.push_back(shifted(Coord::maxComponent(at, layer.min()), axis_, to_side_));
  }

  StateReader states_;
  CoordBBox region_;
  VoxelState side_;
  int axis_ = 0;
  int to_side_ = 0;  ///< from the layer to the side that is asked for, along the axis
};

/// The blocks in which voxels of the box may have the state and a neighbour of the opposite one.
std::vector<Coord> blocks_at_boundaries(const RangeVolume& volume, const CoordBBox& box, VoxelState side,
                                        const Progress& progress) {
  const openvdb::BoolGrid& states = *volume.grids().state;
  BlockSet blocks;
  add_leaves(states.tree(), grown(box, 1), blocks);
  progress.update(0.3);
  blocks.dilate(openvdb::tools::NN_FACE);
  progress.update(0.5);

  std::vector<CoordBBox> tiles;
  auto tile = states.tree().cbeginValueOff();
  tile.setMaxDepth(openvdb::BoolTree::ValueOffCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
    if (!tile.getValue()) tiles.push_back(tile.getBoundingBox());
  std::vector<std::vector<Coord>> found((tiles.size() + blocks_per_range - 1) / blocks_per_range);
  for_ranges(tiles.size(), blocks_per_range, progress, [&](std::size_t begin, std::size_t end) {
    TileBoundaries boundaries(states, to_coord_box(volume.frame().box), box, side);
    for (std::size_t i = begin; i < end; ++i) boundaries.add_tile(tiles[i], found[begin / blocks_per_range]);
  });
  for (const std::vector<Coord>& part : found)
    for (const Coord& block : part) blocks.add(block);
  progress.update(1);
  return blocks.blocks_in(box);
}

std::uint64_t count_voxels(const std::vector<StateChange>& changes) {
  std::uint64_t count = 0;
  for (const StateChange& change : changes) count += count_bits(change.bits);
  return count;
}

/// The voxels of the box in the state `from` that have a 6-neighbour in the state `to`.
std::vector<StateChange> voxels_beside(const RangeVolume& volume, const VoxelBox& box, VoxelState from,
                                       VoxelState to, const Progress& progress) {
  const VoxelBox& all = volume.frame().box;
  const auto blocks =
      blocks_at_boundaries(volume, to_coord_box(box), from, progress.part(0, 0.3, "Finding boundaries"));
  const auto work = [&](std::size_t begin, std::size_t end, std::vector<StateChange>& changes) {
    const StateReader states = volume.grids().state->getConstAccessor();
    // Outside the volume the grid says "empty".
    const auto bits = [&](const Coord& lowest) {
      return state_bits(states, lowest, to) & bits_in_box(to_voxel(lowest), all);
    };
    for (std::size_t i = begin; i < end; ++i) {
      const Coord& lowest = blocks[i];
      const BlockBits own = state_bits(states, lowest, from) & bits_in_box(to_voxel(lowest), box);
      if (!any_bit(own)) continue;
      BlockWithFaces block;
      block.own = bits(lowest);
      for (int axis = 0; axis < 3; ++axis) {
        block.beside[axis][0] = bits(shifted(lowest, axis, -block_size));
        block.beside[axis][1] = bits(shifted(lowest, axis, block_size));
      }
      const BlockBits change = own & bits_beside(block);
      if (any_bit(change)) changes.push_back({to_voxel(lowest), change});
    }
  };
  return for_blocks<StateChange>(blocks, progress.part(0.3, 1, "Comparing neighbours"), work);
}

/// The states with all changed voxels in the other state of unseen and empty.
openvdb::BoolGrid::ConstPtr changed_states(const openvdb::BoolGrid& states,
                                           const std::vector<StateChange>& changes,
                                           const Progress& progress) {
  const openvdb::BoolGrid::Ptr copy = states.deepCopy();
  for (const StateChange& change : changes) {
    std::uint64_t* empty = copy->tree().touchLeaf(to_coord(change.lowest))->buffer().data();
    for (int x = 0; x < block_size; ++x) empty[x] ^= change.bits[x];
  }
  progress.update(0.5);
  openvdb::tools::prune(copy->tree());
  return copy;
}

/// Erosion and dilation.
OperatorResult change_states(const RangeVolume& volume, const VoxelBox& given, VoxelState from, VoxelState to,
                             const Progress& progress) {
  prepare_openvdb();
  const VoxelBox box = box_in_volume(volume.frame(), given);
  const auto changes = voxels_beside(volume, box, from, to, progress.part(0, 0.7, "Comparing neighbours"));
  if (changes.empty()) return {volume, 0};
  VolumeGrids grids = volume.grids();
  grids.state = changed_states(*grids.state, changes, progress.part(0.7, 0.9, "Changing states"));
  reset_filler_distances(grids, changes, progress.part(0.9, 1, "Changing states"));
  progress.update(1);
  return {RangeVolume(volume.frame(), std::make_shared<const VolumeGrids>(std::move(grids))),
          count_voxels(changes)};
}

/// A step to one of the 26 neighbours.
struct NeighbourStep {
  Coord step;
  Eigen::Vector3d direction;  ///< of length 1
};

/// From a voxel to those that may give to it. Of two in the order z, y, x the later one comes first.
std::vector<NeighbourStep> steps_to_sources() {
  std::vector<NeighbourStep> steps;
  for (int z = 1; z >= -1; --z)
    for (int y = 1; y >= -1; --y)
      for (int x = 1; x >= -1; --x)
        if (x != 0 || y != 0 || z != 0)
          steps.push_back({Coord(x, y, z), Eigen::Vector3d(x, y, z).normalized()});
  return steps;
}

/// Voxels of a block that become seen, in the order of the bits, and where each takes its values from.
struct BlockExpansion {
  Coord lowest;
  BlockBits bits{};
  std::vector<Coord> sources;
};

/// Finds which voxels of a block become seen. For one thread.
class BlockExpander {
 public:
  BlockExpander(const RangeVolume& volume, const VoxelBox& box)
      : states_(volume.grids().state->getConstAccessor()),
        normals_(volume.grids().normal->getConstAccessor()),
        all_(volume.frame().box),
        box_(box) {}

  BlockExpansion expand(const Coord& lowest) {
    BlockExpansion expansion;
    expansion.lowest = lowest;
    BlockBits targets = active_bits(states_, lowest);
    for (std::uint64_t& word : targets) word = ~word;
    targets = targets & bits_in_box(to_voxel(lowest), all_);
    if (!any_bit(targets)) return expansion;
    const WideBlock sources = sources_round(lowest);
    known_.reset();
    for_each_bit(targets & sources.near(), [&](int x, int y, int z) {
      for (const NeighbourStep& to : steps_) {
        if (!sources.has(x + to.step.x(), y + to.step.y(), z + to.step.z())) continue;
        const Coord source = lowest.offsetBy(x, y, z) + to.step;
        if (std::abs(normal_at(lowest, source).dot(to.direction)) >= largest_cosine_) continue;
        expansion.bits[x] |= std::uint64_t(1) << (block_size * y + z);
        expansion.sources.push_back(source);
        break;
      }
    });
    return expansion;
  }

 private:
  /// Voxels with a normal that lie in the box.
  WideBlock sources_round(const Coord& lowest) const {
    WideBlock sources;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const Coord block = lowest.offsetBy(block_size * x, block_size * y, block_size * z);
          sources.set({x, y, z}, active_bits(normals_, block) & bits_in_box(to_voxel(block), box_));
        }
    return sources;
  }

  /// The normal of a voxel of the block or one beside it. It is unpacked once: several targets ask for it.
  const Eigen::Vector3d& normal_at(const Coord& lowest, const Coord& voxel) {
    const Coord local = voxel - lowest.offsetBy(-1);
    const int number = (local.x() * wide_size + local.y()) * wide_size + local.z();
    if (!known_[number]) {
      known_.set(number);
      unpacked_[number] = unpack_normal(normals_.getValue(voxel)).cast<double>();
    }
    return unpacked_[number];
  }

  static constexpr int wide_size = block_size + 2;
  static constexpr int wide_voxels = wide_size * wide_size * wide_size;

  StateReader states_;
  openvdb::Int32Grid::ConstAccessor normals_;
  VoxelBox all_, box_;
  std::bitset<wide_voxels> known_;
  std::array<Eigen::Vector3d, wide_voxels> unpacked_;
  std::vector<NeighbourStep> steps_ = steps_to_sources();
  /// cos 67.5 degrees. A direction and its opposite enclose angles of the same distance from 90.
  double largest_cosine_ = std::cos(67.5 / 180 * EIGEN_PI);
};

std::vector<BlockExpansion> find_expansions(const RangeVolume& volume, const VoxelBox& box,
                                            const Progress& progress) {
  // A tile of normals would not be found as a leaf.
  openvdb::Int32Grid::ConstPtr normals = volume.grids().normal;
  if (normals->tree().hasActiveTiles()) {
    const openvdb::Int32Grid::Ptr copy = normals->deepCopy();
    copy->tree().voxelizeActiveTiles();
    normals = copy;
  }
  BlockSet set;
  add_leaves(normals->tree(), to_coord_box(box), set);
  set.dilate(openvdb::tools::NN_FACE_EDGE_VERTEX);
  const auto blocks =
      set.blocks_in(common_box(grown(to_coord_box(box), 1), to_coord_box(volume.frame().box)));
  progress.update(0.1);
  return for_blocks<BlockExpansion>(
      blocks, progress.part(0.1, 1, "Expanding the isosurface"),
      [&](std::size_t begin, std::size_t end, std::vector<BlockExpansion>& expansions) {
        BlockExpander expander(volume, box);
        for (std::size_t i = begin; i < end; ++i) {
          BlockExpansion expansion = expander.expand(blocks[i]);
          if (any_bit(expansion.bits)) expansions.push_back(std::move(expansion));
        }
      });
}

/// Copies of a grid whose leaves at the changed blocks exist.
template <class Grid>
struct GridCopy {
  GridCopy(const Grid& grid, const std::vector<BlockExpansion>& changes) : copy(grid.deepCopy()) {
    for (const BlockExpansion& change : changes) leaves.push_back(copy->tree().touchLeaf(change.lowest));
  }
  typename Grid::Ptr copy;
  std::vector<typename Grid::TreeType::LeafNodeType*> leaves;
};

/// Changes one grid: every voxel that becomes seen gets its source's value and is active.
template <class Grid>
typename Grid::Ptr with_values(const Grid& grid, const std::vector<BlockExpansion>& changes,
                               const Progress& progress) {
  const GridCopy<Grid> target(grid, changes);
  progress.update(0.7);
  for_ranges(changes.size(), blocks_per_range, progress, [&](std::size_t begin, std::size_t end) {
    const auto reader = grid.getConstAccessor();
    for (std::size_t i = begin; i < end; ++i) {
      const BlockExpansion& change = changes[i];
      auto source = change.sources.begin();
      for_each_bit(change.bits, [&](int x, int y, int z) {
        target.leaves[i]->setValueOn(change.lowest.offsetBy(x, y, z), reader.getValue(*source++));
      });
    }
  });
  progress.update(1);
  return target.copy;
}

}  // namespace

OperatorResult erode(const RangeVolume& volume, const VoxelBox& box, const Progress& progress) {
  return change_states(volume, box, VoxelState::unseen, VoxelState::empty, progress);
}

OperatorResult dilate(const RangeVolume& volume, const VoxelBox& box, const Progress& progress) {
  return change_states(volume, box, VoxelState::empty, VoxelState::unseen, progress);
}

OperatorResult expand_isosurface(const RangeVolume& volume, const VoxelBox& given, const Progress& progress) {
  prepare_openvdb();
  const VoxelBox box = box_in_volume(volume.frame(), given);
  const auto expansions = find_expansions(volume, box, progress.part(0, 0.6, "Expanding the isosurface"));
  if (expansions.empty()) return {volume, 0};
  VolumeGrids grids = volume.grids();
  const auto part = [&](double from, double to) { return progress.part(from, to, "Copying to neighbours"); };
  grids.distance = with_values(*grids.distance, expansions, part(0.6, 0.7));
  grids.weight = with_values(*grids.weight, expansions, part(0.7, 0.8));
  grids.normal = with_values(*grids.normal, expansions, part(0.8, 0.9));
  const auto state = with_values(*grids.state, expansions, part(0.9, 0.95));
  openvdb::tools::prune(state->tree());
  grids.state = state;
  progress.update(1);
  std::uint64_t changed = 0;
  for (const BlockExpansion& expansion : expansions) changed += expansion.sources.size();
  return {RangeVolume(volume.frame(), std::make_shared<const VolumeGrids>(std::move(grids))), changed};
}

}  // namespace meshcomplete
