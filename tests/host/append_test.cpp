#include "common/host/append.h"

#include <gtest/gtest.h>
#include <vcg/complex/algorithms/clean.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "common/core/mesh_statistics.h"
#include "common/core/mesh_topology.h"
#include "common/host/snapshot.h"
#include "tests/host/test_documents.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace host {
namespace {

using test::document_state;
using test::face_states;
using test::fans;
using test::layer_from;
using test::layer_state;
using test::vertex_states;
using vcg::tri::Allocator;

constexpr std::size_t tests_holes = 2;

struct Sphere {
  MeshDocument document;
  MeshModel& model;
  Sphere() : model(layer_from(document, test::sphere_with_holes(tests_holes))) {
    test::give_all_attributes(model);
  }
};

/// The least and the greatest value of `value` at the rim of the fan around new vertex `centre`.
template <class Value>
std::pair<double, double> rim_range(const Patch& patch, Index centre, const Value& value) {
  double least = 1e300, greatest = -1e300;
  for (const Triangle& triangle : patch.triangles) {
    if (triangle[2] != centre) continue;
    for (const Index v : {triangle[0], triangle[1]}) {
      least = std::min(least, double(value(v)));
      greatest = std::max(greatest, double(value(v)));
    }
  }
  return {least, greatest};
}

TEST(AppendPatch, KeepsEveryBitOfWhatIsThere) {
  Sphere sphere;
  const auto vertices = vertex_states(sphere.model);
  const auto faces = face_states(sphere.model);
  const Snapshot taken = snapshot(sphere.model);
  const Patch patch = fans(taken.mesh);
  const Appended where = append_patch(sphere.model, taken.mesh, patch);
  EXPECT_EQ(where.first_vertex, vertices.size());
  EXPECT_EQ(where.first_face, faces.size());
  EXPECT_EQ(where.vertices, tests_holes);
  EXPECT_EQ(where.faces, patch.triangles.size());
  auto vertices_after = vertex_states(sphere.model);
  auto faces_after = face_states(sphere.model);
  ASSERT_EQ(vertices_after.size(), vertices.size() + patch.vertices.size());
  ASSERT_EQ(faces_after.size(), faces.size() + patch.triangles.size());
  vertices_after.resize(vertices.size());
  faces_after.resize(faces.size());
  EXPECT_TRUE(vertices_after == vertices);
  EXPECT_TRUE(faces_after == faces);
  EXPECT_EQ(std::size_t(sphere.model.cm.vn), sphere.model.cm.vert.size());
  EXPECT_EQ(std::size_t(sphere.model.cm.fn), sphere.model.cm.face.size());
}

TEST(AppendPatch, NewElementsStandWhereThePatchSays) {
  Sphere sphere;
  const Snapshot taken = snapshot(sphere.model);
  const Patch patch = fans(taken.mesh);
  const Appended where = append_patch(sphere.model, taken.mesh, patch);
  const Snapshot after = snapshot(sphere.model);
  for (std::size_t i = 0; i < patch.vertices.size(); ++i)
    EXPECT_EQ(after.mesh.vertices[where.first_vertex + i], patch.vertices[i]);
  for (std::size_t i = 0; i < patch.triangles.size(); ++i)
    EXPECT_EQ(after.mesh.triangles[where.first_face + i], patch.triangles[i]);
  EXPECT_EQ(test::fans(after.mesh).triangles.size(), 0u) << "the holes are still there";
}

TEST(AppendPatch, NewVerticesHaveAttributesBetweenThoseOfTheirRim) {
  Sphere sphere;
  const Snapshot taken = snapshot(sphere.model);
  const Patch patch = fans(taken.mesh);
  append_patch(sphere.model, taken.mesh, patch);
  const CMeshO& mesh = sphere.model.cm;
  for (Index centre = patch.input_vertices; centre < mesh.vert.size(); ++centre) {
    const auto expect_between = [&](double value, auto of_rim, const char* what) {
      const auto [least, greatest] = rim_range(patch, centre, of_rim);
      EXPECT_GE(value, least - 1e-4) << what;
      EXPECT_LE(value, greatest + 1e-4) << what;
      EXPECT_NE(value, least) << what << " is not interpolated";
    };
    const CVertexO& vertex = mesh.vert[centre];
    for (int channel = 0; channel < 3; ++channel)
      expect_between(
          vertex.cC()[channel], [&](Index v) { return mesh.vert[v].cC()[channel]; }, "colour");
    expect_between(
        vertex.cQ(), [&](Index v) { return mesh.vert[v].cQ(); }, "quality");
    expect_between(
        vertex.cR(), [&](Index v) { return mesh.vert[v].cR(); }, "radius");
    expect_between(
        vertex.cT().U(), [&](Index v) { return mesh.vert[v].cT().U(); }, "texture coordinate");
    EXPECT_EQ(vertex.cT().N(), 0);
    EXPECT_NEAR(vertex.cN().Norm(), 1, 1e-6);
    EXPECT_GT(vertex.cN() * vertex.cP(), 0) << "the normal points into the sphere";
  }
}

TEST(AppendPatch, NewFacesHaveAttributesBetweenThoseOfTheRimFaces) {
  Sphere sphere;
  const Snapshot taken = snapshot(sphere.model);
  const Patch patch = fans(taken.mesh);
  const Appended where = append_patch(sphere.model, taken.mesh, patch);
  const CMeshO& mesh = sphere.model.cm;
  std::set<Index> rim;
  for (const Triangle& triangle : patch.triangles) rim.insert({triangle[0], triangle[1]});
  float least = 1e30f, greatest = -1e30f;
  for (std::size_t f = 0; f < where.first_face; ++f) {
    int at_rim = 0;
    for (int corner = 0; corner < 3; ++corner)
      at_rim += static_cast<int>(rim.count(taken.mesh.triangles[f][corner]));
    if (at_rim < 2) continue;
    least = std::min(least, mesh.face[f].cQ());
    greatest = std::max(greatest, mesh.face[f].cQ());
  }
  for (std::size_t f = where.first_face; f < mesh.face.size(); ++f) {
    EXPECT_GE(mesh.face[f].cQ(), least);
    EXPECT_LE(mesh.face[f].cQ(), greatest);
    EXPECT_EQ(mesh.face[f].cC()[3], 255);
    EXPECT_NEAR(mesh.face[f].cN().Norm(), 1, 1e-6);
    for (int edge = 0; edge < 3; ++edge) EXPECT_FALSE(mesh.face[f].IsF(edge));
  }
}

TEST(AppendPatch, TheTextureContinuesAcrossTheRim) {
  Sphere sphere;
  const Snapshot taken = snapshot(sphere.model);
  const Patch patch = fans(taken.mesh);
  const Appended where = append_patch(sphere.model, taken.mesh, patch);
  const CMeshO& mesh = sphere.model.cm;
  for (std::size_t f = where.first_face; f < mesh.face.size(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      const vcg::TexCoord2f& wedge = mesh.face[f].cWT(corner);
      EXPECT_EQ(wedge.N(), 1);
      const Point3m& p = mesh.face[f].cP(corner);
      if (corner < 2) {
        EXPECT_EQ(wedge.U(), 0.5f + 0.25f * p[0]);
        EXPECT_EQ(wedge.V(), 0.5f + 0.25f * p[1]);
      } else {  // the rims are round about an axis: the mean of the coordinates belongs to the centre
        EXPECT_NEAR(wedge.U(), 0.5f + 0.25f * p[0], 0.02);
        EXPECT_NEAR(wedge.V(), 0.5f + 0.25f * p[1], 0.02);
      }
    }
  }
}

TEST(AppendPatch, OfSeveralTexturesTheMostFrequentIsTaken) {
  Sphere sphere;
  for (std::size_t f = 0; f < sphere.model.cm.face.size(); f += 10)
    for (int corner = 0; corner < 3; ++corner) sphere.model.cm.face[f].WT(corner).N() = 0;
  const Snapshot taken = snapshot(sphere.model);
  const Appended where = append_patch(sphere.model, taken.mesh, fans(taken.mesh));
  for (std::size_t f = where.first_face; f < sphere.model.cm.face.size(); ++f)
    for (int corner = 0; corner < 3; ++corner) EXPECT_EQ(sphere.model.cm.face[f].cWT(corner).N(), 1);
}

TEST(AppendPatch, SelectsTheNewFacesOnlyWhenAsked) {
  for (const bool select : {false, true}) {
    Sphere sphere;
    const Snapshot taken = snapshot(sphere.model);
    AppendOptions options;
    options.select_new_faces = select;
    const Appended where = append_patch(sphere.model, taken.mesh, fans(taken.mesh), options);
    for (std::size_t f = 0; f < sphere.model.cm.face.size(); ++f) {
      const bool is_new = f >= where.first_face;
      EXPECT_EQ(sphere.model.cm.face[f].IsS(), select ? is_new : (!is_new && f % 3 == 0));
    }
    for (std::size_t v = 0; v < where.first_vertex; ++v)
      EXPECT_EQ(sphere.model.cm.vert[v].IsS(), v % 5 == 0) << "the vertex selection never changes";
    EXPECT_EQ(std::size_t(sphere.model.cm.sfn),
              vcg::tri::UpdateSelection<CMeshO>::FaceCount(sphere.model.cm));
  }
}

TEST(AppendPatch, AdjacencyIsRightAfterwards) {
  Sphere sphere;
  const Snapshot taken = snapshot(sphere.model);
  append_patch(sphere.model, taken.mesh, fans(taken.mesh));
  CMeshO& mesh = sphere.model.cm;
  EXPECT_TRUE(vcg::tri::Clean<CMeshO>::IsFFAdjacencyConsistent(mesh));
  for (CFaceO& face : mesh.face)
    for (int edge = 0; edge < 3; ++edge) EXPECT_FALSE(vcg::face::IsBorder(face, edge));
  for (CVertexO& vertex : mesh.vert) {
    ASSERT_NE(vertex.VFp(), nullptr);
    EXPECT_EQ(vertex.VFp()->V(vertex.VFi()), &vertex);
  }
}

TEST(AppendPatch, TheBoundingBoxGrows) {
  MeshDocument document;
  TriangleMesh open = test::cube();
  open.triangles.resize(10);
  MeshModel& model = layer_from(document, open);
  const Snapshot taken = snapshot(model);
  Patch patch = fans(taken.mesh);
  patch.vertices[0] = Vector3(5, 6, 7);
  append_patch(model, taken.mesh, patch);
  EXPECT_EQ(model.cm.bbox.max, Point3m(5, 6, 7));
  EXPECT_EQ(model.cm.bbox.min, Point3m(0, 0, 0));
}

TEST(AppendPatch, AnEmptyPatchChangesNothing) {
  Sphere sphere;
  const std::string before = document_state(sphere.document);
  const Snapshot taken = snapshot(sphere.model);
  Patch nothing;
  nothing.input_vertices = static_cast<Index>(taken.mesh.vertices.size());
  AppendOptions options;
  options.select_new_faces = true;
  append_patch(sphere.model, taken.mesh, nothing, options);
  EXPECT_TRUE(document_state(sphere.document) == before);
}

TEST(AppendPatch, RefusesAPatchOfAnotherMeshAndChangesNothing) {
  Sphere sphere;
  const std::string before = document_state(sphere.document);
  const Snapshot taken = snapshot(sphere.model);
  Patch other = fans(taken.mesh);
  --other.input_vertices;
  EXPECT_THROW(append_patch(sphere.model, taken.mesh, other), std::logic_error);
  Patch dangling = fans(taken.mesh);
  dangling.triangles[0][1] = dangling.input_vertices + 100;
  EXPECT_THROW(append_patch(sphere.model, taken.mesh, dangling), std::logic_error);
  EXPECT_THROW(append_patch_to_copy(sphere.document, sphere.model, taken.mesh, dangling, "x"),
               std::logic_error);
  EXPECT_TRUE(document_state(sphere.document) == before);
}

TEST(AppendPatch, DeletedElementsStayDeletedAndKeepTheirPlace) {
  Sphere sphere;
  CMeshO& mesh = sphere.model.cm;
  for (int f = 0; f < 3; ++f) Allocator<CMeshO>::DeleteFace(mesh, mesh.face[100 + f]);
  const Snapshot taken = snapshot(sphere.model);
  const auto faces = face_states(sphere.model);
  const Appended where = append_patch(sphere.model, taken.mesh, fans(taken.mesh));
  EXPECT_EQ(where.first_face, faces.size());
  for (int f = 0; f < 3; ++f) EXPECT_TRUE(mesh.face[100 + f].IsD());
  auto after = face_states(sphere.model);
  after.resize(faces.size());
  EXPECT_TRUE(after == faces);
}

TEST(AppendPatchToCopy, TheOldLayerStaysAndTheNewOneIsACompleteCopy) {
  Sphere sphere;
  const std::string before = layer_state(sphere.model);
  const auto vertices = vertex_states(sphere.model);
  const auto faces = face_states(sphere.model);
  const Snapshot taken = snapshot(sphere.model);
  const Patch patch = fans(taken.mesh);
  MeshModel& copy = append_patch_to_copy(sphere.document, sphere.model, taken.mesh, patch, "mesh (closed)");
  EXPECT_TRUE(layer_state(sphere.model) == before);
  EXPECT_EQ(sphere.document.meshList.size(), 2);
  EXPECT_EQ(sphere.document.mm(), &copy);
  EXPECT_EQ(copy.label(), "mesh (closed)");
  auto copied_vertices = vertex_states(copy);
  auto copied_faces = face_states(copy);
  ASSERT_EQ(copied_vertices.size(), vertices.size() + patch.vertices.size());
  ASSERT_EQ(copied_faces.size(), faces.size() + patch.triangles.size());
  copied_vertices.resize(vertices.size());
  copied_faces.resize(faces.size());
  EXPECT_TRUE(copied_vertices == vertices);
  EXPECT_TRUE(copied_faces == faces);
  EXPECT_EQ(copy.cm.textures, sphere.model.cm.textures);
  EXPECT_TRUE(copy.cm.Tr == sphere.model.cm.Tr);
  EXPECT_EQ(copy.cm.svn, sphere.model.cm.svn);
  EXPECT_TRUE(copy.hasDataMask(MeshModel::MM_VERTCOLOR | MeshModel::MM_WEDGTEXCOORD));
}

TEST(AppendPatchToCopy, DeletedElementsAreLeftOut) {
  Sphere sphere;
  CMeshO& mesh = sphere.model.cm;
  // An isolated vertex before all that the patch uses, and a face.
  Allocator<CMeshO>::DeleteFace(mesh, mesh.face[0]);
  std::set<Index> used;
  for (const Triangle& triangle : snapshot(sphere.model).mesh.triangles)
    used.insert(triangle.begin(), triangle.end());
  auto unused = Allocator<CMeshO>::AddVertices(mesh, 2);
  unused->P() = Point3m(9, 9, 9);
  Allocator<CMeshO>::DeleteVertex(mesh, *unused);
  const Snapshot taken = snapshot(sphere.model);
  const Patch patch = fans(taken.mesh);
  MeshModel& copy = append_patch_to_copy(sphere.document, sphere.model, taken.mesh, patch, "copy");
  EXPECT_EQ(copy.cm.vert.size(), mesh.vert.size() - 1 + patch.vertices.size());
  const Snapshot after = snapshot(copy);
  EXPECT_EQ(after.mesh.triangles.size(), taken.mesh.triangles.size() + patch.triangles.size());
  EXPECT_EQ(fans(after.mesh).triangles.size(), 0u) << "the patch does not meet the rim";
  const Triangle& last = after.mesh.triangles.back();
  EXPECT_EQ(after.mesh.vertices[last[2]], patch.vertices.back());
}

TEST(AddLayer, HoldsTheMeshLiesBesideAnotherAndDoesNotBecomeCurrent) {
  Sphere sphere;
  sphere.model.cm.Tr.SetTranslate(1, 2, 3);
  const std::string before = layer_state(sphere.model);
  const TriangleMesh mesh = test::cube();
  const MeshModel& layer = add_layer(sphere.document, mesh, "cube", sphere.model);
  EXPECT_TRUE(layer.cm.Tr == sphere.model.cm.Tr);
  EXPECT_EQ(sphere.document.mm(), &sphere.model);
  EXPECT_TRUE(layer_state(sphere.model) == before);
  EXPECT_EQ(snapshot(layer).mesh.triangles, mesh.triangles);
  EXPECT_EQ(snapshot(layer).mesh.vertices, mesh.vertices);
}

/// A vertex that is deleted, one without a face, a cube, and two tetrahedra with one vertex in common.
TriangleMesh cube_and_pinched_tetrahedra() {
  TriangleMesh mesh;
  mesh.vertices = {Vector3(9, 9, 9), Vector3(8, 8, 8)};
  return test::join(test::join(mesh, test::cube()), test::pinched_tetrahedra());
}

TEST(AppendPatchToCopy, SplitsVerticesAndLeavesOutThoseThatOnlyRemovedFacesUsed) {
  MeshDocument document;
  MeshModel& model = layer_from(document, cube_and_pinched_tetrahedra());
  test::give_all_attributes(model);
  Allocator<CMeshO>::DeleteVertex(model.cm, model.cm.vert[0]);
  model.cm.svn = static_cast<int>(vcg::tri::UpdateSelection<CMeshO>::VertexCount(model.cm));
  const std::string before = layer_state(model);
  const Snapshot taken = snapshot(model);
  AppendOptions options;
  for (Index f = 0; f < 12; ++f) options.left_out.push_back(f);
  options.leave_out_vertices = true;
  TriangleMesh rest = taken.mesh;
  rest.triangles.erase(rest.triangles.begin(), rest.triangles.begin() + 12);
  options.splits = split_overlapping_vertices(rest, build_topology(rest));
  ASSERT_EQ(options.splits.size(), 1u);
  Patch nothing;
  nothing.input_vertices = static_cast<Index>(taken.mesh.vertices.size());
  MeshModel& copy = append_patch_to_copy(document, model, taken.mesh, nothing, "copy", options);
  EXPECT_TRUE(layer_state(model) == before);

  const auto old = vertex_states(model);
  std::vector<std::string> expected = {old[1]};
  expected.insert(expected.end(), old.begin() + 10, old.end());
  expected.push_back(old[options.splits[0].vertex]);
  EXPECT_TRUE(vertex_states(copy) == expected);
  EXPECT_EQ(std::size_t(copy.cm.vn), expected.size());
  EXPECT_EQ(std::size_t(copy.cm.svn), vcg::tri::UpdateSelection<CMeshO>::VertexCount(copy.cm));
  const MeshStatistics statistics = measure(snapshot(copy).mesh, false);
  EXPECT_EQ(statistics.faces, 8u);
  EXPECT_EQ(statistics.components, 2u);
  EXPECT_TRUE(statistics.manifold() && statistics.watertight());
}

TEST(AppendPatchToCopy, SplitsVerticesOfThePatchsFacesToo) {
  Sphere sphere;
  const Snapshot taken = snapshot(sphere.model);
  const Patch patch = fans(taken.mesh);
  AppendOptions options;
  const auto kept = static_cast<Index>(taken.mesh.triangles.size());
  const Index vertex = patch.triangles[0][0];
  options.splits = {{vertex, {kept}}};
  const MeshModel& copy =
      append_patch_to_copy(sphere.document, sphere.model, taken.mesh, patch, "copy", options);
  const TriangleMesh after = snapshot(copy).mesh;
  const auto added = static_cast<Index>(taken.mesh.vertices.size() + patch.vertices.size());
  EXPECT_EQ(after.vertices.size(), added + 1u);
  EXPECT_EQ(after.vertices[added], taken.mesh.vertices[vertex]);
  for (Index f = 0; f < after.triangles.size(); ++f)
    EXPECT_EQ(after.triangles[f], f == kept
                                      ? (Triangle{added, patch.triangles[0][1], patch.triangles[0][2]})
                                      : (f < kept ? taken.mesh.triangles[f] : patch.triangles[f - kept]));
}

}  // namespace
}  // namespace host
}  // namespace meshcomplete
