// How far a point is from the mesh, and which side of it the point is on.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "common/core/box_tree.h"
#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"

namespace meshcomplete {

/// The part of the mesh that is nearest to a point.
struct NearestSide {
  double distance = std::numeric_limits<double>::infinity();
  /// Whether the point is behind it. Absent where it is a boundary (or non-manifold) edge or vertex: what is
  /// missing there may come nearer and have either side.
  std::optional<bool> inside;
};

/// Tells sides by the pseudo-normals of the nearest triangle, edge or vertex (Baerentzen and Aanaes, "Signed
/// distance computation using the angle weighted pseudonormal", 2005). Refers to its arguments, which must
/// outlive it. Immutable, safe to ask from many threads.
class SideFinder {
 public:
  /// Cost: O(faces log faces), mostly threaded.
  SideFinder(const TriangleMesh& mesh, const MeshTopology& topology);

  /// What is nearest of that within `radius`; nothing: an infinite distance. `near` is a triangle to begin
  /// with and becomes the nearest one: for neighbouring points one after the other that saves most of the
  /// search. Does not change the result. Cost: O(log faces + triangles at about that distance).
  NearestSide nearest(const Vector3& point, Index& near,
                      double radius = std::numeric_limits<double>::infinity()) const;

 private:
  void build_tree();
  void add_vertex_normals();
  Box box_of(Index triangle) const;
  Vector3 normal(Index triangle) const;
  NearestSide side_of(const Vector3& point, Index triangle) const;

  const TriangleMesh& mesh_;
  const MeshTopology& topology_;
  std::vector<Index> order_;             // the triangles, neighbours in space next to each other
  BoxTree tree_;                         // its leaves are runs of them
  std::vector<Vector3> vertex_normals_;  // weighted by angle; zero on the boundary
};

}  // namespace meshcomplete
