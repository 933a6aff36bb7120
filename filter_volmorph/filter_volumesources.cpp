#include "filter_volmorph/filter_volumesources.h"

#include <QFileInfo>
#include <utility>

#include "common/core/error.h"
#include "common/host/close_holes_parameters.h"
#include "common/host/meshlab_version.h"
#include "common/host/other_layers.h"
#include "filter_volmorph/filter_volumelayers.h"
#include "filter_volmorph/filter_volumelog.h"
#include "filter_volmorph/scan_merge.h"
#include "filter_volmorph/volume_file.h"
#include "filter_volmorph/voxelize_mesh.h"

namespace meshcomplete {
namespace host {
namespace {

const char* const reading = "reading the scans";

enum class Sight { automatic, camera, viewpoint, own_axis, frame_axis };

QString quoted(const MeshModel& layer) { return "\"" + layer.label() + "\""; }

// The median edge of the first visible layer with faces.
QVariant default_voxel_size(const MeshDocument& document) {
  for (const MeshModel* layer : document.meshList)
    if (layer->visible && layer->cm.fn > 0 && !is_slice(*layer))
      return median_edge(layer_surface(*layer).mesh);
  return QVariant();
}

std::vector<ParameterDeclaration> size_parameters() {
  ParameterDeclaration size = length_parameter("VoxelSize", "Voxel size",
                                               "The side of a voxel. Half of it takes four times the memory. "
                                               "A percentage is of the bounding box's diagonal.");
  size.document_default = default_voxel_size;
  size.default_in_words = "the median edge of the first visible layer";
  size.above_minimum = true;
  return {size,
          length_parameter("Ramp", "Ramp",
                           "How far from an observed surface voxels hold its distance, on both sides: above "
                           "the noise of the scans, below half the thinnest wall. 0: four voxels."),
          positive_parameter(
              "MaxMemory", "Maximum memory",
              "A volume that would need more is not made; the message says which voxel size would do.",
              "gigabytes", 4)};
}

VolumeSizeOptions size_options(const ParameterValues& values) {
  VolumeSizeOptions options;
  options.voxel_size = values.real("VoxelSize");
  if (values.real("Ramp") > 0) options.ramp = values.real("Ramp");
  options.max_memory = 1e9 * values.real("MaxMemory");
  return options;
}

LineOfSight line_of_sight(const MeshModel& layer, Sight sight, const Vector3& viewpoint) {
  const bool camera = layer.cm.shot.IsValid();
  if (sight == Sight::camera && !camera)
    throw CompletionError(
        reading,
        ("The layer " + quoted(layer) + " has no camera. Choose another line of sight.").toStdString());
  if (sight == Sight::camera || (sight == Sight::automatic && camera)) {
    const Point3m from = layer.cm.shot.GetViewPoint();
    return LineOfSight::from(point_in_project(layer, Vector3(from[0], from[1], from[2])));
  }
  if (sight == Sight::viewpoint) return LineOfSight::from(viewpoint);
  if (sight == Sight::frame_axis) return LineOfSight::parallel(direction_in_project(layer, Vector3::UnitZ()));
  return LineOfSight::own_axis();
}

std::vector<RangeScan> visible_scans(FilterRun& run) {
  const Sight sight = static_cast<Sight>(run.parameters.choice("LineOfSight"));
  std::vector<RangeScan> scans;
  for (const MeshModel* layer : run.document.meshList) {
    if (!layer->visible || volume_of(*layer) != nullptr || is_slice(*layer)) continue;
    if (layer->cm.fn == 0)
      throw CompletionError(reading, ("The layer " + quoted(*layer) +
                                      " has no faces. Hide it, or triangulate its points first.")
                                         .toStdString());
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
  run.log(QString("%1: %2 faces, %3 dropped (%4 long, %5 grazing, %6 from behind, %7 degenerate); seen %8 "
                  "(%9 %10 %11)")
              .arg(QString::fromStdString(scan.name))
              .arg(faces.kept)
              .arg(faces.dropped())
              .arg(faces.long_edge)
              .arg(faces.grazing)
              .arg(faces.from_behind)
              .arg(faces.degenerate)
              .arg(parallel ? "along" : "from")
              .arg(v[0], 0, 'g', 4)
              .arg(v[1], 0, 'g', 4)
              .arg(v[2], 0, 'g', 4));
}

void apply_merge(FilterRun& run) {
  const ParameterValues& values = run.parameters;
  ScanMergeOptions options;
  options.size = size_options(values);
  options.carving = values.boolean("Carving");
  if (values.real("LongestEdge") > 0) options.depth_steps.longest_edge = values.real("LongestEdge");
  options.depth_steps.grazing_angle = values.real("GrazingAngle");
  options.grazing_power = values.real("GrazingPower");
  if (values.real("BoundaryFalloff") > 0) options.boundary_falloff = values.real("BoundaryFalloff");
  ScanMerge merge = merge_scans(visible_scans(run), options, run.progress);
  for (const ScanFigures& scan : merge.scans) log_scan(run, scan);
  log_volume(run, merge.volume);
  run.report.stage_seconds = std::move(merge.stage_seconds);
  add_volume_layer(run.document, merge.volume, "range volume");
}

void apply_voxelize(FilterRun& run) {
  const MeshModel& current = *run.document.mm();
  VoxelizedMesh made = voxelize_mesh(layer_surface(current).mesh, size_options(run.parameters), run.progress);
  if (made.rim_edges > 0)
    run.log(QString::number(made.rim_edges) + " edges at holes: what lies behind them was not seen");
  log_volume(run, made.volume);
  run.report.stage_seconds = std::move(made.stage_seconds);
  add_volume_layer(run.document, made.volume, current.label() + " volume");
}

void apply_open(FilterRun& run) {
  const QString path = run.parameters.text("File");
  if (path.isEmpty()) throw CompletionError("opening the volume", "Choose a file: parameter File is empty.");
  const RangeVolume volume = open_volume(path.toStdString(), run.progress);
  log_volume(run, volume);
  add_volume_layer(run.document, volume, QFileInfo(path).fileName());
}

FilterDeclaration merge_filter() {
  FilterDeclaration filter;
  filter.name = "Range Volume: Merge Scans";
  filter.python_name = "range_volume_merge_scans";
  filter.description =
      "Merges all visible layers, each an aligned range scan, into one volume in a new layer: every voxel is "
      "seen (near "
      "an observed surface, with its distance), empty (a scanner looked through it) or unseen. The scans "
      "stay as they are."
      "<br>See: <br/><i>Brian Curless, Marc Levoy</i><br/><b>\"A volumetric method for building complex "
      "models from range images\"</b><br/>"
      "SIGGRAPH 1996, and <br/><i>Eric Firestone</i><br/><b>\"An Exploration of Hole Filling "
      "Algorithms\"</b><br/>"
      "Master's thesis, California Polytechnic State University, 2008.";
  filter.place = MenuPlace::range_map;
  filter.arity = Arity::visible_meshes;
  filter.parameters = size_parameters();
  const std::vector<ParameterDeclaration> more = {
      choice_parameter(
          "LineOfSight", "Line of sight",
          "From where the scans were seen. Automatic: the layer's camera, or without one the scan's own "
          "axis, which is estimated from the edges across depth steps. Z axis: along the z axis of "
          "each layer, before its transformation, as in Stanford's range scans.",
          {"Automatic", "Camera of each layer", "Viewpoint", "Own axis of each scan",
           "Z axis of each layer"}),
      point_parameter("Viewpoint", "Viewpoint",
                      "Where the scanner stood, for the line of sight of that name.", Vector3::Zero()),
      switch_parameter("Carving", "Space carving",
                       "What a scanner looked through becomes empty. Without, it stays unseen.", true),
      length_parameter(
          "LongestEdge", "Longest edge",
          "Longer faces of a scan lie across a depth step and are left out. 0: four times its median edge."),
      angle_parameter("GrazingAngle", "Grazing angle",
                      "Faces that are seen at a larger angle to their normal are left out.", 75),
      at_least_zero_parameter("GrazingPower", "Grazing weight",
                              "The weight of a scan falls off as the cosine of that angle to this power.", 1),
      length_parameter(
          "BoundaryFalloff", "Boundary falloff",
          "How far from its boundary a scan has its full weight. 0: four times its median edge.")};
  filter.parameters.insert(filter.parameters.end(), more.begin(), more.end());
  filter.apply = apply_merge;
  return filter;
}

FilterDeclaration voxelize_filter() {
  FilterDeclaration filter;
  filter.name = "Range Volume: Voxelize Mesh";
  filter.python_name = "range_volume_voxelize_mesh";
  filter.description =
      "Makes a range volume of the current layer, a mesh with or without holes, in a new layer, as if it had "
      "been seen from all sides: "
      "voxels near it are seen, the rest is unseen inside and empty outside. Holes stay open there until a "
      "filler fills them.";
  filter.place = MenuPlace::range_map;
  filter.parameters = size_parameters();
  filter.apply = apply_voxelize;
  return filter;
}

FilterDeclaration open_filter() {
  FilterDeclaration filter;
  filter.name = "Range Volume: Open";
  filter.python_name = "range_volume_open";
  filter.description = "Opens a range volume that \"Range Volume: Save\" has saved (.vdb), in a new layer.";
  filter.place = MenuPlace::range_map;
  filter.arity = Arity::no_mesh;
  filter.parameters = {file_parameter("File", "File", "The .vdb file.", ParameterType::open_file)};
  filter.apply = apply_open;
  return filter;
}

}  // namespace

std::vector<FilterDeclaration> volume_source_filters() {
  return {merge_filter(), voxelize_filter(), open_filter()};
}

}  // namespace host
}  // namespace meshcomplete
