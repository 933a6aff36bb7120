// Closes every hole of a mesh with CGAL's triangulate_refine_and_fair_hole, to compare with.
//
//   cgal_fill IN OUT.ply
//
// CGAL fills holes of orientable 2-manifold meshes only, so that the input is first oriented, and split at
// vertices and edges that are not manifold, by CGAL's own tools.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <cstdio>
#include <exception>
#include <iterator>
#include <vector>

#include "benchmarks/mesh_file.h"

namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using meshcomplete::Index;
using meshcomplete::TriangleMesh;
namespace processing = CGAL::Polygon_mesh_processing;

SurfaceMesh as_surface_mesh(const TriangleMesh& mesh) {
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
  for (const meshcomplete::Vector3& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  for (const meshcomplete::Triangle& t : mesh.triangles) polygons.push_back({t[0], t[1], t[2]});
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
    meshcomplete::Triangle t;
    int k = 0;
    for (SurfaceMesh::Vertex_index v : CGAL::vertices_around_face(surface.halfedge(f), surface))
      t[k++] = static_cast<Index>(v);
    mesh.triangles.push_back(t);
  }
  return mesh;
}

void fill(const char* input, const char* output) {
  SurfaceMesh surface = as_surface_mesh(meshcomplete::benchmarks::read_mesh(input));
  std::vector<SurfaceMesh::Halfedge_index> holes;
  processing::extract_boundary_cycles(surface, std::back_inserter(holes));
  std::size_t filled = 0;
  for (SurfaceMesh::Halfedge_index hole : holes) {
    std::vector<SurfaceMesh::Face_index> faces;
    std::vector<SurfaceMesh::Vertex_index> vertices;
    processing::triangulate_refine_and_fair_hole(surface, hole, std::back_inserter(faces),
                                                 std::back_inserter(vertices));
    filled += !faces.empty();
  }
  std::printf("%zu of %zu holes filled\n", filled, holes.size());
  meshcomplete::benchmarks::write_ply(output, as_triangle_mesh(surface));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: cgal_fill IN OUT.ply\n");
    return 2;
  }
  try {
    fill(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
