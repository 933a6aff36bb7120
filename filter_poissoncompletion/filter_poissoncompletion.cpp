#include "filter_poissoncompletion/filter_poissoncompletion.h"

#include <utility>

#include "common/core/error.h"
#include "common/core/reduced_mesh.h"
#include "common/host/close_holes.h"
#include "common/host/other_layers.h"
#include "common/host/parameter_blocks.h"
#include "filter_poissoncompletion/filter_poissonparameters.h"
#include "filter_poissoncompletion/filter_poissonremeshing.h"
#include "filter_poissoncompletion/poisson_completion.h"

using namespace meshcomplete;
using namespace meshcomplete::host;

namespace {

const char* const closing_description =
    "Closes holes, also gaps between separate parts and holes with islands, with triangles like those of the "
    "mesh around. A Poisson reconstruction of the mesh says where the surface goes on, and a Delaunay "
    "triangulation is refined along it in the holes only. The mesh itself is not changed: faces and vertices "
    "are only added, and they intersect nothing."
    "<br>See: <br/><i>Marco Centin, Nicola Pezzotti, Alberto Signoroni</i><br/>"
    "<b>\"Poisson-driven seamless completion of triangular meshes\"</b><br/>"
    "Computer Aided Geometric Design, 2015.";

std::vector<ParameterDeclaration> guide_parameters() {
  return {layer_parameter("GuideLayer", "Guide",
                          "A layer whose surface, or points with normals, the completion follows too. It is "
                          "not completed itself, and its faces are not added."),
          switch_parameter("GuideVisible", "Visible layers are guides", "So are all other visible layers.",
                           false)};
}

std::vector<ParameterDeclaration> refinement_parameters() {
  return {
      switch_parameter("PartialFill", "Fill only along the selection",
                       "Of each hole only a strip is filled, along the part of its boundary whose vertices "
                       "are selected, or corners of selected faces: from one end of the part straight to the "
                       "other, or with several parts from one to the next.",
                       false),
      integer_parameter("RemoveRings", "Remove rings",
                        "So many rings of faces are removed round each hole before it is closed, for noisy "
                        "boundaries. More than 0 makes the result a new layer, and the log names them.",
                        "rings", 0, 0, 100),
      length_parameter("EdgeLength", "Edge length",
                       "Length of the new edges. 0: as in the mesh around, and between holes of unlike "
                       "meshes in between. A percentage is of the bounding box's diagonal."),
      integer_parameter("Rings", "Rings",
                        "So many rings of faces round each hole hold the new surface in its place.", "rings",
                        3, 1, 100),
      length_parameter("CushionRadius", "Cushion",
                       "Nearer than this to the mesh no vertex is put. 0: a little more than the edge "
                       "length. A percentage is of the bounding box's diagonal."),
      choice_parameter(
          "Fairing", "Fairing",
          "What the new surface minimises in the end. Thin plate: bending. Membrane: area. "
          "Normal variation: the change of the normals. None: it stays the reconstruction's. "
          "Automatic: normal variation, but near the reconstruction; none where guides shape it.",
          {"Automatic", "None", "Thin plate", "Membrane", "Normal variation"})};
}

PoissonCompletionOptions options_from(const ParameterValues& values) {
  constexpr std::optional<SurfaceEnergy> energies[] = {SurfaceEnergy::normal_variation, std::nullopt,
                                                       SurfaceEnergy::thin_plate, SurfaceEnergy::membrane,
                                                       SurfaceEnergy::normal_variation};
  PoissonCompletionOptions options;
  options.oracle = oracle_options(values);
  options.partial_fill = values.boolean("PartialFill");
  if (options.partial_fill && values.integer("RemoveRings") > 0)
    throw CompletionError("reading the parameters",
                          "\"PartialFill\" goes along the boundary that the selection is on, and "
                          "\"RemoveRings\" would remove it. Use one of them at a time.");
  if (values.real("EdgeLength") > 0) options.refinement.edge_length = values.real("EdgeLength");
  options.refinement.rings = values.integer("Rings");
  if (values.real("CushionRadius") > 0) options.refinement.cushion_radius = values.real("CushionRadius");
  options.refinement.finishing.fairing = energies[values.choice("Fairing")];
  if (values.choice("Fairing") != 0) options.refinement.finishing.near_rough.reset();
  return options;
}

/// What the layers that are guides add; `notes` are for the log.
OrientedSurfaces read_guides(const FilterRun& run, std::vector<std::string>& notes) {
  OrientedSurfaces guides;
  const bool all = run.parameters.boolean("GuideVisible");
  const MeshModel* chosen = run.parameters.layer("GuideLayer");
  if (chosen != nullptr) add_surface(other_layer_surface(run, "GuideLayer"), guides);
  if (!all) return guides;
  for (auto& [name, surface] : visible_layer_surfaces(run, chosen)) {
    notes.push_back("Guide: the layer \"" + name.toStdString() + "\"");
    add_surface(std::move(surface), guides);
  }
  if (guides.empty())
    throw CompletionError("reading the parameters",
                          "Parameter \"GuideVisible\" is on, but there is no other visible layer.");
  return guides;
}

void apply_closing(FilterRun& run) {
  PoissonCompletionOptions options = options_from(run.parameters);
  std::vector<std::string> notes;
  options.guides = read_guides(run, notes);
  // A fair surface has forgotten what guides have asked for.
  if (!options.guides.empty() && run.parameters.choice("Fairing") == 0)
    options.refinement.finishing.fairing.reset();
  close_holes(run, [&](const TriangleMesh& mesh, const MeshSelection& selection,
                       const HoleSelectionOptions& holes, const Progress& progress) {
    options.holes = holes;
    const int rings = run.parameters.integer("RemoveRings");
    ClosedHoles closed;
    if (rings > 0) {
      ReducedMesh rest =
          without_rings(mesh, selection, holes, rings, progress.part(0, 0.05, "removing rings"));
      closed.completion =
          complete_by_poisson(rest.mesh, rest.selection, options, progress.part(0.05, 1, "closing holes"))
              .completion;
      closed.removed = std::move(rest.removed);
    } else {
      closed.completion = complete_by_poisson(mesh, selection, options, progress).completion;
    }
    std::vector<std::string>& all_notes = closed.completion.report.notes;
    all_notes.insert(all_notes.begin(), notes.begin(), notes.end());
    return closed;
  });
}

FilterDeclaration closing_filter() {
  FilterDeclaration filter;
  filter.name = "Close Holes: Poisson-driven";
  filter.python_name = "close_holes_poisson_driven";
  filter.description = closing_description;
  filter.place = MenuPlace::remeshing;
  filter.parameters = close_holes_parameters();
  const ParameterDeclaration max_depth =
      integer_parameter("MaxDepth", "Maximum depth",
                        "Near the holes it is halved until cubes are as small as the edges there, and as "
                        "thin walls are thick; but at most so often, up to 16. 0: 14 times.",
                        "levels", 0, 0, 16);
  for (const auto& more : {guide_parameters(), oracle_parameters(max_depth, 2.2), refinement_parameters()})
    filter.parameters.insert(filter.parameters.end(), more.begin(), more.end());
  filter.apply = apply_closing;
  return filter;
}

}  // namespace

FilterPoissonCompletion::FilterPoissonCompletion() { declare({closing_filter(), remeshing_filter()}, this); }
