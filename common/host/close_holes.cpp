#include "common/host/close_holes.h"

#include <QRegularExpression>
#include <chrono>

#include "common/host/append.h"
#include "common/host/hole_log.h"
#include "common/host/snapshot.h"

namespace meshcomplete {
namespace host {
namespace {

/// Adds the wall time between construction and `stop` to the report.
class Stopwatch {
 public:
  void stop(CompletionReport& report, const char* stage) {
    const auto now = std::chrono::steady_clock::now();
    report.stage_seconds.emplace_back(stage, std::chrono::duration<double>(now - start_).count());
    start_ = now;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// "bunny.ply" becomes "bunny (closed)": MeshLab's list of layers shows a name only up to its first dot.
QString derived_name(const QString& name, const QString& what) {
  static const QRegularExpression extension("\\.[A-Za-z][A-Za-z0-9]{1,3}$");
  return QString("%1 (%2)").arg(QString(name).remove(extension), what);
}

// Whether there is anything to make a layer of.
bool changes_something(const ClosedHoles& result) {
  const bool removes = result.removed && !result.removed->empty();
  return !result.completion.patch.empty() || (result.cleaned && (removes || !result.splits.empty()));
}

// Where there is no new layer, nothing is removed.
void list_removed(const Snapshot& input, const ClosedHoles& result, CompletionReport& report) {
  if (!result.removed || !changes_something(result)) return;
  for (const Index triangle : *result.removed)
    report.removed_faces.push_back(input.face_of_triangle[triangle]);
  for (const VertexSplit& split : result.splits) report.split_vertices.push_back(split.vertex);
}

void append_result(FilterRun& run, MeshModel& model, const Snapshot& input, const ClosedHoles& result) {
  const Patch& patch = result.completion.patch;
  AppendOptions options;
  options.select_new_faces = run.parameters.boolean("NewFaceSelected");
  const QString name = model.label();
  options.left_out = run.report.removed_faces;
  options.splits = result.splits;
  options.leave_out_vertices = result.cleaned;
  const bool new_layer = result.removed || run.parameters.boolean("AsNewLayer");
  if (new_layer && changes_something(result))
    append_patch_to_copy(run.document, model, input.mesh, patch, derived_name(name, "closed"), options);
  else
    append_patch(model, input.mesh, patch, options);
  for (const ExtraLayer& layer : result.layers)
    if (!layer.mesh.triangles.empty())
      add_layer(run.document, layer.mesh, derived_name(name, layer.suffix), model);
}

}  // namespace

void close_holes(FilterRun& run, const CloseHolesAlgorithm& algorithm) {
  const HoleSelectionOptions holes = hole_selection_options(run.parameters);
  MeshModel& model = *run.document.mm();
  Stopwatch watch;
  const Snapshot input = snapshot(model);
  run.progress.check();
  CompletionReport reading;
  watch.stop(reading, "reading the mesh");
  const ClosedHoles result =
      algorithm(input.mesh, input.selection, holes, run.progress.part(0.02, 0.95, "closing holes"));
  run.report = result.completion.report;
  list_removed(input, result, run.report);
  run.report.stage_seconds.insert(run.report.stage_seconds.begin(), reading.stage_seconds.front());
  run.progress.check();
  watch = Stopwatch();
  append_result(run, model, input, result);
  watch.stop(run.report, "appending the patch");
  for (const QString& line : describe_holes(run.report)) run.log(line);
}

}  // namespace host
}  // namespace meshcomplete
