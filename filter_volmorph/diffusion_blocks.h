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

constexpr int block_voxels = block_size * block_size * block_size;
/// A voxel's number in its block.
constexpr int block_number(int x, int y, int z) { return (x * block_size + y) * block_size + z; }

/// One coordinate of each voxel's normal, a unit vector or a mean of such, times 32767; 0 where it has none.
using NormalPart = std::array<std::int16_t, block_voxels>;

/// 1 or 0 for each voxel.
using BlockFlags = std::array<std::uint8_t, block_voxels>;

struct DiffusionBlock {
  VoxelIndex index;
  std::bitset<block_voxels> within;           ///< to be filled
  BlockFlags empty{};                         ///< of those, known to be empty
  BlockFlags known{};                         ///< with a distance
  std::array<float, block_voxels> distance;   ///< mesh units; 0 where it is not known
  BlockFlags directed{};                      ///< with a normal
  std::vector<NormalPart> normals;            ///< x, y and z of each voxel's, or nothing at all
  std::vector<std::uint8_t> weights;          ///< of the 26 neighbours for each voxel, or none
  std::array<std::int32_t, 27> neighbours{};  ///< numbers of the blocks around, -1 where there is none;
                                              ///< [(x + 1) * 9 + (y + 1) * 3 + z + 1]
};

/// Bytes that a block takes while distances diffuse, about: values, weights, normals and what the next step
/// makes of them.
constexpr double bytes_per_diffusion_block = 25e3;

/// The blocks within reach of a rim (in `box`, inside the volume's), and those around which hold something
/// known. A rim is where the surface leaves what was observed: a voxel that is not seen, with a neighbour on
/// the other side of the surface, beside a seen one that the surface passes (no farther from it than the
/// diagonal of a voxel). Where seen space ends above and below an observed surface there is none. Normals of
/// seen voxels only with `normals`. Throws CompletionError when the blocks would take more than `max_memory`
/// bytes.
std::vector<DiffusionBlock> diffusion_blocks(const RangeVolume& volume, const VoxelBox& box, int reach,
                                             bool normals, double max_memory,
                                             const Progress& progress = Progress());

/// The numbers of the blocks in which something is to be filled.
std::vector<std::size_t> blocks_to_fill(const std::vector<DiffusionBlock>& blocks);

/// The volume with the distances of the voxels that are within and known.
RangeVolume with_distances(const RangeVolume& volume, const std::vector<DiffusionBlock>& blocks,
                           const Progress& progress = Progress());

}  // namespace meshcomplete
