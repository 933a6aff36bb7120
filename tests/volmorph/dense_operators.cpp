#include "tests/volmorph/dense_operators.h"

#include <cmath>

namespace meshcomplete {
namespace {

bool has_neighbour(const DenseVolume& volume, const VoxelIndex& at, VoxelState state) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int step : {-1, 1}) {
      VoxelIndex neighbour = at;
      neighbour[axis] += step;
      if (volume.frame.box.contains(neighbour) && volume.at(neighbour).state == state) return true;
    }
  }
  return false;
}

DenseVolume with_other_state(const DenseVolume& volume, const VoxelBox& box, VoxelState from, VoxelState to) {
  DenseVolume result = volume;
  const double distance = to == VoxelState::empty ? volume.frame.ramp : -volume.frame.ramp;
  volume.for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    if (voxel.state != from || !box.contains(at) || !has_neighbour(volume, at, to)) return;
    result.at(at) = {to, static_cast<float>(distance), 0, {}};
  });
  return result;
}

}  // namespace

DenseVolume dense_erosion(const DenseVolume& volume, const VoxelBox& box) {
  return with_other_state(volume, box, VoxelState::unseen, VoxelState::empty);
}

DenseVolume dense_dilation(const DenseVolume& volume, const VoxelBox& box) {
  return with_other_state(volume, box, VoxelState::empty, VoxelState::unseen);
}

DenseVolume dense_expansion(const DenseVolume& volume, const VoxelBox& box) {
  const double pi = 3.14159265358979323846;
  DenseVolume result = volume;
  volume.for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    if (voxel.state != VoxelState::seen || !voxel.normal || !box.contains(at)) return;
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
          const VoxelIndex target = at + VoxelIndex(x, y, z);
          if (!volume.frame.box.contains(target) || volume.at(target).state == VoxelState::seen) continue;
          const double dot =
              voxel.normal->cast<double>().dot(Vector3(x, y, z)) / std::sqrt(x * x + y * y + z * z);
          if (dot > std::cos(112.5 * pi / 180) && dot < std::cos(67.5 * pi / 180)) result.at(target) = voxel;
        }
      }
    }
  });
  return result;
}

std::uint64_t count_differences(const DenseVolume& a, const DenseVolume& b) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < a.voxels.size(); ++i)
    if (!same_voxel(a.voxels[i], b.voxels[i])) ++count;
  return count;
}

}  // namespace meshcomplete
