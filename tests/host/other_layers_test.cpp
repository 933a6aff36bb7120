#include "common/host/other_layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "common/host/close_holes_parameters.h"
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

}  // namespace
}  // namespace host
}  // namespace meshcomplete
