// The inner loops of diffusion, over one block each.
#pragma once

#include <array>
#include <cstdint>

#include "filter_volmorph/diffusion_blocks.h"

namespace meshcomplete {

/// A value of each voxel of a block and of those around it; BlockValues::number says where.
template <class Value>
using Halo = std::array<Value, BlockValues::count>;

/// A value of each voxel of a block; block_number says where.
template <class Value>
using Block = std::array<Value, block_voxels>;

/// The neighbours of a voxel, in the order of `DiffusionBlock::neighbours` without the voxel itself.
constexpr int neighbour_count = 26;

/// For each voxel the sum over its neighbours of weight times value; `weights` holds 26 blocks, one for each
/// neighbour. These and the next are compiled for processors with AVX2, too; the sums are the same in every
/// bit.
void sum_neighbours(const std::uint8_t* weights, const Halo<float>& values, Block<float>& sums);

/// For each voxel the sum over its neighbours, each times its nearness: the binomial blur, one axis after
/// another, without the voxel itself, divided by four.
void blur_neighbours(const Halo<float>& values, Block<float>& sums);

/// What becomes of distances in a step, mesh units.
struct DistanceRule {
  float ramp;
  float least_empty;   ///< of voxels known to be empty
  float empty_weight;  ///< of the ramp in these, 0 to 1
};

/// Replaces the distance of each voxel whose weight is above 0 by the mean of its neighbours' (sum divided by
/// weight), and those of empty voxels (1 in `empty`) by what the rule makes of that.
void compose_distances(const DistanceRule& rule, const Block<std::uint8_t>& empty,
                       const Block<float>& weights, const Block<float>& sums, Block<float>& distances);

/// One part of a block's normals: from `part`, those before, `factor` times the way to sum divided by weight;
/// within -largest and largest, rounded. Voxels without weight keep theirs.
void relax_part(const Block<float>& weights, const Block<float>& sums, float factor, float largest,
                Block<std::int16_t>& part);

}  // namespace meshcomplete
