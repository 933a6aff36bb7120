// A mesh as a search for symmetries sees it: samples, and what is near an image of one of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/box_tree.h"
#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// The least cosine of normals that face the same way, 45 degrees: the facets and the noise of scans pass,
/// the sides of corners and of thin plates do not.
constexpr double least_alike = 0.70710678118654752;

/// Whether two normals of length 1 face the same way.
inline bool faces_alike(const Vector3& a, const Vector3& b) { return a.dot(b) >= least_alike; }

/// A point of the surface and the normal there.
struct SurfacePoint {
  Vector3 position = Vector3::Zero();
  Vector3 normal = Vector3::UnitZ();  ///< of length 1
  bool on_rim = false;                ///< at a boundary edge or vertex, beyond which the surface is not known
};

/// The surface in a frame of its own: the middle of the bounding box is the origin, its diagonal the unit of
/// length. Triangles without area do not take part. Refers to the mesh, which must outlive it. Immutable,
/// safe to ask from many threads.
class SampledSurface {
 public:
  /// Throws CompletionError when the mesh has no area. Cost: O(faces log faces), threaded.
  explicit SampledSurface(const TriangleMesh& mesh, const Progress& progress = Progress());
  SampledSurface(const SampledSurface&) = delete;
  SampledSurface& operator=(const SampledSurface&) = delete;

  const Vector3& middle() const { return middle_; }        ///< of the bounding box, in the mesh's frame
  double diagonal() const { return diagonal_; }            ///< of the bounding box, mesh units
  const Vector3& half_size() const { return half_size_; }  ///< of the bounding box, in the surface's frame

  bool has_rim() const { return !topology_.boundary_half_edges.empty(); }

  /// Spread evenly over the area; so is every second one, every third, and so on. The same on every run.
  const std::vector<SurfacePoint>& samples() const { return samples_; }

  /// A point of the surface near `x`, from a table: further from `x` than the nearest by up to a cell or two.
  const SurfacePoint& rough_neighbour(const Vector3& x) const;

  /// The closest point to `x` nearer than `radius`; false when there is none.
  bool closest(const Vector3& x, double radius, SurfacePoint& found) const;

  /// As `closest`, of the parts of the surface that face the same way as `normal` (`faces_alike`).
  bool closest_facing(const Vector3& x, const Vector3& normal, double radius, SurfacePoint& found) const;

 private:
  template <class Accept>
  bool search(const Vector3& x, double radius, Accept&& accept, SurfacePoint& found) const;
  bool is_on_rim(Index triangle, int place) const;
  Vector3 in_frame(const Vector3& position) const { return (position - middle_) / diagonal_; }
  SurfacePoint point_of(Index triangle, double u, double v) const;
  void build_tree(const std::vector<double>& areas);
  void take_samples(const std::vector<double>& areas);
  void take_rim_sites(double spacing);
  void fill_table();

  const TriangleMesh& mesh_;
  const MeshTopology topology_;
  std::vector<Index> order_;  // the triangles with area, neighbours in space next to each other
  BoxTree tree_;              // its leaves are runs of them
  // Theirs, in the surface's frame; a search for symmetries needs no more than single precision.
  std::vector<Eigen::Vector3f> corners_;
  std::vector<bool> rim_vertex_;
  Vector3 middle_ = Vector3::Zero(), half_size_ = Vector3::Zero();
  double diagonal_ = 0;
  std::vector<SurfacePoint> samples_;
  std::vector<SurfacePoint> sites_;  // what the table knows of the surface
  std::array<int, 3> cells_ = {0, 0, 0};
  Vector3 table_corner_ = Vector3::Zero();
  std::vector<std::int32_t> table_;  // for every cell the site nearest to its centre
};

}  // namespace meshcomplete
