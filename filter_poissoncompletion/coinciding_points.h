// Points at the same position, and rims that touch there.
#pragma once

#include <memory>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"

namespace meshcomplete {

/// For each point the first one at its position. Cost: O(n log n).
std::vector<Index> first_at_position(const std::vector<Vector3>& points);

/// A mesh with the same numbers of vertices and faces whose boundary vertices at one position are one vertex,
/// the one with the lowest number: in a triangulation of space they are one.
struct MergedRims {
  TriangleMesh mesh;
  MeshTopology topology;
};

/// Null when no two boundary vertices are at the same position. Cost: O(boundary log boundary), else O(faces)
/// too.
std::unique_ptr<MergedRims> merge_rims(const TriangleMesh& mesh, const MeshTopology& topology);

}  // namespace meshcomplete
