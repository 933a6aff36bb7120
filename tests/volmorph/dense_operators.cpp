#include "tests/volmorph/dense_operators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

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

// The up to 26 neighbours in the volume, with the axes along which they differ: 1, 2 or 3.
void for_each_around(const VoxelBox& box, const VoxelIndex& at,
                     const std::function<void(const VoxelIndex&, int)>& visit) {
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const VoxelIndex neighbour = at + VoxelIndex(x, y, z);
        const int axes = std::abs(x) + std::abs(y) + std::abs(z);
        if (axes > 0 && box.contains(neighbour)) visit(neighbour, axes);
      }
}

// Whatever an earlier filler made of voxels that are not seen.
bool inside(const DenseVolume& volume, const VoxelIndex& at) {
  if (!volume.frame.box.contains(at)) return false;
  const Voxel& voxel = volume.at(at);
  return voxel.state == VoxelState::seen ? voxel.distance < 0 : voxel.state == VoxelState::unseen;
}

// Whether a voxel lies beside a seen one that the surface passes, and the surface without any filler between
// it and one that shares a face with it.
bool at_rim(const DenseVolume& volume, const VoxelIndex& at) {
  const double farthest = std::min(std::sqrt(3.0) * volume.frame.voxel_size, volume.frame.ramp / 2);
  bool beside = false, passed = false;
  for_each_around(volume.frame.box, at, [&](const VoxelIndex& neighbour, int) {
    const Voxel& from = volume.at(neighbour);
    beside = beside || (from.state == VoxelState::seen && std::abs(from.distance) <= farthest);
  });
  for (int face = 0; face < 6; ++face) {
    VoxelIndex other = at;
    other[face / 2] += face % 2 == 0 ? -1 : 1;
    passed = passed || inside(volume, other) != inside(volume, at);
  }
  return beside && passed;
}

// By voxel: whether it is in the box, not seen, and at a rim or fewer than so many steps from one that is,
// through others like it.
std::vector<char> within_reach(const DenseVolume& volume, const VoxelBox& box, int reach) {
  std::vector<char> within(volume.voxels.size(), 0);
  for (int step = 0; step < reach; ++step) {
    const std::vector<char> before = within;
    volume.for_each([&](const VoxelIndex& at, const Voxel& voxel) {
      if (voxel.state == VoxelState::seen || !box.contains(at)) return;
      if (step == 0) within[volume.number(at)] = at_rim(volume, at);
      for_each_around(volume.frame.box, at, [&](const VoxelIndex& neighbour, int) {
        if (before[volume.number(neighbour)]) within[volume.number(at)] = 1;
      });
    });
  }
  return within;
}

struct DenseDistances {
  std::vector<char> known;
  std::vector<double> distance;
};

DenseDistances known_distances(const DenseVolume& volume) {
  DenseDistances found;
  for (const Voxel& voxel : volume.voxels) {
    const double unfilled = voxel.state == VoxelState::empty ? volume.frame.ramp : -volume.frame.ramp;
    found.known.push_back(voxel.state == VoxelState::seen || voxel.distance != float(unfilled));
    found.distance.push_back(voxel.distance);
  }
  return found;
}

// One step of blurring: the mean of the known neighbours, and of empty voxels as much of the ramp as the
// options say, half a voxel at least.
DenseDistances blurred(const DenseVolume& volume, const std::vector<char>& within,
                       const DiffusionOptions& options, const DenseDistances& before) {
  // 1, a half and a quarter, the binomial blur, as a byte holds them: by the axes along which neighbours
  // differ.
  const std::array<double, 4> weights = {0, 255, 127, 63};
  DenseDistances after = before;
  volume.for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    const std::size_t number = volume.number(at);
    if (!within[number]) return;
    double total = 0, sum = 0;
    for_each_around(volume.frame.box, at, [&](const VoxelIndex& neighbour, int axes) {
      const std::size_t from = volume.number(neighbour);
      if (!before.known[from]) return;
      total += weights[std::size_t(axes)];
      sum += weights[std::size_t(axes)] * before.distance[from];
    });
    if (total == 0) return;
    double distance = sum / total;
    if (voxel.state == VoxelState::empty && options.line_of_sight)
      distance = std::max(std::min(volume.frame.ramp, 0.5 * volume.frame.voxel_size),
                          options.empty_weight * volume.frame.ramp + (1 - options.empty_weight) * distance);
    after.known[number] = 1;
    after.distance[number] = distance;
  });
  return after;
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

DenseVolume dense_diffusion(const DenseVolume& volume, const VoxelBox& box, const DiffusionOptions& options) {
  const std::vector<char> within = within_reach(volume, box, options.reach);
  DenseDistances distances = known_distances(volume);
  for (int iteration = 0; iteration < options.iterations; ++iteration)
    distances = blurred(volume, within, options, distances);
  DenseVolume result = volume;
  for (std::size_t i = 0; i < within.size(); ++i)
    if (within[i] && distances.known[i]) result.voxels[i].distance = float(distances.distance[i]);
  return result;
}

std::uint64_t count_differences(const DenseVolume& a, const DenseVolume& b) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < a.voxels.size(); ++i)
    if (!same_voxel(a.voxels[i], b.voxels[i])) ++count;
  return count;
}

}  // namespace meshcomplete
