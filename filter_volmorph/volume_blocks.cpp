#include "filter_volmorph/volume_blocks.h"

#include <algorithm>

#include "common/core/threads.h"
#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {
namespace {

using StateLeaf = openvdb::BoolTree::LeafNodeType;
using DistanceLeaf = openvdb::FloatTree::LeafNodeType;
static_assert(StateLeaf::DIM == block_size && DistanceLeaf::DIM == block_size);

constexpr std::size_t blocks_at_once = 256;

openvdb::Coord first_voxel(const VoxelIndex& block) { return to_coord(block * block_size); }

// A cube of blocks that all have the same distance.
struct Tile {
  VoxelIndex low;  // block
  int side;        // blocks
};

struct BlocksAndTiles {
  std::vector<VoxelIndex> blocks;  // those with leaves
  std::vector<Tile> tiles;         // those that may be inside, the others left out
};

template <class Tree>
void add_leaves(const Tree& tree, const Progress& progress, std::vector<VoxelIndex>& blocks) {
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    if (blocks.size() % blocks_at_once == 0) progress.check();
    blocks.push_back(block_of(to_voxel(leaf->origin())));
  }
}

template <class Iterator, class Wanted>
void add_tiles(Iterator tile, const Progress& progress, std::vector<Tile>& tiles, Wanted&& wanted) {
  tile.setMaxDepth(Iterator::LEAF_DEPTH - 1);
  for (std::size_t visited = 0; tile; ++tile, ++visited) {
    if (visited % blocks_at_once == 0) progress.check();
    if (!wanted(tile.getValue())) continue;
    openvdb::CoordBBox box;
    tile.getBoundingBox(box);
    tiles.push_back({block_of(to_voxel(box.min())), box.dim().x() / block_size});
  }
}

// Every change of sign between constant blocks is at a tile of unseen voxels or of stored distances, as
// nothing else is below 0 or covers such a tile.
BlocksAndTiles blocks_and_tiles(const VolumeGrids& grids, const Progress& progress) {
  BlocksAndTiles result;
  add_leaves(grids.state->tree(), progress, result.blocks);
  add_leaves(grids.distance->tree(), progress, result.blocks);
  add_tiles(grids.state->tree().cbeginValueOff(), progress, result.tiles, [](bool empty) { return !empty; });
  add_tiles(grids.distance->tree().cbeginValueOn(), progress, result.tiles, [](float) { return true; });
  return result;
}

// Whether blocks are inside, outside, or neither.
class BlockSigns {
 public:
  enum class Sign { inside, outside, mixed };

  explicit BlockSigns(const VolumeGrids& grids)
      : state_(grids.state->getConstAccessor()), distance_(grids.distance->getConstAccessor()) {}

  Sign sign(const VoxelIndex& block) const {
    const openvdb::Coord at = first_voxel(block);
    if (state_.probeConstLeaf(at) || distance_.probeConstLeaf(at)) return Sign::mixed;
    float distance = 0;
    if (distance_.probeValue(at, distance)) return distance < 0 ? Sign::inside : Sign::outside;
    bool empty = true;
    return !state_.probeValue(at, empty) && !empty ? Sign::inside : Sign::outside;
  }

  // Whether the box of blocks, whose corners belong to it, is all inside or all outside.
  bool constant(const VoxelIndex& low, const VoxelIndex& high) const {
    const Sign first = sign(low);
    if (first == Sign::mixed) return false;
    for (int x = low.x(); x <= high.x(); ++x)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int z = low.z(); z <= high.z(); ++z)
          if (sign({x, y, z}) != first) return false;
    return true;
  }

 private:
  openvdb::BoolGrid::ConstAccessor state_;
  openvdb::FloatGrid::ConstAccessor distance_;
};

// The blocks whose upper neighbours, or they themselves, reach across the surface of a tile.
void add_changes_at(const Tile& tile, const BlockSigns& signs, const Progress& progress,
                    std::vector<VoxelIndex>& blocks) {
  const VoxelIndex one = VoxelIndex::Ones();
  const VoxelIndex low = tile.low - one, high = tile.low + one * (tile.side - 1);
  if (tile.side == 1 && signs.constant(low, high + one)) return;
  for (int x = low.x(); x <= high.x(); ++x) {
    progress.check();
    for (int y = low.y(); y <= high.y(); ++y) {
      const bool shell = x == low.x() || x == high.x() || y == low.y() || y == high.y();
      for (int z = low.z(); z <= high.z(); z += shell ? 1 : tile.side) {
        const VoxelIndex block(x, y, z);
        if (!signs.constant(block, block + one)) blocks.push_back(block);
      }
    }
  }
}

void sort_and_unite(std::vector<VoxelIndex>& blocks) {
  std::sort(blocks.begin(), blocks.end(), block_before);
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
}

}  // namespace

struct BlockReader::Grids {
  openvdb::BoolGrid::ConstAccessor state;
  openvdb::FloatGrid::ConstAccessor distance;
  float ramp;

  // The part of a block that lies within the wanted one and the voxels round it.
  void read_part(const VoxelIndex& block, const VoxelIndex& step, BlockValues& values) const {
    const openvdb::Coord origin = first_voxel(block + step);
    const StateLeaf* states = state.probeConstLeaf(origin);
    const DistanceLeaf* distances = distance.probeConstLeaf(origin);
    bool tile_empty = true;
    float tile_distance = 0;
    const bool tile_seen = !states && state.probeValue(origin, tile_empty);
    const bool tile_known = !distances && distance.probeValue(origin, tile_distance);
    const auto first = [&](int axis) { return step[axis] < 0 ? block_size - 1 : 0; };
    const auto last = [&](int axis) { return step[axis] > 0 ? 0 : block_size - 1; };
    for (int x = first(0); x <= last(0); ++x)
      for (int y = first(1); y <= last(1); ++y)
        for (int z = first(2); z <= last(2); ++z) {
          const openvdb::Index at = openvdb::Index((x * block_size + y) * block_size + z);
          const int to = BlockValues::number(x + block_size * step.x(), y + block_size * step.y(),
                                             z + block_size * step.z());
          const bool seen = states ? states->isValueOn(at) : tile_seen;
          const bool empty = states ? states->getValue(at) : tile_empty;
          const bool known = distances ? distances->isValueOn(at) : tile_known;
          values.seen[to] = seen;
          values.distance[to] = known           ? (distances ? distances->getValue(at) : tile_distance)
                                : seen || empty ? ramp
                                                : -ramp;
        }
  }
};

BlockReader::BlockReader(const RangeVolume& volume)
    : grids_(new Grids{volume.grids().state->getConstAccessor(), volume.grids().distance->getConstAccessor(),
                       static_cast<float>(volume.frame().ramp)}) {}

BlockReader::~BlockReader() = default;

void BlockReader::read(const VoxelIndex& block, BlockValues& values) {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) grids_->read_part(block, {x, y, z}, values);
}

std::vector<VoxelIndex> blocks_with_sign_changes(const RangeVolume& volume, const Progress& progress) {
  BlocksAndTiles parts = blocks_and_tiles(volume.grids(), progress);
  sort_and_unite(parts.blocks);
  std::vector<VoxelIndex> result;
  result.reserve(8 * parts.blocks.size());
  for (const VoxelIndex& block : parts.blocks)
    for (int corner = 0; corner < 8; ++corner)
      result.push_back(block - VoxelIndex(corner & 1, corner >> 1 & 1, corner >> 2));
  const std::size_t ranges = (parts.tiles.size() + blocks_at_once - 1) / blocks_at_once;
  std::vector<std::vector<VoxelIndex>> found(ranges);
  for_ranges(parts.tiles.size(), blocks_at_once, progress, [&](std::size_t begin, std::size_t end) {
    const BlockSigns signs(volume.grids());
    for (std::size_t i = begin; i < end; ++i)
      add_changes_at(parts.tiles[i], signs, progress, found[begin / blocks_at_once]);
    progress.advance(double(end - begin) / double(parts.tiles.size()));
  });
  for (const std::vector<VoxelIndex>& some : found) result.insert(result.end(), some.begin(), some.end());
  sort_and_unite(result);
  progress.update(1);
  return result;
}

}  // namespace meshcomplete
