#include "filter_volmorph/filter_volumeresults.h"

#include <QDir>
#include <QImage>
#include <algorithm>

#include "common/core/error.h"
#include "common/host/meshlab_version.h"
#include "common/host/parameter_blocks.h"
#include "filter_volmorph/filter_volumelayers.h"
#include "filter_volmorph/filter_volumelog.h"
#include "filter_volmorph/surface_extraction.h"
#include "filter_volmorph/volume_file.h"
#include "filter_volmorph/volume_slice.h"

namespace meshcomplete {
namespace host {
namespace {

/// Of a slice that becomes a layer: two faces each, about 3 GB in all.
constexpr std::size_t most_layer_pixels = 16000000;

void apply_extract(FilterRun& run) {
  const MeshModel& layer = volume_layer(run);
  const RangeVolume& volume = *volume_of(layer);
  ExtractionOptions options;
  options.observed_only = run.parameters.boolean("ObservedOnly");
  options.smallest_component = static_cast<std::size_t>(run.parameters.integer("SmallestComponent"));
  const TriangleMesh surface =
      extract_surface(volume, options, run.progress.part(0, 0.5, "extracting the surface"));
  if (surface.triangles.empty())
    throw CompletionError("extracting the surface",
                          "There is no surface in this volume: nothing of it is inside, or all components "
                          "are smaller than asked for.");
  const SurfaceOrigins origins =
      surface_origins(volume, surface, run.progress.part(0.5, 0.55, "measuring the surface"));
  log_origins(run, origins, "Surface");
  if (run.parameters.boolean("Measure"))
    log_topology(run, volume, surface, "Surface", run.progress.part(0.55, 1, "measuring the surface"));
  add_surface_layer(run.document, layer, surface, origins, run.parameters.boolean("FilledSelected"));
}

QString axis_name(int axis) { return QString("xyz").mid(axis, 1); }

QString describe(const VolumeCounts& counts) {
  return QString("%1 seen, %2 unseen, %3 empty").arg(counts.seen).arg(counts.unseen).arg(counts.empty);
}

void save_image(const VolumeSlice& slice, const QString& path) {
  const QImage image(slice.pixels.data(), slice.width, slice.height, 3 * slice.width, QImage::Format_RGB888);
  if (!image.save(path, "PNG"))
    throw CompletionError(
        "writing the slices",
        "The image " + path.toStdString() +
            " could not be written. Choose a folder that you may write to, with enough room.");
}

// Every slice along an axis.
void save_images(FilterRun& run, const RangeVolume& volume, SliceOptions options, const QString& folder) {
  if (!QDir().mkpath(folder))
    throw CompletionError("writing the slices", "The folder " + folder.toStdString() + " could not be made.");
  const VoxelBox& box = volume.frame().box;
  options.largest_weight = std::max(largest_weight(volume), std::numeric_limits<float>::min());
  const int first = box.low[options.axis], last = box.high[options.axis];
  const double share = 1.0 / (last - first + 1);
  VolumeCounts sum;
  for (options.position = first; options.position <= last; ++options.position) {
    const double done = share * (options.position - first);
    const VolumeSlice slice =
        make_slice(volume, options, run.progress.part(done, done + share / 2, "writing the slices"));
    save_image(
        slice,
        QDir(folder).filePath(
            QString("%1_%2.png").arg(axis_name(options.axis)).arg(options.position, 4, 10, QChar('0'))));
    sum.seen += slice.counts.seen;
    sum.unseen += slice.counts.unseen;
    sum.empty += slice.counts.empty;
    run.progress.update(done + share);
  }
  run.log(QString("%1 slices along %2 in %3: %4")
              .arg(QString::number(last - first + 1), axis_name(options.axis), folder, describe(sum)));
}

void apply_slice(FilterRun& run) {
  const ParameterValues& values = run.parameters;
  const MeshModel& layer = volume_layer(run);
  const RangeVolume& volume = *volume_of(layer);
  SliceOptions options;
  options.axis = values.choice("Axis");
  options.view = static_cast<SliceView>(values.choice("View"));
  const QString folder = values.text("Folder");
  if (!folder.isEmpty()) return save_images(run, volume, options, folder);
  const VoxelBox& box = volume.frame().box;
  const int middle = (box.low[options.axis] + box.high[options.axis]) / 2;
  options.position = values.boolean("Middle") ? middle : values.integer("Position");
  options.most_pixels = most_layer_pixels;
  const VolumeSlice slice = make_slice(volume, options, run.progress);
  const QString name =
      QString("%1 %2 = %3").arg(layer.label(), axis_name(options.axis), QString::number(options.position));
  run.log(name + ": " + describe(slice.counts));
  add_slice_layer(run.document, layer, slice, name);
}

void apply_save(FilterRun& run) {
  const QString path = run.parameters.text("File");
  if (path.isEmpty()) throw CompletionError("saving the volume", "Choose a file: parameter File is empty.");
  save_volume(*volume_of(volume_layer(run)), path.toStdString(), run.progress);
  run.log("Saved in " + path);
}

FilterDeclaration extract_filter() {
  FilterDeclaration filter;
  filter.name = "Range Volume: Extract Surface";
  filter.python_name = "range_volume_extract_surface";
  filter.description =
      "Makes a mesh of the surface in the current layer's volume, in a new layer, by marching cubes: "
      "manifold always, without degenerate faces or "
      "intersections, and closed, since what no scanner saw is bounded by what they looked through (VRIP's "
      "filler). Its quality is the weight with which the scanners saw it, and 0 where a filler made it."
      "<br>See: <br/><i>Brian Curless, Marc Levoy</i><br/><b>\"A volumetric method for building complex "
      "models from range images\"</b><br/>SIGGRAPH 1996.";
  filter.place = MenuPlace::range_map;
  filter.parameters = {
      switch_parameter(
          "ObservedOnly", "Observed surface only",
          "Holes stay open where nothing was observed, for a filter that closes holes of meshes.", false),
      integer_parameter("SmallestComponent", "Smallest component",
                        "Components with fewer faces are left out. 0 keeps all.", "faces", 0, 0, 2000000000),
      switch_parameter("FilledSelected", "Select what was not observed",
                       "The faces that a filler made become the face selection, for example to smooth or "
                       "colour them afterwards.",
                       true),
      switch_parameter("Measure", "Measure",
                       "Logs genus, components, boundary loops, and the lengths and places of handles.",
                       true)};
  filter.apply = apply_extract;
  return filter;
}

FilterDeclaration slice_filter() {
  FilterDeclaration filter;
  filter.name = "Range Volume: Slice";
  filter.python_name = "range_volume_slice";
  filter.description =
      "Shows a slice through the current layer's volume in a new layer, or writes images of all slices to a "
      "folder. States: empty "
      "black, unseen brown, seen white. Faces that are selected in a slice choose the box of \"Range Volume: "
      "Morphology\" and \"Range Volume: Fill\"."
      "<br>See: <br/><i>Eric Firestone</i><br/><b>\"An Exploration of Hole Filling Algorithms\"</b><br/>"
      "Master's thesis, California Polytechnic State University, San Luis Obispo, 2008, section 3.2.";
  filter.place = MenuPlace::range_map;
  filter.parameters = {
      choice_parameter("Axis", "Axis", "The slice is perpendicular to this axis.", {"x", "y", "z"}, 2),
      switch_parameter("Middle", "In the middle",
                       "The slice is in the middle of the volume, and Position does not count.", true),
      integer_parameter("Position", "Position", "Of the slice along the axis; voxels are counted from 0.",
                        "voxels", 0, 0, 1000000000),
      choice_parameter("View", "View",
                       "States; normals, as colours; or weights, black for none to white for the largest.",
                       {"States", "Normals", "Weights"}),
      text_parameter("Folder", "Folder",
                     "Where images of all slices along the axis are written (PNG); it is made if need be. "
                     "Empty: one slice, as a layer.",
                     "")};
  filter.apply = apply_slice;
  return filter;
}

FilterDeclaration save_filter() {
  FilterDeclaration filter;
  filter.name = "Range Volume: Save";
  filter.python_name = "range_volume_save";
  filter.description =
      "Saves the current layer's volume in a file (.vdb) that \"Range Volume: Open\" and OpenVDB's own "
      "programs open.";
  filter.place = MenuPlace::range_map;
  filter.parameters = {file_parameter("File", "File", "The .vdb file.", ParameterType::save_file)};
  filter.apply = apply_save;
  filter.changes_mesh = false;
  return filter;
}

}  // namespace

std::vector<FilterDeclaration> volume_result_filters() {
  return {extract_filter(), slice_filter(), save_filter()};
}

}  // namespace host
}  // namespace meshcomplete
