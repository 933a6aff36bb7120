// What range volumes and their surfaces are, as lines of MeshLab's log.
#pragma once

#include <QString>

#include "common/host/filter_declaration.h"
#include "filter_volmorph/range_volume.h"
#include "filter_volmorph/surface_origin.h"

namespace meshcomplete {
namespace host {

/// Size, voxels of each state, memory; also as figures of the report.
void log_volume(FilterRun& run, const RangeVolume& volume);

/// Genus, components, boundary loops and the handles of a surface that was extracted from the volume, with
/// their lengths, places and voxels, behind `when` ("Before", "After"); also as figures of the report.
void log_topology(FilterRun& run, const RangeVolume& volume, const TriangleMesh& surface, const QString& when,
                  const Progress& progress);

/// How many faces were observed, how many filled, and how many are nothing but the boundary between unseen
/// and empty voxels; also as figures of the report.
void log_origins(FilterRun& run, const SurfaceOrigins& origins, const QString& when);

}  // namespace host
}  // namespace meshcomplete
