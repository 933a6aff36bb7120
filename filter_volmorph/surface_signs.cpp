#include "filter_volmorph/surface_signs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace meshcomplete {

SurfaceSigns::SurfaceSigns(const TriangleMesh& mesh, const MeshTopology& topology, const Progress& progress)
    : mesh_(mesh),
      topology_(topology),
      faces_(mesh.triangles.size(), Vector3::Zero()),
      vertices_(mesh.vertices.size(), Vector3::Zero()),
      vertex_places_(mesh.vertices.size(), SurfacePlace::surface) {
  constexpr std::size_t between_updates = 4096;
  const auto faces = static_cast<double>(mesh.triangles.size());
  for (Index f = 0; f < mesh.triangles.size(); ++f) {
    if (f % between_updates == 0) progress.update(f / faces);
    const Triangle& t = mesh.triangles[f];
    const Vector3* corners[] = {&mesh.vertices[t[0]], &mesh.vertices[t[1]], &mesh.vertices[t[2]]};
    faces_[f] = (*corners[1] - *corners[0]).cross(*corners[2] - *corners[0]).normalized();
    if (!faces_[f].allFinite()) faces_[f].setZero();
    for (int k = 0; k < 3; ++k) {
      const Vector3 a = *corners[(k + 1) % 3] - *corners[k], b = *corners[(k + 2) % 3] - *corners[k];
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      if (std::isfinite(angle)) vertices_[t[k]] += angle * faces_[f];
      const SurfacePlace place = edge_place(3 * f + static_cast<Index>(k));
      for (const Index v : {t[k], t[(k + 1) % 3]}) vertex_places_[v] = std::max(vertex_places_[v], place);
    }
  }
}

SurfacePlace SurfaceSigns::edge_place(Index half_edge) const {
  const Index other = topology_.opposite[half_edge];
  if (other == MeshTopology::boundary) return SurfacePlace::rim;
  if (other >= topology_.opposite.size()) return SurfacePlace::ambiguous;
  const auto start = [&](Index h) { return mesh_.triangles[h / 3][h % 3]; };
  return start(other) == start(half_edge) ? SurfacePlace::ambiguous : SurfacePlace::surface;
}

SurfacePlace SurfaceSigns::place(Index triangle, const ClosestPoint& point) const {
  if (point.place < ClosestPoint::edge) return SurfacePlace::surface;
  if (point.place < ClosestPoint::corner) {
    return edge_place(3 * triangle + static_cast<Index>(point.place - ClosestPoint::edge));
  }
  return vertex_places_[mesh_.triangles[triangle]
                                       [static_cast<std::size_t>(point.place - ClosestPoint::corner)]];
}

Vector3 SurfaceSigns::normal(Index triangle, const ClosestPoint& point) const {
  if (point.place < ClosestPoint::edge) return faces_[triangle];
  Vector3 sum;
  if (point.place < ClosestPoint::corner) {
    const Index other =
        topology_.opposite[3 * triangle + static_cast<Index>(point.place - ClosestPoint::edge)];
    sum = faces_[triangle];
    if (other < topology_.opposite.size()) sum += faces_[other / 3];
  } else {
    sum = vertices_[mesh_.triangles[triangle][static_cast<std::size_t>(point.place - ClosestPoint::corner)]];
  }
  return sum.norm() > 0 ? Vector3(sum.normalized()) : sum;
}

}  // namespace meshcomplete
