// What range volumes and their surfaces are, as lines of MeshLab's log.
#pragma once

#include <QString>
#include <vector>

#include "common/host/filter_declaration.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {
namespace host {

/// Size, voxels of each state, memory; also as figures of the report.
void log_volume(FilterRun& run, const RangeVolume& volume);

/// Genus, components, boundary loops and the lengths of the handles of a mesh, behind `when` ("before",
/// "after"); also as figures of the report.
void log_topology(FilterRun& run, const TriangleMesh& surface, const QString& when, const Progress& progress);

/// Building blocks for parameters.
ParameterDeclaration angle_parameter(const char* name, const char* label, const char* meaning,
                                     double fallback);
ParameterDeclaration at_least_zero_parameter(const char* name, const char* label, const char* meaning,
                                             double fallback);
ParameterDeclaration text_parameter(const char* name, const char* label, const char* meaning,
                                    const char* fallback);
ParameterDeclaration file_parameter(const char* name, const char* label, const char* meaning,
                                    ParameterType type);

}  // namespace host
}  // namespace meshcomplete
