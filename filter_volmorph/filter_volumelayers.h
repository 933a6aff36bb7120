// Layers that hold a range volume, and layers that show a slice of one.
#pragma once

#include <QString>

#include "common/host/filter_declaration.h"
#include "common/host/meshlab_version.h"
#include "filter_volmorph/range_volume.h"
#include "filter_volmorph/surface_origin.h"
#include "filter_volmorph/volume_slice.h"

namespace meshcomplete {
namespace host {

/// A new current layer that holds the volume, with `placed` as its transformation matrix. What it shows are
/// the voxels at the observed surface, as points with normals, and with weights as quality.
MeshModel& add_volume_layer(MeshDocument& document, const RangeVolume& volume, const QString& name,
                            const Matrix44m& placed = Matrix44m::Identity());

/// Gives a layer another volume, and shows that. The layer is the one of `volume_layer`. When it throws, the
/// layer is as before.
void replace_volume(MeshModel& layer, const RangeVolume& volume);

/// Null where the layer holds none.
const RangeVolume* volume_of(const MeshModel& layer);

/// The layer that a filter works on: the current one, or the one that a current slice was cut out of. Throws
/// CompletionError, which says how to get one, when there is none.
MeshModel& volume_layer(FilterRun& run);

/// A new current layer with a surface that was extracted from the volume of the layer `volume`: with weights
/// as quality, and the faces that were not observed selected with `select`.
MeshModel& add_surface_layer(MeshDocument& document, const MeshModel& volume, const TriangleMesh& surface,
                             const SurfaceOrigins& origins, bool select);

/// Whether the layer is one of `add_surface_layer`.
bool is_extracted(const MeshModel& layer);

/// A new current layer: one square for each pixel of the slice, in its colour, where the voxels of `volume`,
/// which holds one, are.
MeshModel& add_slice_layer(MeshDocument& document, const MeshModel& volume, const VolumeSlice& slice,
                           const QString& name);

/// What a slice layer shows.
struct SliceOrigin {
  int layer = -1;  ///< the volume's, by its number in the project
  VolumeFrame frame;
  int axis = 2;
};

/// Null where the layer shows no slice.
const SliceOrigin* slice_origin(const MeshModel& layer);

/// Whether the layer shows a slice.
inline bool is_slice(const MeshModel& layer) { return slice_origin(layer) != nullptr; }

}  // namespace host
}  // namespace meshcomplete
