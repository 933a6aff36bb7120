// The visible layers as range scans: what "Range Volume: Merge Scans" reads.
#pragma once

#include <vector>

#include "common/host/filter_declaration.h"
#include "filter_volmorph/scan_merge.h"

namespace meshcomplete {
namespace host {

/// The visible layers, seen as the parameters LineOfSight and Viewpoint say. Throws CompletionError when
/// there is none, or one without faces, or without a camera that is asked for.
std::vector<RangeScan> visible_scans(FilterRun& run);

/// What became of a scan, as a line of MeshLab's log.
void log_scan(const FilterRun& run, const ScanFigures& scan);

}  // namespace host
}  // namespace meshcomplete
