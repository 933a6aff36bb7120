// Slices of a volume as images, after Firestone 2008, section 3.2 and figure 3.1.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

enum class SliceView {
  states,   ///< empty black, unseen brown, seen white
  normals,  ///< components from -1 to 1 as red, green and blue from 0 to 255; black without a normal
  weights   ///< grey, from black for 0 to white for the largest weight
};

struct SliceOptions {
  int axis = 2;      ///< 0 to 2: the slice is perpendicular to x, y or z
  int position = 0;  ///< the voxels' number along the axis
  SliceView view = SliceView::states;
  /// What is white among the weights, above 0; absent: the largest of the volume, which is then looked for
  /// (cost: proportional to the leaves of the weights' grid). For many slices of one volume, look once.
  std::optional<float> largest_weight;
  /// Slices with more pixels are refused. Absent: none is.
  std::optional<std::size_t> most_pixels = std::nullopt;
};

/// One pixel per voxel. Columns go along the first of the two other axes (x, or y where the axis is x), to
/// the right; rows along the second (z, or y where the axis is z), from the highest voxels at the top
/// downwards.
struct VolumeSlice {
  int axis = 2;
  int position = 0;
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  ///< red, green, blue, row after row from the top
  VolumeCounts counts;               ///< of this slice

  const std::uint8_t* pixel(int column, int row) const {
    return pixels.data() + 3 * (std::size_t(row) * std::size_t(width) + std::size_t(column));
  }
};

/// The slice over the whole volume. CompletionError when the axis or the position is out of range (the
/// message says the range), or when it has too many pixels. Cost: proportional to the pixels.
VolumeSlice make_slice(const RangeVolume& volume, const SliceOptions& options, const Progress& progress);

/// The largest weight of all voxels; 0 where none is seen. Cost: proportional to the leaves of that grid.
float largest_weight(const RangeVolume& volume);

/// The axes along a slice's columns and rows.
std::array<int, 2> slice_axes(int axis);

/// The voxel that a pixel shows; also for pixels beside the image.
VoxelIndex voxel_of_pixel(const VolumeFrame& frame, int axis, int position, int column, int row);

/// The voxels under a rectangle of pixels (both corners belong to it, in any order), of the volume's full
/// depth along the axis. Not cut to the volume.
VoxelBox box_of_rectangle(const VolumeFrame& frame, int axis, const std::array<int, 2>& corner,
                          const std::array<int, 2>& opposite);

}  // namespace meshcomplete
