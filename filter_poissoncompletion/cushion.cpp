#include "filter_poissoncompletion/cushion.h"

#include <utility>

#include "common/core/closest_point.h"

namespace meshcomplete {

Cushion::Cushion(const TriangleBlocks& mesh, Radius radius, double largest)
    : mesh_(mesh), radius_(std::move(radius)), largest_(largest) {}

Cushion::Cushion(const TriangleBlocks& mesh, double radius)
    : Cushion(
          mesh, [radius](const Vector3&) { return radius; }, radius) {}

std::optional<Cushion::Nearest> Cushion::nearest(const Vector3& point) const {
  const TriangleMesh& mesh = mesh_.mesh();
  double best = largest_ * largest_;
  std::optional<Nearest> found;
  const auto offer = [&](Index triangle) {
    if (squared_distance(mesh_.triangle_box(triangle), point) > best) return true;
    const Triangle& t = mesh.triangles[triangle];
    const Vector3 at =
        closest_point(point, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]).position;
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

std::optional<Cushion::Nearest> Cushion::within(const Vector3& point) const {
  std::optional<Nearest> near = nearest(point);
  if (near && !(near->distance < radius_(near->position))) near.reset();
  return near;
}

}  // namespace meshcomplete
