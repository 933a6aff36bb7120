#include "filter_volmorph/diffusion_blocks.h"

#include <openvdb/tools/Morphology.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/threads.h"
#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {
namespace {

constexpr std::size_t blocks_at_once = 32;
constexpr std::size_t leaves_between_checks = 256;

const double voxel_diagonal = std::sqrt(3.0);  // voxels

void grow(openvdb::MaskTree& tree) {
  openvdb::tools::dilateActiveValues(tree, 1, openvdb::tools::NN_FACE_EDGE_VERTEX,
                                     openvdb::tools::EXPAND_TILES);
}

// The seen voxels that the surface passes, as far as their neighbours may lie in the box.
openvdb::MaskTree voxels_at_surface(const RangeVolume& volume, const VoxelBox& box,
                                    const Progress& progress) {
  openvdb::CoordBBox wanted = to_coord_box(box);
  wanted.expand(1);
  const float largest = float(voxel_diagonal * volume.frame().voxel_size);
  const auto state = volume.grids().state->getConstAccessor();
  openvdb::MaskTree mask;
  openvdb::tree::ValueAccessor<openvdb::MaskTree> marks(mask);
  std::size_t visited = 0;
  for (auto value = volume.grids().distance->cbeginValueOn(); value; ++value) {
    if (visited++ % (leaves_between_checks * block_voxels) == 0) progress.check();
    if (std::abs(value.getValue()) > largest) continue;
    openvdb::CoordBBox at;
    value.getBoundingBox(at);
    at.intersect(wanted);
    for (auto coord = at.begin(); coord; ++coord)
      if (state.isValueOn(*coord)) marks.setValueOn(*coord);
  }
  return mask;
}

openvdb::MaskTree voxels_within_reach(const RangeVolume& volume, const VoxelBox& box, int reach,
                                      const Progress& progress) {
  openvdb::MaskTree within = voxels_at_surface(volume, box, progress);
  const openvdb::BoolTree& seen = volume.grids().state->tree();
  openvdb::Index64 before = 0;
  for (int step = 0; step < reach; ++step) {
    progress.update(double(step) / reach);
    grow(within);
    within.topologyDifference(seen);
    within.clip(to_coord_box(box));
    const openvdb::Index64 count = within.activeVoxelCount();
    if (count == before) break;
    before = count;
  }
  within.voxelizeActiveTiles();
  return within;
}

StoredNormal stored(const Eigen::Vector3f& n) {
  const auto part = [](float x) { return std::int16_t(std::lround(32767 * x)); };
  return {part(n.x()), part(n.y()), part(n.z())};
}

// Writes what the volume knows of the block.
void read_block(const VoxelReader& reader, const openvdb::FloatGrid::ConstAccessor& distances, bool normals,
                DiffusionBlock& block) {
  const openvdb::Coord origin = to_coord(block_side * block.index);
  block.distance.fill(0);
  for (int number = 0; number < block_voxels; ++number) {
    const openvdb::Coord at = origin.offsetBy(number / (block_side * block_side),
                                              number / block_side % block_side, number % block_side);
    block.known[number] = distances.probeValue(at, block.distance[number]);
    if (!block.known[number]) block.distance[number] = 0;
    block.empty[number] = block.within[number] && reader.state(at) == VoxelState::empty;
    const std::optional<Eigen::Vector3f> normal = normals ? reader.normal(at) : std::nullopt;
    if (!normal) continue;
    block.normals.resize(block_voxels);
    block.directed[number] = true;
    block.normals[number] = stored(*normal);
  }
  if (normals && block.within.any()) block.normals.resize(block_voxels);
}

std::int32_t number_of(const std::vector<DiffusionBlock>& blocks, const VoxelIndex& index) {
  const auto found = std::lower_bound(blocks.begin(), blocks.end(), index,
                                      [](const DiffusionBlock& block, const VoxelIndex& wanted) {
                                        return block_before(block.index, wanted);
                                      });
  return found != blocks.end() && found->index == index ? std::int32_t(found - blocks.begin()) : -1;
}

template <class Visit>
void for_each_neighbour(const VoxelIndex& index, Visit&& visit) {
  for (int number = 0; number < 27; ++number)
    visit(number, VoxelIndex(index + VoxelIndex(number / 9 - 1, number / 3 % 3 - 1, number % 3 - 1)));
}

// Every leaf's block and those around it that may know something.
std::vector<VoxelIndex> blocks_around(const openvdb::MaskTree& within, const VolumeGrids& grids) {
  const auto distances = grids.distance->getConstAccessor();
  std::vector<VoxelIndex> blocks;
  for (auto leaf = within.cbeginLeaf(); leaf; ++leaf)
    for_each_neighbour(block_of(to_voxel(leaf->origin())), [&](int, const VoxelIndex& block) {
      const openvdb::Coord at = to_coord(block_side * block);
      if (block_of(to_voxel(leaf->origin())) == block || distances.probeConstLeaf(at) ||
          distances.isValueOn(at))
        blocks.push_back(block);
    });
  std::sort(blocks.begin(), blocks.end(), block_before);
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

}  // namespace

std::vector<DiffusionBlock> diffusion_blocks(const RangeVolume& volume, const VoxelBox& box, int reach,
                                             bool normals, const Progress& progress) {
  const VolumeGrids& grids = volume.grids();
  const openvdb::MaskTree within =
      voxels_within_reach(volume, box, reach, progress.part(0, 0.8, "finding the rims of holes"));
  const std::vector<VoxelIndex> indices = blocks_around(within, grids);
  std::vector<DiffusionBlock> blocks(indices.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i].index = indices[i];
  const Progress reading = progress.part(0.8, 1, "finding the rims of holes");
  for_ranges(blocks.size(), blocks_at_once, reading, [&](std::size_t begin, std::size_t end) {
    const VoxelReader reader(volume);
    const auto distances = grids.distance->getConstAccessor();
    for (std::size_t i = begin; i < end; ++i) {
      DiffusionBlock& block = blocks[i];
      if (const auto* leaf = within.probeConstLeaf(to_coord(block_side * block.index)))
        for (auto on = leaf->cbeginValueOn(); on; ++on) block.within[on.pos()] = true;
      read_block(reader, distances, normals, block);
      if (block.within.any())
        for_each_neighbour(block.index, [&](int place, const VoxelIndex& index) {
          block.neighbours[place] = number_of(blocks, index);
        });
    }
    reading.advance(double(end - begin) / double(blocks.size()));
  });
  return blocks;
}

RangeVolume with_distances(const RangeVolume& volume, const std::vector<DiffusionBlock>& blocks,
                           const Progress& progress) {
  VolumeGrids grids = volume.grids();
  openvdb::FloatGrid::Ptr distance = grids.distance->deepCopy();
  std::size_t visited = 0;
  for (const DiffusionBlock& block : blocks) {
    if (visited++ % leaves_between_checks == 0) progress.check();
    const std::bitset<block_voxels> written = block.within & block.known;
    if (written.none()) continue;
    auto* leaf = distance->tree().touchLeaf(to_coord(block_side * block.index));
    for (int number = 0; number < block_voxels; ++number)
      if (written[number]) leaf->setValueOn(openvdb::Index(number), block.distance[number]);
  }
  grids.distance = distance;
  return RangeVolume(volume.frame(), std::make_shared<const VolumeGrids>(std::move(grids)));
}

}  // namespace meshcomplete
