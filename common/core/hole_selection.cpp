#include "common/core/hole_selection.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

constexpr const char* stage = "choosing the holes";

bool any(const std::vector<char>& flags) {
  return std::any_of(flags.begin(), flags.end(), [](char flag) { return flag != 0; });
}

void check_options(const TriangleMesh& mesh, const MeshSelection& selection,
                   const HoleSelectionOptions& options) {
  if (options.max_edges && *options.max_edges < 3)
    throw CompletionError(stage, "The greatest number of edges of a hole must be at least 3, or 0 for any.");
  if (options.max_perimeter && !(std::isfinite(*options.max_perimeter) && *options.max_perimeter > 0))
    throw CompletionError(stage, "The greatest perimeter of a hole must be positive, or 0 for any.");
  if (!options.selected_only) return;
  if ((!selection.vertices.empty() && selection.vertices.size() != mesh.vertices.size()) ||
      (!selection.faces.empty() && selection.faces.size() != mesh.triangles.size()))
    throw CompletionError(stage, "The selection does not belong to this mesh.");
  if (!any(selection.vertices) && !any(selection.faces))
    throw CompletionError(
        stage,
        "Only holes at the selection were asked for, but nothing is selected. Select some faces or "
        "vertices at the holes, or switch off 'Selected'.");
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

HoleReport describe_hole(const TriangleMesh& mesh, const BoundaryLoop& loop, std::size_t position) {
  HoleReport hole;
  hole.loops = {position};
  hole.edges = loop.vertices.size();
  hole.perimeter = perimeter(mesh, loop);
  for (Index v : loop.vertices) hole.centre += mesh.vertices[v];
  hole.centre /= static_cast<double>(loop.vertices.size());
  return hole;
}

std::size_t longest(const std::vector<HoleReport>& holes) {
  const auto it = std::max_element(holes.begin(), holes.end(), [](const HoleReport& a, const HoleReport& b) {
    return a.perimeter < b.perimeter;
  });
  return static_cast<std::size_t>(it - holes.begin());
}

}  // namespace

std::vector<char> touched_vertices(const TriangleMesh& mesh, const MeshSelection& selection) {
  std::vector<char> touched = selection.vertices;
  touched.resize(mesh.vertices.size(), 0);
  for (std::size_t f = 0; f < selection.faces.size(); ++f)
    if (selection.faces[f])
      for (Index corner : mesh.triangles[f]) touched[corner] = 1;
  return touched;
}

std::vector<HoleReport> select_holes(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops,
                                     const MeshSelection& selection, const HoleSelectionOptions& options) {
  check_options(mesh, selection, options);
  std::vector<HoleReport> holes;
  for (std::size_t i = 0; i < loops.size(); ++i) holes.push_back(describe_hole(mesh, loops[i], i));

  std::vector<char> touched;
  if (options.selected_only) touched = touched_vertices(mesh, selection);
  const std::size_t largest = longest(holes);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    HoleReport& hole = holes[i];
    const auto& vertices = loops[i].vertices;
    if (options.selected_only &&
        std::none_of(vertices.begin(), vertices.end(), [&](Index v) { return touched[v] != 0; }))
      hole.reason = not_selected;
    else if (options.max_edges && hole.edges > *options.max_edges)
      hole.reason = "more than " + std::to_string(*options.max_edges) + " edges";
    else if (options.max_perimeter && hole.perimeter > *options.max_perimeter)
      hole.reason = "perimeter above " + number(*options.max_perimeter);
    else if (options.keep_largest && i == largest)
      hole.reason = "the longest boundary, kept open";
    else if (loops[i].defect == LoopDefect::isolated_triangle || loops[i].defect == LoopDefect::open_sheet)
      hole.reason = describe(loops[i].defect);
    else {
      hole.outcome = HoleOutcome::failed;
      hole.reason = describe(loops[i].defect);
    }
  }
  return holes;
}

}  // namespace meshcomplete
