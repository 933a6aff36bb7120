// The mesh by which space is divided when that is impossible by the input itself: where faces intersect each
// other at the rims, and where rims touch.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch_check.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// The input with the same numbers of vertices and faces, but for what cubes cannot tell apart however small
/// they are:
/// - of two faces that meet each other and have a rim vertex in common, one is left out, if it has no edge on
///   a rim; so are faces without area whose longest side is on a rim, and those beside a gap made in this
///   way that meet others. They have three equal corners here;
/// - rim vertices at the same position are one vertex, the one with the lowest number.
/// A patch made with it has to be checked against the input.
struct DivisibleMesh {
  TriangleMesh mesh;
  MeshTopology topology;
  InputNeighbourhood neighbourhood;  ///< of `mesh`
  std::vector<Index> left_out;       ///< faces, ascending
  bool merged = false;               ///< whether any vertices are one here

  explicit DivisibleMesh(TriangleMesh changed)
      : mesh(std::move(changed)), topology(build_topology(mesh)), neighbourhood(mesh) {}
  DivisibleMesh(const DivisibleMesh&) = delete;
  DivisibleMesh& operator=(const DivisibleMesh&) = delete;
};

/// Null when space can be divided by the input itself. Exact. Cost: O(faces) for a pass over the triangles,
/// O(n log n) for the n faces at the rims.
std::unique_ptr<DivisibleMesh> make_divisible(const TriangleMesh& mesh, const MeshTopology& topology,
                                              const InputNeighbourhood& neighbourhood,
                                              const Progress& progress = Progress());

}  // namespace meshcomplete
