#include "filter_poissoncompletion/filter_poissonparameters.h"

#include <utility>

#include "common/host/parameter_blocks.h"

namespace meshcomplete {
namespace host {

std::vector<ParameterDeclaration> oracle_parameters(ParameterDeclaration max_depth, double scale) {
  return {integer_parameter("MinDepth", "Minimum depth",
                            "How often the cube around the mesh is halved everywhere, 1 to 8.", "levels", 5,
                            1, 8),
          std::move(max_depth),
          positive_parameter("Scale", "Scale", "Size of the cube around the mesh; above 1, up to 10.",
                             "bounding boxes", scale),
          choice_parameter("Boundary", "Outside",
                           "Solid: all that is far away is outside, so that separate parts stay separate. "
                           "Free: a surface may leave the cube.",
                           {"Solid", "Free"}),
          positive_parameter("Screening", "Screening",
                             "How closely the reconstruction goes through the mesh.", "", 16),
          positive_parameter("Samples", "Samples", "Points taken from the mesh.", "per face of a cube", 4),
          choice_parameter("Interpolation", "Interpolation",
                           "Of the reconstruction between corners of cubes. Trilinear: smooth and fast. "
                           "Tetrahedral: as published.",
                           {"Trilinear", "Tetrahedral"})};
}

PoissonOracleOptions oracle_options(const ParameterValues& values) {
  PoissonOracleOptions oracle;
  oracle.poisson.min_depth = values.integer("MinDepth");
  if (values.integer("MaxDepth") > 0) oracle.max_depth = values.integer("MaxDepth");
  oracle.scale = values.real("Scale");
  oracle.poisson.boundary =
      values.choice("Boundary") == 0 ? PoissonBoundary::dirichlet : PoissonBoundary::neumann;
  oracle.poisson.screening = values.real("Screening");
  oracle.density = values.real("Samples");
  oracle.interpolation =
      values.choice("Interpolation") == 0 ? FieldInterpolation::trilinear : FieldInterpolation::tetrahedral;
  return oracle;
}

void add_surface(LayerSurface surface, OrientedSurfaces& surfaces) {
  if (!surface.mesh.triangles.empty()) surfaces.meshes.push_back(std::move(surface.mesh));
  surfaces.points.insert(surfaces.points.end(), surface.points.begin(), surface.points.end());
  surfaces.normals.insert(surfaces.normals.end(), surface.normals.begin(), surface.normals.end());
}

}  // namespace host
}  // namespace meshcomplete
