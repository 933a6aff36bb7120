// The grids behind a RangeVolume. The only header that knows OpenVDB: for sources of this folder.
#pragma once

#include <openvdb/openvdb.h>

#include "filter_volmorph/block_bits.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

/// Grid coordinates are voxel numbers. All grids keep to the volume's box: outside is background, inactive.
/// Of registered grid types, so that OpenVDB's own programs can read what is saved.
struct VolumeGrids {
  /// Active: seen. Inactive: true is empty, false is unseen. The background, outside the box, is empty.
  openvdb::BoolGrid::ConstPtr state;
  /// Active: the distance, mesh units. Inactive: -ramp or +ramp, as `state` says; the value there is not
  /// used.
  openvdb::FloatGrid::ConstPtr distance;
  openvdb::FloatGrid::ConstPtr weight;  ///< active: above 0, of a seen voxel
  openvdb::Int32Grid::ConstPtr normal;  ///< active: `pack_normal` of a seen voxel's normal
};

inline openvdb::Coord to_coord(const VoxelIndex& voxel) { return {voxel.x(), voxel.y(), voxel.z()}; }
inline VoxelIndex to_voxel(const openvdb::Coord& at) { return {at.x(), at.y(), at.z()}; }
inline openvdb::CoordBBox to_coord_box(const VoxelBox& box) {
  return {to_coord(box.low), to_coord(box.high)};
}

/// OpenVDB's registry of grid types, filled once; every function that makes or reads grids calls it.
void prepare_openvdb();

/// The unseen voxels of a leaf of the states.
inline BlockBits unseen_bits(const openvdb::BoolTree::LeafNodeType& states) {
  BlockBits bits;
  for (int x = 0; x < block_size; ++x)
    bits[x] = ~states.valueMask().getWord<std::uint64_t>(x) & ~states.buffer().data()[x];
  return bits;
}

/// Reads voxels one after another, fast where they are neighbours. For one thread.
class VoxelReader {
 public:
  explicit VoxelReader(const RangeVolume& volume);

  VoxelState state(const openvdb::Coord& at) const {
    bool empty = true;
    if (state_.probeValue(at, empty)) return VoxelState::seen;
    return empty ? VoxelState::empty : VoxelState::unseen;
  }
  float distance(const openvdb::Coord& at) const {
    float distance = 0;
    if (distance_.probeValue(at, distance)) return distance;
    return state(at) == VoxelState::unseen ? -ramp_ : ramp_;
  }
  float weight(const openvdb::Coord& at) const { return weight_.getValue(at); }
  std::optional<Eigen::Vector3f> normal(const openvdb::Coord& at) const {
    std::int32_t packed = 0;
    if (!normal_.probeValue(at, packed)) return {};
    return unpack_normal(packed);
  }
  Voxel voxel(const openvdb::Coord& at) const { return {state(at), distance(at), weight(at), normal(at)}; }

 private:
  openvdb::BoolGrid::ConstAccessor state_;
  openvdb::FloatGrid::ConstAccessor distance_;
  openvdb::FloatGrid::ConstAccessor weight_;
  openvdb::Int32Grid::ConstAccessor normal_;
  float ramp_;
};

/// Voxels written one by one into grids that grow, for merging, opening and tests. Whatever is not set is
/// unseen. For one thread.
class VolumeBuilder {
 public:
  explicit VolumeBuilder(const VolumeFrame& frame);

  /// The voxel lies in the box. Distance, weight and normal of a voxel that is not seen are ignored.
  void set(const VoxelIndex& at, const Voxel& voxel);
  /// All voxels of the box, cut to the volume's.
  void fill(const VoxelBox& box, VoxelState state);

  /// The volume, pruned. The builder is of no use afterwards.
  RangeVolume finish();

 private:
  VolumeFrame frame_;
  openvdb::BoolGrid::Ptr state_;
  openvdb::FloatGrid::Ptr distance_;
  openvdb::FloatGrid::Ptr weight_;
  openvdb::Int32Grid::Ptr normal_;
};

}  // namespace meshcomplete
