#include "common/host/other_layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "common/core/error.h"
#include "common/host/parameter_blocks.h"
#include "tests/host/fake_plugin.h"
#include "tests/host/test_documents.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace host {
namespace {

using test::FakePlugin;

/// A document with a mesh, which is current, and two layers of points.
class OtherLayersTest : public testing::Test {
 protected:
  OtherLayersTest() { document.setCurrentMesh(mesh.id()); }

  /// Runs `look` in a filter with the parameters First and Second, set to these layers: 0 is none.
  bool run(const std::function<void(const FilterRun&)>& look, int first, int second) {
    FilterDeclaration filter;
    filter.name = "Fake Filter";
    filter.apply = [look](FilterRun& run) { look(run); };
    filter.parameters = {layer_parameter("First", "First", "One."),
                         layer_parameter("Second", "Second", "Another.")};
    plugin = std::make_unique<FakePlugin>(std::vector<FilterDeclaration>{filter});
    return plugin->run(document, 0, [&](RichParameterList& list) {
      list.setValue("First", EnumValue(first));
      list.setValue("Second", EnumValue(second));
    });
  }
  std::string message() { return plugin->message().toStdString(); }

  static MeshModel& points(MeshDocument& document, const char* name, const std::vector<Vector3>& positions) {
    TriangleMesh cloud;
    cloud.vertices = positions;
    return test::layer_from(document, cloud, name);
  }

  static void give_camera(MeshModel& model, const Point3m& position) {
    model.cm.shot.Intrinsics.PixelSizeMm = {0.1f, 0.1f};
    model.cm.shot.SetViewPoint(position);
  }

  MeshDocument document;
  MeshModel& mesh = test::layer_from(document, test::cube(), "mesh.ply");
  MeshModel& inside = points(document, "inside.ply", {{0, 0, 0}, {0.1, 0.2, 0.3}, {1, 2, 3}});
  MeshModel& outside = points(document, "outside.ply", {{5, 5, 5}});
  std::unique_ptr<FakePlugin> plugin;
};

TEST_F(OtherLayersTest, NoneHasNoPoints) {
  EXPECT_TRUE(run(
      [&](const FilterRun& run) {
        EXPECT_TRUE(other_layer_points(run, "First").empty());
        EXPECT_EQ(other_layer_points(run, "Second").size(), 1u);
        refuse_shared_layers(run, {"First", "Second"});
      },
      0, 3));
}

TEST_F(OtherLayersTest, PointsAreTheVerticesThatAreNotDeleted) {
  vcg::tri::Allocator<CMeshO>::DeleteVertex(inside.cm, inside.cm.vert[1]);
  inside.cm.Tr.SetTranslate(0.1f, 0, 0);
  mesh.cm.Tr = inside.cm.Tr;
  EXPECT_TRUE(run(
      [](const FilterRun& run) {
        const std::vector<Vector3> expected = {{0, 0, 0}, {1, 2, 3}};
        EXPECT_EQ(other_layer_points(run, "First"), expected) << "equal matrices change nothing at all";
      },
      2, 0));
}

TEST_F(OtherLayersTest, PointsAreInTheCoordinatesOfTheCurrentLayer) {
  // In space: the mesh is turned by 90 degrees about z and twice as large, the points are moved by (10, 0,
  // 0).
  mesh.cm.Tr.SetIdentity();
  mesh.cm.Tr.ElementAt(0, 0) = mesh.cm.Tr.ElementAt(1, 1) = 0;
  mesh.cm.Tr.ElementAt(0, 1) = -2;
  mesh.cm.Tr.ElementAt(1, 0) = mesh.cm.Tr.ElementAt(2, 2) = 2;
  inside.cm.Tr.SetTranslate(10, 0, 0);
  EXPECT_TRUE(run(
      [](const FilterRun& run) {
        // (1, 2, 3) is (11, 2, 3) in space, and 2 * (-y, x, z) = (11, 2, 3) in the mesh's coordinates.
        EXPECT_LT((other_layer_points(run, "First").at(2) - Vector3(1, -5.5, 1.5)).norm(), 1e-12);
      },
      2, 0));
}

TEST_F(OtherLayersTest, AMatrixThatCannotBeInvertedIsRefused) {
  mesh.cm.Tr.SetScale(1, 0, 1);
  EXPECT_FALSE(run([](const FilterRun& run) { other_layer_points(run, "First"); }, 2, 0));
  EXPECT_EQ(
      message(),
      "The transformation matrix of the layer \"mesh.ply\" cannot be inverted. Reset it with \"Matrix: Reset "
      "Current Matrix\".");
}

TEST_F(OtherLayersTest, UnusableLayersAreRefused) {
  document.addNewMesh("", "nothing", false);
  EXPECT_FALSE(run([](const FilterRun& run) { other_layer_points(run, "First"); }, 4, 0));
  EXPECT_EQ(message(), "The layer \"nothing\", chosen as \"First\", is empty: it has no vertices.");
  inside.cm.vert[1].P()[2] = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(run([](const FilterRun& run) { other_layer_points(run, "First"); }, 2, 0));
  EXPECT_EQ(message(),
            "The layer \"inside.ply\" has vertices with coordinates that are infinite or not numbers.");
}

TEST_F(OtherLayersTest, TheCurrentLayerIsRefused) {
  EXPECT_FALSE(run([](const FilterRun& run) { other_layer_points(run, "First"); }, 1, 0));
  EXPECT_EQ(message(),
            "Parameter \"First\" names \"mesh.ply\", the layer that the filter works on. Choose another one, "
            "or none.");
}

TEST_F(OtherLayersTest, OneLayerForTwoParametersIsRefused) {
  EXPECT_FALSE(run([](const FilterRun& run) { refuse_shared_layers(run, {"First", "Second"}); }, 2, 2));
  EXPECT_EQ(message(), "The layer \"inside.ply\" is chosen twice, as \"First\" and as \"Second\".");
  EXPECT_TRUE(run([](const FilterRun& run) { refuse_shared_layers(run, {"First", "Second"}); }, 0, 0));
}

TEST_F(OtherLayersTest, ViewsAreThoseOfVisibleLayersWithACamera) {
  std::vector<LayerView> views;
  const auto look = [&](const FilterRun& run) { views = layer_views(run); };
  EXPECT_TRUE(run(look, 0, 0));
  EXPECT_TRUE(views.empty());
  give_camera(mesh, {9, 9, 9});
  give_camera(inside, {1, 0, 7});
  give_camera(outside, {0, 0, 8});
  give_camera(*document.addNewMesh("", "nothing", false), {0, 0, 9});
  inside.cm.Tr.SetTranslate(0, 0, 1);
  outside.visible = false;
  EXPECT_TRUE(run(look, 0, 0));
  ASSERT_EQ(views.size(), 1u) << "not the current layer, nor a hidden one, nor one without vertices";
  EXPECT_EQ(views[0].layer, "inside.ply");
  EXPECT_EQ(views[0].from, Vector3(1, 0, 8));
  ASSERT_EQ(views[0].seen.size(), 3u);
  EXPECT_EQ(views[0].seen[2], Vector3(1, 2, 4));
  outside.visible = true;
  EXPECT_TRUE(run(look, 0, 0));
  ASSERT_EQ(views.size(), 2u);
  EXPECT_EQ(views[1].from, Vector3(0, 0, 8));
}

// --- surfaces
// ------------------------------------------------------------------------------------------------------

/// A normal for every vertex that is in use.
void give_normals(MeshModel& model, const std::vector<Vector3>& normals) {
  std::size_t next = 0;
  for (CVertexO& vertex : model.cm.vert)
    if (!vertex.IsD()) {
      const Vector3& n = normals.at(next++);
      vertex.N() = Point3m(float(n.x()), float(n.y()), float(n.z()));
    }
}

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6;
  return sum;
}

TEST_F(OtherLayersTest, ASurfaceIsItsFacesInTheOtherLayersCoordinates) {
  const LayerSurface same = layer_surface(mesh, mesh);
  EXPECT_EQ(same.mesh.vertices, test::cube().vertices);
  EXPECT_EQ(same.mesh.triangles, test::cube().triangles);
  EXPECT_TRUE(same.points.empty());
  EXPECT_TRUE(same.normals.empty());
  mesh.cm.Tr.SetTranslate(10, 0, 0);
  inside.cm.Tr.SetScale(2, 2, 2);
  const LayerSurface moved = layer_surface(mesh, inside);
  ASSERT_EQ(moved.mesh.vertices.size(), 8u);
  for (std::size_t v = 0; v < 8; ++v)
    EXPECT_LT((moved.mesh.vertices[v] - (test::cube().vertices[v] + Vector3(10, 0, 0)) / 2).norm(), 1e-12);
  EXPECT_EQ(moved.mesh.triangles, test::cube().triangles);
}

TEST_F(OtherLayersTest, WhatIsDeletedIsNotInTheSurface) {
  MeshModel& layer = test::layer_from(document, test::join(test::isolated_triangle(), test::cube()), "two");
  for (int v = 0; v < 3; ++v) vcg::tri::Allocator<CMeshO>::DeleteVertex(layer.cm, layer.cm.vert[v]);
  vcg::tri::Allocator<CMeshO>::DeleteFace(layer.cm, layer.cm.face[0]);
  const LayerSurface surface = layer_surface(layer, layer);
  EXPECT_EQ(surface.mesh.vertices, test::cube().vertices);
  EXPECT_EQ(surface.mesh.triangles, test::cube().triangles) << "corners have the numbers of what is left";
}

TEST_F(OtherLayersTest, AMirroringMatrixTurnsFacesRound) {
  EXPECT_NEAR(volume(layer_surface(mesh, inside).mesh), 1, 1e-12);
  mesh.cm.Tr.SetScale(1, 1, -1);
  EXPECT_NEAR(volume(layer_surface(mesh, inside).mesh), 1, 1e-12) << "the layer is mirrored";
  inside.cm.Tr.SetScale(-1, 1, 1);
  EXPECT_NEAR(volume(layer_surface(mesh, inside).mesh), 1, 1e-12) << "both are";
  mesh.cm.Tr.SetIdentity();
  EXPECT_NEAR(volume(layer_surface(mesh, inside).mesh), 1, 1e-12) << "the other one is";
}

TEST_F(OtherLayersTest, APointSetHasNormalsInTheOtherLayersCoordinates) {
  give_normals(inside, {{0, 0, 1}, {1, 0, 0}, {0, 0.6f, 0.8f}});
  LayerSurface surface = layer_surface(inside, inside);
  EXPECT_TRUE(surface.mesh.triangles.empty());
  ASSERT_EQ(surface.points.size(), 3u);
  EXPECT_EQ(surface.points[2], Vector3(1, 2, 3));
  EXPECT_EQ(surface.normals[1], Vector3(1, 0, 0));
  // Planes are carried along: a normal leans away from the axis that is stretched.
  inside.cm.Tr.SetScale(1, 1, 2);
  surface = layer_surface(inside, mesh);
  EXPECT_EQ(surface.points[2], Vector3(1, 2, 6));
  EXPECT_LT((surface.normals[2].normalized() - Vector3(0, 0.6, 0.4).normalized()).norm(), 1e-6);
  // A mirror image looks where the image of the normal points: away from its own inside.
  inside.cm.Tr.SetScale(1, 1, -1);
  surface = layer_surface(inside, mesh);
  EXPECT_EQ(surface.points[2], Vector3(1, 2, -3));
  EXPECT_LT((surface.normals[0] - Vector3(0, 0, -1)).norm(), 1e-12);
  EXPECT_LT((surface.normals[2] - Vector3(0, 0.6, -0.8)).norm(), 1e-6);
}

TEST_F(OtherLayersTest, NormalsGoWithTheFacesOfAMirroredLayer) {
  MeshModel& cloud = points(document, "cloud", test::icosphere(1).vertices);
  give_normals(cloud, test::icosphere(1).vertices);
  MeshModel& ball = test::layer_from(document, test::icosphere(1), "ball");
  cloud.cm.Tr.SetScale(-2, 1, 1);
  ball.cm.Tr.SetScale(-2, 1, 1);
  const LayerSurface oriented = layer_surface(cloud, mesh), faces = layer_surface(ball, mesh);
  ASSERT_EQ(oriented.points, faces.mesh.vertices);
  for (const Triangle& t : faces.mesh.triangles) {
    const auto& p = faces.mesh.vertices;
    const Vector3 face = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
    EXPECT_GT(face.dot(oriented.normals[t[0]]), 0) << "both outwards";
  }
}

TEST_F(OtherLayersTest, PointSetsWithoutNormalsAreRefused) {
  const std::string expected =
      "The layer \"inside.ply\" is a point set with points that have no normals. Apply \"Compute normals for "
      "point sets\" to it.";
  for (const Vector3& bad : {Vector3(0, 0, 0), Vector3(0, 0, std::numeric_limits<float>::quiet_NaN())}) {
    give_normals(inside, {{0, 0, 1}, bad, {0, 0, 1}});
    EXPECT_FALSE(run([](const FilterRun& run) { other_layer_surface(run, "First"); }, 2, 0));
    EXPECT_EQ(message(), expected);
  }
  vcg::tri::Allocator<CMeshO>::DeleteVertex(inside.cm, inside.cm.vert[1]);
  EXPECT_TRUE(run([](const FilterRun& run) { other_layer_surface(run, "First"); }, 2, 0))
      << "the point without one is gone";
}

TEST_F(OtherLayersTest, OtherSurfacesAreRefusedLikePoints) {
  const auto look = [](const FilterRun& run) { other_layer_surface(run, "First"); };
  EXPECT_FALSE(run(look, 1, 0));
  EXPECT_EQ(message(),
            "Parameter \"First\" names \"mesh.ply\", the layer that the filter works on. Choose another one, "
            "or none.")
      << "the current layer is not its own guide";
  MeshModel& empty = *document.addNewMesh("", "nothing", false);
  EXPECT_FALSE(run(look, 4, 0));
  EXPECT_EQ(message(), "The layer \"nothing\", chosen as \"First\", is empty: it has no vertices.");
  EXPECT_THROW(layer_surface(empty, mesh), CompletionError);
  mesh.cm.vert[3].P()[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(layer_surface(mesh, outside), CompletionError);
  inside.cm.Tr.SetScale(0, 1, 1);
  EXPECT_THROW(layer_surface(outside, inside), CompletionError);
  EXPECT_TRUE(run(
      [](const FilterRun& run) {
        const LayerSurface none = other_layer_surface(run, "First");
        EXPECT_TRUE(none.mesh.triangles.empty());
        EXPECT_TRUE(none.points.empty());
      },
      0, 0));
}

TEST_F(OtherLayersTest, VisibleSurfacesAreThoseOfTheOtherLayers) {
  give_normals(inside, {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}});
  give_normals(outside, {{0, 0, 1}});
  document.addNewMesh("", "nothing", false);
  const MeshModel& ball = test::layer_from(document, test::icosphere(1), "ball");
  document.setCurrentMesh(mesh.id());
  const MeshModel* left_out = nullptr;
  std::vector<std::string> names;
  std::vector<std::size_t> faces;
  const auto look = [&](const FilterRun& run) {
    names.clear();
    faces.clear();
    for (const auto& [name, surface] : visible_layer_surfaces(run, left_out)) {
      names.push_back(name.toStdString());
      faces.push_back(surface.mesh.triangles.size());
    }
  };
  using Names = std::vector<std::string>;
  EXPECT_TRUE(run(look, 0, 0));
  EXPECT_EQ(names, (Names{"inside.ply", "outside.ply", "ball"})) << "not the current one, nor the empty one";
  EXPECT_EQ(faces, (std::vector<std::size_t>{0, 0, 80}));
  outside.visible = false;
  EXPECT_TRUE(run(look, 0, 0));
  EXPECT_EQ(names, (Names{"inside.ply", "ball"}));
  left_out = &ball;
  EXPECT_TRUE(run(look, 0, 0));
  EXPECT_EQ(names, Names{"inside.ply"});
  give_normals(outside, {{0, 0, 0}});
  EXPECT_TRUE(run(look, 0, 0)) << "what is not visible may be anything";
  outside.visible = true;
  EXPECT_FALSE(run(look, 0, 0));
  EXPECT_NE(message().find("\"outside.ply\" is a point set"), std::string::npos);
}

}  // namespace
}  // namespace host
}  // namespace meshcomplete
