#include "filter_volmorph/small_components.h"

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
  std::size_t kept = 0;
  for (const Triangle& corners : mesh.triangles)
    if (size[root[corners[0]]] >= faces) mesh.triangles[kept++] = corners;
  mesh.triangles.resize(kept);
  compact(mesh);
  progress.update(1);
  return mesh;
}

std::size_t largest_component(const TriangleMesh& mesh, const Progress& progress) {
  if (mesh.triangles.empty()) return 0;
  const std::vector<Index> sizes = component_sizes(mesh, component_roots(mesh, progress));
  return *std::max_element(sizes.begin(), sizes.end());
}

}  // namespace meshcomplete
