#include "filter_curveunfold/curve_unfolding.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <utility>

#include "common/core/error.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch_check.h"
#include "common/core/stage_clock.h"
#include "common/core/triangle_intersection.h"
#include "filter_curveunfold/hole_filler.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;

void check_options(const CurveUnfoldingOptions& options) {
  constexpr const char* stage = "reading the parameters";
  const UnfoldOptions& u = options.unfolding;
  if (options.edge_length && !(std::isfinite(*options.edge_length) && *options.edge_length > 0))
    throw CompletionError(stage,
                          "The edge length must be positive, or 0 for that of the mesh round the hole.");
  if (u.restarts < 1 || u.restarts > 10000)
    throw CompletionError(stage, "The restarts must lie between 1 and 10000.");
  if (!(u.min_distance >= 1e-9 && u.min_distance <= 1e-2))
    throw CompletionError(stage, "The least distance must lie between 1e-9 and 0.01.");
  if (!(u.cooling > 0 && u.cooling < 1))
    throw CompletionError(stage, "The cooling rate must lie between 0 and 1.");
  if (!(std::isfinite(u.start_temperature) && u.start_temperature > 0))
    throw CompletionError(stage, "The start temperature must be positive.");
}

// All holes of one run, each filled on its own and then made to fit with the others.
class Run {
 public:
  Run(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<BoundaryLoop>& loops,
      const CurveUnfoldingOptions& options, CompletionReport& report)
      : mesh_(mesh),
        loops_(loops),
        neighbourhood_(mesh),
        report_(report),
        filled_(loops.size()),
        context_{mesh, topology, neighbourhood_, options} {
    for (std::size_t i = 0; i < loops.size(); ++i)
      if (report.holes[i].outcome == HoleOutcome::failed && report.holes[i].reason.empty())
        todo_.push_back(i);
    // Long loops first, so that no thread is left alone with the longest.
    std::stable_sort(todo_.begin(), todo_.end(), [&](std::size_t a, std::size_t b) {
      return loops[a].vertices.size() > loops[b].vertices.size();
    });
  }

  void fill_all(const Progress& progress);
  void separate(const Progress& progress);
  CurveUnfoldingResult finish(CompletionReport report, bool unfolded_layer);

 private:
  std::vector<std::pair<std::size_t, std::size_t>> conflicts() const;
  std::vector<Corners> patch_corners(std::size_t hole) const;
  std::vector<Corners> patches_but(std::size_t hole) const;
  void record(std::size_t hole);

  const TriangleMesh& mesh_;
  const std::vector<BoundaryLoop>& loops_;
  const InputNeighbourhood neighbourhood_;
  CompletionReport& report_;
  std::vector<FilledHole> filled_;
  std::vector<std::size_t> todo_;
  HoleFillerContext context_;
};

void Run::record(std::size_t hole) {
  HoleReport& report = report_.holes[hole];
  const FilledHole& filled = filled_[hole];
  report.outcome = filled.patch.empty() ? HoleOutcome::failed : HoleOutcome::closed;
  report.route = filled.route;
  report.reason = filled.reason;
  report.vertices_added = filled.patch.vertices.size();
  report.faces_added = filled.patch.triangles.size();
}

void Run::fill_all(const Progress& progress) {
  double total = 0;
  for (std::size_t hole : todo_) total += static_cast<double>(loops_[hole].vertices.size());
  // No exception may reach TBB: it would cut short the loops that other threads run inside this one, which
  // then return as if they were done. What is done moves on by whole holes; steps within one are only asked
  // whether to stop.
  const Progress within = progress.part(0, 0, "closing holes");
  std::mutex mutex;
  std::exception_ptr error;
  std::atomic<bool> failed{false};
  tbb::parallel_for(std::size_t(0), todo_.size(), [&](std::size_t i) {
    if (failed) return;
    const std::size_t hole = todo_[i];
    try {
      filled_[hole] = fill_hole(context_, loops_[hole], {}, within);
      progress.advance(static_cast<double>(loops_[hole].vertices.size()) / total);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (!error) error = std::current_exception();
      failed = true;
    }
  });
  if (error) std::rethrow_exception(error);
  for (std::size_t hole : todo_) record(hole);
}

// Pairs of holes, the earlier first, whose patches meet.
std::vector<std::pair<std::size_t, std::size_t>> Run::conflicts() const {
  std::vector<Corners> triangles;
  std::vector<std::size_t> owner;
  for (std::size_t hole = 0; hole < filled_.size(); ++hole)
    for (const Triangle& t : filled_[hole].patch.triangles) {
      triangles.push_back(corners(mesh_, filled_[hole].patch, t));
      owner.push_back(hole);
    }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [a, b] : improper_pairs(triangles))
    if (owner[a] != owner[b]) pairs.push_back(std::minmax(owner[a], owner[b]));
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

std::vector<Corners> Run::patch_corners(std::size_t hole) const {
  std::vector<Corners> triangles;
  for (const Triangle& t : filled_[hole].patch.triangles)
    triangles.push_back(corners(mesh_, filled_[hole].patch, t));
  return triangles;
}

std::vector<Corners> Run::patches_but(std::size_t hole) const {
  std::vector<Corners> triangles;
  for (std::size_t other = 0; other < filled_.size(); ++other) {
    if (other == hole) continue;
    const std::vector<Corners> more = patch_corners(other);
    triangles.insert(triangles.end(), more.begin(), more.end());
  }
  return triangles;
}

// Each patch is clean by itself; where two of them meet, the later one is made again with the others as
// obstacles, and if that is no help both as membranes, which bulge least. Only then the later one is tried in
// every way there is, and left open when it meets the other even so.
void Run::separate(const Progress& progress) {
  const Progress within = progress.part(0, 0, "comparing the patches");
  CurveUnfoldingOptions soft = context_.options;
  soft.energy = SurfaceEnergy::membrane;
  const HoleFillerContext soft_context{mesh_, context_.topology, neighbourhood_, soft, false};
  HoleFillerContext quick_context = context_;
  quick_context.thorough = false;
  const bool softer = context_.options.energy != soft.energy;
  const auto fill = [&](std::size_t hole, const HoleFillerContext& context) {
    filled_[hole] = fill_hole(context, loops_[hole], patches_but(hole), within);
    return !filled_[hole].patch.empty();
  };
  const auto both_soft = [&](std::size_t first, std::size_t second) {
    FilledHole kept = std::move(filled_[first]);
    filled_[first] = FilledHole();
    if (fill(first, soft_context) && fill(second, soft_context)) return true;
    filled_[first] = std::move(kept);
    return false;
  };
  for (const auto& [first, second] : conflicts()) {
    // Mended while another pair was?
    if (improper_pairs_between(patch_corners(first), patch_corners(second)).empty()) continue;
    if (!fill(second, quick_context) && !(softer && both_soft(first, second)) && !fill(second, context_))
      filled_[second].reason = "the patch meets the patch of another hole";
    record(first);
    record(second);
  }
}

// The flat triangulations, one beside the other in the plane z = 0.
TriangleMesh lay_out(const std::vector<FilledHole>& filled) {
  TriangleMesh sheet;
  double left = 0;
  for (const FilledHole& hole : filled) {
    if (hole.patch.empty() || hole.flat.empty()) continue;
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : hole.polygon) box.extend(p);
    const Index first = static_cast<Index>(sheet.vertices.size());
    for (const Eigen::Vector2d& p : hole.polygon)
      sheet.vertices.push_back(as_stored(Vector3(p.x() - box.min().x() + left, p.y() - box.min().y(), 0)));
    for (const Triangle& t : hole.flat) sheet.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    left += 1.1 * box.sizes().x();
  }
  return sheet;
}

CurveUnfoldingResult Run::finish(CompletionReport report, bool unfolded_layer) {
  CurveUnfoldingResult result;
  result.completion.patch.input_vertices = static_cast<Index>(mesh_.vertices.size());
  for (const FilledHole& filled : filled_) {
    if (!filled.patch.empty()) append(result.completion.patch, filled.patch);
    result.times.push_back(filled.times);
  }
  if (unfolded_layer) result.unfolded = lay_out(filled_);
  result.completion.report = std::move(report);
  return result;
}

}  // namespace

CurveUnfoldingResult fill_by_curve_unfolding(const TriangleMesh& mesh, const MeshSelection& selection,
                                             const CurveUnfoldingOptions& options, const Progress& progress) {
  check_options(options);
  CompletionReport report;
  StageClock clock(report);
  const MeshTopology topology = build_topology(mesh, progress.part(0, 0.1, "finding the boundary"));
  const std::vector<BoundaryLoop> loops =
      trace_boundary_loops(mesh, topology, progress.part(0.1, 0.15, "tracing boundary loops"));
  report.holes = select_holes(mesh, loops, selection, options.holes);
  Run run(mesh, topology, loops, options, report);
  clock.end_of("finding the holes");
  run.fill_all(progress.part(0.15, 0.95, "closing holes"));
  clock.end_of("closing the holes");
  run.separate(progress.part(0.95, 1.0, "comparing the patches"));
  clock.end_of("comparing the patches");
  progress.update(1.0);
  return run.finish(std::move(report), options.unfolded_layer);
}

}  // namespace meshcomplete
