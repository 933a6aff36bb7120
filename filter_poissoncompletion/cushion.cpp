#include "filter_poissoncompletion/cushion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "common/core/closest_point.h"

namespace meshcomplete {
namespace {

// Surfaces that face as the mesh does to within some 60 degrees are taken for the same sheet.
constexpr double least_cosine = 0.5;

}  // namespace

Cushion::Cushion(const TriangleBlocks& mesh, Radius radius, double largest)
    : mesh_(mesh), radius_(std::move(radius)), largest_(largest) {}

Cushion::Cushion(const TriangleBlocks& mesh, double radius)
    : Cushion(
          mesh, [radius](const Vector3&, bool) { return radius; }, radius) {}

std::optional<Cushion::Nearest> Cushion::nearest(const Vector3& point) const {
  const TriangleMesh& mesh = mesh_.mesh();
  double best = largest_ * largest_;
  std::optional<Nearest> found;
  const auto offer = [&](Index triangle) {
    const Triangle& t = mesh.triangles[triangle];
    const Vector3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    // No finite box is asked for: what comes of other coordinates is not below the best.
    const Vector3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const Vector3 off = (low - point).cwiseMax(point - high).cwiseMax(0.0);
    if (off.squaredNorm() > best) return true;
    const Vector3 at = closest_point(point, a, b, c).position;
    const double squared = (at - point).squaredNorm();
    if (!(squared < best) && !(squared == best && found && triangle < found->triangle)) return true;
    best = squared;
    found = Nearest{triangle, at, 0};
    return true;
  };
  mesh_.tree().descend([&](const Box& box) { return squared_distance(box, point) <= best; },
                       [&](std::size_t block) { return mesh_.visit_block(block, offer); });
  if (found) found->distance = (found->position - point).norm();
  return found;
}

bool Cushion::reaches(const Nearest& nearest, const Vector3& outwards) const {
  const TriangleMesh& mesh = mesh_.mesh();
  const Triangle& t = mesh.triangles[nearest.triangle];
  const Vector3& p = mesh.vertices[t[0]];
  const Vector3 normal = (mesh.vertices[t[1]] - p).cross(mesh.vertices[t[2]] - p);
  const bool alike = normal.dot(outwards) > least_cosine * normal.norm() * outwards.norm();
  return nearest.distance < std::min(radius_(nearest.position, alike), largest_);
}

}  // namespace meshcomplete
