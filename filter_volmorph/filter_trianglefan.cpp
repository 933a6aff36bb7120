#include "filter_volmorph/filter_trianglefan.h"

#include <utility>

#include "common/core/error.h"
#include "common/host/close_holes.h"
#include "common/host/parameter_blocks.h"
#include "filter_volmorph/published_fans.h"
#include "filter_volmorph/triangle_fan.h"

namespace meshcomplete {
namespace host {
namespace {

const char* const description =
    "Closes each hole by a fan of triangles from its boundary to one new vertex, at the mean of the "
    "boundary's "
    "vertices: the least that closes a hole, with long triangles. It adds no handles, and is quick. The mesh "
    "itself is not changed: faces and vertices are only added, and they intersect nothing; a hole whose fan "
    "would is left open, and the log says so. The mode \"As published\" makes a new layer without boundary, "
    "and "
    "for that removes and splits parts of the mesh."
    "<br>See: <br/><i>Eric Firestone</i><br/>"
    "<b>\"An Exploration of Hole Filling Algorithms\"</b><br/>"
    "Master's thesis, California Polytechnic State University, San Luis Obispo, 2008, section 2.2.1.";

std::vector<ParameterDeclaration> parameters() {
  std::vector<ParameterDeclaration> all = close_holes_parameters();
  all.push_back(switch_parameter(
      "AsPublished", "As published",
      "Makes a new layer that is manifold, and without boundary when no parameter above leaves holes open. "
      "Faces that span holes are removed first (see below), and faces at edges with three or more faces; "
      "then "
      "every hole is closed, even if faces intersect, also those of single triangles and flat sheets; then "
      "vertices that several fans of faces share are split. The log lists removed faces and split vertices, "
      "and "
      "counts the intersections. The current layer stays as it is.",
      false));
  all.push_back(choice_parameter("Spanning", "Faces that span holes",
                                 "Which pieces, connected by edges, \"As published\" removes. All but the "
                                 "largest: as published; a mesh of "
                                 "several parts loses all but one. Those at a larger piece: only pieces that "
                                 "share a vertex with a larger "
                                 "one.",
                                 {"All but the largest", "Those at a larger piece"}));
  return all;
}

ClosedHoles as_published(const TriangleMesh& mesh, const MeshSelection& selection,
                         const PublishedFansOptions& options, const Progress& progress) {
  PublishedFans result = close_as_published(mesh, selection, options, progress);
  ClosedHoles closed;
  closed.completion = std::move(result.completion);
  closed.removed = std::move(result.removed);
  closed.splits = std::move(result.splits);
  closed.cleaned = true;
  return closed;
}

void apply(FilterRun& run) {
  constexpr SpanningPieces spanning[] = {SpanningPieces::all_but_largest, SpanningPieces::touching_larger};
  const bool published = run.parameters.boolean("AsPublished");
  const SpanningPieces pieces = spanning[run.parameters.choice("Spanning")];
  if (!published && pieces != SpanningPieces::all_but_largest)
    throw CompletionError("reading the parameters",
                          "\"Spanning\" says which faces \"AsPublished\" removes; switch that on, too.");
  close_holes(run, [&](const TriangleMesh& mesh, const MeshSelection& selection,
                       const HoleSelectionOptions& holes, const Progress& progress) {
    if (published) return as_published(mesh, selection, {holes, pieces}, progress);
    ClosedHoles closed;
    closed.completion = close_by_fans(mesh, selection, {holes}, progress);
    CompletionReport& report = closed.completion.report;
    if (report.count(HoleOutcome::failed) > 0)
      report.notes.push_back(
          "\"Close Holes: Curve Unfolding\" can close most of the holes that a fan cannot");
    return closed;
  });
}

}  // namespace

FilterDeclaration triangle_fan_filter() {
  FilterDeclaration filter;
  filter.name = "Close Holes: Triangle Fan";
  filter.python_name = "close_holes_triangle_fan";
  filter.description = description;
  filter.place = MenuPlace::remeshing;
  filter.parameters = parameters();
  filter.apply = apply;
  return filter;
}

}  // namespace host
}  // namespace meshcomplete
