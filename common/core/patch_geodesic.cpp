#include "common/core/patch_geodesic.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>

#include <algorithm>
#include <iterator>
#include <unordered_map>

namespace meshcomplete {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Search = CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<Kernel, Surface>>;

}  // namespace

std::vector<Vector3> geodesic(const TriangleMesh& mesh, const Patch& patch,
                              const std::vector<Index>& triangles, Index from, Index to) {
  Surface surface;
  std::unordered_map<Index, Surface::Vertex_index> number;
  const auto vertex = [&](Index v) {
    const auto [found, fresh] = number.try_emplace(v);
    if (fresh) {
      const Vector3& p = position(mesh, patch, v);
      found->second = surface.add_vertex({p.x(), p.y(), p.z()});
    }
    return found->second;
  };
  for (Index triangle : triangles) {
    const Triangle& t = patch.triangles[triangle];
    surface.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2]));
  }
  std::vector<Vector3> way;
  if (!number.count(from) || !number.count(to)) return way;
  Search search(surface);
  search.add_source_point(number.at(from));
  std::vector<Kernel::Point_3> points;
  search.shortest_path_points_to_source_points(number.at(to), std::back_inserter(points));
  for (auto p = points.rbegin(); p != points.rend(); ++p) way.emplace_back(p->x(), p->y(), p->z());
  return way;
}

}  // namespace meshcomplete
