#include "benchmarks/cgal_reconstruction.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/compute_average_spacing.h>
#include <CGAL/poisson_surface_reconstruction.h>
#include <CGAL/property_map.h>

#include <stdexcept>
#include <utility>
#include <vector>

namespace meshcomplete::benchmarks {

TriangleMesh reconstruct_with_cgal(const OrientedPoints& set) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using OrientedPoint = std::pair<Kernel::Point_3, Kernel::Vector_3>;
  const CGAL::First_of_pair_property_map<OrientedPoint> position;
  const CGAL::Second_of_pair_property_map<OrientedPoint> normal;
  std::vector<OrientedPoint> list;
  for (std::size_t i = 0; i < set.points.size(); ++i) {
    const Vector3 &p = set.points[i], &n = set.normals[i];
    list.emplace_back(Kernel::Point_3(p[0], p[1], p[2]), Kernel::Vector_3(n[0], n[1], n[2]));
  }
  constexpr unsigned neighbours = 6;
  const double spacing = CGAL::compute_average_spacing<CGAL::Sequential_tag>(
      list, neighbours, CGAL::parameters::point_map(position));
  CGAL::Surface_mesh<Kernel::Point_3> surface;
  if (!CGAL::poisson_surface_reconstruction_delaunay(list.begin(), list.end(), position, normal, surface,
                                                     spacing))
    throw std::runtime_error("CGAL has no reconstruction");
  TriangleMesh mesh;
  for (const auto v : surface.vertices()) {
    const Kernel::Point_3& p = surface.point(v);
    mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : surface.faces()) {
    Triangle t;
    int k = 0;
    for (const auto v : CGAL::vertices_around_face(surface.halfedge(f), surface))
      t[k++] = static_cast<Index>(static_cast<std::size_t>(v));
    mesh.triangles.push_back(t);
  }
  return mesh;
}

}  // namespace meshcomplete::benchmarks
