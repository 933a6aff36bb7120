// Volumes as plain arrays: what the tests make volumes from and compare them with.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {

/// Every voxel of a box.
struct DenseVolume {
  explicit DenseVolume(const VolumeFrame& frame);
  /// The same voxels as the volume's.
  explicit DenseVolume(const RangeVolume& volume);

  Voxel& at(const VoxelIndex& voxel) { return voxels[number(voxel)]; }
  const Voxel& at(const VoxelIndex& voxel) const { return voxels[number(voxel)]; }
  std::size_t number(const VoxelIndex& voxel) const;

  /// In the order z, y, x: x fastest.
  void for_each(const std::function<void(const VoxelIndex&, const Voxel&)>& visit) const;

  RangeVolume volume() const;

  VolumeFrame frame;
  std::vector<Voxel> voxels;
};

/// Random states in patches, with random distances, weights and normals of the seen voxels, a third of them
/// without a normal. Ramp 4, voxel size 1.
DenseVolume random_volume(const VoxelBox& box, std::uint32_t seed);

/// The same in every bit.
bool same_voxel(const Voxel& a, const Voxel& b);

}  // namespace meshcomplete
