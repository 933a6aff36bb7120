// A volume made from range scans: for every voxel what the scanners know of it. An immutable value.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "common/core/mesh.h"

namespace meshcomplete {

/// What is known of a voxel: no scanner looked at it, a scanner looked through it, or it is near an observed
/// surface.
enum class VoxelState : std::uint8_t { unseen, empty, seen };

/// A voxel's number along x, y and z.
using VoxelIndex = Eigen::Vector3i;

/// A box of voxels; both corners belong to it.
struct VoxelBox {
  VoxelIndex low = VoxelIndex::Zero();
  VoxelIndex high = VoxelIndex::Constant(-1);

  bool empty() const { return (high.array() < low.array()).any(); }
  bool contains(const VoxelIndex& voxel) const {
    return (voxel.array() >= low.array()).all() && (voxel.array() <= high.array()).all();
  }
  VoxelIndex size() const {
    return empty() ? VoxelIndex::Zero() : VoxelIndex(high - low + VoxelIndex::Ones());
  }
  VoxelBox common(const VoxelBox& other) const {
    return {low.cwiseMax(other.low), high.cwiseMin(other.high)};
  }
};

/// Where a volume lies in space. Nothing exists outside its box.
struct VolumeFrame {
  Vector3 origin = Vector3::Zero();  ///< the middle of voxel (0, 0, 0), mesh units
  double voxel_size = 1;             ///< mesh units
  double ramp = 4;                   ///< the largest distance that is stored, mesh units
  VoxelBox box;

  Vector3 position(const Vector3& voxel) const { return origin + voxel_size * voxel; }
  Vector3 voxel(const Vector3& position) const { return (position - origin) / voxel_size; }
};

/// One voxel. `distance` is signed, mesh units, negative inside, within the ramp. It is that of the surface
/// where the voxel is seen, -ramp where it is unseen, +ramp where it is empty, unless a filler has set it.
/// Only seen voxels have a weight above 0, and some of them a normal (unit, outwards).
struct Voxel {
  VoxelState state = VoxelState::empty;
  float distance = 0;
  float weight = 0;
  std::optional<Eigen::Vector3f> normal;
};

struct VolumeCounts {
  std::uint64_t seen = 0, unseen = 0, empty = 0;  ///< together the voxels of the box
  std::uint64_t filled = 0;                       ///< unseen and empty ones with a distance from a filler
};

/// The sparse grids of a volume (volume_grids.h; OpenVDB).
struct VolumeGrids;

/// Copies share everything. What makes a volume from another one shares the grids that it does not change.
class RangeVolume {
 public:
  RangeVolume(const VolumeFrame& frame, std::shared_ptr<const VolumeGrids> grids);

  const VolumeFrame& frame() const { return frame_; }
  const VolumeGrids& grids() const { return *grids_; }

  /// Any voxel of the box; throws std::out_of_range elsewhere. For single questions: loops use the grids.
  Voxel at(const VoxelIndex& voxel) const;

  /// Cost: proportional to the stored leaves.
  VolumeCounts counts() const;

  /// Bytes that the grids hold, those shared with other volumes included.
  std::size_t memory() const;

 private:
  VolumeFrame frame_;
  std::shared_ptr<const VolumeGrids> grids_;
};

/// A normal as it is stored: three numbers of ten bits. The zero vector, "no normal", is never packed.
/// Unpacked it is a unit vector within 0.1 degrees of what was packed, and packs to the same number again.
std::int32_t pack_normal(const Eigen::Vector3f& normal);
Eigen::Vector3f unpack_normal(std::int32_t packed);

}  // namespace meshcomplete
