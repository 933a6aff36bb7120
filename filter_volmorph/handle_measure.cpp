#include "filter_volmorph/handle_measure.h"

#include <algorithm>

#include "common/core/mesh_topology.h"
#include "filter_volmorph/capped_surface.h"
#include "filter_volmorph/loop_basis.h"
#include "filter_volmorph/loop_shortening.h"

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

// All that the sum of some loops, moved a little to their left, crosses.
std::vector<Index> crossed_by(const CappedSurface& surface, const std::vector<SurfaceLoop>& loops,
                              const std::vector<Index>& sum) {
  std::vector<Index> edges;
  for (const Index loop : sum) {
    const std::vector<Index> some = edges_beside(surface, loops[loop]);
    edges.insert(edges.end(), some.begin(), some.end());
  }
  return edges;
}

// The shorter of a pair's loops, each as short as can be found without crossing the other one no more.
std::vector<Handle> shortest_handles(const TriangleMesh& mesh, const CappedSurface& surface,
                                     const std::vector<SurfaceLoop>& loops,
                                     const std::vector<LoopPair>& pairs, const Progress& progress) {
  LoopShortener shortener(mesh, surface);
  std::vector<Handle> handles;
  for (const LoopPair& pair : pairs) {
    progress.update(double(handles.size()) / double(pairs.size()));
    const SurfaceLoop first =
        shortener.shortened(loops[pair.first], crossed_by(surface, loops, pair.second_sum), progress);
    const SurfaceLoop second =
        shortener.shortened(loops[pair.second], crossed_by(surface, loops, pair.first_sum), progress);
    handles.push_back(handle_along(mesh, surface, second.length < first.length ? second : first));
  }
  std::stable_sort(handles.begin(), handles.end(),
                   [](const Handle& a, const Handle& b) { return a.length < b.length; });
  return handles;
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
    const std::vector<SurfaceLoop> loops = loop_basis(mesh, surface, progress.part(0.4, 0.7, stage));
    const auto crossings = crossing_loops(surface, loops, progress.part(0.7, 0.75, stage));
    const std::vector<LoopPair> pairs = pair_loops(loops.size(), crossings, progress.part(0.75, 0.8, stage));
    report.handles = shortest_handles(mesh, surface, loops, pairs, progress.part(0.8, 1, stage));
  }
  progress.update(1);
  return report;
}

}  // namespace meshcomplete
