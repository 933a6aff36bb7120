#include "filter_volmorph/published_fans.h"

#include <string>
#include <utility>

#include "common/core/boundary_loops.h"
#include "common/core/counted.h"
#include "common/core/hole_targets.h"
#include "common/core/mesh_statistics.h"
#include "common/core/mesh_topology.h"
#include "common/core/stage_clock.h"
#include "filter_volmorph/rim_fan.h"

namespace meshcomplete {
namespace {

// The rims of a swept mesh. Its edges leave no doubt how a rim goes on, and every rim is filled.
std::vector<BoundaryLoop> rims_to_fill(const TriangleMesh& mesh, const Progress& progress) {
  const MeshTopology topology = build_topology(mesh, progress.part(0, 0.5, "finding the boundary"));
  std::vector<BoundaryLoop> loops =
      trace_boundary_loops(mesh, topology, progress.part(0.5, 1, "tracing boundary loops"));
  for (BoundaryLoop& loop : loops) loop.defect = LoopDefect::none;
  return loops;
}

void fill(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops, Completion& completion,
          const Progress& progress) {
  completion.patch.input_vertices = static_cast<Index>(mesh.vertices.size());
  std::size_t edges = 0;
  for (const BoundaryLoop& loop : loops) edges += loop.vertices.size();
  completion.patch.triangles.reserve(edges);  // or `append` would move them for every hole
  for (std::size_t i = 0; i < loops.size(); ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(loops.size()));
    HoleReport& hole = completion.report.holes[i];
    if (!is_targeted(hole)) continue;
    const Patch fan = rim_fan(mesh, loops[i]);
    hole.outcome = HoleOutcome::closed;
    hole.route = "fan as published";
    hole.vertices_added = fan.vertices.size();
    hole.faces_added = fan.triangles.size();
    append(completion.patch, fan);
  }
}

TriangleMesh with_patch(TriangleMesh mesh, const Patch& patch) {
  mesh.vertices.insert(mesh.vertices.end(), patch.vertices.begin(), patch.vertices.end());
  mesh.triangles.insert(mesh.triangles.end(), patch.triangles.begin(), patch.triangles.end());
  return mesh;
}

void say_what_was_removed(const SweptMesh& swept, std::vector<std::string>& notes) {
  if (swept.repeating_faces > 0)
    notes.push_back("Removed " + counted(swept.repeating_faces, "face", "faces") + " naming a vertex twice");
  if (swept.spanning_faces > 0)
    notes.push_back("Removed " + counted(swept.spanning_faces, "hole-spanning face", "hole-spanning faces") +
                    ", in " + counted(swept.spanning_pieces, "piece", "pieces"));
  if (swept.unclear_faces > 0)
    notes.push_back("Removed " + counted(swept.unclear_faces, "face", "faces") +
                    " at edges with three or more faces or with two that disagree which side is the front");
}

void say_what_came_of_it(const PublishedFans& result, CompletionReport& report) {
  if (!result.splits.empty())
    report.notes.push_back("Split vertices where several fans of faces met: " +
                           counted(result.splits.size(), "copy", "copies"));
  report.notes.push_back(result.intersections == 0
                             ? std::string("No faces of the result intersect")
                             : counted(result.intersections, "pair of faces of the result intersects",
                                       "pairs of faces of the result intersect") +
                                   ": this mode does not avoid that");
  report.figures.emplace_back("split vertices", static_cast<double>(result.splits.size()));
  report.figures.emplace_back("self-intersecting pairs", static_cast<double>(result.intersections));
}

}  // namespace

PublishedFans close_as_published(const TriangleMesh& mesh, const MeshSelection& selection,
                                 const PublishedFansOptions& options, const Progress& progress) {
  PublishedFans result;
  CompletionReport& report = result.completion.report;
  StageClock clock(report);
  SweptMesh swept = sweep_hole_spanning_faces(mesh, selection, options.spanning, options.holes.selected_only,
                                              progress.part(0, 0.2, "removing hole-spanning faces"));
  say_what_was_removed(swept, report.notes);
  report.figures = {
      {"hole-spanning faces", static_cast<double>(swept.spanning_faces)},
      {"hole-spanning pieces", static_cast<double>(swept.spanning_pieces)},
      {"other faces removed", static_cast<double>(swept.repeating_faces + swept.unclear_faces)}};
  const TriangleMesh& rest = swept.rest.mesh;
  clock.end_of("removing hole-spanning faces");
  const std::vector<BoundaryLoop> loops = rims_to_fill(rest, progress.part(0.2, 0.4, "finding the holes"));
  report.holes = select_holes(rest, loops, swept.rest.selection, options.holes);
  clock.end_of("finding the holes");
  fill(rest, loops, result.completion, progress.part(0.4, 0.5, "closing holes"));
  clock.end_of("closing the holes");
  TriangleMesh whole = with_patch(rest, result.completion.patch);
  result.splits =
      split_overlapping_vertices(whole, build_topology(whole, progress.part(0.5, 0.6, "splitting vertices")));
  apply_splits(whole, result.splits);
  clock.end_of("splitting vertices");
  result.intersections = measure(whole, true, progress.part(0.6, 1, "counting intersections"))
                             .self_intersecting_pairs.value_or(0);
  clock.end_of("counting intersections");
  say_what_came_of_it(result, report);
  result.removed = std::move(swept.rest.removed);
  progress.update(1);
  return result;
}

}  // namespace meshcomplete
