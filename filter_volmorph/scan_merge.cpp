#include "filter_volmorph/scan_merge.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "common/core/closest_point.h"
#include "common/core/parameter_checks.h"
#include "common/core/threads.h"
#include "filter_volmorph/scan_voxels.h"

namespace meshcomplete {
namespace {

constexpr double default_falloff_edges = 4;

class Seconds {
 public:
  explicit Seconds(ScanMerge& merge) : merge_(merge) {}
  void end_of(const char* stage) {
    const auto now = std::chrono::steady_clock::now();
    merge_.stage_seconds.emplace_back(stage, std::chrono::duration<double>(now - start_).count());
    start_ = now;
  }

 private:
  ScanMerge& merge_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string name_of(const std::vector<RangeScan>& scans, std::size_t i) {
  if (scans[i].name.empty()) return "scan " + std::to_string(i + 1);
  return "the scan '" + scans[i].name + "'";
}

LineOfSight check_line_of_sight(const LineOfSight& given, const std::string& name) {
  if (given.kind == LineOfSight::Kind::own_axis) return given;
  if (given.vector.allFinite() && (given.kind != LineOfSight::Kind::parallel || given.vector.norm() > 0)) {
    return given;
  }
  throw CompletionError("reading the parameters", given.kind == LineOfSight::Kind::parallel
                                                      ? "The line of sight of " + name +
                                                            " has no direction: it is zero or not a number."
                                                      : "The viewpoint of " + name + " is not a number.");
}

/// Throws when it is within the ramp.
double viewpoint_distance(const TriangleMesh& scan, const Vector3& viewpoint, double ramp,
                          const std::string& name) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : scan.triangles) {
    const Vector3 point =
        closest_point(viewpoint, scan.vertices[t[0]], scan.vertices[t[1]], scan.vertices[t[2]]).position;
    nearest = std::min(nearest, (point - viewpoint).norm());
  }
  if (nearest > ramp) return nearest;
  throw CompletionError(
      "reading the parameters",
      "The viewpoint of " + name +
          " lies on its surface, or nearer to it than the ramp. Give the place of the sensor, "
          "or a smaller ramp.");
}

struct Kept {
  TriangleMesh mesh;
  PreparedScan prepared;
};

/// The faces that count, and the weights.
Kept keep(const RangeScan& scan, const std::string& name, const ScanMergeOptions& options,
          ScanFigures& figures, const Progress& progress) {
  figures.name = name;
  figures.line_of_sight = check_line_of_sight(scan.line_of_sight, name);
  if (scan.line_of_sight.kind == LineOfSight::Kind::own_axis) {
    try {
      figures.line_of_sight = LineOfSight::parallel(estimate_axis(scan.mesh));
    } catch (const CompletionError& error) {
      throw CompletionError(error.stage(), "In " + name + ": " + error.what());
    }
  }
  progress.check();
  DepthSteps steps = drop_depth_steps(scan.mesh, figures.line_of_sight, name, options.depth_steps);
  progress.check();
  figures.faces = steps.counts;
  figures.longest_edge = steps.longest_edge;
  figures.boundary_falloff = options.boundary_falloff.value_or(default_falloff_edges * steps.median_edge);
  Kept kept;
  kept.prepared.weights =
      weigh_scan(steps.mesh, figures.line_of_sight, {options.grazing_power, figures.boundary_falloff});
  kept.mesh = std::move(steps.mesh);
  return kept;
}

/// The scan as its sensor sees it, in voxels.
void add_views(Kept& kept, const ScanFigures& figures, const VolumeFrame& frame) {
  LineOfSight line_of_sight = figures.line_of_sight;
  double nearest = 1;
  if (line_of_sight.kind == LineOfSight::Kind::viewpoint) {
    nearest =
        viewpoint_distance(kept.mesh, line_of_sight.vector, frame.ramp, figures.name) / frame.voxel_size;
    line_of_sight.vector = frame.voxel(line_of_sight.vector);
  }
  for (Vector3& vertex : kept.mesh.vertices) vertex = frame.voxel(vertex);
  kept.prepared.views = ScanView::make(kept.mesh, line_of_sight, nearest);
  kept.mesh = {};
}

}  // namespace

void check_options(const ScanMergeOptions& options) {
  check_options(options.size);
  check_options(options.depth_steps);
  check_options(ScanWeightOptions{options.grazing_power, options.boundary_falloff.value_or(0)});
  require(options.full_behind >= 0 && options.full_behind < 1,
          "The part of the ramp with full weight behind the surface must be at least 0 and below 1.");
}

ScanMerge merge_scans(const std::vector<RangeScan>& scans, const ScanMergeOptions& options,
                      const Progress& progress) {
  check_options(options);
  require(!scans.empty(), "There are no scans to merge.");
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (!scans[i].mesh.triangles.empty()) continue;
    throw CompletionError("reading the scans", "There are no faces in " + name_of(scans, i) +
                                                   ". Hide the layer, or triangulate it first.");
  }
  std::vector<ScanFigures> figures(scans.size());
  std::vector<Kept> kept(scans.size());
  ScanMerge merge{RangeVolume(VolumeFrame(), nullptr), {}, {}, {}};
  Seconds seconds(merge);
  const Progress dropping = progress.part(0, 0.1, "dropping depth steps");
  const double share = 1.0 / static_cast<double>(scans.size());
  for_each(scans.size(), 1, dropping, [&](std::size_t i) {
    kept[i] = keep(scans[i], name_of(scans, i), options, figures[i], dropping);
    dropping.advance(share);
  });
  seconds.end_of("dropping depth steps");

  std::vector<const TriangleMesh*> surfaces;
  for (const Kept& scan : kept) surfaces.push_back(&scan.mesh);
  const VolumeFrame frame =
      choose_frame(surfaces, options.size, progress.part(0.1, 0.12, "choosing the volume"));
  const Progress viewing = progress.part(0.12, 0.2, "preparing the scans");
  for_each(scans.size(), 1, viewing, [&](std::size_t i) {
    add_views(kept[i], figures[i], frame);
    viewing.advance(share);
  });
  std::vector<PreparedScan> prepared;
  for (Kept& scan : kept) prepared.push_back(std::move(scan.prepared));
  seconds.end_of("preparing the scans");

  merge.volume = merge_voxels(prepared, frame, options.size, {options.carving, options.full_behind},
                              progress.part(0.2, 1, "merging the scans"));
  seconds.end_of("merging the scans");
  merge.counts = merge.volume.counts();
  merge.scans = std::move(figures);
  return merge;
}

}  // namespace meshcomplete
