#include "filter_volmorph/filter_volumechanges.h"

#include <functional>
#include <utility>

#include "common/host/meshlab_version.h"
#include "common/host/parameter_blocks.h"
#include "filter_volmorph/filter_volumebox.h"
#include "filter_volmorph/filter_volumelayers.h"
#include "filter_volmorph/filter_volumelog.h"
#include "filter_volmorph/operator_sequence.h"
#include "filter_volmorph/surface_extraction.h"
#include "filter_volmorph/volume_diffusion.h"

namespace meshcomplete {
namespace host {
namespace {

std::vector<ParameterDeclaration> result_parameters() {
  return {
      switch_parameter("Measure", "Measure",
                       "Extracts the surface before and after, and logs its genus, components, boundary "
                       "loops, and the lengths of its handles.",
                       true),
      switch_parameter(
          "AsNewLayer", "Result as new layer",
          "The result becomes a layer of its own and the current layer stays as it is, since MeshLab cannot "
          "undo a filter. Both share the grids that did not change.",
          false)};
}

std::vector<ParameterDeclaration> diffusion_parameters() {
  const DiffusionOptions standard;
  return {integer_parameter("Iterations", "Diffusion: iterations",
                            "Each goes one voxel further into a hole; a hole is closed by half its width and "
                            "smoothed by the rest.",
                            "steps", standard.iterations, 1, 100000),
          integer_parameter("Reach", "Diffusion: reach",
                            "How far from observed surface it goes. A hole needs half its width.", "voxels",
                            standard.reach, 1, 10000),
          switch_parameter("LineOfSight", "Diffusion: line of sight",
                           "What a scanner looked through stays outside.", standard.line_of_sight),
          switch_parameter("Normals", "Diffusion: normals", "It goes along the surface, and not across it.",
                           standard.normals)};
}

DiffusionOptions diffusion_options(const ParameterValues& values) {
  DiffusionOptions options;
  options.iterations = values.integer("Iterations");
  options.reach = values.integer("Reach");
  options.line_of_sight = values.boolean("LineOfSight");
  options.normals = values.boolean("Normals");
  return options;
}

// Changes the volume of the layer that the filter works on, within a box, or makes a layer with the result.
void change_volume(
    FilterRun& run, const QString& name,
    const std::function<RangeVolume(const RangeVolume&, const VoxelBox&, const Progress&)>& change) {
  MeshModel& layer = volume_layer(run);
  const RangeVolume before = *volume_of(layer);
  const VoxelBox box = wanted_box(run, layer);
  const bool measure = run.parameters.boolean("Measure");
  const auto log_surface = [&](const RangeVolume& volume, const char* when, double from, double to) {
    const TriangleMesh surface = extract_surface(
        volume, {}, run.progress.part(from, from + 0.4 * (to - from), "extracting the surface"));
    log_origins(run,
                surface_origins(volume, surface,
                                run.progress.part(from + 0.4 * (to - from), to, "measuring the surface")),
                when);
    log_topology(run, volume, surface, when,
                 run.progress.part(from + 0.4 * (to - from), to, "measuring the surface"));
  };
  if (measure) log_surface(before, "Before", 0, 0.25);
  const RangeVolume after =
      change(before, box, run.progress.part(measure ? 0.25 : 0, measure ? 0.75 : 1, name.toStdString()));
  if (measure) log_surface(after, "After", 0.75, 1);
  log_volume(run, after);
  if (run.parameters.boolean("AsNewLayer"))
    add_volume_layer(run.document, after, layer.label() + " " + name, layer.cm.Tr);
  else
    replace_volume(layer, after);
}

void apply_morphology(FilterRun& run) {
  const std::vector<OperatorStep> steps = parse_operators(run.parameters.text("Operators").toStdString());
  const DiffusionOptions diffusion = diffusion_options(run.parameters);
  change_volume(run, "treated",
                [&](const RangeVolume& volume, const VoxelBox& box, const Progress& progress) {
                  SequenceResult result = apply_sequence(
                      volume, steps, box,
                      [&](const RangeVolume& given, const VoxelBox& where, const Progress& part) {
                        return diffuse(given, where, diffusion, part);
                      },
                      progress);
                  for (const StepReport& step : result.steps)
                    run.log(QString::fromStdString(text_of(step.step)) + ": " +
                            QString::number(step.changed) + " voxels changed");
                  return std::move(result.volume);
                });
}

void apply_fill(FilterRun& run) {
  const DiffusionOptions diffusion = diffusion_options(run.parameters);
  change_volume(run, "filled", [&](const RangeVolume& volume, const VoxelBox& box, const Progress& progress) {
    return diffuse(volume, box, diffusion, progress);
  });
}

void append(std::vector<ParameterDeclaration>& to, const std::vector<ParameterDeclaration>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

FilterDeclaration morphology_filter() {
  FilterDeclaration filter;
  filter.name = "Range Volume: Morphology";
  filter.python_name = "range_volume_morphology";
  filter.description =
      "Cleans the boundary between unseen and empty voxels of the current layer's volume, where holes are "
      "going to be filled: "
      "dilation (d) closes narrow tunnels, erosion (e) removes specks, expansion (x) goes on with the "
      "observed surface, "
      "diffusion (v) fills holes. Seen voxels are kept, so nothing of what was observed is smoothed."
      "<br>See: <br/><i>Eric Firestone</i><br/><b>\"An Exploration of Hole Filling Algorithms\"</b><br/>"
      "Master's thesis, California Polytechnic State University, San Luis Obispo, 2008.";
  filter.place = MenuPlace::range_map;
  filter.parameters = {text_parameter(
      "Operators", "Operators",
      "Applied one after another: the letters d, e, x and v, each with a count behind it or none. d2 e2: "
      "two dilations, then two erosions.",
      "d2 e2")};
  append(filter.parameters, box_parameters());
  append(filter.parameters, diffusion_parameters());
  append(filter.parameters, result_parameters());
  filter.apply = apply_morphology;
  return filter;
}

FilterDeclaration fill_filter() {
  FilterDeclaration filter;
  filter.name = "Range Volume: Fill";
  filter.python_name = "range_volume_fill";
  filter.description =
      "Fills holes of the current layer's volume by volumetric diffusion: the observed distances spread into "
      "what was not seen. "
      "What is not filled is closed between unseen and empty voxels when the surface is extracted (VRIP's "
      "filler), so this filter is not needed for that."
      "<br>See: <br/><i>James Davis, Stephen Marschner, Matt Garr, Marc Levoy</i><br/>"
      "<b>\"Filling holes in complex surfaces using volumetric diffusion\"</b><br/>3DPVT 2002.";
  filter.place = MenuPlace::range_map;
  filter.parameters = diffusion_parameters();
  append(filter.parameters, box_parameters());
  append(filter.parameters, result_parameters());
  filter.apply = apply_fill;
  return filter;
}

}  // namespace

std::vector<FilterDeclaration> volume_change_filters() { return {morphology_filter(), fill_filter()}; }

}  // namespace host
}  // namespace meshcomplete
