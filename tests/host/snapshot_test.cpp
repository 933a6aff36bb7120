#include "common/host/snapshot.h"

#include <gtest/gtest.h>

#include <limits>

#include "common/core/error.h"
#include "tests/host/test_documents.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace host {
namespace {

using test::layer_from;
using vcg::tri::Allocator;

/// The message of the CompletionError that `snapshot` throws.
std::string complaint(const MeshModel& model) {
  try {
    snapshot(model);
  } catch (const CompletionError& error) {
    EXPECT_EQ(error.stage(), "reading the mesh");
    return error.what();
  }
  return "nothing was thrown";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Snapshot, HoldsTheMeshInItsOwnNumbering) {
  MeshDocument document;
  const TriangleMesh mesh = test::sphere_with_hole();
  const Snapshot taken = snapshot(layer_from(document, mesh));
  EXPECT_EQ(taken.mesh.triangles, mesh.triangles);
  ASSERT_EQ(taken.mesh.vertices.size(), mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) EXPECT_EQ(taken.mesh.vertices[v], mesh.vertices[v]);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) EXPECT_EQ(taken.face_of_triangle[t], t);
  EXPECT_TRUE(taken.selection.vertices.empty());
  EXPECT_TRUE(taken.selection.faces.empty());
}

TEST(Snapshot, CoordinatesAreTheStoredFloats) {
  MeshDocument document;
  MeshModel& model = layer_from(document, test::cube());
  model.cm.vert[3].P() = Point3m(0.1f, 1e-30f, 16777217.0f);
  const Snapshot taken = snapshot(model);
  EXPECT_EQ(taken.mesh.vertices[3], Vector3(double(0.1f), double(1e-30f), double(16777217.0f)));
}

TEST(Snapshot, DeletedElementsAreLeftOutAndKeepTheirNumbers) {
  MeshDocument document;
  MeshModel& model = layer_from(document, test::cube());
  for (const std::size_t f : {0, 5}) Allocator<CMeshO>::DeleteFace(model.cm, model.cm.face[f]);
  const Snapshot taken = snapshot(model);
  EXPECT_EQ(taken.mesh.vertices.size(), 8u);
  EXPECT_EQ(taken.mesh.triangles.size(), 10u);
  const std::vector<Index> expected = {1, 2, 3, 4, 6, 7, 8, 9, 10, 11};
  EXPECT_EQ(taken.face_of_triangle, expected);
  const TriangleMesh cube = test::cube();
  for (std::size_t t = 0; t < expected.size(); ++t)
    EXPECT_EQ(taken.mesh.triangles[t], cube.triangles[expected[t]]);
}

TEST(Snapshot, SelectionFollowsTheTriangles) {
  MeshDocument document;
  MeshModel& model = layer_from(document, test::cube());
  Allocator<CMeshO>::DeleteFace(model.cm, model.cm.face[0]);
  model.cm.face[2].SetS();
  model.cm.vert[7].SetS();
  const Snapshot taken = snapshot(model);
  ASSERT_EQ(taken.selection.faces.size(), 11u);
  ASSERT_EQ(taken.selection.vertices.size(), 8u);
  for (std::size_t t = 0; t < 11; ++t) EXPECT_EQ(taken.selection.faces[t], t == 1 ? 1 : 0);
  for (std::size_t v = 0; v < 8; ++v) EXPECT_EQ(taken.selection.vertices[v], v == 7 ? 1 : 0);
}

TEST(Snapshot, IgnoresTheTransformationOfTheLayerAndFauxEdges) {
  MeshDocument document;
  MeshModel& model = layer_from(document, test::cube());
  const Snapshot before = snapshot(model);
  model.cm.Tr.SetTranslate(10, 20, 30);
  model.cm.face[4].SetF(0);
  const Snapshot after = snapshot(model);
  EXPECT_EQ(after.mesh.triangles, before.mesh.triangles);
  EXPECT_EQ(after.mesh.vertices, before.mesh.vertices);
}

TEST(Snapshot, RefusesAnEmptyLayerAndAPointCloud) {
  MeshDocument document;
  MeshModel& empty = *document.addNewMesh("", "nothing", true);
  EXPECT_TRUE(contains(complaint(empty), "\"nothing\" is empty"));
  MeshModel& cloud = *document.addNewMesh("", "cloud", true);
  Allocator<CMeshO>::AddVertices(cloud.cm, 5);
  EXPECT_TRUE(contains(complaint(cloud), "a cloud of 5 points"));
  EXPECT_TRUE(contains(complaint(cloud), "Surface Reconstruction: Screened Poisson"));
}

TEST(Snapshot, RefusesFacesAtCoordinatesThatAreNotFinite) {
  MeshDocument document;
  MeshModel& model = layer_from(document, test::cube());
  model.cm.vert[2].P()[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(contains(complaint(model), "1 vertex has coordinates that are infinite or not numbers"));
  model.cm.vert[6].P()[0] = -std::numeric_limits<float>::infinity();
  EXPECT_TRUE(contains(complaint(model), "2 vertices have coordinates"));
}

TEST(Snapshot, VerticesThatNoFaceUsesMayHoldAnything) {
  MeshDocument document;
  MeshModel& model = layer_from(document, test::cube());
  auto unused = Allocator<CMeshO>::AddVertices(model.cm, 1);
  unused->P() = Point3m(std::numeric_limits<float>::quiet_NaN(), 0, 0);
  const Snapshot taken = snapshot(model);
  ASSERT_EQ(taken.mesh.vertices.size(), 9u);
  EXPECT_EQ(taken.mesh.vertices[8], Vector3::Zero());
}

}  // namespace
}  // namespace host
}  // namespace meshcomplete
