#include "benchmarks/cgal_filling.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <chrono>
#include <iterator>
#include <vector>

namespace meshcomplete {
namespace benchmarks {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
namespace processing = CGAL::Polygon_mesh_processing;

SurfaceMesh as_surface_mesh(const TriangleMesh& mesh) {
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
  for (const Vector3& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  for (const Triangle& t : mesh.triangles) polygons.push_back({t[0], t[1], t[2]});
  processing::orient_polygon_soup(points, polygons);
  SurfaceMesh surface;
  processing::polygon_soup_to_polygon_mesh(points, polygons, surface);
  return surface;
}

TriangleMesh as_triangle_mesh(SurfaceMesh& surface) {
  surface.collect_garbage();
  TriangleMesh mesh;
  for (SurfaceMesh::Vertex_index v : surface.vertices()) {
    const Point& p = surface.point(v);
    mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (SurfaceMesh::Face_index f : surface.faces()) {
    Triangle t;
    int k = 0;
    for (SurfaceMesh::Vertex_index v : CGAL::vertices_around_face(surface.halfedge(f), surface))
      t[k++] = static_cast<Index>(v);
    mesh.triangles.push_back(t);
  }
  return mesh;
}

}  // namespace

CgalFilling fill_with_cgal(const TriangleMesh& mesh) {
  CgalFilling result;
  SurfaceMesh surface = as_surface_mesh(mesh);
  const auto start = std::chrono::steady_clock::now();
  std::vector<SurfaceMesh::Halfedge_index> holes;
  processing::extract_boundary_cycles(surface, std::back_inserter(holes));
  for (SurfaceMesh::Halfedge_index hole : holes) {
    std::vector<SurfaceMesh::Face_index> faces;
    std::vector<SurfaceMesh::Vertex_index> vertices;
    processing::triangulate_refine_and_fair_hole(surface, hole, std::back_inserter(faces),
                                                 std::back_inserter(vertices));
    result.filled += !faces.empty();
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.holes = holes.size();
  result.mesh = as_triangle_mesh(surface);
  return result;
}

}  // namespace benchmarks
}  // namespace meshcomplete
