#include "common/core/patch_graph.h"

#include <functional>
#include <queue>
#include <utility>

namespace meshcomplete {

PatchGraph::PatchGraph(const TriangleMesh& mesh, const Patch& patch) : mesh_(mesh), patch_(patch) {
  for (Index t = 0; t < patch.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) face_.emplace(key(patch.triangles[t][k], patch.triangles[t][(k + 1) % 3]), t);
  for (const Triangle& t : patch.triangles)
    for (int k = 0; k < 3; ++k)
      if (face_.count(key(t[(k + 1) % 3], t[k]))) neighbours_[t[k]].push_back(t[(k + 1) % 3]);
}

Index PatchGraph::beyond(Index triangle, int side) const {
  const Triangle& t = patch_.triangles[triangle];
  const auto found = face_.find(key(t[(side + 1) % 3], t[side]));
  return found == face_.end() ? static_cast<Index>(patch_.triangles.size()) : found->second;
}

std::vector<Index> PatchPaths::back_from(Index vertex) const {
  std::vector<Index> path = {vertex};
  for (auto found = before.find(vertex); found != before.end(); found = before.find(path.back()))
    path.push_back(found->second);
  return path;
}

PatchPaths PatchGraph::paths_from(const std::vector<std::pair<Index, double>>& starts, const Price& price,
                                  const std::unordered_set<Index>& closed, const Progress& progress) const {
  using Step = std::pair<double, Index>;
  PatchPaths paths;
  std::unordered_set<Index> first;
  std::priority_queue<Step, std::vector<Step>, std::greater<Step>> open;
  for (const auto& [vertex, cost] : starts) {
    first.insert(vertex);
    paths.distance[vertex] = cost;
    open.emplace(cost, vertex);
  }
  while (!open.empty()) {
    const auto [cost, vertex] = open.top();
    open.pop();
    if (cost > paths.distance[vertex]) continue;
    const bool ends = vertex < patch_.input_vertices || closed.count(vertex) != 0;
    const auto neighbours = neighbours_.find(vertex);
    if ((ends && !first.count(vertex)) || neighbours == neighbours_.end()) continue;
    progress.check();
    for (Index next : neighbours->second) {
      const double more = cost + price(vertex, next);
      if (first.count(next) || more >= paths.to(next)) continue;
      paths.distance[next] = more;
      paths.before[next] = vertex;
      open.emplace(more, next);
    }
  }
  return paths;
}

}  // namespace meshcomplete
