#include "filter_volmorph/filter_volumebox.h"

#include <cmath>
#include <optional>
#include <string>

#include "common/core/error.h"
#include "common/host/layers.h"
#include "common/host/parameter_blocks.h"
#include "filter_volmorph/filter_volumelayers.h"
#include "filter_volmorph/volume_box.h"

namespace meshcomplete {
namespace host {
namespace {

const char* const stage = "choosing the box";

enum class Where { everywhere, voxels, space, selection };

VoxelIndex as_voxel(const Vector3& numbers, const char* name) {
  for (double x : numbers)
    if (x != std::floor(x) || std::abs(x) > 1e9)
      throw CompletionError(
          "reading the parameters",
          std::string("Parameter \"") + name +
              "\" must be three whole numbers: voxels are counted. For mesh units choose the other box.");
  return numbers.cast<int>();
}

// By where the faces are, so that it does not matter what else was done to the slice.
std::optional<VoxelBox> box_under_selection(const MeshModel& layer) {
  const SliceOrigin& slice = *slice_origin(layer);
  VoxelBox box;
  bool any = false;
  for (const CFaceO& face : layer.cm.face) {
    if (face.IsD() || !face.IsS()) continue;
    const Point3m middle = (face.cP(0) + face.cP(1) + face.cP(2)) / 3;
    const Vector3 voxel = slice.frame.voxel(Vector3(middle[0], middle[1], middle[2]));
    const VoxelIndex rounded(static_cast<int>(std::lround(voxel[0])), static_cast<int>(std::lround(voxel[1])),
                             static_cast<int>(std::lround(voxel[2])));
    box.low = any ? VoxelIndex(box.low.cwiseMin(rounded)) : rounded;
    box.high = any ? VoxelIndex(box.high.cwiseMax(rounded)) : rounded;
    any = true;
  }
  if (!any) return std::nullopt;
  box.low[slice.axis] = slice.frame.box.low[slice.axis];
  box.high[slice.axis] = slice.frame.box.high[slice.axis];
  return box;
}

}  // namespace

std::vector<ParameterDeclaration> box_parameters() {
  return {
      choice_parameter(
          "Box", "Where",
          "Everywhere; in a box given in voxels or in mesh units; or under the selected faces of a slice "
          "of this volume, through its whole depth.",
          {"Everywhere", "Box, in voxels", "Box, in mesh units", "Selection in a slice"}),
      point_parameter("BoxFrom", "Box from", "The lowest corner of the box; it belongs to it.",
                      Vector3::Zero()),
      point_parameter("BoxTo", "Box to", "The highest corner of the box; it belongs to it.", Vector3::Zero()),
      layer_parameter("SliceLayer", "Slice",
                      "The slice with the selection. None: the only one of this volume that has one.")};
}

VoxelBox wanted_box(const FilterRun& run, const MeshModel& layer) {
  const ParameterValues& values = run.parameters;
  const VolumeFrame& frame = volume_of(layer)->frame();
  switch (static_cast<Where>(values.choice("Box"))) {
    case Where::everywhere:
      return frame.box;
    case Where::voxels:
      return box_in_volume(
          frame, {as_voxel(values.point("BoxFrom"), "BoxFrom"), as_voxel(values.point("BoxTo"), "BoxTo")});
    case Where::space:
      return box_in_volume(frame, voxels_between(frame, values.point("BoxFrom"), values.point("BoxTo")));
    case Where::selection:
      break;
  }
  return box_in_volume(frame, selected_box(run, layer, values.layer("SliceLayer")));
}

VoxelBox selected_box(const FilterRun& run, const MeshModel& volume, const MeshModel* slice) {
  if (slice != nullptr && !is_slice(*slice))
    throw CompletionError(stage, "The layer " + quoted(*slice) +
                                     " is no slice of a volume. Choose a layer made by \"Range Volume: "
                                     "Slice\", or none.");
  std::optional<VoxelBox> box;
  for (const MeshModel* layer : run.document.meshList) {
    if (slice != nullptr ? layer != slice : !is_slice(*layer)) continue;
    if (slice_origin(*layer)->layer != volume.id()) {
      if (slice == nullptr) continue;
      throw CompletionError(stage, "The slice " + quoted(*slice) + " was cut out of another volume.");
    }
    const std::optional<VoxelBox> selected = box_under_selection(*layer);
    if (selected && box)
      throw CompletionError(
          stage, "More than one slice of this volume has selected faces. Choose one as \"SliceLayer\".");
    if (selected) box = selected;
  }
  if (!box)
    throw CompletionError(stage,
                          "No face of a slice of this volume is selected. Make a slice with \"Range Volume: "
                          "Slice\", and select faces of it with the rectangle of \"Select Faces\".");
  return *box;
}

}  // namespace host
}  // namespace meshcomplete
