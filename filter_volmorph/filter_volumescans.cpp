#include "filter_volmorph/filter_volumescans.h"

#include "common/core/error.h"
#include "common/host/layers.h"
#include "common/host/other_layers.h"
#include "filter_volmorph/filter_volumelayers.h"

namespace meshcomplete {
namespace host {
namespace {

const char* const reading = "reading the scans";

enum class Sight { automatic, camera, viewpoint, own_axis, frame_axis };

LineOfSight line_of_sight(const MeshModel& layer, Sight sight, const Vector3& viewpoint) {
  const bool camera = layer.cm.shot.IsValid();
  if (sight == Sight::camera && !camera)
    throw CompletionError(reading,
                          "The layer " + quoted(layer) + " has no camera. Choose another line of sight.");
  if (sight == Sight::camera || (sight == Sight::automatic && camera)) {
    // The camera looks against its third axis.
    if (layer.cm.shot.Intrinsics.IsOrtho())
      return LineOfSight::parallel(direction_in_project(layer, as_vector(layer.cm.shot.Axis(2))));
    return LineOfSight::from(point_in_project(layer, as_vector(layer.cm.shot.GetViewPoint())));
  }
  if (sight == Sight::viewpoint) return LineOfSight::from(viewpoint);
  if (sight == Sight::frame_axis) return LineOfSight::parallel(direction_in_project(layer, Vector3::UnitZ()));
  return LineOfSight::own_axis();
}

}  // namespace

std::vector<RangeScan> visible_scans(FilterRun& run) {
  const Sight sight = static_cast<Sight>(run.parameters.choice("LineOfSight"));
  std::vector<RangeScan> scans;
  for (const MeshModel* layer : run.document.meshList) {
    if (!layer->visible || volume_of(*layer) != nullptr || is_slice(*layer)) continue;
    if (is_extracted(*layer)) {
      run.log("Left out: " + layer->label() + ", a surface that was extracted from a volume and is no scan");
      continue;
    }
    if (layer->cm.fn == 0)
      throw CompletionError(reading, "The layer " + quoted(*layer) +
                                         " has no faces. Hide it, or triangulate its points first.");
    scans.push_back({layer_surface(*layer).mesh,
                     line_of_sight(*layer, sight, run.parameters.point("Viewpoint")),
                     layer->label().toStdString()});
  }
  if (scans.empty())
    throw CompletionError(
        reading,
        "There is no visible layer with faces. Open the range scans, or a project with them, first.");
  return scans;
}

void log_scan(const FilterRun& run, const ScanFigures& scan) {
  const DepthStepCounts& faces = scan.faces;
  const Vector3& v = scan.line_of_sight.vector;
  const bool parallel = scan.line_of_sight.kind == LineOfSight::Kind::parallel;
  const auto number = [](double x) { return QString::number(x, 'g', 4); };
  const QString dropped = QString("%1 long, %2 grazing, %3 from behind, %4 degenerate")
                              .arg(faces.long_edge)
                              .arg(faces.grazing)
                              .arg(faces.from_behind)
                              .arg(faces.degenerate);
  const QString seen =
      QString("%1 (%2 %3 %4)").arg(parallel ? "along" : "from", number(v[0]), number(v[1]), number(v[2]));
  // Together: what looks like a place for an argument in the name is none.
  run.log(QString("%1: %2 faces, %3 dropped (%4); seen %5")
              .arg(QString::fromStdString(scan.name), QString::number(faces.kept),
                   QString::number(faces.dropped()), dropped, seen));
}

}  // namespace host
}  // namespace meshcomplete
