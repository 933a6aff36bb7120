// The voxels round the rims of an observed surface, in blocks: what diffusion works on.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"
#include "filter_volmorph/volume_blocks.h"

namespace meshcomplete {

constexpr int block_voxels = block_side * block_side * block_side;
/// A voxel's number in its block.
constexpr int block_number(int x, int y, int z) { return (x * block_side + y) * block_side + z; }

/// A unit vector, or a mean of such; times 32767.
using StoredNormal = std::array<std::int16_t, 3>;

struct DiffusionBlock {
  VoxelIndex index;
  std::bitset<block_voxels> within;           ///< to be filled
  std::bitset<block_voxels> empty;            ///< of those, known to be empty
  std::bitset<block_voxels> known;            ///< with a distance
  std::array<float, block_voxels> distance;   ///< mesh units; 0 where it is not known
  std::bitset<block_voxels> directed;         ///< with a normal
  std::vector<StoredNormal> normals;          ///< of each voxel, or none at all
  std::vector<std::uint8_t> weights;          ///< of the 26 neighbours for each voxel, or none
  std::array<std::int32_t, 27> neighbours{};  ///< numbers of the blocks around, -1 where there is none;
                                              ///< [(x + 1) * 9 + (y + 1) * 3 + z + 1]
};

/// The blocks within reach of a rim (in `box`, inside the volume's), and those around which hold something
/// known. A rim is where a voxel that is not seen is beside a seen one that the surface passes: no farther
/// from it than the diagonal of a voxel. Normals of seen voxels only with `normals`.
std::vector<DiffusionBlock> diffusion_blocks(const RangeVolume& volume, const VoxelBox& box, int reach,
                                             bool normals, const Progress& progress = Progress());

/// The volume with the distances of the voxels that are within and known.
RangeVolume with_distances(const RangeVolume& volume, const std::vector<DiffusionBlock>& blocks,
                           const Progress& progress = Progress());

}  // namespace meshcomplete
