#include "filter_poissoncompletion/mesh_guard.h"

#include <limits>

namespace meshcomplete {
namespace {

// Over which part of a target edge length the function's slope is measured: it tells which way the surface
// faces where facets are still too coarse to.
constexpr double slope_step = 0.05;

// In target edge lengths, how near the surface may come to the mesh before the mesh's vertices there are
// wanted: balls of good facets reach no further.
constexpr double mesh_in_sight = 1.5;

// The direction in which the function grows.
Vector3 slope(const ImplicitFunction& function, const Vector3& at, double step) {
  Vector3 result;
  for (int k = 0; k < 3; ++k) {
    const Vector3 way = step * Vector3::Unit(k);
    result[k] = function.value(at + way) - function.value(at - way);
  }
  return result;
}

}  // namespace

MeshGuard::MeshGuard(const ProtectedMesh& around, const ImplicitFunction& function)
    : around_(around), function_(function), taken_(around.mesh.vertices.size(), 0) {
  for (Index v : around.initial) taken_[v] = 1;
}

MeshGuard::Answer MeshGuard::ask(const Vector3& point, double size) {
  Answer answer;
  const std::optional<Cushion::Nearest> nearest = around_.cushion.nearest(point);
  if (!nearest) return answer;
  answer.in_cushion = around_.cushion.reaches(*nearest, slope(function_, point, slope_step * size));
  if (answer.in_cushion || nearest->distance < mesh_in_sight * size)
    answer.vertex = take_vertex(nearest->triangle, point);
  return answer;
}

// The nearest of the triangle's corners that are not taken.
std::optional<Index> MeshGuard::take_vertex(Index triangle, const Vector3& point) {
  std::optional<Index> best;
  double least = std::numeric_limits<double>::infinity();
  for (Index v : around_.mesh.triangles[triangle]) {
    const double squared = (around_.mesh.vertices[v] - point).squaredNorm();
    if (taken_[v] || squared >= least) continue;
    best = v;
    least = squared;
  }
  if (best) taken_[*best] = 1;
  return best;
}

}  // namespace meshcomplete
