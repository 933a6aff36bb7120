#include "common/core/mesh_topology.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <string>
#include <unordered_set>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

constexpr Index unset = 0xfffffffdu;

Index origin(const TriangleMesh& mesh, Index half_edge) {
  return mesh.triangles[half_edge / 3][half_edge % 3];
}
Index target(const TriangleMesh& mesh, Index half_edge) {
  return mesh.triangles[half_edge / 3][(half_edge % 3 + 1) % 3];
}

void check_indices(const TriangleMesh& mesh) {
  if (mesh.triangles.size() >= (std::size_t(1) << 30))
    throw CompletionError("reading the mesh",
                          "The mesh has a thousand million triangles or more; split it first.");
  const std::size_t count = mesh.vertices.size();
  for (const Triangle& triangle : mesh.triangles)
    for (Index corner : triangle)
      if (corner >= count)
        throw CompletionError("reading the mesh", "A triangle refers to vertex " + std::to_string(corner) +
                                                      ", but the mesh has only " + std::to_string(count) +
                                                      ".");
}

bool repeats_a_corner(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// Half-edges grouped by the smaller end of their edge: bucket v is entries[start[v]] to entries[start[v +
// 1]].
struct Buckets {
  std::vector<Index> start, entries;
};

Buckets group_by_smaller_end(const TriangleMesh& mesh, std::vector<Index>& degenerate) {
  Buckets buckets;
  buckets.start.assign(mesh.vertices.size() + 1, 0);
  const auto smaller = [&](Index h) { return std::min(origin(mesh, h), target(mesh, h)); };
  const Index faces = static_cast<Index>(mesh.triangles.size());
  for (Index f = 0; f < faces; ++f) {
    if (repeats_a_corner(mesh.triangles[f])) {
      degenerate.push_back(f);
      continue;
    }
    for (Index h = 3 * f; h < 3 * f + 3; ++h) ++buckets.start[smaller(h) + 1];
  }
  for (std::size_t v = 1; v < buckets.start.size(); ++v) buckets.start[v] += buckets.start[v - 1];
  buckets.entries.resize(buckets.start.back());
  std::vector<Index> next(buckets.start.begin(), buckets.start.end() - 1);
  for (Index f = 0; f < faces; ++f) {
    if (repeats_a_corner(mesh.triangles[f])) continue;
    for (Index h = 3 * f; h < 3 * f + 3; ++h) buckets.entries[next[smaller(h)]++] = h;
  }
  return buckets;
}

// Pairs the half-edges of one bucket. Sorting by the larger end puts those of one edge next to each other.
void pair_bucket(const TriangleMesh& mesh, Index* first, Index* last, std::vector<Index>& opposite) {
  const auto larger = [&](Index h) { return std::max(origin(mesh, h), target(mesh, h)); };
  std::sort(first, last, [&](Index a, Index b) {
    const Index la = larger(a), lb = larger(b);
    return la != lb ? la < lb : a < b;
  });
  for (Index* h = first; h != last;) {
    Index* end = h + 1;
    while (end != last && larger(*end) == larger(*h)) ++end;
    if (end - h == 1) {
      opposite[*h] = MeshTopology::boundary;
    } else if (end - h == 2) {
      opposite[h[0]] = h[1];
      opposite[h[1]] = h[0];
    } else {
      for (Index* g = h; g != end; ++g) opposite[*g] = MeshTopology::non_manifold;
    }
    h = end;
  }
}

}  // namespace

MeshTopology build_topology(const TriangleMesh& mesh, const Progress& progress) {
  check_indices(mesh);
  progress.update(0.1);
  MeshTopology topology;
  topology.opposite.assign(3 * mesh.triangles.size(), unset);
  Buckets buckets = group_by_smaller_end(mesh, topology.degenerate_faces);
  progress.update(0.5);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.vertices.size(), 4096), [&](const auto& range) {
    for (std::size_t v = range.begin(); v != range.end(); ++v) {
      Index* const entries = buckets.entries.data();
      pair_bucket(mesh, entries + buckets.start[v], entries + buckets.start[v + 1], topology.opposite);
    }
  });
  for (Index h = 0; h < topology.opposite.size(); ++h) {
    if (topology.opposite[h] == MeshTopology::boundary) topology.boundary_half_edges.push_back(h);
    if (topology.opposite[h] == MeshTopology::non_manifold) topology.non_manifold_half_edges.push_back(h);
  }
  progress.update(1.0);
  return topology;
}

std::size_t separate_piece(const MeshTopology& topology, const std::vector<Index>& starts,
                           const std::vector<Index>& others, std::size_t limit) {
  // Faces of which it is known that they are not part of such a piece; a flood that comes to one is none
  // either.
  std::unordered_set<Index> attached(others.begin(), others.end());
  for (Index start : starts) {
    if (attached.count(start) > 0) continue;
    std::vector<Index> piece = {start};
    std::unordered_set<Index> seen = {start};
    bool separate = true;
    for (std::size_t i = 0; i < piece.size() && separate && piece.size() <= limit; ++i)
      for (Index h = 3 * piece[i]; h < 3 * piece[i] + 3; ++h) {
        const Index other = topology.opposite[h];
        if (other == MeshTopology::boundary) continue;
        // Beyond all half-edges: not manifold, or a degenerate face.
        if (other >= topology.opposite.size() || attached.count(other / 3) > 0)
          separate = false;
        else if (seen.insert(other / 3).second)
          piece.push_back(other / 3);
      }
    if (separate && piece.size() <= limit) return piece.size();
    attached.insert(piece.begin(), piece.end());
  }
  return 0;
}

}  // namespace meshcomplete
