#include "filter_volmorph/diffusion_blocks.h"

#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

#include "common/core/error.h"
#include "common/core/threads.h"
#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {
namespace {

constexpr std::size_t blocks_at_once = 32;
constexpr std::size_t leaves_between_checks = 256;
constexpr std::size_t leaves_at_once = 16;

// The surface passes a voxel that is no farther from it than its diagonal, or than half of the ramp if that
// is less.
const double voxel_diagonal = std::sqrt(3.0);  // voxels
constexpr double part_of_ramp = 0.5;

void grow(openvdb::MaskTree& tree) {
  openvdb::tools::dilateActiveValues(tree, 1, openvdb::tools::NN_FACE_EDGE_VERTEX,
                                     openvdb::tools::EXPAND_TILES);
}

// Finds the voxels at rims.
class Rims {
 public:
  Rims(const RangeVolume& volume, const VoxelBox& box)
      : box_(to_coord_box(box)),
        largest_(
            float(std::min(voxel_diagonal * volume.frame().voxel_size, part_of_ramp * volume.frame().ramp))),
        voxels_(volume) {}

  // `visit(voxel)` is called for each that lies beside one of `leaf`, some more than once.
  template <class Visit>
  void beside(const openvdb::FloatTree::LeafNodeType& leaf, Visit&& visit) const {
    for (auto value = leaf.cbeginValueOn(); value; ++value)
      if (std::abs(value.getValue()) <= largest_) beside_voxel(value.getCoord(), visit);
  }

  template <class Visit>
  void beside_voxel(const openvdb::Coord& at, Visit&& visit) const {
    if (voxels_.state(at) != VoxelState::seen) return;
    for (int place = 0; place < 27; ++place) {
      const openvdb::Coord to = at.offsetBy(place / 9 - 1, place / 3 % 3 - 1, place % 3 - 1);
      if (box_.isInside(to) && voxels_.state(to) != VoxelState::seen && at_surface(to)) visit(to);
    }
  }

  bool reaches(const openvdb::CoordBBox& voxels) const {
    openvdb::CoordBBox wanted = box_;
    wanted.expand(1);
    return wanted.hasOverlap(voxels);
  }

  float largest() const { return largest_; }

 private:
  // Whether the surface, without any filler, passes between the voxel and one that shares a face with it.
  bool at_surface(const openvdb::Coord& voxel) const {
    const bool within = inside(voxel);
    for (int face = 0; face < 6; ++face) {
      openvdb::Coord beside = voxel;
      beside[face / 2] += face % 2 == 0 ? -1 : 1;
      if (inside(beside) != within) return true;
    }
    return false;
  }

  // Whatever an earlier filler made of voxels that are not seen.
  bool inside(const openvdb::Coord& voxel) const {
    const VoxelState state = voxels_.state(voxel);
    return state == VoxelState::seen ? voxels_.distance(voxel) < 0 : state == VoxelState::unseen;
  }

  openvdb::CoordBBox box_;
  float largest_;
  VoxelReader voxels_;
};

openvdb::MaskTree voxels_at_rims(const RangeVolume& volume, const VoxelBox& box, const Progress& progress) {
  using Leaf = openvdb::FloatTree::LeafNodeType;
  std::vector<const Leaf*> leaves;
  volume.grids().distance->tree().getNodes(leaves);
  std::vector<std::vector<openvdb::Coord>> found(leaves.size());
  for_ranges(leaves.size(), leaves_at_once, progress, [&](std::size_t begin, std::size_t end) {
    const Rims rims(volume, box);
    for (std::size_t i = begin; i < end; ++i)
      if (rims.reaches(leaves[i]->getNodeBoundingBox()))
        rims.beside(*leaves[i], [&](const openvdb::Coord& at) { found[i].push_back(at); });
  });
  openvdb::MaskTree mask;
  openvdb::tree::ValueAccessor<openvdb::MaskTree> marks(mask);
  for (const std::vector<openvdb::Coord>& voxels : found)
    for (const openvdb::Coord& at : voxels) marks.setValueOn(at);
  const Rims rims(volume, box);
  auto tile = volume.grids().distance->cbeginValueOn();
  tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    progress.check();
    if (std::abs(tile.getValue()) > rims.largest() || !rims.reaches(tile.getBoundingBox())) continue;
    for (auto at = tile.getBoundingBox().begin(); at; ++at)
      rims.beside_voxel(*at, [&](const openvdb::Coord& to) { marks.setValueOn(to); });
  }
  return mask;
}

void check_memory(const openvdb::MaskTree& within, double max_memory) {
  const double bytes = double(within.leafCount()) * bytes_per_diffusion_block;
  if (bytes <= max_memory) return;
  std::ostringstream text;
  text << std::setprecision(2) << "Filling would need more than " << 1e-9 * bytes << " GB of memory; "
       << 1e-9 * max_memory << " GB are allowed. Lower Reach, or choose a box round the holes.";
  throw CompletionError("finding the rims of holes", text.str());
}

openvdb::MaskTree voxels_within_reach(const RangeVolume& volume, const VoxelBox& box, int reach,
                                      double max_memory, const Progress& progress) {
  openvdb::MaskTree within = voxels_at_rims(volume, box, progress);
  const openvdb::BoolTree& seen = volume.grids().state->tree();
  openvdb::Index64 before = within.activeVoxelCount();
  for (int step = 1; step < reach; ++step) {
    progress.update(double(step) / reach);
    grow(within);
    within.topologyDifference(seen);
    within.clip(to_coord_box(box));
    openvdb::tools::pruneInactive(within);
    check_memory(within, max_memory);
    const openvdb::Index64 count = within.activeVoxelCount();
    if (count == before) break;
    before = count;
  }
  within.voxelizeActiveTiles();
  return within;
}

// Writes what the volume knows of the block.
void read_block(const VoxelReader& reader, const openvdb::FloatGrid::ConstAccessor& distances, bool normals,
                DiffusionBlock& block) {
  const openvdb::Coord origin = to_coord(block_size * block.index);
  block.distance.fill(0);
  for (int number = 0; number < block_voxels; ++number) {
    const openvdb::Coord at = origin.offsetBy(number / (block_size * block_size),
                                              number / block_size % block_size, number % block_size);
    block.known[number] = distances.probeValue(at, block.distance[number]);
    if (!block.known[number]) block.distance[number] = 0;
    block.empty[number] = block.within[number] && reader.state(at) == VoxelState::empty;
    const std::optional<Eigen::Vector3f> normal = normals ? reader.normal(at) : std::nullopt;
    if (!normal) continue;
    block.normals.resize(3);
    block.directed[number] = true;
    for (int k = 0; k < 3; ++k) block.normals[k][number] = std::int16_t(std::lround(32767 * (*normal)[k]));
  }
  if (normals && block.within.any()) block.normals.resize(3);
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
      const openvdb::Coord at = to_coord(block_size * block);
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
                                             bool normals, double max_memory, const Progress& progress) {
  const VolumeGrids& grids = volume.grids();
  const openvdb::MaskTree within =
      voxels_within_reach(volume, box, reach, max_memory, progress.part(0, 0.8, "finding the rims of holes"));
  const std::vector<VoxelIndex> indices = blocks_around(within, grids);
  std::vector<DiffusionBlock> blocks(indices.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i].index = indices[i];
  const Progress reading = progress.part(0.8, 1, "finding the rims of holes");
  for_ranges(blocks.size(), blocks_at_once, reading, [&](std::size_t begin, std::size_t end) {
    const VoxelReader reader(volume);
    const auto distances = grids.distance->getConstAccessor();
    for (std::size_t i = begin; i < end; ++i) {
      DiffusionBlock& block = blocks[i];
      if (const auto* leaf = within.probeConstLeaf(to_coord(block_size * block.index)))
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

std::vector<std::size_t> blocks_to_fill(const std::vector<DiffusionBlock>& blocks) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (blocks[i].within.any()) numbers.push_back(i);
  return numbers;
}

RangeVolume with_distances(const RangeVolume& volume, const std::vector<DiffusionBlock>& blocks,
                           const Progress& progress) {
  VolumeGrids grids = volume.grids();
  openvdb::FloatGrid::Ptr distance = grids.distance->deepCopy();
  std::size_t visited = 0;
  for (const DiffusionBlock& block : blocks) {
    if (visited++ % leaves_between_checks == 0) progress.check();
    if (block.within.none()) continue;
    auto* leaf = distance->tree().touchLeaf(to_coord(block_size * block.index));
    for (int number = 0; number < block_voxels; ++number)
      if (block.within[number] && block.known[number])
        leaf->setValueOn(openvdb::Index(number), block.distance[number]);
  }
  grids.distance = distance;
  return RangeVolume(volume.frame(), std::make_shared<const VolumeGrids>(std::move(grids)));
}

}  // namespace meshcomplete
