#include "filter_volmorph/filler_distances.h"

#include <openvdb/tools/Prune.h>

#include <utility>
#include <vector>

#include "filter_volmorph/block_bits.h"
#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {
namespace {

using openvdb::Coord;

constexpr std::size_t blocks_between_checks = 1024;
constexpr std::uint64_t all_bits = ~std::uint64_t(0);
static_assert(openvdb::BoolTree::LeafNodeType::DIM == block_size);

/// Which voxels of a block are empty, and which are not seen.
std::pair<BlockBits, BlockBits> empty_and_not_seen(const openvdb::BoolGrid::ConstAccessor& states,
                                                   const Coord& lowest) {
  BlockBits empty, not_seen;
  if (const auto* leaf = states.probeConstLeaf(lowest)) {
    for (int x = 0; x < block_size; ++x) {
      not_seen[x] = ~leaf->valueMask().getWord<std::uint64_t>(x);
      empty[x] = not_seen[x] & leaf->buffer().data()[x];
    }
  } else {
    bool value = true;
    const bool seen = states.probeValue(lowest, value);
    not_seen.fill(seen ? 0 : all_bits);
    empty.fill(!seen && value ? all_bits : 0);
  }
  return {empty, not_seen};
}

struct Block {
  Coord lowest;
  BlockBits stored;
};

/// The blocks with stored distances.
std::vector<Block> blocks_of(const openvdb::FloatTree& distances) {
  std::vector<Block> blocks;
  for (auto leaf = distances.cbeginLeaf(); leaf; ++leaf) {
    Block block{leaf->origin(), {}};
    for (int x = 0; x < block_size; ++x) block.stored[x] = leaf->valueMask().getWord<std::uint64_t>(x);
    blocks.push_back(block);
  }
  auto tile = distances.cbeginValueOn();
  tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const openvdb::CoordBBox box = tile.getBoundingBox();
    Block block{{}, {}};
    block.stored.fill(all_bits);
    for (int x = box.min().x(); x <= box.max().x(); x += block_size)
      for (int y = box.min().y(); y <= box.max().y(); y += block_size)
        for (int z = box.min().z(); z <= box.max().z(); z += block_size) {
          block.lowest = Coord(x, y, z);
          blocks.push_back(block);
        }
  }
  return blocks;
}

}  // namespace

void reset_filler_distances(const VolumeGrids& before, VolumeGrids& grids, const Progress& progress) {
  const auto old_states = before.state->getConstAccessor(), new_states = grids.state->getConstAccessor();
  std::vector<Block> changed;
  std::size_t looked_at = 0;
  for (const Block& block : blocks_of(grids.distance->tree())) {
    if (++looked_at % blocks_between_checks == 0) progress.check();
    const auto was = empty_and_not_seen(old_states, block.lowest);
    const auto is = empty_and_not_seen(new_states, block.lowest);
    Block change = block;
    for (int x = 0; x < block_size; ++x)
      change.stored[x] &= was.second[x] & is.second[x] & (was.first[x] ^ is.first[x]);
    if (any_bit(change.stored)) changed.push_back(change);
  }
  progress.update(0.2);
  if (changed.empty()) return;
  const openvdb::FloatGrid::Ptr copy = grids.distance->deepCopy();
  progress.update(0.8);
  for (const Block& change : changed) {
    auto* leaf = copy->tree().touchLeaf(change.lowest);
    for_each_bit(change.stored, [&](int x, int y, int z) {
      leaf->setValueOff(change.lowest.offsetBy(x, y, z), copy->background());
    });
  }
  openvdb::tools::pruneInactive(copy->tree());
  grids.distance = copy;
}

}  // namespace meshcomplete
