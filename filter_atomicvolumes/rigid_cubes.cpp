#include "filter_atomicvolumes/rigid_cubes.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>

#include "common/core/patch.h"

namespace meshcomplete {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Flat = std::array<double, 2>;

int turn(const Flat& a, const Flat& b, const Flat& c) {
  return CGAL::orientation(Kernel::Point_2(a[0], a[1]), Kernel::Point_2(b[0], b[1]),
                           Kernel::Point_2(c[0], c[1]));
}

bool separated_by_sides(const std::array<Vector3, 3>& t, const Vector3& low, const Vector3& high) {
  for (int k = 0; k < 3; ++k)
    if (std::max({t[0][k], t[1][k], t[2][k]}) <= low[k] || std::min({t[0][k], t[1][k], t[2][k]}) >= high[k])
      return true;
  return false;
}

// Whether the box lies on one side of the triangle's plane.
bool separated_by_plane(const std::array<Vector3, 3>& t, const Vector3& low, const Vector3& high) {
  const auto point = [](const Vector3& p) { return Kernel::Point_3(p[0], p[1], p[2]); };
  const Kernel::Point_3 a = point(t[0]), b = point(t[1]), c = point(t[2]);
  bool above = false, below = false;
  for (int corner = 0; corner < 8; ++corner) {
    Vector3 p = low;
    for (int k = 0; k < 3; ++k)
      if (corner >> k & 1) p[k] = high[k];
    const int side = CGAL::orientation(a, b, c, point(p));
    above |= side > 0;
    below |= side < 0;
  }
  return !(above && below);
}

// Whether a side of the triangle, seen along `axis`, has the triangle on one side and the box on the other.
bool separated_along(const std::array<Vector3, 3>& t, const Vector3& low, const Vector3& high, int axis) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const std::array<Flat, 4> box = {
      {{low[i], low[j]}, {high[i], low[j]}, {high[i], high[j]}, {low[i], high[j]}}};
  std::array<Flat, 3> flat;
  for (int k = 0; k < 3; ++k) flat[k] = {t[k][i], t[k][j]};
  for (int k = 0; k < 3; ++k) {
    const Flat &p = flat[k], &q = flat[(k + 1) % 3];
    if (p == q) continue;
    const int own = turn(p, q, flat[(k + 2) % 3]);
    int least = 1, most = -1;
    for (const Flat& corner : box) {
      const int side = turn(p, q, corner);
      least = std::min(least, side);
      most = std::max(most, side);
    }
    if ((own >= 0 && most <= 0) || (own <= 0 && least >= 0)) return true;
  }
  return false;
}

}  // namespace

bool enters(const std::array<Vector3, 3>& triangle, const Vector3& low, const Vector3& high) {
  if ((low.array() >= high.array()).any() || separated_by_sides(triangle, low, high)) return false;
  if (separated_by_plane(triangle, low, high)) return false;
  for (int axis = 0; axis < 3; ++axis)
    if (separated_along(triangle, low, high, axis)) return false;
  return true;
}

StoredBox stored_box(const LatticeMesh& mesh, const Octree& octree, Index cube) {
  const LatticeBox box = octree.box(cube);
  return {as_stored(mesh.lattice.position(box.low)), as_stored(mesh.lattice.position(box.high))};
}

std::vector<StoredBox> rigid_cubes_near(const LatticeMesh& mesh, const Decomposition& decomposition,
                                        const Box& box) {
  std::vector<StoredBox> found;
  visit_leaves(mesh, decomposition.octree, box, [&](Index cube) {
    const VolumeKind kind = decomposition.volumes[cube].kind;
    if (kind == VolumeKind::crossed || kind == VolumeKind::unresolved)
      found.push_back(stored_box(mesh, decomposition.octree, cube));
  });
  return found;
}

}  // namespace meshcomplete
