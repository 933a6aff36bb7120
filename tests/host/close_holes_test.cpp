#include "common/host/close_holes.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "common/core/boundary_loops.h"
#include "common/core/error.h"
#include "common/core/mesh_topology.h"
#include "common/host/hole_log.h"
#include "common/host/snapshot.h"
#include "tests/host/fake_plugin.h"
#include "tests/host/test_documents.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace host {
namespace {

using test::FakePlugin;

/// Closes every selected hole with a fan.
ClosedHoles fill_with_fans(const TriangleMesh& mesh, const MeshSelection& selection,
                           const HoleSelectionOptions& options) {
  ClosedHoles result;
  Patch& patch = result.completion.patch;
  patch.input_vertices = static_cast<Index>(mesh.vertices.size());
  const auto loops = trace_boundary_loops(mesh, build_topology(mesh));
  result.completion.report.holes = select_holes(mesh, loops, selection, options);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    HoleReport& hole = result.completion.report.holes[i];
    if (hole.outcome == HoleOutcome::skipped) continue;
    const auto& rim = loops[i].vertices;
    for (std::size_t k = 1; k + 1 < rim.size(); ++k) patch.triangles.push_back({rim[0], rim[k], rim[k + 1]});
    hole.outcome = HoleOutcome::closed;
    hole.faces_added = rim.size() - 2;
    hole.route = "fan";
    hole.reason.clear();
  }
  return result;
}

FilterDeclaration close_holes_filter(CloseHolesAlgorithm algorithm) {
  FilterDeclaration filter;
  filter.name = "Close Holes: Fake";
  filter.parameters = close_holes_parameters();
  filter.apply = [algorithm = std::move(algorithm)](FilterRun& run) { close_holes(run, algorithm); };
  return filter;
}

class CloseHolesTest : public testing::Test {
 protected:
  CloseHolesTest() {
    test::give_all_attributes(model);
    vcg::tri::UpdateSelection<CMeshO>::Clear(model.cm);
  }
  static void set(RichParameterList& list, const char* name, bool on) { list.setValue(name, BoolValue(on)); }

  MeshDocument document;
  MeshModel& model = test::layer_from(document, test::sphere_with_holes(3), "ball 1.5.ply");
  FakePlugin fan_plugin{{close_holes_filter(
      [](const TriangleMesh& mesh, const MeshSelection& selection, const HoleSelectionOptions& holes,
         const Progress&) { return fill_with_fans(mesh, selection, holes); })}};
};

TEST_F(CloseHolesTest, ClosesTheHolesOfTheCurrentLayer) {
  const std::size_t faces = model.cm.face.size();
  ASSERT_TRUE(fan_plugin.run(document)) << qPrintable(fan_plugin.message());
  EXPECT_EQ(document.meshList.size(), 1);
  EXPECT_GT(model.cm.face.size(), faces);
  EXPECT_EQ(fan_plugin.last_report().count(HoleOutcome::closed), 3u);
  EXPECT_TRUE(fan_plugin.log().contains("Hole 1 ("));
  EXPECT_TRUE(fan_plugin.log().contains("Closed 3 of 3 holes."));
  const auto& stages = fan_plugin.last_report().stage_seconds;
  ASSERT_GE(stages.size(), 2u);
  EXPECT_EQ(stages.front().first, "reading the mesh");
  EXPECT_EQ(stages.back().first, "appending the patch");
  for (std::size_t f = 0; f < model.cm.face.size(); ++f) EXPECT_EQ(model.cm.face[f].IsS(), f >= faces);
}

TEST_F(CloseHolesTest, ASecondRunFindsNothingToDo) {
  ASSERT_TRUE(fan_plugin.run(document));
  const std::string before = test::document_state(document);
  ASSERT_TRUE(fan_plugin.run(document, 0, [](RichParameterList& list) { set(list, "Selected", false); }));
  EXPECT_TRUE(fan_plugin.log().contains("The mesh has no holes"));
  EXPECT_TRUE(test::document_state(document) == before);
}

TEST_F(CloseHolesTest, AFailedOrCancelledRunLeavesTheDocumentAsItWas) {
  const std::string before = test::document_state(document);
  const std::function<void()> failures[] = {[] { throw CompletionError("x", "No."); },
                                            [] { throw Cancelled(); },
                                            [] { throw std::runtime_error("odd"); }};
  for (const bool as_new_layer : {false, true}) {
    for (const auto& failure : failures) {
      FakePlugin plugin({close_holes_filter([&](const TriangleMesh&, const MeshSelection&,
                                                const HoleSelectionOptions&, const Progress&) -> ClosedHoles {
        failure();
        return {};
      })});
      EXPECT_FALSE(
          plugin.run(document, 0, [&](RichParameterList& list) { set(list, "AsNewLayer", as_new_layer); }));
      EXPECT_TRUE(test::document_state(document) == before);
    }
  }
}

TEST_F(CloseHolesTest, APatchThatDoesNotFitIsRefusedAndTheDocumentIsAsItWas) {
  const std::string before = test::document_state(document);
  FakePlugin plugin({close_holes_filter([](const TriangleMesh& mesh, const MeshSelection& selection,
                                           const HoleSelectionOptions& holes, const Progress&) {
    ClosedHoles result = fill_with_fans(mesh, selection, holes);
    result.completion.patch.triangles[0][0] = 1000000;
    return result;
  })});
  for (const bool as_new_layer : {false, true}) {
    EXPECT_FALSE(
        plugin.run(document, 0, [&](RichParameterList& list) { set(list, "AsNewLayer", as_new_layer); }));
    EXPECT_TRUE(test::document_state(document) == before);
  }
}

TEST_F(CloseHolesTest, ResultAsNewLayer) {
  const std::string before = test::layer_state(model);
  ASSERT_TRUE(fan_plugin.run(document, 0, [](RichParameterList& list) { set(list, "AsNewLayer", true); }));
  EXPECT_TRUE(test::layer_state(model) == before);
  ASSERT_EQ(document.meshList.size(), 2);
  EXPECT_EQ(document.mm(), document.meshList.at(1));
  EXPECT_EQ(document.mm()->label(), "ball 1.5 (closed)");
}

/// Takes the faces with these places in the snapshot out, and closes what is then open.
CloseHolesAlgorithm without_triangles(std::vector<Index> removed) {
  return [removed](const TriangleMesh& mesh, const MeshSelection& selection,
                   const HoleSelectionOptions& options, const Progress&) {
    TriangleMesh rest = mesh;
    for (auto t = removed.rbegin(); t != removed.rend(); ++t)
      rest.triangles.erase(rest.triangles.begin() + *t);
    ClosedHoles result = fill_with_fans(rest, selection, options);
    result.removed = removed;
    return result;
  };
}

TEST_F(CloseHolesTest, RemovedFacesAreMissingInANewLayerOnly) {
  vcg::tri::Allocator<CMeshO>::DeleteFace(model.cm, model.cm.face[3]);
  const std::string before = test::layer_state(model);
  const std::vector<std::string> faces = test::face_states(model);
  const std::vector<std::string> vertices = test::vertex_states(model);
  FakePlugin plugin({close_holes_filter(without_triangles({1, 7, 8}))});
  ASSERT_TRUE(plugin.run(document, 0, [](RichParameterList& list) { set(list, "NewFaceSelected", false); }))
      << qPrintable(plugin.message());
  EXPECT_TRUE(test::layer_state(model) == before);
  ASSERT_EQ(document.meshList.size(), 2);
  const MeshModel& copy = *document.mm();
  // Faces behind the deleted one have their places in the layer, not in the snapshot.
  EXPECT_EQ(plugin.last_report().removed_faces, (std::vector<Index>{1, 8, 9}));
  EXPECT_TRUE(plugin.log().contains("The new layer lacks 3 faces of the input, counted from 0: 1, 8, 9"));
  std::vector<std::string> kept;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (f != 1 && f != 3 && f != 8 && f != 9) kept.push_back(faces[f]);
  std::vector<std::string> after = test::face_states(copy);
  EXPECT_EQ(static_cast<std::size_t>(copy.cm.fn), copy.cm.face.size());
  ASSERT_GT(after.size(), kept.size());
  after.resize(kept.size());
  EXPECT_TRUE(after == kept);
  std::vector<std::string> vertices_after = test::vertex_states(copy);
  vertices_after.resize(vertices.size());
  EXPECT_TRUE(vertices_after == vertices);
  EXPECT_TRUE(test::fans(snapshot(copy).mesh).triangles.empty()) << "something is still open";
}

TEST_F(CloseHolesTest, ALayerOfItsOwnAlsoWhenNothingHadToBeRemoved) {
  FakePlugin plugin({close_holes_filter(without_triangles({}))});
  ASSERT_TRUE(plugin.run(document));
  EXPECT_EQ(document.meshList.size(), 2);
  EXPECT_TRUE(plugin.last_report().removed_faces.empty());
  EXPECT_FALSE(plugin.log().contains("lacks"));
}

TEST_F(CloseHolesTest, WhenNothingWasClosedNothingIsRemoved) {
  const std::string before = test::document_state(document);
  FakePlugin plugin({close_holes_filter(
      [](const TriangleMesh& mesh, const MeshSelection&, const HoleSelectionOptions&, const Progress&) {
        ClosedHoles result;
        result.completion.patch.input_vertices = static_cast<Index>(mesh.vertices.size());
        result.removed = std::vector<Index>{1, 2};
        return result;
      })});
  ASSERT_TRUE(plugin.run(document));
  EXPECT_TRUE(plugin.last_report().removed_faces.empty());
  EXPECT_TRUE(test::document_state(document) == before);
}

TEST_F(CloseHolesTest, CleaningMakesALayerEvenIfNothingWasClosed) {
  const std::string before = test::layer_state(model);
  std::vector<Index> removed = {1, 2};
  std::vector<VertexSplit> splits = {{5, {0}}};
  FakePlugin plugin({close_holes_filter(
      [&](const TriangleMesh& mesh, const MeshSelection&, const HoleSelectionOptions&, const Progress&) {
        ClosedHoles result;
        result.completion.patch.input_vertices = static_cast<Index>(mesh.vertices.size());
        result.removed = removed;
        result.splits = splits;
        result.cleaned = true;
        return result;
      })});
  ASSERT_TRUE(plugin.run(document)) << qPrintable(plugin.message());
  EXPECT_TRUE(test::layer_state(model) == before);
  ASSERT_EQ(document.meshList.size(), 2);
  EXPECT_EQ(plugin.last_report().removed_faces, removed);
  EXPECT_EQ(plugin.last_report().split_vertices, std::vector<Index>{5});
  EXPECT_TRUE(plugin.log().contains("The new layer lacks 2 faces of the input, counted from 0: 1, 2"));
  EXPECT_TRUE(plugin.log().contains("The new layer has 1 copy of vertices of the input, counted from 0: 5"));
  removed.clear();
  splits.clear();
  document.setCurrentMesh(model.id());
  ASSERT_TRUE(plugin.run(document));
  EXPECT_EQ(document.meshList.size(), 2) << "there was nothing to change";
}

TEST_F(CloseHolesTest, WhenNothingWasClosedThereIsNoNewLayer) {
  ASSERT_TRUE(fan_plugin.run(document, 0, [](RichParameterList& list) {
    set(list, "AsNewLayer", true);
    list.setValue("MaxHoleEdges", IntValue(3));
  }));
  EXPECT_EQ(document.meshList.size(), 1);
  EXPECT_TRUE(fan_plugin.log().contains("Closed 0 of 3 holes"));
}

TEST_F(CloseHolesTest, ExtraLayersAreAddedUnlessEmpty) {
  FakePlugin plugin({close_holes_filter([](const TriangleMesh& mesh, const MeshSelection& selection,
                                           const HoleSelectionOptions& holes, const Progress&) {
    ClosedHoles result = fill_with_fans(mesh, selection, holes);
    result.layers = {{"unfolded", test::cube()}, {"empty", TriangleMesh()}};
    return result;
  })});
  ASSERT_TRUE(plugin.run(document));
  ASSERT_EQ(document.meshList.size(), 2);
  EXPECT_EQ(document.meshList.at(1)->label(), "ball 1.5 (unfolded)");
  EXPECT_EQ(document.mm(), &model);
}

TEST_F(CloseHolesTest, SelectionParametersReachTheCore) {
  HoleSelectionOptions seen;
  FakePlugin plugin({close_holes_filter([&seen](const TriangleMesh& mesh, const MeshSelection& selection,
                                                const HoleSelectionOptions& holes, const Progress&) {
    seen = holes;
    return fill_with_fans(mesh, selection, HoleSelectionOptions());
  })});
  ASSERT_TRUE(plugin.run(document));
  EXPECT_FALSE(seen.selected_only || seen.keep_largest || seen.max_edges || seen.max_perimeter);
  MeshDocument other;
  test::layer_from(other, test::sphere_with_hole());
  ASSERT_TRUE(plugin.run(other, 0, [](RichParameterList& list) {
    set(list, "Selected", true);
    set(list, "KeepLargest", true);
    list.setValue("MaxHoleEdges", IntValue(7));
    list.setValue("MaxHolePerimeter", AbsPercValue(0.5f));
  }));
  EXPECT_TRUE(seen.selected_only && seen.keep_largest);
  EXPECT_EQ(seen.max_edges, std::optional<std::size_t>(7));
  EXPECT_EQ(seen.max_perimeter, std::optional<double>(0.5));
}

TEST_F(CloseHolesTest, AHoleOfOneOrTwoEdgesIsNotOffered) {
  EXPECT_FALSE(fan_plugin.run(document, 0,
                              [](RichParameterList& list) { list.setValue("MaxHoleEdges", IntValue(2)); }));
  EXPECT_TRUE(fan_plugin.message().contains("MaxHoleEdges"));
}

TEST_F(CloseHolesTest, SelectedWithoutASelectionFailsWithAMessage) {
  EXPECT_FALSE(fan_plugin.run(document, 0, [](RichParameterList& list) { set(list, "Selected", true); }));
  EXPECT_TRUE(fan_plugin.message().contains("elect")) << qPrintable(fan_plugin.message());
}

HoleReport hole(HoleOutcome outcome, std::size_t edges, const char* reason = "") {
  HoleReport report;
  report.outcome = outcome;
  report.edges = edges;
  report.perimeter = 2.5;
  report.faces_added = outcome == HoleOutcome::closed ? edges : 0;
  report.route = outcome == HoleOutcome::closed ? "projected" : "";
  report.reason = reason;
  return report;
}

TEST(HoleLog, OneLinePerHole) {
  CompletionReport report;
  report.holes = {hole(HoleOutcome::closed, 8), hole(HoleOutcome::skipped, 9, "too long"),
                  hole(HoleOutcome::failed, 10, "knotted")};
  const QStringList lines = describe_holes(report);
  ASSERT_EQ(lines.size(), 4);
  EXPECT_EQ(lines[0], "Hole 1 (8 edges, perimeter 2.5, near (0, 0, 0)): closed with 8 faces, projected");
  EXPECT_EQ(lines[1], "Hole 2 (9 edges, perimeter 2.5, near (0, 0, 0)): left open: too long");
  EXPECT_EQ(lines[2], "Hole 3 (10 edges, perimeter 2.5, near (0, 0, 0)): NOT closed: knotted");
  EXPECT_EQ(lines[3],
            "Closed 1 of 3 holes, 1 could not be closed, 1 left open as asked or for the reason given.");
}

TEST(HoleLog, FiguresAreOneLine) {
  CompletionReport report;
  report.holes = {hole(HoleOutcome::closed, 8)};
  report.notes = {"a note"};
  report.figures = {{"nodes", 1234567}, {"smallest leaf", 0.0625}};
  const QStringList lines = describe_holes(report);
  ASSERT_EQ(lines.size(), 4);
  EXPECT_EQ(lines[1], "a note");
  EXPECT_EQ(lines[2], "Figures: nodes 1234567, smallest leaf 0.0625");
}

TEST(HoleLog, ManyHolesAreSummedUp) {
  CompletionReport report;
  for (std::size_t i = 0; i < 500; ++i) report.holes.push_back(hole(HoleOutcome::closed, 3 + i % 20));
  for (std::size_t i = 0; i < 150; ++i) report.holes.push_back(hole(HoleOutcome::failed, 5, "because"));
  const QStringList lines = describe_holes(report);
  ASSERT_EQ(lines.size(), 103);
  EXPECT_EQ(lines[0], "Closed 500 holes of 3 to 22 edges with 6250 faces");
  EXPECT_TRUE(lines[1].startsWith("Hole 501 ("));
  EXPECT_EQ(lines[101], "... and 50 more that are not closed");
  EXPECT_EQ(lines[102], "Closed 500 of 650 holes, 150 could not be closed.");
}

TEST(HoleLog, AMeshWithoutHoles) {
  EXPECT_EQ(describe_holes(CompletionReport()),
            QStringList("The mesh has no holes: there is nothing to close."));
}

}  // namespace
}  // namespace host
}  // namespace meshcomplete
