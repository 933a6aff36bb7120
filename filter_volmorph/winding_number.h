// How often a mesh goes round a point, also for meshes with holes.
#pragma once

#include <vector>

#include "common/core/box_tree.h"
#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// The generalized winding number: the solid angle of a mesh as seen from a point, over 4 pi; 1 inside and 0
/// outside a closed mesh, changing smoothly through the holes of an open one, 0.5 about half-way through.
/// Sources: Jacobson et al., "Robust Inside-Outside Segmentation using Generalized Winding Numbers" (2013);
/// Barill et al., "Fast Winding Numbers for Soups and Clouds" (2018), with the first term of their series.
/// Immutable, safe to ask from many threads.
class WindingNumber {
 public:
  /// Refers to the mesh and its topology, which must outlive it. Throws `Cancelled`. Cost: O(faces log
  /// faces).
  WindingNumber(const TriangleMesh& mesh, const MeshTopology& topology,
                const Progress& progress = Progress());

  /// Within about `largest_error`. Cost: O(log faces) away from the surface.
  double at(const Vector3& point) const;
  static constexpr double largest_error = 0.1;

  bool inside(const Vector3& point) const { return at(point) > 0.5; }

  /// An upper bound of how fast the number changes, per length, within `radius` of a point, on ways that do
  /// not cross the surface; infinite at a rim. 0 for a closed mesh. (The gradient of a sheet's solid angle is
  /// the field of a current along its rim: every edge adds at most its length / (4 pi distance^2).) Cost:
  /// O(log rim edges) away from rims.
  double steepest(const Vector3& point, double radius) const;

 private:
  /// Faces next to each other in space, as seen from afar.
  struct Node {
    Vector3 middle = Vector3::Zero();  ///< weighted with the areas
    Vector3 normal = Vector3::Zero();  ///< sum of the faces', as long as their areas
    double area = 0;
    double radius = 0;  ///< all faces are within it of the middle
    Box box;
  };

  /// Edges where the mesh ends, or is not oriented alike, next to each other in space.
  struct Rim {
    Box box;
    double length = 0;
  };

  double at(const Vector3& point, std::size_t level, std::size_t node) const;
  double steepest(const Vector3& point, double radius, std::size_t level, std::size_t rim) const;
  void build_nodes(const std::vector<Box>& boxes, const Progress& progress);
  void build_rims(const MeshTopology& topology, const Progress& progress);

  const TriangleMesh& mesh_;
  std::vector<Index> order_;               ///< faces, neighbours in space after another
  std::vector<std::vector<Node>> levels_;  ///< the first over eight faces each, the next over four nodes each
  std::vector<std::vector<Rim>> rims_;     ///< single edges first, the next over four each
};

}  // namespace meshcomplete
