#include "tests/support/patches.h"

#include <vector>

#include "common/core/mesh_topology.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace test {

std::vector<BoundaryLoop> loops_of(const TriangleMesh& mesh) {
  return trace_boundary_loops(mesh, build_topology(mesh));
}

std::vector<const BoundaryLoop*> pointers(const std::vector<BoundaryLoop>& loops) {
  std::vector<const BoundaryLoop*> result;
  for (const BoundaryLoop& loop : loops) result.push_back(&loop);
  return result;
}

PatchCheck check(const TriangleMesh& mesh, const Patch& patch, const std::vector<BoundaryLoop>& loops) {
  return check_patch(InputNeighbourhood(mesh), patch, pointers(loops));
}

Patch fan_patch(const TriangleMesh& mesh, const BoundaryLoop& loop, const Vector3& apex) {
  Patch patch;
  patch.input_vertices = static_cast<Index>(mesh.vertices.size());
  patch.vertices = {as_stored(apex)};
  for (std::size_t i = 0; i < loop.vertices.size(); ++i)
    patch.triangles.push_back(
        {loop.vertices[i], loop.vertices[(i + 1) % loop.vertices.size()], patch.input_vertices});
  return patch;
}

Patch fan_patch(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  Vector3 sum = Vector3::Zero();
  for (Index v : loop.vertices) sum += mesh.vertices[v];
  return fan_patch(mesh, loop, sum / static_cast<double>(loop.vertices.size()));
}

Patch fan_from_corner(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  Patch patch;
  patch.input_vertices = static_cast<Index>(mesh.vertices.size());
  for (std::size_t i = 1; i + 1 < loop.vertices.size(); ++i)
    patch.triangles.push_back({loop.vertices[0], loop.vertices[i], loop.vertices[i + 1]});
  return patch;
}

TriangleMesh with_patch(const TriangleMesh& mesh, const Patch& patch) {
  TriangleMesh whole = mesh;
  whole.vertices.insert(whole.vertices.end(), patch.vertices.begin(), patch.vertices.end());
  whole.triangles.insert(whole.triangles.end(), patch.triangles.begin(), patch.triangles.end());
  return whole;
}

CutOut cut_out(const TriangleMesh& mesh, const std::function<bool(Index face)>& remove) {
  CutOut result;
  result.mesh = without_faces(mesh, remove);
  std::vector<char> kept(mesh.vertices.size(), 0);
  for (Index f = 0; f < mesh.triangles.size(); ++f)
    if (!remove(f))
      for (Index v : mesh.triangles[f]) kept[v] = 1;
  // Kept vertices come first, in their order: that is how `without_faces` numbers them.
  std::vector<Index> number(mesh.vertices.size());
  Index next = 0;
  for (std::size_t v = 0; v < kept.size(); ++v)
    if (kept[v]) number[v] = next++;
  result.patch.input_vertices = next;
  std::vector<char> numbered = kept;
  for (Index f = 0; f < mesh.triangles.size(); ++f) {
    if (!remove(f)) continue;
    Triangle triangle = mesh.triangles[f];
    for (Index& v : triangle) {
      if (!numbered[v]) {
        numbered[v] = 1;
        number[v] = next++;
        result.patch.vertices.push_back(mesh.vertices[v]);
      }
      v = number[v];
    }
    result.patch.triangles.push_back(triangle);
  }
  return result;
}

}  // namespace test
}  // namespace meshcomplete
