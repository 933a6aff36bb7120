#include "filter_atomicvolumes/volume_locator.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "filter_atomicvolumes/crossed_cube.h"

namespace meshcomplete {
namespace {

bool holds(const std::array<Vector3, 4>& corners, const Vector3& point) {
  const auto volume = [](const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
    return (b - a).cross(c - a).dot(d - a);
  };
  const auto& [a, b, c, apex] = corners;
  // The base is counter-clockwise seen from outside, so that the apex is behind it.
  return volume(a, b, c, point) <= 0 && volume(a, apex, b, point) <= 0 && volume(b, apex, c, point) <= 0 &&
         volume(c, apex, a, point) <= 0;
}

}  // namespace

std::optional<LeafOfPoint> find_leaf(const Lattice& lattice, const Octree& octree, const Vector3& point) {
  const Vector3 share = (point - lattice.position({0, 0, 0})) / lattice.side();
  if (!(share.minCoeff() > 0 && share.maxCoeff() < 1)) return std::nullopt;
  LatticePoint p = lattice.snap(point);
  for (std::int64_t& coordinate : p)
    coordinate = std::clamp<std::int64_t>(coordinate - 1, 0, Lattice::steps - 2);
  return LeafOfPoint{octree.find(p), p};
}

std::optional<bool> side_in_leaf(const LatticeMesh& mesh, const Decomposition& decomposition,
                                 const SideFinder& sides, const LeafOfPoint& at, const Vector3& point) {
  const std::vector<Index>& triangles = decomposition.volumes[at.leaf].triangles;
  if (triangles.empty()) return std::nullopt;
  Index near = triangles.front();
  const std::optional<bool> side = sides.nearest(point, near).inside;
  return side ? side : is_inside(mesh, triangles, decomposition.octree.box(at.leaf), at.point);
}

std::array<Vector3, 4> corners_of(const VolumeComplex& complex, const VolumeComplex::Tetrahedron& t) {
  return {complex.vertices[t.base[0]].position, complex.vertices[t.base[1]].position,
          complex.vertices[t.base[2]].position, complex.vertices[t.apex].position};
}

// Whether the point lies in a free tetrahedron or a convex cell of the leaf. The complex lists both cube by
// cube, ascending.
bool VolumeLocator::find_part(const Vector3& point, VolumePlace& place) const {
  const auto precedes = [](const auto& part, Index cube) { return part.cube < cube; };
  const auto& tetrahedra = complex_.free_tetrahedra;
  auto t = std::lower_bound(tetrahedra.begin(), tetrahedra.end(), place.leaf, precedes);
  for (; t != tetrahedra.end() && t->cube == place.leaf; ++t) {
    if (!holds(corners_of(complex_, *t), point)) continue;
    place.kind = VolumePlace::free;
    place.node = static_cast<Cell>(complex_.blank_nodes) + static_cast<Cell>(t - tetrahedra.begin());
    return true;
  }
  const auto& cells = complex_.convex_cells;
  auto c = std::lower_bound(cells.begin(), cells.end(), place.leaf, precedes);
  for (; c != cells.end() && c->cube == place.leaf; ++c) {
    if (!c->holds(point)) continue;
    place.kind = c->cell >= 0              ? VolumePlace::free
                 : c->cell == inside_cell  ? VolumePlace::inside
                 : c->cell == outside_cell ? VolumePlace::outside
                                           : VolumePlace::unknown;
    place.node = c->cell;
    return true;
  }
  return false;
}

VolumePlace VolumeLocator::locate(const Vector3& point) const {
  const std::optional<LeafOfPoint> at = find_leaf(mesh_.lattice, decomposition_.octree, point);
  if (!at) return {};
  const Volume& volume = decomposition_.volumes[at->leaf];
  VolumePlace place{VolumePlace::unknown, complex_.cube_cells[at->leaf], at->leaf};
  if (volume.kind == VolumeKind::blank) {
    place.kind = VolumePlace::free;
    return place;
  }
  if (find_part(point, place)) return place;
  const std::optional<bool> side = side_in_leaf(mesh_, decomposition_, sides_, *at, point);
  if (side) place.kind = *side ? VolumePlace::inside : VolumePlace::outside;
  return place;
}

}  // namespace meshcomplete
