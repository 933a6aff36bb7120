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

/// Which voxels of a block have a stored distance.
BlockBits stored_bits(const openvdb::FloatGrid::ConstAccessor& distances, const Coord& lowest) {
  BlockBits bits;
  if (const auto* leaf = distances.probeConstLeaf(lowest)) {
    for (int x = 0; x < block_size; ++x) bits[x] = leaf->valueMask().getWord<std::uint64_t>(x);
  } else {
    bits.fill(distances.isValueOn(lowest) ? all_bits : 0);
  }
  return bits;
}

/// The blocks with stored distances.
std::vector<Coord> blocks_of(const openvdb::FloatTree& distances) {
  std::vector<Coord> blocks;
  for (auto leaf = distances.cbeginLeaf(); leaf; ++leaf) blocks.push_back(leaf->origin());
  auto tile = distances.cbeginValueOn();
  tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const openvdb::CoordBBox box = tile.getBoundingBox();
    for (int x = box.min().x(); x <= box.max().x(); x += block_size)
      for (int y = box.min().y(); y <= box.max().y(); y += block_size)
        for (int z = box.min().z(); z <= box.max().z(); z += block_size) blocks.emplace_back(x, y, z);
  }
  return blocks;
}

}  // namespace

void reset_filler_distances(VolumeGrids& grids, const std::vector<StateChange>& changes,
                            const Progress& progress) {
  const auto distances = grids.distance->getConstAccessor();
  std::vector<StateChange> stored;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (i % blocks_between_checks == 0) progress.check();
    const StateChange change{changes[i].lowest,
                             changes[i].bits & stored_bits(distances, to_coord(changes[i].lowest))};
    if (any_bit(change.bits)) stored.push_back(change);
  }
  progress.update(0.2);
  if (stored.empty()) return;
  const openvdb::FloatGrid::Ptr copy = grids.distance->deepCopy();
  progress.update(0.8);
  for (const StateChange& change : stored) {
    const Coord lowest = to_coord(change.lowest);
    auto* leaf = copy->tree().touchLeaf(lowest);
    for_each_bit(change.bits, [&](int x, int y, int z) {
      leaf->setValueOff(lowest.offsetBy(x, y, z), copy->background());
    });
  }
  openvdb::tools::pruneInactive(copy->tree());
  grids.distance = copy;
}

void reset_filler_distances(const VolumeGrids& before, VolumeGrids& grids, const Progress& progress) {
  const auto old_states = before.state->getConstAccessor(), new_states = grids.state->getConstAccessor();
  std::vector<StateChange> changes;
  std::size_t looked_at = 0;
  for (const Coord& lowest : blocks_of(grids.distance->tree())) {
    if (++looked_at % blocks_between_checks == 0) progress.check();
    const auto was = empty_and_not_seen(old_states, lowest);
    const auto is = empty_and_not_seen(new_states, lowest);
    StateChange change{to_voxel(lowest), was.second & is.second};
    for (int x = 0; x < block_size; ++x) change.bits[x] &= was.first[x] ^ is.first[x];
    if (any_bit(change.bits)) changes.push_back(change);
  }
  reset_filler_distances(grids, changes, progress.part(0.2, 1, "forgetting distances"));
}

}  // namespace meshcomplete
