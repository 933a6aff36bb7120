// Cutting the patches out of a refined triangulation, so that they fit the rims of the input.
#pragma once

#include <cstddef>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/progress.h"
#include "common/core/sheets.h"
#include "filter_poissoncompletion/delaunay_complex.h"

namespace meshcomplete {

/// How the input is in the triangulation.
struct TailoringInput {
  const TriangleMesh& mesh;
  const MeshTopology& topology;
  const DelaunayComplex& complex;
  /// The mesh's half-edge at each protected edge: first the `rim_edges` boundary half-edges of the rims, then
  /// inner ones.
  const std::vector<Index>& half_edges;
  std::size_t rim_edges;
};

/// What the tailoring came to, for reports and tests.
struct TailoringFigures {
  std::size_t faces_met = 0;       ///< faces of the mesh that are facets of the triangulation
  std::size_t contradictions = 0;  ///< cells that lie on both sides of the mesh
  std::size_t surplus = 0;         ///< facets that lay over the mesh's own faces
  std::size_t relabelled = 0;      ///< cells that are not on the side that the function has them on
};

/// The surface between inside and outside without the input's own part of it. Cells next to a face of
/// the input are on the side on which the face has them, whatever the function says; of the others those are
/// on the other side than the function has them on for which that makes the surface smaller (a minimum cut).
/// What remains are the facets with corners on the rims and new ones. Source: the paper, section 3.4. Cost:
/// near-linear in the cells near the rims.
SeparatingSurface tailor(const TailoringInput& input, TailoringFigures& figures,
                         const Progress& progress = Progress());

}  // namespace meshcomplete
