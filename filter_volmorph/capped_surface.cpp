#include "filter_volmorph/capped_surface.h"

namespace meshcomplete {
namespace {

constexpr Index none = 0xffffffffu;
constexpr std::size_t between_checks = 1 << 16;

// The boundary half-edge that follows in the loop, round the fan at the end of `half_edge`.
Index next_at_boundary(const std::vector<Index>& opposite, Index half_edge) {
  Index h = CappedSurface::next(half_edge);
  while (opposite[h] != MeshTopology::boundary) h = CappedSurface::next(opposite[h]);
  return h;
}

// Adds the cap of the loop that begins at a boundary half-edge; its middle gets a vertex later.
void add_cap(CappedSurface& surface, Index first) {
  std::vector<Index> loop;
  Index h = first;
  do {
    loop.push_back(h);
    h = next_at_boundary(surface.opposite, h);
  } while (h != first);
  const Index base = Index(surface.opposite.size());
  const Index count = Index(loop.size());
  surface.opposite.resize(base + 3 * count);
  // Face i: from the end of loop[i] to its beginning, to the middle, and back.
  for (Index i = 0; i < count; ++i) {
    const Index face = base + 3 * i, after = base + 3 * ((i + 1) % count);
    surface.opposite[face] = loop[i];
    surface.opposite[loop[i]] = face;
    surface.opposite[face + 2] = after + 1;
    surface.opposite[after + 1] = face + 2;
  }
}

}  // namespace

CappedSurface cap_surface(const TriangleMesh& mesh, const MeshTopology& topology, const Progress& progress) {
  CappedSurface surface;
  surface.first_cap = Index(mesh.triangles.size());
  surface.opposite = topology.opposite;
  for (const Index h : topology.boundary_half_edges)
    if (surface.opposite[h] == MeshTopology::boundary) add_cap(surface, h);
  surface.origin.assign(surface.opposite.size(), none);
  for (Index first = 0; first < surface.origin.size(); ++first) {
    if (first % between_checks == 0) progress.update(double(first) / double(surface.origin.size()));
    if (surface.origin[first] != none) continue;
    const Index vertex = Index(surface.outgoing.size());
    surface.outgoing.push_back(first);
    Index original = CappedSurface::no_vertex;
    Index h = first;
    do {
      surface.origin[h] = vertex;
      if (!surface.in_cap(h)) original = mesh.triangles[h / 3][h % 3];
      h = surface.turned(h);
    } while (h != first);
    surface.original.push_back(original);
  }
  progress.update(1);
  return surface;
}

}  // namespace meshcomplete
