#include "filter_volmorph/hole_spanning.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "common/core/error.h"
#include "common/core/mesh_topology.h"

namespace meshcomplete {
namespace {

constexpr Index none = 0xffffffffu;
constexpr const char* stage = "removing hole-spanning faces";

Index origin(const TriangleMesh& mesh, Index half_edge) {
  return mesh.triangles[half_edge / 3][half_edge % 3];
}

// The face on the other side of an edge that marking may cross, or `none`.
Index across(const TriangleMesh& mesh, const MeshTopology& topology, Index half_edge) {
  const Index other = topology.opposite[half_edge];
  if (other >= topology.opposite.size() || origin(mesh, half_edge) == origin(mesh, other)) return none;
  return other / 3;
}

struct Pieces {
  std::vector<Index> of;           // the piece of each face; `none` for those that name a vertex twice
  std::vector<std::size_t> faces;  // of each piece; pieces are in the order of their lowest faces
};

Pieces mark(const TriangleMesh& mesh, const MeshTopology& topology, const Progress& progress) {
  Pieces pieces{std::vector<Index>(mesh.triangles.size(), none), {}};
  std::vector<char> left_out(mesh.triangles.size(), 0);
  for (const Index f : topology.degenerate_faces) left_out[f] = 1;
  std::vector<Index> flood;
  std::size_t done = 0;
  for (Index start = 0; start < mesh.triangles.size(); ++start) {
    if (left_out[start] || pieces.of[start] != none) continue;
    const auto piece = static_cast<Index>(pieces.faces.size());
    pieces.faces.push_back(0);
    pieces.of[start] = piece;
    flood.push_back(start);
    while (!flood.empty()) {
      const Index face = flood.back();
      flood.pop_back();
      ++pieces.faces.back();
      if (++done % 4096 == 0)
        progress.update(static_cast<double>(done) / static_cast<double>(mesh.triangles.size()));
      for (Index h = 3 * face; h < 3 * face + 3; ++h) {
        const Index next = across(mesh, topology, h);
        if (next == none || pieces.of[next] != none) continue;
        pieces.of[next] = piece;
        flood.push_back(next);
      }
    }
  }
  return pieces;
}

// For each piece whether it stays.
std::vector<char> staying(const TriangleMesh& mesh, const Pieces& pieces, SpanningPieces spanning) {
  std::vector<char> stays(pieces.faces.size(), 0);
  std::vector<Index> order(pieces.faces.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return pieces.faces[a] > pieces.faces[b]; });
  if (order.empty()) return stays;
  if (spanning == SpanningPieces::all_but_largest) {
    stays[order.front()] = 1;
    return stays;
  }
  std::vector<std::size_t> first(pieces.faces.size() + 1, 0);  // of each piece, in `faces`
  for (std::size_t p = 0; p < pieces.faces.size(); ++p) first[p + 1] = first[p] + pieces.faces[p];
  std::vector<Index> faces(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (Index f = 0; f < pieces.of.size(); ++f)
    if (pieces.of[f] != none) faces[next[pieces.of[f]]++] = f;
  std::vector<char> taken(mesh.vertices.size(), 0);
  for (const Index piece : order) {
    const auto begin = faces.begin() + static_cast<std::ptrdiff_t>(first[piece]);
    const auto end = faces.begin() + static_cast<std::ptrdiff_t>(first[piece + 1]);
    stays[piece] = std::none_of(begin, end, [&](Index f) {
      const Triangle& t = mesh.triangles[f];
      return taken[t[0]] || taken[t[1]] || taken[t[2]];
    });
    if (!stays[piece]) continue;
    for (auto f = begin; f != end; ++f)
      for (const Index v : mesh.triangles[*f]) taken[v] = 1;
  }
  return stays;
}

// One round of mark and sweep.
void sweep(SweptMesh& swept, SpanningPieces spanning, bool select_corners, const Progress& progress) {
  const MeshTopology topology = build_topology(swept.rest.mesh, progress.part(0, 0.5, stage));
  const Pieces pieces = mark(swept.rest.mesh, topology, progress.part(0.5, 1, stage));
  const std::vector<char> stays = staying(swept.rest.mesh, pieces, spanning);
  std::vector<Index> unmarked;
  for (Index f = 0; f < pieces.of.size(); ++f)
    if (pieces.of[f] == none || !stays[pieces.of[f]]) unmarked.push_back(f);
  swept.repeating_faces += topology.degenerate_faces.size();
  swept.spanning_faces += unmarked.size() - topology.degenerate_faces.size();
  swept.spanning_pieces += static_cast<std::size_t>(std::count(stays.begin(), stays.end(), 0));
  if (!unmarked.empty()) remove_faces(swept.rest, unmarked, select_corners);
}

// All faces at edges where it is not clear which two belong together; returns whether there were any.
bool remove_unclear_faces(SweptMesh& swept, bool select_corners, const Progress& progress) {
  const TriangleMesh& mesh = swept.rest.mesh;
  const MeshTopology topology = build_topology(mesh, progress);
  std::vector<Index> unclear;
  for (Index f = 0; f < mesh.triangles.size(); ++f)
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
      if (topology.opposite[h] != MeshTopology::boundary && across(mesh, topology, h) == none) {
        unclear.push_back(f);
        break;
      }
  if (unclear.empty()) return false;
  swept.unclear_faces += unclear.size();
  remove_faces(swept.rest, unclear, select_corners);
  return true;
}

}  // namespace

SweptMesh sweep_hole_spanning_faces(const TriangleMesh& mesh, const MeshSelection& selection,
                                    SpanningPieces pieces, bool select_corners, const Progress& progress) {
  SweptMesh swept;
  swept.rest = unreduced(mesh, selection);
  sweep(swept, pieces, select_corners, progress.part(0, 0.4, stage));
  if (remove_unclear_faces(swept, select_corners, progress.part(0.4, 0.6, stage)))
    sweep(swept, pieces, select_corners, progress.part(0.6, 1, stage));
  if (swept.rest.mesh.triangles.empty() && !mesh.triangles.empty())
    throw CompletionError(
        stage,
        "Nothing of the mesh would be left: all of its faces name a vertex twice, or lie at "
        "edges with three or more faces or with two that do not agree which side is the front. "
        "Apply 'Repair non Manifold Edges by removing faces' and 'Re-Orient all faces "
        "coherentely' first.");
  progress.update(1);
  return swept;
}

}  // namespace meshcomplete
