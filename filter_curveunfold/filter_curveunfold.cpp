#include "filter_curveunfold/filter_curveunfold.h"

#include <cstdint>
#include <limits>
#include <utility>

#include "common/host/close_holes.h"
#include "common/host/parameter_blocks.h"
#include "filter_curveunfold/curve_unfolding.h"

using namespace meshcomplete;
using namespace meshcomplete::host;

namespace {

const char* const description =
    "Closes holes, however curved and twisted their boundary is, each with a smooth surface of the same "
    "resolution as "
    "the mesh around it. The boundary of a hole is unfolded into the plane without crossing itself, "
    "triangulated there, "
    "put back, refined, and its inner vertices move to the surface of least energy. The mesh itself is not "
    "changed: "
    "faces and vertices are only added. A patch that would intersect itself or the mesh is never added; the "
    "hole then "
    "stays open and the log says why. A hole with islands inside, or whose boundary is knotted, is beyond "
    "this method."
    "<br>See: <br/>"
    "<i>Alan Brunton, Stefanie Wuhrer, Chang Shu, Prosenjit Bose, Erik D. Demaine</i><br/>"
    "<b>\"Filling Holes in Triangular Meshes by Curve Unfolding\"</b><br/>"
    "IEEE International Conference on Shape Modeling and Applications (SMI), 2009, Pages 66-72.";

std::vector<ParameterDeclaration> parameters() {
  std::vector<ParameterDeclaration> all = close_holes_parameters();
  all.push_back(choice_parameter("Energy", "Surface energy",
                                 "What the surface of a patch minimises. Thin plate: bending, continues the "
                                 "surface around the hole smoothly. "
                                 "Membrane (least-squares mesh): small area, with a crease along the "
                                 "boundary. Normal variation: the change of the "
                                 "normals from face to face. When the patch of one energy would intersect "
                                 "the mesh, another one is tried.",
                                 {"Thin plate", "Membrane (least-squares mesh)", "Normal variation"}));
  all.push_back(
      choice_parameter("Weights", "Weights",
                       "How the neighbours of a vertex count in the energy. Cotangent: by the shape of the "
                       "triangles, for an even surface. Uniform: all the same, as in the paper.",
                       {"Cotangent", "Uniform"}));
  all.push_back(choice_parameter("Unfolding", "Unfolding",
                                 "How a boundary is unfolded into the plane. Automatic: by projection where "
                                 "that does not make it cross itself, else "
                                 "by self-avoiding descent. Simulated annealing: as in the paper. "
                                 "Self-avoiding descent: faster, and the same "
                                 "whatever the seed.",
                                 {"Automatic", "Simulated annealing", "Self-avoiding descent"}));
  all.push_back(integer_parameter(
      "Restarts", "Annealing restarts",
      "How many times simulated annealing starts anew before it gives up on a hole.", "runs", 100, 1, 10000));
  all.push_back(
      integer_parameter("Seed", "Annealing seed",
                        "Start of the random numbers of simulated annealing. The same seed gives the same "
                        "result.",
                        "", 1, 0, std::numeric_limits<int>::max()));
  all.push_back(
      length_parameter("EdgeLength", "Edge length",
                       "Length of the edges inside the patches. 0 means automatic: as in the mesh around the "
                       "hole. A percentage refers to the diagonal of the bounding box."));
  all.push_back(
      switch_parameter("UnfoldedLayer", "Layer with the unfolded holes",
                       "Adds a layer that shows the unfolded boundaries with their triangulations, side by "
                       "side in the plane.",
                       false));
  return all;
}

CurveUnfoldingOptions options_from(const ParameterValues& values) {
  constexpr SurfaceEnergy energies[] = {SurfaceEnergy::thin_plate, SurfaceEnergy::membrane,
                                        SurfaceEnergy::normal_variation};
  constexpr LaplacianWeights weights[] = {LaplacianWeights::cotangent, LaplacianWeights::uniform};
  constexpr UnfoldMethod methods[] = {UnfoldMethod::automatic, UnfoldMethod::annealing,
                                      UnfoldMethod::descent};
  CurveUnfoldingOptions options;
  options.energy = energies[values.choice("Energy")];
  options.weights = weights[values.choice("Weights")];
  options.unfolding.method = methods[values.choice("Unfolding")];
  options.unfolding.restarts = values.integer("Restarts");
  options.unfolding.seed = static_cast<std::uint64_t>(values.integer("Seed"));
  const double edge_length = values.real("EdgeLength");
  if (edge_length > 0) options.edge_length = edge_length;
  options.unfolded_layer = values.boolean("UnfoldedLayer");
  return options;
}

void apply(FilterRun& run) {
  CurveUnfoldingOptions options = options_from(run.parameters);
  close_holes(run, [&options](const TriangleMesh& mesh, const MeshSelection& selection,
                              const HoleSelectionOptions& holes, const Progress& progress) {
    options.holes = holes;
    CurveUnfoldingResult result = fill_by_curve_unfolding(mesh, selection, options, progress);
    return ClosedHoles{std::move(result.completion), {{"unfolded", std::move(result.unfolded)}}};
  });
}

FilterDeclaration curve_unfolding_filter() {
  FilterDeclaration filter;
  filter.name = "Close Holes: Curve Unfolding";
  filter.python_name = "close_holes_curve_unfolding";
  filter.description = description;
  filter.place = MenuPlace::remeshing;
  filter.parameters = parameters();
  filter.apply = apply;
  return filter;
}

}  // namespace

FilterCurveUnfold::FilterCurveUnfold() { declare({curve_unfolding_filter()}, this); }
