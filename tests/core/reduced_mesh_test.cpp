#include "common/core/reduced_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/error.h"
#include "common/core/mesh_topology.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

std::size_t rims(const TriangleMesh& mesh) { return trace_boundary_loops(mesh, build_topology(mesh)).size(); }

TEST(ReducedMesh, RemovesFacesAndNothingElse) {
  const TriangleMesh mesh = test::icosphere(2);
  MeshSelection selection;
  selection.faces.assign(mesh.triangles.size(), 0);
  selection.faces[7] = 1;
  ReducedMesh rest = unreduced(mesh, selection);
  remove_faces(rest, {2, 5}, false);
  remove_faces(rest, {0, 3}, false);  // 0 and 4 of the whole
  EXPECT_EQ(rest.removed, (std::vector<Index>{0, 2, 4, 5}));
  EXPECT_EQ(rest.mesh.vertices, mesh.vertices);
  ASSERT_EQ(rest.number.size(), mesh.triangles.size() - 4);
  for (Index t = 0; t < rest.number.size(); ++t) {
    EXPECT_EQ(rest.mesh.triangles[t], mesh.triangles[rest.number[t]]);
    EXPECT_EQ(rest.selection.faces[t] != 0, rest.number[t] == 7);
  }
  EXPECT_TRUE(rest.selection.vertices.empty());
}

TEST(ReducedMesh, EachRingTakesTheFacesAtTheRim) {
  const TriangleMesh mesh = test::sphere_with_hole();
  std::size_t faces = mesh.triangles.size();
  for (int rings = 0; rings <= 3; ++rings) {
    const ReducedMesh rest = without_rings(mesh, {}, {}, rings);
    EXPECT_EQ(rest.removed.empty(), rings == 0);
    EXPECT_EQ(rest.mesh.triangles.size() + rest.removed.size(), mesh.triangles.size());
    EXPECT_LE(rest.mesh.triangles.size(), faces);
    faces = rest.mesh.triangles.size();
    EXPECT_EQ(rims(rest.mesh), 1u) << rings;
    EXPECT_TRUE(std::is_sorted(rest.removed.begin(), rest.removed.end()));
  }
}

TEST(ReducedMesh, NothingIsLeft) {
  EXPECT_THROW(without_rings(test::sphere_with_hole(), {}, {}, 100), CompletionError);
}

TEST(ReducedMesh, OnlyAtTheHolesThatAreAskedFor) {
  const TriangleMesh mesh = test::sphere_with_holes(3);
  const auto loops = trace_boundary_loops(mesh, build_topology(mesh));
  MeshSelection selection;
  selection.vertices.assign(mesh.vertices.size(), 0);
  selection.vertices[loops[1].vertices[4]] = 1;
  HoleSelectionOptions options;
  options.selected_only = true;
  const ReducedMesh rest = without_rings(mesh, selection, options, 2);
  const auto after = trace_boundary_loops(rest.mesh, build_topology(rest.mesh));
  const auto holes = select_holes(rest.mesh, after, rest.selection, options);
  ASSERT_EQ(after.size(), 3u);
  std::size_t targeted = 0, kept = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    targeted += holes[i].outcome == HoleOutcome::failed;
    kept += std::any_of(loops.begin(), loops.end(),
                        [&](const BoundaryLoop& loop) { return loop.vertices == after[i].vertices; });
  }
  EXPECT_EQ(targeted, 1u) << "the hole is still the one that was asked for";
  EXPECT_EQ(kept, 2u);
}

}  // namespace
}  // namespace meshcomplete
