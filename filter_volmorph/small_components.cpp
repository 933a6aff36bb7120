#include "filter_volmorph/small_components.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "common/core/disjoint_sets.h"

namespace meshcomplete {
namespace {

constexpr std::size_t faces_between_checks = 1 << 16;
constexpr Index unused = 0xffffffffu;

// A vertex that stands for each vertex's component.
std::vector<Index> component_roots(const TriangleMesh& mesh, const Progress& progress) {
  DisjointSets components(mesh.vertices.size());
  for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
    if (face % faces_between_checks == 0) progress.update(double(face) / double(mesh.triangles.size()));
    const Triangle& corners = mesh.triangles[face];
    for (int k = 1; k < 3; ++k) components.unite(corners[0], corners[k]);
  }
  std::vector<Index> root(mesh.vertices.size());
  for (Index vertex = 0; vertex < root.size(); ++vertex) root[vertex] = components.root(vertex);
  return root;
}

// How many faces each component has, at the vertex that stands for it.
std::vector<Index> component_sizes(const TriangleMesh& mesh, const std::vector<Index>& root) {
  std::vector<Index> size(mesh.vertices.size(), 0);
  for (const Triangle& corners : mesh.triangles) ++size[root[corners[0]]];
  return size;
}

struct Extent {  // of a component
  std::size_t faces = 0;
  double area = 0;
  Eigen::AlignedBox3d box;

  bool narrower(double width) const {
    const double length = box.sizes().maxCoeff();
    return length < width || area < width * length;
  }
};

// Numbers from 0 on instead of the vertices that stand for components; returns how many there are.
std::size_t number_components(const TriangleMesh& mesh, std::vector<Index>& root) {
  std::vector<Index> number(root.size(), unused);
  Index count = 0;
  for (const Triangle& corners : mesh.triangles)
    if (Index& own = number[root[corners[0]]]; own == unused) own = count++;
  for (Index& own : root) own = number[own];
  return count;
}

std::vector<Extent> component_extents(const TriangleMesh& mesh, const std::vector<Index>& component,
                                      std::size_t count, const Progress& progress) {
  std::vector<Extent> extents(count);
  for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
    if (face % faces_between_checks == 0) progress.update(double(face) / double(mesh.triangles.size()));
    const Triangle& corners = mesh.triangles[face];
    const Vector3 &a = mesh.vertices[corners[0]], &b = mesh.vertices[corners[1]],
                  &c = mesh.vertices[corners[2]];
    Extent& extent = extents[component[corners[0]]];
    ++extent.faces;
    extent.area += (b - a).cross(c - a).norm() / 2;
    for (const Vector3* corner : {&a, &b, &c}) extent.box.extend(*corner);
  }
  return extents;
}

// Leaves the faces of the components that are kept.
template <class Keep>
void keep_components(TriangleMesh& mesh, const std::vector<Index>& component, Keep&& keep) {
  std::size_t kept = 0;
  for (const Triangle& corners : mesh.triangles)
    if (keep(component[corners[0]])) mesh.triangles[kept++] = corners;
  mesh.triangles.resize(kept);
}

void compact(TriangleMesh& mesh) {
  std::vector<Index> number(mesh.vertices.size(), unused);
  for (const Triangle& corners : mesh.triangles)
    for (const Index corner : corners) number[corner] = 0;
  Index count = 0;
  for (std::size_t vertex = 0; vertex < number.size(); ++vertex) {
    if (number[vertex] == unused) continue;
    number[vertex] = count;
    mesh.vertices[count++] = mesh.vertices[vertex];
  }
  mesh.vertices.resize(count);
  for (Triangle& corners : mesh.triangles)
    for (Index& corner : corners) corner = number[corner];
}

}  // namespace

TriangleMesh without_small_components(TriangleMesh mesh, std::size_t faces, const Progress& progress) {
  if (faces < 2) return mesh;
  const std::vector<Index> root = component_roots(mesh, progress.part(0, 0.8, "finding small components"));
  const std::vector<Index> size = component_sizes(mesh, root);
  progress.update(0.9);
  keep_components(mesh, root, [&](Index component) { return size[component] >= faces; });
  compact(mesh);
  progress.update(1);
  return mesh;
}

TriangleMesh without_narrow_components(TriangleMesh mesh, double width, const Progress& progress) {
  if (mesh.triangles.empty()) return mesh;
  std::vector<Index> component = component_roots(mesh, progress.part(0, 0.6, "finding small components"));
  const std::size_t count = number_components(mesh, component);
  const std::vector<Extent> extents =
      component_extents(mesh, component, count, progress.part(0.6, 0.9, "finding small components"));
  const auto fewer = [](const Extent& a, const Extent& b) { return a.faces < b.faces; };
  const auto largest =
      static_cast<Index>(std::max_element(extents.begin(), extents.end(), fewer) - extents.begin());
  keep_components(mesh, component,
                  [&](Index own) { return own == largest || !extents[own].narrower(width); });
  compact(mesh);
  progress.update(1);
  return mesh;
}

}  // namespace meshcomplete
