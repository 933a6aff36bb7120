#include "filter_volmorph/handle_measure.h"

#include "common/core/mesh_topology.h"
#include "filter_volmorph/capped_surface.h"
#include "filter_volmorph/handle_loops.h"
#include "filter_volmorph/loop_basis.h"

namespace meshcomplete {
namespace {

const char* const stage = "measuring handles";

Handle handle_along(const TriangleMesh& mesh, const CappedSurface& surface, const SurfaceLoop& path) {
  Handle handle;
  handle.length = path.length;
  for (const Index h : path.half_edges) {
    handle.loop.push_back(surface.original[surface.origin[h]]);
    handle.centre += mesh.vertices[handle.loop.back()] / double(path.half_edges.size());
  }
  return handle;
}

}  // namespace

HandleReport measure_handles(const TriangleMesh& mesh, const Progress& progress) {
  HandleReport report;
  report.statistics = measure(mesh, false, progress.part(0, 0.2, stage));
  const MeshTopology topology = build_topology(mesh, progress.part(0.2, 0.3, stage));
  if (!report.statistics.genus || report.statistics.inconsistent_edges > 0 ||
      !topology.degenerate_faces.empty())
    return report;
  report.handles.emplace();
  if (*report.statistics.genus > 0) {
    const CappedSurface surface = cap_surface(mesh, topology, progress.part(0.3, 0.4, stage));
    const std::vector<double> lengths = edge_lengths(mesh, surface);
    const std::vector<SurfaceLoop> loops = loop_basis(surface, lengths, progress.part(0.4, 0.7, stage));
    for (const SurfaceLoop& loop : loops_of_handles(surface, lengths, loops, progress.part(0.7, 1, stage)))
      report.handles->push_back(handle_along(mesh, surface, loop));
  }
  progress.update(1);
  return report;
}

}  // namespace meshcomplete
