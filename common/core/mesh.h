// The mesh that every algorithm reads: positions and triangles, in the caller's numbering, never changed.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace meshcomplete {

/// Index of a vertex or triangle. Numbering is the caller's and is never permuted.
using Index = std::uint32_t;

/// A position or vector in the mesh's own units.
using Vector3 = Eigen::Vector3d;

/// Corners of a triangle, counter-clockwise seen from outside.
using Triangle = std::array<Index, 3>;

/// A snapshot of the caller's mesh. Positions are held in double precision; every coordinate is exactly a
/// value that the caller stores (MeshLab stores floats), so that exact predicates on the snapshot speak about
/// the caller's mesh. Vertices that no triangle uses are allowed and keep their numbers.
struct TriangleMesh {
  std::vector<Vector3> vertices;
  std::vector<Triangle> triangles;
};

/// Length of the diagonal of the bounding box of the vertices that triangles use; 0 for a mesh without
/// triangles. Cost: one pass over the triangles.
double bounding_box_diagonal(const TriangleMesh& mesh);

}  // namespace meshcomplete
