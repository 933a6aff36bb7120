// Attributes of new vertices, interpolated smoothly from the rim.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "common/core/mesh.h"
#include "common/core/patch.h"

namespace meshcomplete {

/// Harmonic interpolation of any number of attributes. `rim_value(v)` gives the row of attributes (colour
/// channels, quality, texture coordinates, ...; `columns` of them) of input vertex v, and is asked once for
/// every input vertex that the patch uses. Returns one row per new vertex of the patch. Every value lies
/// between the least and the greatest of its rim; a rim value that is not finite counts as the mean of the
/// others. Throws CompletionError when a piece of the patch has no rim. Cost: one sparse Cholesky
/// factorisation of the patch, shared by all columns.
Eigen::MatrixXd interpolate_attributes(const TriangleMesh& mesh, const Patch& patch, Eigen::Index columns,
                                       const std::function<Eigen::RowVectorXd(Index)>& rim_value);

/// Unit normals of the new vertices: the mean of the adjacent faces' normals weighted by the angle at the
/// vertex (the z axis where no adjacent face has an area).
std::vector<Vector3> patch_vertex_normals(const TriangleMesh& mesh, const Patch& patch);

}  // namespace meshcomplete
