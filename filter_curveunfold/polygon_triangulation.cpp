#include "filter_curveunfold/polygon_triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
enum class Side : char { unknown, inside, outside };
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceInfo = CGAL::Triangulation_face_base_with_info_2<Side, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel, FaceInfo>;
using DataStructure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
// No intersections are expected; the tag makes CGAL throw when a constraint would cross another.
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, DataStructure, CGAL::No_constraint_intersection_tag>;

// Floods outwards in: every constrained edge changes the side.
void mark_sides(Triangulation& triangulation) {
  for (auto face : triangulation.all_face_handles()) face->info() = Side::unknown;
  std::vector<Triangulation::Face_handle> stack = {triangulation.infinite_face()};
  stack.front()->info() = Side::outside;
  while (!stack.empty()) {
    const auto face = stack.back();
    stack.pop_back();
    for (int k = 0; k < 3; ++k) {
      const auto neighbour = face->neighbor(k);
      if (neighbour->info() != Side::unknown) continue;
      const bool crosses = face->is_constrained(k);
      const bool inside = (face->info() == Side::inside) != crosses;
      neighbour->info() = inside ? Side::inside : Side::outside;
      stack.push_back(neighbour);
    }
  }
}

[[noreturn]] void not_simple() {
  throw CompletionError("triangulating the unfolded rim", "The unfolded rim is not a simple polygon.");
}

}  // namespace

std::vector<Triangle> triangulate_polygon(const std::vector<Eigen::Vector2d>& polygon) {
  if (polygon.size() < 3) not_simple();
  std::vector<std::pair<Kernel::Point_2, Index>> points;
  for (const Eigen::Vector2d& p : polygon)
    points.emplace_back(Kernel::Point_2(p.x(), p.y()), static_cast<Index>(points.size()));
  Triangulation triangulation;
  triangulation.insert(points.begin(), points.end());
  if (triangulation.number_of_vertices() != polygon.size()) not_simple();
  std::vector<Triangulation::Vertex_handle> handle(polygon.size());
  for (auto vertex : triangulation.finite_vertex_handles()) handle[vertex->info()] = vertex;
  try {
    for (std::size_t i = 0; i < polygon.size(); ++i)
      triangulation.insert_constraint(handle[i], handle[(i + 1) % polygon.size()]);
  } catch (const Triangulation::Intersection_of_constraints_exception&) {
    not_simple();
  }
  mark_sides(triangulation);
  std::vector<Triangle> triangles;
  for (auto face : triangulation.finite_face_handles())
    if (face->info() == Side::inside)
      triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  if (triangles.size() + 2 != polygon.size()) not_simple();
  return triangles;
}

}  // namespace meshcomplete
