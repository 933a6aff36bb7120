#include "filter_volmorph/loop_basis.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

#include "common/core/disjoint_sets.h"
#include "common/core/threads.h"

namespace meshcomplete {
namespace {

const char* const stage = "finding handles";

constexpr Index none = 0xffffffffu;
constexpr std::size_t between_checks = 1 << 14;
constexpr double unreached = std::numeric_limits<double>::infinity();

// An edge that ends in the middle of a cap.
bool ends_in_middle(const CappedSurface& surface, Index h) {
  return surface.original[surface.origin[h]] == CappedSurface::no_vertex ||
         surface.original[surface.target(h)] == CappedSurface::no_vertex;
}

// Shortest paths from the first vertex of every component along the mesh's edges.
struct PathTree {
  std::vector<double> distance;
  std::vector<Index> entering;  // the half-edge by which each vertex is reached; `none` at the roots
  std::vector<Index> depth;     // half-edges from the root
};

class PathFinder {
 public:
  PathFinder(const CappedSurface& surface, const std::vector<double>& lengths)
      : surface_(surface), lengths_(lengths) {
    const std::size_t count = surface.outgoing.size();
    tree_ = {std::vector<double>(count, unreached), std::vector<Index>(count, none),
             std::vector<Index>(count, 0)};
  }

  PathTree find(const Progress& progress) {
    for (Index root = 0; root < surface_.outgoing.size(); ++root)
      if (tree_.distance[root] == unreached && surface_.original[root] != CappedSurface::no_vertex)
        spread_from(root, progress);
    // Middles of caps are leaves, far away.
    for (Index vertex = 0; vertex < surface_.outgoing.size(); ++vertex)
      if (surface_.original[vertex] == CappedSurface::no_vertex)
        tree_.entering[vertex] = surface_.opposite[surface_.outgoing[vertex]];
    progress.update(1);
    return std::move(tree_);
  }

 private:
  using Arrival = std::pair<double, Index>;

  void spread_from(Index root, const Progress& progress) {
    std::priority_queue<Arrival, std::vector<Arrival>, std::greater<Arrival>> queue;
    tree_.distance[root] = 0;
    queue.push({0, root});
    while (!queue.empty()) {
      const auto [distance, vertex] = queue.top();
      queue.pop();
      if (distance > tree_.distance[vertex]) continue;
      if (++settled_ % between_checks == 0)
        progress.update(double(settled_) / double(surface_.outgoing.size()));
      const Index first = surface_.outgoing[vertex];
      Index h = first;
      do {
        const Index target = surface_.target(h);
        const double there = distance + lengths_[h];
        if (there < tree_.distance[target]) {
          tree_.distance[target] = there;
          tree_.entering[target] = h;
          tree_.depth[target] = tree_.depth[vertex] + 1;
          queue.push({there, target});
        }
        h = surface_.turned(h);
      } while (h != first);
    }
  }

  const CappedSurface& surface_;
  const std::vector<double>& lengths_;
  PathTree tree_;
  std::size_t settled_ = 0;
};

bool in_tree(const CappedSurface& surface, const PathTree& tree, Index h) {
  return tree.entering[surface.target(h)] == h || tree.entering[surface.origin[h]] == surface.opposite[h];
}

// The edges that are in neither tree: one for each loop. The tree of faces takes those first whose loops
// through the root are longest.
std::vector<Index> generating_edges(const CappedSurface& surface, const std::vector<double>& lengths,
                                    const PathTree& tree, const Progress& progress) {
  struct Edge {
    double loop;
    Index half_edge;
  };
  std::vector<Edge> edges;
  edges.reserve(surface.opposite.size() / 3);
  for (Index h = 0; h < surface.opposite.size(); ++h) {
    if (h % between_checks == 0) progress.update(0.3 * h / double(surface.opposite.size()));
    if (h > surface.opposite[h] || in_tree(surface, tree, h)) continue;
    const double loop = tree.distance[surface.origin[h]] + tree.distance[surface.target(h)] + lengths[h];
    edges.push_back({loop, h});
  }
  tbb::parallel_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.loop != b.loop ? a.loop > b.loop : a.half_edge < b.half_edge;
  });
  DisjointSets faces(surface.opposite.size() / 3);
  std::vector<Index> rest;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i % between_checks == 0) progress.update(0.6 + 0.4 * double(i) / double(edges.size()));
    const Index h = edges[i].half_edge;
    if (!faces.unite(h / 3, surface.opposite[h] / 3)) rest.push_back(h);
  }
  return rest;
}

// Along an edge, and from both of its ends along the tree until the ways meet.
SurfaceLoop loop_through(const CappedSurface& surface, const std::vector<double>& lengths,
                         const PathTree& tree, Index edge) {
  std::vector<Index> to_origin, from_target;
  Index a = surface.origin[edge], b = surface.target(edge);
  while (a != b) {
    if (tree.depth[a] >= tree.depth[b]) {
      to_origin.push_back(tree.entering[a]);
      a = surface.origin[tree.entering[a]];
    } else {
      from_target.push_back(surface.opposite[tree.entering[b]]);
      b = surface.origin[tree.entering[b]];
    }
  }
  SurfaceLoop loop;
  loop.half_edges.assign(to_origin.rbegin(), to_origin.rend());
  loop.half_edges.push_back(edge);
  loop.half_edges.insert(loop.half_edges.end(), from_target.begin(), from_target.end());
  for (const Index h : loop.half_edges) loop.length += lengths[h];
  return loop;
}

}  // namespace

std::vector<double> edge_lengths(const TriangleMesh& mesh, const CappedSurface& surface) {
  std::vector<double> lengths(surface.opposite.size());
  for_each(lengths.size(), between_checks, Progress(), [&](std::size_t i) {
    const Index h = static_cast<Index>(i);
    lengths[h] = ends_in_middle(surface, h) ? unreached
                                            : (mesh.vertices[surface.original[surface.origin[h]]] -
                                               mesh.vertices[surface.original[surface.target(h)]])
                                                  .norm();
  });
  return lengths;
}

std::vector<SurfaceLoop> loop_basis(const CappedSurface& surface, const std::vector<double>& lengths,
                                    const Progress& progress) {
  const PathTree tree = PathFinder(surface, lengths).find(progress.part(0, 0.5, stage));
  const std::vector<Index> edges = generating_edges(surface, lengths, tree, progress.part(0.5, 0.9, stage));
  std::vector<SurfaceLoop> loops;
  for (const Index edge : edges) {
    progress.check();
    loops.push_back(loop_through(surface, lengths, tree, edge));
  }
  std::stable_sort(loops.begin(), loops.end(),
                   [](const SurfaceLoop& a, const SurfaceLoop& b) { return a.length < b.length; });
  progress.update(1);
  return loops;
}

std::vector<Index> edges_beside(const CappedSurface& surface, const SurfaceLoop& loop) {
  std::vector<Index> edges;
  for (std::size_t i = 0; i < loop.half_edges.size(); ++i) {
    const Index out = loop.half_edges[(i + 1) % loop.half_edges.size()];
    for (Index h = CappedSurface::next(loop.half_edges[i]); h != out; h = surface.turned(h))
      edges.push_back(h);
  }
  return edges;
}

}  // namespace meshcomplete
