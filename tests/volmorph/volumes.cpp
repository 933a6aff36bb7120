#include "tests/volmorph/volumes.h"

#include <cstring>
#include <random>

namespace meshcomplete {

DenseVolume::DenseVolume(const VolumeFrame& given) : frame(given) {
  const VoxelIndex size = frame.box.size();
  voxels.resize(std::size_t(size.x()) * std::size_t(size.y()) * std::size_t(size.z()));
}

DenseVolume::DenseVolume(const RangeVolume& volume) : DenseVolume(volume.frame()) {
  const VoxelReader reader(volume);
  for_each([&](const VoxelIndex& at, const Voxel&) { voxels[number(at)] = reader.voxel(to_coord(at)); });
}

std::size_t DenseVolume::number(const VoxelIndex& voxel) const {
  const VoxelIndex from_low = voxel - frame.box.low;
  const VoxelIndex size = frame.box.size();
  return (std::size_t(from_low.z()) * size.y() + from_low.y()) * size.x() + from_low.x();
}

void DenseVolume::for_each(const std::function<void(const VoxelIndex&, const Voxel&)>& visit) const {
  const VoxelBox& box = frame.box;
  for (int z = box.low.z(); z <= box.high.z(); ++z)
    for (int y = box.low.y(); y <= box.high.y(); ++y)
      for (int x = box.low.x(); x <= box.high.x(); ++x) visit({x, y, z}, at({x, y, z}));
}

RangeVolume DenseVolume::volume() const {
  VolumeBuilder builder(frame);
  for_each([&](const VoxelIndex& at, const Voxel& voxel) { builder.set(at, voxel); });
  return builder.finish();
}

DenseVolume random_volume(const VoxelBox& box, std::uint32_t seed) {
  VolumeFrame frame;
  frame.box = box;
  DenseVolume volume(frame);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  VoxelState state = VoxelState::unseen;
  volume.for_each([&](const VoxelIndex& at, const Voxel&) {
    if (unit(random) < 0) state = static_cast<VoxelState>(random() % 3);
    Voxel& voxel = volume.at(at);
    voxel.state = state;
    voxel.distance = state == VoxelState::empty ? 4.f : -4.f;
    if (state != VoxelState::seen) return;
    voxel.distance = 4 * unit(random);
    voxel.weight = 1.5f + unit(random);
    const Eigen::Vector3f normal(unit(random), unit(random), unit(random));
    if (random() % 3 != 0) voxel.normal = unpack_normal(pack_normal(normal.normalized()));
  });
  return volume;
}

bool same_voxel(const Voxel& a, const Voxel& b) {
  const auto same = [](float x, float y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  if (a.state != b.state || !same(a.distance, b.distance) || !same(a.weight, b.weight)) return false;
  if (a.normal.has_value() != b.normal.has_value()) return false;
  return !a.normal || *a.normal == *b.normal;
}

}  // namespace meshcomplete
