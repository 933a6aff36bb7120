#include "filter_volmorph/volume_box.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/core/parameter_checks.h"

namespace meshcomplete {
namespace {

/// Far beyond any volume, and far from the largest integer, so that one can be added.
constexpr double largest_number = 1 << 30;

std::string text(const VoxelIndex& voxel) {
  std::ostringstream out;
  out << '(' << voxel.x() << ", " << voxel.y() << ", " << voxel.z() << ')';
  return out.str();
}

}  // namespace

VoxelBox box_in_volume(const VolumeFrame& frame, const VoxelBox& box) {
  const std::string bounds =
      "The volume has the voxels from " + text(frame.box.low) + " to " + text(frame.box.high) + ".";
  if (box.empty())
    throw CompletionError("reading the parameters", "The box from " + text(box.low) + " to " +
                                                        text(box.high) +
                                                        " has no voxels: every \"from\" must be at most its "
                                                        "\"to\". " +
                                                        bounds);
  const VoxelBox inside = box.common(frame.box);
  if (inside.empty())
    throw CompletionError(
        "reading the parameters",
        "The box from " + text(box.low) + " to " + text(box.high) + " lies outside the volume. " + bounds);
  return inside;
}

VoxelBox voxels_between(const VolumeFrame& frame, const Vector3& low, const Vector3& high) {
  require(low.allFinite() && high.allFinite(), "The corners of the box must be finite numbers.");
  const auto number = [](double voxel) {
    return static_cast<int>(std::clamp(voxel, -largest_number, largest_number));
  };
  // The position decides, not the quotient: that may be rounded to the wrong side of a middle.
  const auto middle = [&](int voxel, int axis) {
    return frame.position(Vector3::Constant(static_cast<double>(voxel)))[axis];
  };
  VoxelBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = number(std::ceil(frame.voxel(low)[axis]));
    if (middle(box.low[axis] - 1, axis) >= low[axis]) --box.low[axis];
    if (middle(box.low[axis], axis) < low[axis]) ++box.low[axis];
    box.high[axis] = number(std::floor(frame.voxel(high)[axis]));
    if (middle(box.high[axis] + 1, axis) <= high[axis]) ++box.high[axis];
    if (middle(box.high[axis], axis) > high[axis]) --box.high[axis];
  }
  return box;
}

}  // namespace meshcomplete
