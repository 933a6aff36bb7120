#include "tests/support/atomic_shapes.h"

#include <cmath>

#include "common/core/patch.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace test {
namespace {

constexpr double pi = 3.14159265358979323846;

/// A profile, the radius in x and the height in z, turned round the z axis. The front is on its left, seen
/// with the radius to the right and the height up.
TriangleMesh turned(const std::vector<Vector3>& profile, Index around) {
  TriangleMesh mesh;
  for (const Vector3& p : profile)
    for (Index j = 0; j < around; ++j) {
      const double angle = 2 * pi * j / around;
      mesh.vertices.push_back(as_stored(Vector3(p.x() * std::cos(angle), p.x() * std::sin(angle), p.z())));
    }
  for (Index i = 0; i + 1 < static_cast<Index>(profile.size()); ++i)
    for (Index j = 0; j < around; ++j) {
      const Index a = i * around + j, b = a + around, c = i * around + (j + 1) % around, d = c + around;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

}  // namespace

Vector3 middle_of(const TriangleMesh& mesh, Index face) {
  const Triangle& t = mesh.triangles[face];
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}

TriangleMesh pierced_sphere() {
  std::vector<Vector3> arc, wall;
  for (int i = 0; i <= 30; ++i) {
    const double angle = (24 + 4.4 * i) * pi / 180;
    arc.emplace_back(std::sin(angle), 0, std::cos(angle));
  }
  for (int i = 0; i <= 50; ++i) wall.emplace_back(0.2, 0, 1.45 - 0.058 * i);
  return join(turned(arc, 48), turned(wall, 24));
}

TriangleMesh outer_half_of_torus() {
  const TriangleMesh whole = torus(48, 24, 1, 0.6);
  return without_faces(whole, [&](Index f) {
    const Vector3 p = middle_of(whole, f);
    return std::hypot(p[0], p[1]) < 1;
  });
}

std::vector<Vector3> points_in_ring() { return {{0, 0, -0.4}, {0, 0, 0}, {0, 0, 0.4}}; }

TriangleMesh spiral_torus() {
  std::vector<Vector3> spiral;
  const double turns = 2;
  for (int i = 0; i <= 48; ++i) {
    const double turn = turns * i / 48, radius = 0.2 + 0.24 * turn;
    // Clockwise, so that the outer side is on the left.
    spiral.emplace_back(2 + radius * std::cos(2 * pi * turn), 0, -radius * std::sin(2 * pi * turn));
  }
  return turned(spiral, 24);
}

TriangleMesh torus_without_arc(double from, double to) {
  const TriangleMesh whole = torus(48, 24, 1, 0.4);
  return without_faces(whole, [&](Index f) {
    const Vector3 p = middle_of(whole, f);
    const double angle = std::atan2(p[1], p[0]) * 180 / pi;
    return from < angle && angle < to;
  });
}

TriangleMesh lumps() { return torus_without_arc(-8, 8); }

std::vector<Vector3> points_in_gap() {
  std::vector<Vector3> points;
  for (int i = -2; i <= 2; ++i)
    for (int k = -2; k <= 2; ++k) points.push_back({1 + 0.18 * i, 0.003, 0.18 * k});
  return points;
}

}  // namespace test
}  // namespace meshcomplete
