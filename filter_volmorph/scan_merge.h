// Aligned range scans merged into one volume (Curless and Levoy).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "filter_volmorph/depth_steps.h"
#include "filter_volmorph/line_of_sight.h"
#include "filter_volmorph/range_volume.h"
#include "filter_volmorph/volume_size.h"

namespace meshcomplete {

struct RangeScan {
  TriangleMesh mesh;  ///< where it belongs; faces counter-clockwise as the sensor sees them
  LineOfSight line_of_sight;
  std::string name;  ///< for messages; empty: its number
};

struct ScanMergeOptions {
  VolumeSizeOptions size;
  DepthStepOptions depth_steps;
  /// Voxels between the sensor and the ramp before a surface become empty. Without, they stay unseen.
  bool carving = true;
  /// A scan's weight falls off as the cosine between normal and line of sight to this power; at least 0.
  double grazing_power = 1;
  /// How far from a scan's boundary its weight is full, mesh units, at least 0. Absent: four times the scan's
  /// median edge. (Boundary: edges of the faces that the depth-step limits keep.)
  std::optional<double> boundary_falloff;
  /// Behind the surface the weight is full up to this part of the ramp, and falls to 0 at its end, so that
  /// what was seen of one side of a wall counts little on its other side. 0 up to, not including, 1.
  double full_behind = 0.5;
};

/// What became of a scan.
struct ScanFigures {
  std::string name;
  LineOfSight line_of_sight;  ///< that was used: parallel or a viewpoint
  DepthStepCounts faces;
  double longest_edge = 0;      ///< the limit that was used, mesh units
  double boundary_falloff = 0;  ///< that was used, mesh units
};

struct ScanMerge {
  RangeVolume volume;
  VolumeCounts counts;
  std::vector<ScanFigures> scans;
  std::vector<std::pair<std::string, double>> stage_seconds;
};

/// Throws CompletionError on options out of range.
void check_options(const ScanMergeOptions& options);

/// A volume of what all scans saw. For each voxel and scan the line of sight through the voxel's middle is
/// met exactly with the scan's faces; only the first of them seen from the sensor counts. With s the distance
/// from there to the voxel, positive towards the sensor:
/// - within the ramp, -ramp < s <= ramp, the voxel is seen: it gets the mean of s and of the normals
///   interpolated there, weighted with the weights interpolated there (and falling off behind the surface),
///   and the sum of the weights as its weight. No normal where they nearly cancel out.
/// - s > ramp: the scan looked through the voxel, which is empty unless some scan sees it;
/// - behind the ramp, and where no line of sight to a face goes: the scan knows nothing. What no scan knows
/// of
///   is unseen.
/// A voxel before a surface of its own that another scan looked through stays seen. A wall thinner than twice
/// the ramp is seen from both sides in the same voxels: its two surfaces are drawn apart, the less the closer
/// `full_behind` is to 0; keep the ramp below half of the thinnest wall.
///
/// Source: Curless and Levoy, "A Volumetric Method for Building Complex Models from Range Images" (1996),
/// sections 3 (merging) and 4 (space carving). The volume is the same in every bit whatever the number of
/// threads. Throws CompletionError when there are no scans, a scan has no faces or loses all to the
/// depth-step limits, a viewpoint is within the ramp of its scan, or the volume needs too much memory; and
/// Cancelled. Cost: O(faces + scans * voxels within the ramp or at the edge of what was carved); memory
/// likewise, never the voxels of the box.
ScanMerge merge_scans(const std::vector<RangeScan>& scans, const ScanMergeOptions& options,
                      const Progress& progress = Progress());

}  // namespace meshcomplete
