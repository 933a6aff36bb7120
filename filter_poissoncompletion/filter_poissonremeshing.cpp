#include "filter_poissoncompletion/filter_poissonremeshing.h"

#include <utility>

#include "common/host/append.h"
#include "common/host/parameter_blocks.h"
#include "filter_poissoncompletion/filter_poissonparameters.h"
#include "filter_poissoncompletion/poisson_remeshing.h"

namespace meshcomplete {
namespace host {
namespace {

const char* const remeshing_description =
    "Makes a new layer: a closed mesh of well-shaped triangles, smaller where the surface is more curved, "
    "through a mesh or through points with normals. The surface is a Poisson reconstruction, and a Delaunay "
    "triangulation is refined along it."
    "<br>See: <br/><i>Marco Centin, Nicola Pezzotti, Alberto Signoroni</i><br/>"
    "<b>\"Poisson-driven seamless completion of triangular meshes\"</b><br/>"
    "Computer Aided Geometric Design, 2015, section 4.4.";

void apply_remeshing(FilterRun& run) {
  const ParameterValues& values = run.parameters;
  PoissonRemeshingOptions options;
  options.oracle = oracle_options(values);
  options.adaptive = values.boolean("Adaptive");
  if (values.real("EdgeLength") > 0) options.edge_length = values.real("EdgeLength");
  if (values.real("Distance") > 0) options.distance = values.real("Distance");
  options.share = values.real("Share");
  options.smallest_angle = values.integer("Angle");
  const MeshModel& current = *run.document.mm();
  OrientedSurfaces surface;
  add_surface(layer_surface(current, current), surface);
  if (values.boolean("VisibleLayers"))
    for (auto& [name, other] : visible_layer_surfaces(run)) add_surface(std::move(other), surface);
  PoissonRemeshingResult result = remesh_by_poisson(surface, options, run.progress);
  run.report.stage_seconds = std::move(result.stage_seconds);
  run.document.setCurrentMesh(
      add_layer(run.document, result.mesh, current.label() + " reconstructed", current).id());
  run.log("Reconstructed with " + QString::number(result.mesh.vertices.size()) + " vertices and " +
          QString::number(result.mesh.triangles.size()) + " faces, from " +
          QString::number(result.oracle.samples) + " samples in an octree of depth " +
          QString::number(result.oracle.depth));
}

}  // namespace

FilterDeclaration remeshing_filter() {
  FilterDeclaration filter;
  filter.name = "Surface Reconstruction: Poisson Delaunay";
  filter.python_name = "surface_reconstruction_poisson_delaunay";
  filter.description = remeshing_description;
  filter.place = MenuPlace::remeshing;
  filter.parameters = {
      switch_parameter("VisibleLayers", "Visible layers too",
                       "The surface goes through all visible layers, not the current one only.", false),
      switch_parameter("Adaptive", "Adaptive", "Shorter edges where the surface is more curved.", true),
      length_parameter(
          "EdgeLength", "Edge length",
          "Of the edges, at most. 0: 8 of the smallest cubes, 1.6 when not adaptive. A percentage "
          "is of the bounding box's diagonal."),
      length_parameter("Distance", "Distance",
                       "How far faces may be from the surface when they adapt to it. 0: as little as Share "
                       "allows. A percentage is of the bounding box's diagonal."),
      positive_parameter("Share", "Share of faces",
                         "When Distance is 0 and faces adapt to the surface: about so many there will be. Up "
                         "to 10.",
                         "of those that marching cubes make", 0.3),
      integer_parameter("Angle", "Smallest angle", "Faces with smaller angles are refined.", "degrees", 25, 0,
                        30)};
  const ParameterDeclaration max_depth =
      integer_parameter("MaxDepth", "Maximum depth",
                        "How often it is halved at the surface, up to 16. 0: 8 times.", "levels", 0, 0, 16);
  for (const ParameterDeclaration& more : oracle_parameters(max_depth, 1.5))
    filter.parameters.push_back(more);
  filter.apply = apply_remeshing;
  return filter;
}

}  // namespace host
}  // namespace meshcomplete
