#include "filter_volmorph/filter_volumesources.h"

#include <QFileInfo>
#include <utility>

#include "common/core/error.h"
#include "common/core/stage_clock.h"
#include "common/host/layers.h"
#include "common/host/meshlab_version.h"
#include "common/host/other_layers.h"
#include "common/host/parameter_blocks.h"
#include "filter_volmorph/filter_volumelayers.h"
#include "filter_volmorph/filter_volumelog.h"
#include "filter_volmorph/filter_volumescans.h"
#include "filter_volmorph/scan_merge.h"
#include "filter_volmorph/surroundings.h"
#include "filter_volmorph/volume_file.h"
#include "filter_volmorph/voxelize_mesh.h"

namespace meshcomplete {
namespace host {
namespace {

QVariant edge_of_first_scan(const MeshDocument& document) {
  for (const MeshModel* layer : document.meshList)
    if (layer->visible && layer->cm.fn > 0 && !is_slice(*layer))
      return median_edge(layer_surface(*layer).mesh);
  return QVariant();
}

QVariant edge_of_current_layer(const MeshDocument& document) {
  const MeshModel* layer = document.mm();
  if (layer == nullptr) return QVariant();
  // Any length does where there are no faces: it is the filter that says so then, and not the parameter.
  return layer->cm.fn > 0 ? median_edge(layer_surface(*layer).mesh) : layer->cm.bbox.Diag();
}

std::vector<ParameterDeclaration> size_parameters(QVariant (*default_size)(const MeshDocument&),
                                                  const char* default_in_words) {
  ParameterDeclaration size = length_parameter("VoxelSize", "Voxel size",
                                               "The side of a voxel. Half of it takes four times the memory. "
                                               "A percentage is of the bounding box's diagonal.");
  size.document_default = default_size;
  size.default_in_words = default_in_words;
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

RangeVolume without_surroundings(FilterRun& run, const RangeVolume& volume, const Progress& progress) {
  StageClock clock(run.report);
  const SurroundingsResult result = empty_surroundings(volume, progress);
  clock.end_of("emptying the surroundings");
  run.log(QString("Surroundings: %1 unseen voxels before the observed surface are empty now")
              .arg(result.emptied));
  return result.volume;
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
  const bool surroundings = values.boolean("Surroundings");
  ScanMerge merge = merge_scans(visible_scans(run), options,
                                surroundings ? run.progress.part(0, 0.8, "merging scans") : run.progress);
  for (const ScanFigures& scan : merge.scans) log_scan(run, scan);
  run.report.stage_seconds = std::move(merge.stage_seconds);
  if (surroundings) merge.volume = without_surroundings(run, merge.volume, run.progress.part(0.8, 1, ""));
  log_volume(run, merge.volume);
  add_volume_layer(run.document, merge.volume, "range volume");
}

// Layers of which no volume can be made.
void refuse_other_than_meshes(const MeshModel& layer) {
  const char* const stage = "reading the mesh";
  if (volume_of(layer) != nullptr)
    throw CompletionError(stage, "The layer " + quoted(layer) +
                                     " holds a range volume, and what it shows is no mesh. Make the layer of "
                                     "a mesh current; a volume's own surface comes from \"Range Volume: "
                                     "Extract Surface\".");
  if (is_slice(layer))
    throw CompletionError(stage, "The layer " + quoted(layer) +
                                     " shows a slice of a range volume. Make the layer of a mesh current.");
  if (layer.cm.fn == 0)
    throw CompletionError(stage, "The layer " + quoted(layer) +
                                     " has no faces. Triangulate its points first, for example with "
                                     "\"Surface Reconstruction: Ball Pivoting\".");
}

void apply_voxelize(FilterRun& run) {
  const MeshModel& current = *run.document.mm();
  refuse_other_than_meshes(current);
  VoxelizedMesh made = voxelize_mesh(layer_surface(current).mesh, size_options(run.parameters), run.progress);
  if (made.rim_edges > 0)
    run.log(
        QString::number(made.rim_edges) +
        " edges at holes: what lies behind them was not seen. Nobody looked through what lies before them, "
        "either: \"Range Volume: Fill\" closes wide holes better with its line of sight off");
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
  filter.parameters = size_parameters(edge_of_first_scan, "the median edge of the first visible layer");
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
      switch_parameter("Surroundings", "Empty surroundings",
                       "Unseen space that lies before the observed surface becomes empty. Without, only what "
                       "scanners looked through is empty, as published.",
                       true),
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
  filter.parameters = size_parameters(edge_of_current_layer, "the median edge of the current layer");
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
