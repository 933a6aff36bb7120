#include "filter_volmorph/volume_slice.h"

#include <openvdb/tools/Count.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/core/parameter_checks.h"
#include "common/core/threads.h"
#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour black{0, 0, 0};
constexpr Colour brown{139, 90, 43};
constexpr Colour white{255, 255, 255};
constexpr double brightest = 255;
constexpr std::size_t rows_per_range = 8;

Colour colour_of(const Voxel& voxel, SliceView view, float white_weight) {
  switch (view) {
    case SliceView::states:
      return voxel.state == VoxelState::seen ? white : voxel.state == VoxelState::unseen ? brown : black;
    case SliceView::normals: {
      Colour colour = black;
      for (int axis = 0; voxel.normal && axis < 3; ++axis)
        colour[axis] = static_cast<std::uint8_t>(std::lround(brightest * ((*voxel.normal)[axis] + 1) / 2));
      return colour;
    }
    case SliceView::weights:
      break;
  }
  const double part = white_weight > 0 ? std::clamp<double>(voxel.weight / white_weight, 0, 1) : 0;
  const auto grey = static_cast<std::uint8_t>(std::lround(brightest * part));
  return {grey, grey, grey};
}

void count(VoxelState state, VolumeCounts& counts) {
  ++(state == VoxelState::seen ? counts.seen : state == VoxelState::unseen ? counts.unseen : counts.empty);
}

void check(const VolumeFrame& frame, const SliceOptions& options) {
  require(options.axis >= 0 && options.axis <= 2, "The axis of a slice must be 0 (x), 1 (y) or 2 (z).");
  require(!options.largest_weight || positive(*options.largest_weight),
          "The weight that is shown white must be greater than 0.");
  const int low = frame.box.low[options.axis], high = frame.box.high[options.axis];
  if (options.position < low || options.position > high)
    throw CompletionError("reading the parameters", std::string("The slice lies outside the volume: along ") +
                                                        "xyz"[options.axis] + " it has the voxels " +
                                                        std::to_string(low) + " to " + std::to_string(high) +
                                                        ".");
  const auto [across, down] = slice_axes(options.axis);
  const VoxelIndex size = frame.box.size();
  if (!options.most_pixels || std::size_t(size[across]) * std::size_t(size[down]) <= *options.most_pixels)
    return;
  throw CompletionError("choosing the slice",
                        "The slice has " + std::to_string(size[across]) + " x " + std::to_string(size[down]) +
                            " pixels; a layer may have " + std::to_string(*options.most_pixels) +
                            ". Write images of the slices instead (give a folder), take another axis, or "
                            "make the volume with larger voxels.");
}

}  // namespace

VolumeSlice make_slice(const RangeVolume& volume, const SliceOptions& options, const Progress& progress) {
  const VolumeFrame& frame = volume.frame();
  check(frame, options);
  float white_weight = 0;
  if (options.view == SliceView::weights)
    white_weight = options.largest_weight ? *options.largest_weight : largest_weight(volume);
  progress.update(0);

  VolumeSlice slice;
  slice.axis = options.axis;
  slice.position = options.position;
  const auto [across, down] = slice_axes(options.axis);
  slice.width = frame.box.size()[across];
  slice.height = frame.box.size()[down];
  slice.pixels.resize(3 * std::size_t(slice.width) * std::size_t(slice.height));
  std::vector<VolumeCounts> counts(std::size_t(slice.height));
  for_ranges(counts.size(), rows_per_range, progress, [&](std::size_t begin, std::size_t end) {
    const VoxelReader reader(volume);
    for (std::size_t row = begin; row < end; ++row) {
      for (int column = 0; column < slice.width; ++column) {
        const Voxel voxel =
            reader.voxel(to_coord(voxel_of_pixel(frame, slice.axis, slice.position, column, int(row))));
        const Colour colour = colour_of(voxel, options.view, white_weight);
        std::copy(colour.begin(), colour.end(),
                  slice.pixels.begin() + 3 * std::ptrdiff_t(row * std::size_t(slice.width) + column));
        count(voxel.state, counts[row]);
      }
    }
    progress.advance(double(end - begin) / slice.height);
  });
  for (const VolumeCounts& row : counts) {
    slice.counts.seen += row.seen;
    slice.counts.unseen += row.unseen;
    slice.counts.empty += row.empty;
  }
  progress.update(1);
  return slice;
}

float largest_weight(const RangeVolume& volume) {
  const openvdb::FloatTree& weights = volume.grids().weight->tree();
  return weights.empty() ? 0 : std::max(0.f, openvdb::tools::minMax(weights).max());
}

std::array<int, 2> slice_axes(int axis) { return {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2}; }

VoxelIndex voxel_of_pixel(const VolumeFrame& frame, int axis, int position, int column, int row) {
  const auto [across, down] = slice_axes(axis);
  VoxelIndex voxel;
  voxel[axis] = position;
  voxel[across] = frame.box.low[across] + column;
  voxel[down] = frame.box.high[down] - row;
  return voxel;
}

VoxelBox box_of_rectangle(const VolumeFrame& frame, int axis, const std::array<int, 2>& corner,
                          const std::array<int, 2>& opposite) {
  const VoxelIndex a = voxel_of_pixel(frame, axis, frame.box.low[axis], corner[0], corner[1]);
  const VoxelIndex b = voxel_of_pixel(frame, axis, frame.box.high[axis], opposite[0], opposite[1]);
  return {a.cwiseMin(b), a.cwiseMax(b)};
}

}  // namespace meshcomplete
