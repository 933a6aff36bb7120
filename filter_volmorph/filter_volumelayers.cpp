#include "filter_volmorph/filter_volumelayers.h"

#include <array>
#include <memory>
#include <vector>

#include "common/core/error.h"
#include "common/host/meshlab_version.h"
#include "filter_volmorph/surface_voxels.h"

namespace meshcomplete {
namespace host {
namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

const char* const stage = "finding the volume";

// Per-mesh attributes: MeshLab keeps them with the layer, and frees them with it.
const char* const volume_name = "RangeVolume";
const char* const slice_name = "RangeVolumeSlice";

template <class Value>
const Value* attribute(const MeshModel& layer, const char* name) {
  // vcg looks attributes up in a mesh that is not const, and changes nothing of this one.
  CMeshO& mesh = const_cast<CMeshO&>(layer.cm);
  auto handle = Allocator::FindPerMeshAttribute<std::shared_ptr<const Value>>(mesh, name);
  return Allocator::IsValidHandle(mesh, handle) ? handle().get() : nullptr;
}

template <class Value>
void set_attribute(MeshModel& layer, const char* name, Value value) {
  auto handle = Allocator::GetPerMeshAttribute<std::shared_ptr<const Value>>(layer.cm, name);
  handle() = std::make_shared<const Value>(std::move(value));
}

Point3m as_point(const Vector3& v) {
  return Point3m(static_cast<Scalarm>(v.x()), static_cast<Scalarm>(v.y()), static_cast<Scalarm>(v.z()));
}

void show_points(MeshModel& layer, const RangeVolume& volume) {
  const std::vector<SurfaceVoxel> voxels = surface_voxels(volume);
  CMeshO& mesh = layer.cm;
  mesh.face.clear();
  mesh.vert.clear();
  mesh.fn = mesh.vn = mesh.sfn = mesh.svn = 0;
  layer.updateDataMask(MeshModel::MM_VERTQUALITY);
  auto vertex = Allocator::AddVertices(mesh, voxels.size());
  for (const SurfaceVoxel& voxel : voxels) {
    vertex->P() = as_point(voxel.position);
    vertex->N() = as_point(voxel.normal);
    vertex->Q() = voxel.weight;
    ++vertex;
  }
  vcg::tri::UpdateBounding<CMeshO>::Box(mesh);
}

std::string quoted(const MeshModel& layer) { return "\"" + layer.label().toStdString() + "\""; }

MeshModel* layer_with_number(MeshDocument& document, int number) {
  for (MeshModel* layer : document.meshList)
    if (layer->id() == number) return layer;
  return nullptr;
}

vcg::Color4b colour(const std::uint8_t* pixel) { return vcg::Color4b(pixel[0], pixel[1], pixel[2], 255); }

// Two triangles for each pixel, with the edge between them hidden.
void add_squares(CMeshO& mesh, const VolumeSlice& slice) {
  const int row_length = slice.width + 1;
  auto face = Allocator::AddFaces(mesh, 2 * static_cast<std::size_t>(slice.width) * slice.height);
  for (int row = 0; row < slice.height; ++row)
    for (int column = 0; column < slice.width; ++column) {
      const int top = row * row_length + column, bottom = top + row_length;
      const std::array<std::array<int, 3>, 2> halves = {
          {{top, bottom, bottom + 1}, {top, bottom + 1, top + 1}}};
      for (int half = 0; half < 2; ++half, ++face) {
        for (int corner = 0; corner < 3; ++corner)
          face->V(corner) = &mesh.vert[static_cast<std::size_t>(halves[half][corner])];
        face->SetF(half == 0 ? 2 : 0);
        face->C() = colour(slice.pixel(column, row));
      }
    }
}

}  // namespace

MeshModel& add_volume_layer(MeshDocument& document, const RangeVolume& volume, const QString& name) {
  MeshModel* layer = document.addNewMesh("", name, false);
  try {
    replace_volume(*layer, volume);
  } catch (...) {
    document.delMesh(layer);
    throw;
  }
  document.setCurrentMesh(layer->id());
  return *layer;
}

void replace_volume(MeshModel& layer, const RangeVolume& volume) {
  show_points(layer, volume);
  set_attribute(layer, volume_name, volume);
}

const RangeVolume* volume_of(const MeshModel& layer) { return attribute<RangeVolume>(layer, volume_name); }

const SliceOrigin* slice_origin(const MeshModel& layer) { return attribute<SliceOrigin>(layer, slice_name); }

MeshModel& volume_layer(FilterRun& run) {
  MeshModel& current = *run.document.mm();
  if (volume_of(current) != nullptr) return current;
  if (const SliceOrigin* slice = slice_origin(current)) {
    MeshModel* layer = layer_with_number(run.document, slice->layer);
    if (layer != nullptr && volume_of(*layer) != nullptr) return *layer;
  }
  throw CompletionError(stage, "The layer " + quoted(current) +
                                   " holds no range volume. Make one with \"Range Volume: Merge Scans\", "
                                   "\"... Voxelize Mesh\" or \"... Open\", or make the layer current that "
                                   "holds one.");
}

MeshModel& add_slice_layer(MeshDocument& document, const MeshModel& volume, const VolumeSlice& slice,
                           const QString& name) {
  const VolumeFrame frame = volume_of(volume)->frame();
  const auto [across, along] = slice_axes(slice.axis);
  const int number = volume.id();
  MeshModel* layer = document.addNewMesh("", name, false);
  layer->updateDataMask(MeshModel::MM_FACECOLOR);
  auto vertex =
      Allocator::AddVertices(layer->cm, static_cast<std::size_t>(slice.width + 1) * (slice.height + 1));
  const Vector3 first = voxel_of_pixel(frame, slice.axis, slice.position, 0, 0).cast<double>();
  for (int row = 0; row <= slice.height; ++row)
    for (int column = 0; column <= slice.width; ++column) {
      Vector3 corner = first;
      corner[across] += column - 0.5;
      corner[along] += 0.5 - row;
      (vertex++)->P() = as_point(frame.position(corner));
    }
  add_squares(layer->cm, slice);
  layer->UpdateBoxAndNormals();
  set_attribute(*layer, slice_name, SliceOrigin{number, frame, slice.axis});
  document.setCurrentMesh(layer->id());
  return *layer;
}

}  // namespace host
}  // namespace meshcomplete
