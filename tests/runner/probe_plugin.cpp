#include "probe_plugin.h"

#include <vcg/complex/allocate.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <limits>
#include <thread>

#include "common/core/error.h"
#include "common/host/layers.h"
#include "common/host/meshlab_version.h"
#include "common/host/other_layers.h"
#include "common/host/parameter_blocks.h"

namespace {

using namespace meshcomplete;
using namespace meshcomplete::host;

constexpr auto tick = std::chrono::milliseconds(5);

ParameterDeclaration parameter(ParameterType type, const char* name, const QVariant& fallback,
                               const char* meaning) {
  ParameterDeclaration declaration;
  declaration.type = type;
  declaration.name = name;
  declaration.label = name;
  declaration.meaning = meaning;
  declaration.fallback = fallback;
  return declaration;
}

ParameterDeclaration ranged(ParameterDeclaration declaration, double minimum, double maximum,
                            const char* unit) {
  declaration.minimum = minimum;
  declaration.maximum = maximum;
  declaration.unit = unit;
  return declaration;
}

/// Works for so many seconds in small steps, like a filter that can be cancelled everywhere.
void work(const Progress& progress, double seconds) {
  const auto start = std::chrono::steady_clock::now();
  for (double spent = 0; spent < seconds;) {
    spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    progress.update(seconds > 0 ? spent / seconds : 1);
    std::this_thread::sleep_for(tick);
  }
  progress.check();
}

HoleReport hole(HoleOutcome outcome) {
  HoleReport report;
  report.loops = {0, 2};
  report.edges = 7;
  report.perimeter = std::numeric_limits<double>::quiet_NaN();
  report.centre = Vector3(1, 2, 3);
  report.outcome = outcome;
  report.route = "probe \"route\"";
  report.reason = outcome == HoleOutcome::closed ? "" : "because of a \\ and a \xc3\xa9\n";
  report.faces_added = 1;
  return report;
}

/// Adds one triangle over the first three vertices, and reports one hole with the outcome asked for.
void apply_probe(FilterRun& run) {
  const ParameterValues& values = run.parameters;
  run.log(QString("Count=%1 Real=%2 Length=%3 Kind=%4 Text=%5")
              .arg(values.integer("Count"))
              .arg(values.real("Real"))
              .arg(values.real("Length"))
              .arg(values.choice("Kind"))
              .arg(values.text("Text")));
  work(run.progress.part(0, 1, "probing"), values.real("Seconds"));
  if (values.boolean("Fail")) throw CompletionError("probing", "The probe was told to fail.");
  run.report.stage_seconds.emplace_back("probing", values.real("Seconds"));
  run.report.notes.push_back("a note");
  run.report.figures = {{"some number", 0.5}, {"no number", std::numeric_limits<double>::infinity()}};
  const HoleOutcome outcomes[] = {HoleOutcome::closed, HoleOutcome::partial, HoleOutcome::skipped,
                                  HoleOutcome::failed};
  run.report.holes.push_back(hole(outcomes[values.choice("Outcome")]));
  CMeshO& mesh = run.document.mm()->cm;
  if (mesh.vert.size() >= 3 && values.boolean("Change"))
    vcg::tri::Allocator<CMeshO>::AddFace(mesh, &mesh.vert[0], &mesh.vert[2], &mesh.vert[1]);
}

FilterDeclaration probe() {
  FilterDeclaration filter;
  filter.name = "Probe: Everything";
  filter.python_name = "probe_everything";
  filter.description = "Does what its parameters say.<br>See: <i>nobody</i>.";
  filter.parameters = {
      parameter(ParameterType::boolean, "Fail", false, "Fail."),
      parameter(ParameterType::boolean, "Change", true, "Add a triangle."),
      ranged(parameter(ParameterType::integer, "Count", 5, "A number."), 0, 100, "edges"),
      parameter(ParameterType::real, "Real", 0.5, "A number with a fraction."),
      parameter(ParameterType::real, "Seconds", 0.0, "How long to work."),
      ranged(parameter(ParameterType::length, "Length", 0.25, "A length."), 0,
             std::numeric_limits<double>::infinity(), "mesh units"),
      parameter(ParameterType::choice, "Kind", 1, "A choice."),
      parameter(ParameterType::choice, "Outcome", 0, "What becomes of the hole."),
      parameter(ParameterType::text, "Text", "abc", "Any text."),
  };
  filter.parameters[6].choices = QStringList{"automatic", "annealing", "descent"};
  filter.parameters[7].choices = QStringList{"closed", "partial", "skipped", "failed"};
  filter.parameters[5].default_in_words = "a quarter";
  filter.apply = apply_probe;
  return filter;
}

/// Says what it was given.
FilterDeclaration layers() {
  FilterDeclaration filter;
  filter.name = "Probe: Layers";
  filter.python_name = "probe_layers";
  filter.description = "Looks at another layer.";
  filter.parameters = {layer_parameter("Other", "Other", "Another layer."),
                       centre_parameter("Place", "Place", "A place."),
                       positive_parameter("Price", "Price", "A price.", "coins", 2)};
  filter.apply = [](FilterRun& run) {
    const MeshModel* other = run.parameters.layer("Other");
    const Vector3 place = run.parameters.point("Place");
    run.log(QString("Other=%1 Points=%2 Views=%3 Place=%4 %5 %6.")
                .arg(other == nullptr ? "none" : other->label())
                .arg(other_layer_points(run, "Other").size())
                .arg(layer_views(run).size())
                .arg(place.x())
                .arg(place.y())
                .arg(place.z()));
  };
  return filter;
}

/// Gives the current layer a camera of parallel rays.
FilterDeclaration parallel_camera() {
  FilterDeclaration filter;
  filter.name = "Probe: Parallel Camera";
  filter.python_name = "probe_parallel_camera";
  filter.description = "Sets an orthographic camera.";
  filter.parameters = {point_parameter("From", "From", "Where it stands.", Vector3(0, 0, 1)),
                       point_parameter("Towards", "Towards", "Where it looks.", Vector3(0, 0, -1))};
  filter.apply = [](FilterRun& run) {
    const Vector3 from = run.parameters.point("From"), towards = run.parameters.point("Towards");
    Shotm& shot = run.document.mm()->cm.shot;
    shot.Intrinsics.SetOrtho(-1, 1, -1, 1, vcg::Point2i(100, 100));
    shot.Intrinsics.PixelSizeMm = vcg::Point2<Scalarm>(1, 1);
    shot.SetViewPoint(as_point(from));
    shot.LookTowards(as_point(towards), Point3m(0, 1, 0));
  };
  return filter;
}

/// Code that goes wrong in ways that a filter must not.
FilterDeclaration bad_code() {
  FilterDeclaration filter;
  filter.name = "Probe: Bad Code";
  filter.python_name = "probe_bad_code";
  filter.description = "Crashes, aborts, or does not listen.";
  filter.parameters = {parameter(ParameterType::choice, "How", 0, "What to do.")};
  filter.parameters[0].choices = QStringList{"crash", "abort", "deaf", "throw"};
  filter.apply = [](FilterRun& run) {
    const int how = run.parameters.choice("How");
    if (how == 0) std::raise(SIGSEGV);
    if (how == 1) std::abort();
    if (how == 2) std::this_thread::sleep_for(std::chrono::seconds(60));
    throw 42;
  };
  return filter;
}

}  // namespace

ProbePlugin::ProbePlugin() { declare({probe(), layers(), parallel_camera(), bad_code()}, this); }
