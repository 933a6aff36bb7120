#include "tests/volmorph/volumes.h"

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <random>
#include <utility>

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

namespace {

void make_seen(Voxel& voxel, std::mt19937& random) {
  std::uniform_real_distribution<float> unit(-1, 1);
  voxel.state = VoxelState::seen;
  voxel.distance = 4 * unit(random);
  voxel.weight = 1.5f + unit(random);
  const Eigen::Vector3f normal(unit(random), unit(random), unit(random));
  voxel.normal.reset();
  if (random() % 3 != 0) voxel.normal = unpack_normal(pack_normal(normal.normalized()));
}

int random_number(int low, int high, std::mt19937& random) {
  return std::uniform_int_distribution<int>(low, high)(random);
}

}  // namespace

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
    if (state == VoxelState::seen) make_seen(voxel, random);
  });
  return volume;
}

RangeVolume patchy_volume(const VoxelBox& box, std::uint32_t seed) {
  VolumeFrame frame;
  frame.box = box;
  std::mt19937 random(seed);
  VolumeBuilder builder(frame);
  const auto part = [&](int align) {
    VoxelBox part;
    for (int axis = 0; axis < 3; ++axis) {
      const int a = random_number(box.low[axis], box.high[axis], random);
      const int b = random_number(box.low[axis], box.high[axis], random);
      part.low[axis] = std::min(a, b) & -align;
      part.high[axis] = std::max(a, b) | (align - 1);
    }
    return part;
  };
  for (int i = 0; i < 6; ++i) {
    const int align = std::array<int, 3>{1, 8, 128}[random() % 3];
    builder.fill(part(align), random() % 2 == 0 ? VoxelState::empty : VoxelState::unseen);
  }
  const VoxelBox seen = part(1).common(box);
  const VoxelIndex high = seen.high.cwiseMin(seen.low + VoxelIndex::Constant(12));
  for (int z = seen.low.z(); z <= high.z(); ++z)
    for (int y = seen.low.y(); y <= high.y(); ++y)
      for (int x = seen.low.x(); x <= high.x(); ++x) {
        Voxel voxel;
        make_seen(voxel, random);
        builder.set({x, y, z}, voxel);
      }
  return builder.finish();
}

VoxelBox random_box(const VoxelBox& round, std::uint32_t seed) {
  std::mt19937 random(seed);
  VoxelBox box;
  const bool single = random() % 5 == 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int low = round.low[axis], high = round.high[axis];
    box.low[axis] = random_number(single ? low : low - 5, high, random);
    box.high[axis] = single ? box.low[axis] : random_number(std::max(low, box.low[axis]), high + 5, random);
  }
  return box;
}

RangeVolume sphere_volume(int size) {
  VolumeFrame frame;
  frame.box = {VoxelIndex::Constant(-size / 2), VoxelIndex::Constant(size - size / 2 - 1)};
  const double radius = 0.4 * size;
  VolumeBuilder builder(frame);
  constexpr int cell_size = 8;
  const VoxelIndex first = frame.box.low.array().unaryExpr([](int low) { return low & -cell_size; });
  for (int x = first.x(); x <= frame.box.high.x(); x += cell_size)
    for (int y = first.y(); y <= frame.box.high.y(); y += cell_size)
      for (int z = first.z(); z <= frame.box.high.z(); z += cell_size) {
        const VoxelBox cell = VoxelBox{{x, y, z}, VoxelIndex(x, y, z) + VoxelIndex::Constant(cell_size - 1)};
        const Vector3 middle = (cell.low + cell.high).cast<double>() / 2;
        if (middle.norm() < radius - 2 * cell_size) continue;
        builder.fill(cell, VoxelState::empty);
        if (middle.norm() > radius + 2 * cell_size) continue;
        for (int i = 0; i < cell_size * cell_size * cell_size; ++i) {
          const VoxelIndex at = cell.low + VoxelIndex(i / 64, i / 8 % 8, i % 8);
          const double distance = at.cast<double>().norm() - radius;
          if (!frame.box.contains(at) || distance > frame.ramp) continue;
          Voxel voxel;
          voxel.state = VoxelState::unseen;
          if (at.x() >= -0.8 * radius && distance >= -frame.ramp)
            voxel = {VoxelState::seen, static_cast<float>(distance), 1,
                     Eigen::Vector3f(at.cast<float>().normalized())};
          if (voxel.state == VoxelState::seen || distance < 0) builder.set(at, voxel);
        }
      }
  return builder.finish();
}

RangeVolume uniform_seen_volume() {
  DenseVolume dense(VolumeFrame{{0, 0, 0}, 1, 4, {{-5, -5, -5}, {28, 28, 28}}});
  const VoxelBox seen{{0, 8, 8}, {15, 15, 23}};
  dense.for_each([&](const VoxelIndex& at, const Voxel&) {
    dense.at(at) = {VoxelState::unseen, -4, 0, {}};
    if (seen.contains(at)) dense.at(at) = {VoxelState::seen, 0.5f, 2, Eigen::Vector3f(0, 0, 1)};
  });
  const RangeVolume volume = dense.volume();
  VolumeGrids grids = volume.grids();
  const auto pruned = [](const auto& grid) {
    const auto copy = grid->deepCopy();
    openvdb::tools::prune(copy->tree());
    return copy;
  };
  grids.distance = pruned(grids.distance);
  grids.weight = pruned(grids.weight);
  grids.normal = pruned(grids.normal);
  return RangeVolume(volume.frame(), std::make_shared<const VolumeGrids>(std::move(grids)));
}

RangeVolume with_filler_distances(const RangeVolume& volume) {
  VolumeGrids grids = volume.grids();
  const openvdb::FloatGrid::Ptr distances = grids.distance->deepCopy();
  const VoxelBox& box = volume.frame().box;
  const VoxelReader reader(volume);
  for (auto leaf = grids.state->tree().cbeginLeaf(); leaf; ++leaf) {
    for (auto voxel = leaf->cbeginValueOff(); voxel; ++voxel) {
      const openvdb::Coord at = voxel.getCoord();
      if (!box.contains(to_voxel(at)) || (at.x() + at.y() + at.z()) % 3 == 0) continue;
      distances->tree().setValueOn(at, voxel.getValue() ? 1.25f : -0.75f);
    }
  }
  grids.distance = distances;
  return RangeVolume(volume.frame(), std::make_shared<const VolumeGrids>(std::move(grids)));
}

bool same_voxel(const Voxel& a, const Voxel& b) {
  const auto same = [](float x, float y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  if (a.state != b.state || !same(a.distance, b.distance) || !same(a.weight, b.weight)) return false;
  if (a.normal.has_value() != b.normal.has_value()) return false;
  return !a.normal || *a.normal == *b.normal;
}

}  // namespace meshcomplete
