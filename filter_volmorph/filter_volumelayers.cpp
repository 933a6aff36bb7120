#include "filter_volmorph/filter_volumelayers.h"

#include <array>
#include <memory>
#include <vector>

#include "common/core/error.h"
#include "common/host/append.h"
#include "common/host/layers.h"
#include "filter_volmorph/surface_voxels.h"

namespace meshcomplete {
namespace host {
namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

const char* const stage = "finding the volume";

// Per-mesh attributes: MeshLab keeps them with the layer, and frees them with it.
const char* const volume_name = "RangeVolume";
const char* const slice_name = "RangeVolumeSlice";
const char* const surface_name = "RangeVolumeSurface";

// The layer whose volume a surface was extracted from, by its number in the project.
struct SurfaceOfVolume {
  int layer;
};

template <class Value>
const Value* attribute(const MeshModel& layer, const char* name) {
  // vcg looks attributes up in a mesh that is not const, and changes nothing of this one.
  CMeshO& mesh = const_cast<CMeshO&>(layer.cm);
  auto handle = Allocator::FindPerMeshAttribute<std::shared_ptr<const Value>>(mesh, name);
  return Allocator::IsValidHandle(mesh, handle) ? handle().get() : nullptr;
}

// An attribute that holds nothing when it is new.
template <class Value>
std::shared_ptr<const Value>& attribute_to_set(MeshModel& layer, const char* name) {
  return Allocator::GetPerMeshAttribute<std::shared_ptr<const Value>>(layer.cm, name)();
}

void show_points(MeshModel& layer, const RangeVolume& volume) {
  const std::vector<SurfaceVoxel> voxels = surface_voxels(volume);
  CMeshO& mesh = layer.cm;
  layer.updateDataMask(MeshModel::MM_VERTQUALITY);
  mesh.vert.reserve(voxels.size());  // where memory may run out, before anything is lost
  mesh.face.clear();
  mesh.vert.clear();
  mesh.fn = mesh.vn = mesh.sfn = mesh.svn = 0;
  auto vertex = Allocator::AddVertices(mesh, voxels.size());
  for (const SurfaceVoxel& voxel : voxels) {
    vertex->P() = as_point(voxel.position);
    vertex->N() = as_point(voxel.normal);
    vertex->Q() = voxel.weight;
    ++vertex;
  }
  vcg::tri::UpdateBounding<CMeshO>::Box(mesh);
}

MeshModel* layer_with_number(MeshDocument& document, int number) {
  for (MeshModel* layer : document.meshList)
    if (layer->id() == number) return layer;
  return nullptr;
}

vcg::Color4b colour(const std::uint8_t* pixel) { return vcg::Color4b(pixel[0], pixel[1], pixel[2], 255); }

void add_corners(CMeshO& mesh, const VolumeSlice& slice, const VolumeFrame& frame) {
  const auto [across, along] = slice_axes(slice.axis);
  auto vertex = Allocator::AddVertices(
      mesh, (static_cast<std::size_t>(slice.width) + 1) * (static_cast<std::size_t>(slice.height) + 1));
  const Vector3 first = voxel_of_pixel(frame, slice.axis, slice.position, 0, 0).cast<double>();
  for (int row = 0; row <= slice.height; ++row)
    for (int column = 0; column <= slice.width; ++column) {
      Vector3 corner = first;
      corner[across] += column - 0.5;
      corner[along] += 0.5 - row;
      (vertex++)->P() = as_point(frame.position(corner));
    }
}

// Two triangles for each pixel, with the edge between them hidden.
void add_squares(CMeshO& mesh, const VolumeSlice& slice) {
  const std::size_t row_length = static_cast<std::size_t>(slice.width) + 1;
  auto face = Allocator::AddFaces(mesh, 2 * static_cast<std::size_t>(slice.width) * slice.height);
  for (int row = 0; row < slice.height; ++row)
    for (int column = 0; column < slice.width; ++column) {
      const std::size_t top = static_cast<std::size_t>(row) * row_length + static_cast<std::size_t>(column),
                        bottom = top + row_length;
      const std::array<std::array<std::size_t, 3>, 2> halves = {
          {{top, bottom, bottom + 1}, {top, bottom + 1, top + 1}}};
      for (int half = 0; half < 2; ++half, ++face) {
        for (int corner = 0; corner < 3; ++corner) face->V(corner) = &mesh.vert[halves[half][corner]];
        face->SetF(half == 0 ? 2 : 0);
        face->C() = colour(slice.pixel(column, row));
      }
    }
}

}  // namespace

MeshModel& add_volume_layer(MeshDocument& document, const RangeVolume& volume, const QString& name,
                            const Matrix44m& placed) {
  MeshModel& made = add_layer_with(document, name, [&](MeshModel& layer) {
    layer.cm.Tr = placed;
    replace_volume(layer, volume);
  });
  document.setCurrentMesh(made.id());
  return made;
}

void replace_volume(MeshModel& layer, const RangeVolume& volume) {
  auto holder = std::make_shared<const RangeVolume>(volume);
  auto& attribute = attribute_to_set<RangeVolume>(layer, volume_name);
  show_points(layer, volume);
  attribute = std::move(holder);
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

MeshModel& add_surface_layer(MeshDocument& document, const MeshModel& volume, const TriangleMesh& surface,
                             const SurfaceOrigins& origins, bool select) {
  const Matrix44m placed = volume.cm.Tr;
  const SurfaceOfVolume of{volume.id()};
  MeshModel& made = add_layer_with(document, volume.label() + " surface", [&](MeshModel& layer) {
    layer.cm.Tr = placed;
    fill_layer(layer, surface);
    layer.updateDataMask(MeshModel::MM_VERTQUALITY);
    for (std::size_t v = 0; v < origins.weights.size(); ++v) layer.cm.vert[v].Q() = origins.weights[v];
    for (std::size_t f = 0; select && f < origins.faces.size(); ++f)
      if (origins.faces[f] != SurfaceOrigin::observed) layer.cm.face[f].SetS();
    attribute_to_set<SurfaceOfVolume>(layer, surface_name) = std::make_shared<const SurfaceOfVolume>(of);
  });
  document.setCurrentMesh(made.id());
  return made;
}

bool is_extracted(const MeshModel& layer) {
  return attribute<SurfaceOfVolume>(layer, surface_name) != nullptr;
}

MeshModel& add_slice_layer(MeshDocument& document, const MeshModel& volume, const VolumeSlice& slice,
                           const QString& name) {
  const SliceOrigin origin{volume.id(), volume_of(volume)->frame(), slice.axis};
  const Matrix44m placed = volume.cm.Tr;
  MeshModel& made = add_layer_with(document, name, [&](MeshModel& layer) {
    layer.cm.Tr = placed;
    layer.updateDataMask(MeshModel::MM_FACECOLOR);
    add_corners(layer.cm, slice, origin.frame);
    add_squares(layer.cm, slice);
    layer.UpdateBoxAndNormals();
    attribute_to_set<SliceOrigin>(layer, slice_name) = std::make_shared<const SliceOrigin>(origin);
  });
  document.setCurrentMesh(made.id());
  return made;
}

}  // namespace host
}  // namespace meshcomplete
