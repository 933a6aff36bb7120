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

/// Large uniform regions: boxes of one state each, laid over each other, one of them seen with random voxels
/// like those of `random_volume`. Some regions fill whole leaves and tiles. Made without visiting each voxel.
RangeVolume patchy_volume(const VoxelBox& box, std::uint32_t seed);

/// A box with random corners, of which a part lies in the given one; often it reaches beyond that, and
/// sometimes it is a single voxel.
VoxelBox random_box(const VoxelBox& round, std::uint32_t seed);

/// A band of seen voxels with normals round a sphere in the middle of a cube with so many voxels along an
/// edge, unseen inside, empty outside, open where x < -0.8 radii: no voxel is seen there. Ramp 4, voxel
/// size 1.
RangeVolume sphere_volume(int size);

/// Seen voxels, all the same, as single values of whole blocks in every grid, in an unseen volume.
RangeVolume uniform_seen_volume();

/// Distances of unseen and empty voxels next to the states' boundaries, as a filler stores them; states,
/// weights and normals are shared.
RangeVolume with_filler_distances(const RangeVolume& volume);

/// The same in every bit.
bool same_voxel(const Voxel& a, const Voxel& b);

}  // namespace meshcomplete
