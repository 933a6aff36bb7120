#include "tools/filter_checkcompletion/filter_checkcompletion.h"

#include "common/core/mesh_statistics.h"
#include "common/host/parameter_blocks.h"
#include "common/host/snapshot.h"

using namespace meshcomplete;
using namespace meshcomplete::host;

namespace {

const char* const description =
    "Says in the log whether the current mesh is complete: how many holes it has and how large they are, "
    "non-manifold "
    "edges and vertices, connected components, genus, orientation, pairs of faces that intersect, faces "
    "without area and "
    "faces that are there twice. Intersections are decided exactly. The mesh is not changed.";

void apply(FilterRun& run) {
  const Snapshot input = snapshot(*run.document.mm());
  const MeshStatistics statistics =
      measure(input.mesh, run.parameters.boolean("SelfIntersections"), run.progress);
  for (const std::string& line : describe(statistics)) run.log(QString::fromStdString(line));
}

FilterDeclaration check_completion_filter() {
  FilterDeclaration filter;
  filter.name = "Check Completion";
  filter.python_name = "check_completion";
  filter.description = description;
  filter.place = MenuPlace::quality;
  filter.parameters = {
      switch_parameter("SelfIntersections", "Count self-intersections",
                       "Also counts the pairs of faces that intersect, which takes longer than all the "
                       "rest.",
                       true)};
  filter.apply = apply;
  filter.changes_mesh = false;
  return filter;
}

}  // namespace

FilterCheckCompletion::FilterCheckCompletion() { declare({check_completion_filter()}, this); }
