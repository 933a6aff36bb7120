#include "filter_volmorph/surface_voxels.h"

#include <cmath>

#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {

std::vector<SurfaceVoxel> surface_voxels(const RangeVolume& volume) {
  const VoxelReader reader(volume);
  const VolumeFrame& frame = volume.frame();
  std::vector<SurfaceVoxel> voxels;
  for (auto weight = volume.grids().weight->cbeginValueOn(); weight; ++weight) {
    openvdb::CoordBBox box;
    weight.getBoundingBox(box);
    for (const openvdb::Coord& at : box) {
      if (std::abs(reader.distance(at)) > 0.5 * frame.voxel_size) continue;
      const std::optional<Eigen::Vector3f> normal = reader.normal(at);
      voxels.push_back({frame.position(to_voxel(at).cast<double>()),
                        normal ? Vector3(normal->cast<double>()) : Vector3(Vector3::Zero()), *weight});
    }
  }
  return voxels;
}

}  // namespace meshcomplete
