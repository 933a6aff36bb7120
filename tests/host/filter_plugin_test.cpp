#include "common/host/filter_plugin.h"

#include <gtest/gtest.h>

#include <chrono>
#include <new>
#include <stdexcept>
#include <thread>

#include "common/core/error.h"
#include "common/host/close_holes_parameters.h"
#include "common/host/parameter_blocks.h"
#include "tests/host/fake_plugin.h"
#include "tests/host/test_documents.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace host {
namespace {

using test::FakePlugin;

FilterDeclaration filter_that(std::function<void(FilterRun&)> apply, const char* name = "Fake Filter") {
  FilterDeclaration filter;
  filter.name = name;
  filter.description = "Does what the test says.";
  filter.apply = std::move(apply);
  return filter;
}

class FilterPluginTest : public testing::Test {
 protected:
  MeshDocument document;
  MeshModel& model = test::layer_from(document, test::cube());
};

TEST_F(FilterPluginTest, MeshLabFindsNameDescriptionClassAndArity) {
  FilterDeclaration range = filter_that([](FilterRun&) {}, "Second Filter");
  range.place = MenuPlace::range_map;
  range.arity = Arity::visible_meshes;
  range.changes_mesh = false;
  FakePlugin plugin({filter_that([](FilterRun&) {}), range});
  ASSERT_EQ(plugin.actions().size(), 2);
  QAction* second = plugin.actions().at(1);
  // Desktops add accelerators to the texts of menu entries.
  second->setText("&Second Filter");
  EXPECT_EQ(plugin.ID(second), 1);
  EXPECT_EQ(plugin.filterName(1), "Second Filter");
  EXPECT_EQ(plugin.filterInfo(0), "Does what the test says.");
  EXPECT_EQ(plugin.getClass(plugin.actions().at(0)), MeshFilterInterface::Remeshing);
  EXPECT_EQ(plugin.getClass(second), MeshFilterInterface::RangeMap);
  EXPECT_EQ(plugin.filterArity(plugin.actions().at(0)), MeshFilterInterface::SINGLE_MESH);
  EXPECT_EQ(plugin.filterArity(second), MeshFilterInterface::VARIABLE);
  EXPECT_EQ(plugin.postCondition(second), MeshModel::MM_NONE);
  EXPECT_NE(plugin.postCondition(plugin.actions().at(0)), MeshModel::MM_NONE);
}

TEST_F(FilterPluginTest, NothingThatAFilterThrowsEscapes) {
  const struct {
    std::function<void()> throw_it;
    const char* message;
  } cases[] = {
      {[] { throw CompletionError("a stage", "Do this and that."); }, "Do this and that."},
      {[] { throw Cancelled(); }, "Cancelled. The mesh was not changed."},
      {[] { throw std::bad_alloc(); }, "There is not enough memory for this. The mesh was not changed."},
      {[] { throw std::runtime_error("odd"); }, "Unexpected error: odd. The mesh was not changed."},
      {[] { throw 5; }, "Unexpected error. The mesh was not changed."},
  };
  for (const auto& test_case : cases) {
    FakePlugin plugin({filter_that([&](FilterRun& run) {
      run.report.notes.push_back("got so far");
      test_case.throw_it();
    })});
    EXPECT_FALSE(plugin.run(document));
    EXPECT_EQ(plugin.message(), test_case.message);
    EXPECT_TRUE(plugin.log().contains(QString("Fake Filter failed: ") + test_case.message))
        << qPrintable(plugin.log());
    EXPECT_EQ(plugin.last_report().notes.size(), 1u);
  }
}

TEST_F(FilterPluginTest, ARunStartsWithAnEmptyReportAndMessage) {
  bool fail = true;
  FakePlugin plugin({filter_that([&](FilterRun& run) {
    run.report.notes.push_back("note");
    run.log("a line");
    if (fail) throw std::runtime_error("first");
  })});
  EXPECT_FALSE(plugin.run(document));
  fail = false;
  EXPECT_TRUE(plugin.run(document));
  EXPECT_EQ(plugin.message(), "");
  EXPECT_EQ(plugin.last_report().notes.size(), 1u);
  EXPECT_TRUE(plugin.log().contains("a line"));
}

TEST_F(FilterPluginTest, WithoutAMeshAFilterForOneMeshFails) {
  MeshDocument empty;
  FakePlugin plugin({filter_that([](FilterRun&) { FAIL() << "must not run"; })});
  EXPECT_FALSE(plugin.run(empty));
  EXPECT_TRUE(plugin.message().contains("no mesh"));
}

FilterDeclaration filter_with_parameters(std::function<void(FilterRun&)> apply) {
  FilterDeclaration filter = filter_that(std::move(apply));
  filter.parameters = close_holes_parameters();
  filter.parameters.push_back(choice_parameter("Kind", "Kind", "Which kind.", {"one", "two"}));
  filter.parameters.push_back(integer_parameter("Count", "Count", "How many.", "pieces", 4, 1, 10));
  filter.parameters.push_back(length_parameter("Size", "Size", "How large."));
  ParameterDeclaration word;
  word.type = ParameterType::text;
  word.name = "Word";
  word.fallback = "hello";
  filter.parameters.push_back(word);
  return filter;
}

TEST_F(FilterPluginTest, ParametersArriveAndDefaultsDependOnTheMesh) {
  int runs = 0;
  FakePlugin plugin({filter_with_parameters([&](FilterRun& run) {
    const ParameterValues& values = run.parameters;
    EXPECT_EQ(values.boolean("Selected"), runs == 1);
    EXPECT_EQ(values.choice("Kind"), 0);
    EXPECT_EQ(values.integer("Count"), 4);
    EXPECT_EQ(values.real("Size"), 0);
    EXPECT_EQ(values.text("Word"), "hello");
    EXPECT_THROW(values.integer("Kind"), std::logic_error);
    EXPECT_THROW(values.boolean("Nonsense"), std::logic_error);
    ++runs;
  })});
  EXPECT_TRUE(plugin.run(document));
  model.cm.face[3].SetS();
  EXPECT_TRUE(plugin.run(document));
  model.cm.face[3].ClearS();
  EXPECT_TRUE(plugin.run(document, 0, [](RichParameterList& list) { list.clear(); })) << "left out: defaults";
  EXPECT_EQ(runs, 3);
}

TEST_F(FilterPluginTest, ADefaultThatTheDocumentDoesNotAllowIsTheFallback) {
  int runs = 0;
  FilterDeclaration filter = filter_with_parameters([&](FilterRun& run) {
    EXPECT_EQ(run.parameters.integer("Count"), 4);
    ++runs;
  });
  for (ParameterDeclaration& parameter : filter.parameters)
    if (parameter.name == "Count")
      parameter.document_default = [](const MeshDocument&) -> QVariant {
        throw CompletionError("reading the mesh", "It is broken.");
      };
  FakePlugin plugin({filter});
  EXPECT_TRUE(plugin.run(document));
  EXPECT_EQ(runs, 1);
}

TEST_F(FilterPluginTest, ValuesOutOfRangeOrOfAnotherKindAreRefused) {
  FakePlugin plugin({filter_with_parameters([](FilterRun&) { FAIL() << "must not run"; })});
  const auto refused = [&](const std::function<void(RichParameterList&)>& change, const char* message) {
    EXPECT_FALSE(plugin.run(document, 0, change));
    EXPECT_EQ(plugin.message(), message);
  };
  refused([](RichParameterList& list) { list.setValue("Count", IntValue(11)); },
          "Parameter \"Count\" must lie between 1 and 10 pieces; it is 11.");
  refused([](RichParameterList& list) { list.setValue("Size", AbsPercValue(-1)); },
          "Parameter \"Size\" must be at least 0 mesh units; it is -1.");
  refused([](RichParameterList& list) { list.setValue("Size", AbsPercValue(std::nanf(""))); },
          "Parameter \"Size\" must be a finite number.");
  refused([](RichParameterList& list) { list.setValue("Kind", EnumValue(2)); },
          "Parameter \"Kind\": 2 is not one of its 2 choices, which are counted from 0.");
  refused(
      [](RichParameterList& list) {
        list.clear();
        list.addParam(RichBool("Count", true));
      },
      "Parameter \"Count\" has a value of the wrong kind.");
}

TEST_F(FilterPluginTest, PointsAndLayersArrive) {
  model.cm.bbox = vcg::Box3<Scalarm>(Point3m(1, 2, 3), Point3m(3, 2, 4));
  const MeshModel* other = &test::layer_from(document, test::cube(), "other.ply");
  document.setCurrentMesh(model.id());
  const MeshModel* expected = nullptr;
  Vector3 centre(2, 2, 3.5);
  FilterDeclaration filter = filter_that([&](FilterRun& run) {
    EXPECT_EQ(run.parameters.point("Place"), centre);
    EXPECT_EQ(run.parameters.point("Direction"), Vector3(0, 0, 1));
    EXPECT_EQ(run.parameters.layer("Other"), expected);
    EXPECT_THROW(run.parameters.integer("Other"), std::logic_error);
    EXPECT_THROW(run.parameters.layer("Place"), std::logic_error);
  });
  filter.parameters = {centre_parameter("Place", "Place", "Where."),
                       point_parameter("Direction", "Direction", "Where to.", {0, 0, 1}),
                       layer_parameter("Other", "Other", "Which.")};
  FakePlugin plugin({filter});
  EXPECT_TRUE(plugin.run(document)) << qPrintable(plugin.message());
  EXPECT_TRUE(plugin.run(document, 0, [](RichParameterList& list) { list.clear(); })) << "left out: defaults";
  expected = other;
  centre = Vector3(-0.5, 0, 1e10f);
  EXPECT_TRUE(plugin.run(document, 0, [&](RichParameterList& list) {
    const auto& choice = dynamic_cast<const RichEnum&>(list.getParameterByName("Other"));
    EXPECT_EQ(choice.enumvalues, QStringList({"None", "mesh.ply", "other.ply"}));
    list.setValue("Place", Point3fValue(vcg::Point3f(-0.5f, 0, 1e10f)));
    list.setValue("Other", EnumValue(2));
  })) << qPrintable(plugin.message());
}

TEST_F(FilterPluginTest, WrongPointsAndLayersAreRefused) {
  FilterDeclaration filter = filter_that([](FilterRun&) { FAIL() << "must not run"; });
  filter.parameters = {point_parameter("Place", "Place", "Where.", {0, 0, 0}),
                       layer_parameter("Other", "Other", "Which.")};
  FakePlugin plugin({filter});
  EXPECT_FALSE(plugin.run(document, 0, [](RichParameterList& list) {
    list.setValue("Place", Point3fValue(vcg::Point3f(0, std::nanf(""), 0)));
  }));
  EXPECT_EQ(plugin.message(), "Parameter \"Place\" must be three finite numbers.");
  for (const int wrong : {-1, 2}) {
    EXPECT_FALSE(
        plugin.run(document, 0, [&](RichParameterList& list) { list.setValue("Other", EnumValue(wrong)); }));
    EXPECT_EQ(plugin.message(),
              QString("Parameter \"Other\": there is no layer %1; layers are counted from 1, and 0 is none.")
                  .arg(wrong));
  }
}

TEST_F(FilterPluginTest, ParametersCanBeAskedForWithoutAMesh) {
  MeshDocument empty;
  FilterDeclaration filter = filter_that([](FilterRun&) { FAIL() << "must not run"; });
  filter.parameters = {centre_parameter("Place", "Place", "Where."),
                       layer_parameter("Other", "Other", "Which.")};
  FakePlugin plugin({filter});
  EXPECT_FALSE(plugin.run(empty));
  EXPECT_TRUE(plugin.message().contains("no mesh"));
}

TEST_F(FilterPluginTest, ANumberAboveZeroIsNotZero) {
  double seen = -1;
  FilterDeclaration filter = filter_that([&](FilterRun& run) { seen = run.parameters.real("Price"); });
  filter.parameters = {positive_parameter("Price", "Price", "How much.", "coins", 0.25)};
  FakePlugin plugin({filter});
  EXPECT_TRUE(plugin.run(document));
  EXPECT_EQ(seen, 0.25);
  for (const float wrong : {0.0f, -1.0f}) {
    EXPECT_FALSE(
        plugin.run(document, 0, [&](RichParameterList& list) { list.setValue("Price", FloatValue(wrong)); }));
    EXPECT_EQ(plugin.message(),
              QString("Parameter \"Price\" must be greater than 0 coins; it is %1.").arg(double(wrong)));
  }
}

int percent_seen;
bool keep_going(const int percent, const char* stage) {
  EXPECT_STREQ(stage, "working");
  percent_seen = std::max(percent_seen, percent);
  return true;
}
bool stop_at_once(const int, const char*) { return false; }

TEST_F(FilterPluginTest, ProgressReachesMeshLabOnlyFromItsOwnThread) {
  static std::thread::id main_thread;
  main_thread = std::this_thread::get_id();
  percent_seen = -1;
  FakePlugin plugin({filter_that([](FilterRun& run) {
    const Progress part = run.progress.part(0, 1, "working");
    std::thread other([&part] {
      for (int i = 0; i < 50; ++i) part.update(0.01 * i);
    });
    other.join();
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    part.update(1);
  })});
  EXPECT_TRUE(plugin.run(document, 0, {}, [](const int percent, const char* stage) {
    EXPECT_EQ(std::this_thread::get_id(), main_thread);
    return keep_going(percent, stage);
  }));
  EXPECT_EQ(percent_seen, 100);
}

TEST_F(FilterPluginTest, CancellingFails) {
  FakePlugin plugin({filter_that([](FilterRun& run) {
    for (int i = 0; i <= 100; ++i) {
      run.progress.update(0.01 * i);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    FAIL() << "was not cancelled";
  })});
  EXPECT_FALSE(plugin.run(document, 0, {}, stop_at_once));
  EXPECT_EQ(plugin.message(), "Cancelled. The mesh was not changed.");
  plugin.set_progress_receiver([](double, const std::string&) { return false; });
  EXPECT_FALSE(plugin.run(document, 0, {}, keep_going)) << "the receiver replaces MeshLab's callback";
}

}  // namespace
}  // namespace host
}  // namespace meshcomplete
