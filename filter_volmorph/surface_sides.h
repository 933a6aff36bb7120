// Whether points lie before or behind an open surface, one by one or whole balls of them at once.
#pragma once

#include <optional>
#include <vector>

#include "common/core/box_tree.h"
#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/progress.h"
#include "filter_volmorph/surface_signs.h"
#include "filter_volmorph/winding_number.h"

namespace meshcomplete {

/// A point lies before a surface when the nearest point of the surface faces it, and behind it otherwise.
/// Where the nearest point is on the rim, that says nothing: there the point lies before the surface when the
/// generalized winding number is at most a half. Refers to the mesh, which is consistently oriented, has no
/// degenerate face and at least one face. Immutable, safe to ask from many threads.
class SurfaceSides {
 public:
  /// Cost: O(faces log faces); threaded.
  explicit SurfaceSides(const TriangleMesh& mesh, const Progress& progress = Progress());

  /// `start` is any face; a near one makes it fast. Becomes the nearest one. Cost: O(log faces) for a near
  /// one.
  bool before(const Vector3& point, Index& start) const;

  /// The side of all points of a ball; nothing where it is not sure that they have the same. `start` as
  /// above, for the middle. What is said does not depend on `start`.
  ///
  /// A nearest point that is not on the rim sees what it is nearest to along its normal, or at edges and
  /// vertices within the cone of the normals round it. So of the faces that may be nearest to some point of
  /// the ball only those count which have the ball, as wide as it looks from there, in a cone before or
  /// behind them.
  std::optional<bool> before(const Vector3& middle, double radius, Index& start) const;

 private:
  /// Faces next to each other in space, and the directions of their normals and of those round them.
  struct Cone {
    Vector3 middle = Vector3::Zero();
    double radius = 0;               ///< all faces are within it of the middle
    Vector3 axis = Vector3::Zero();  ///< unit, or zero
    double cosine = 1, sine = 0;     ///< of the widest angle between the axis and a normal
    bool rim = false;                ///< some vertex is on the rim
  };
  /// What the nearest points of some faces may be, of the points of a ball.
  struct Chances {
    bool before = false, behind = false, rim = false;
  };
  struct Nearest;
  class Stars;

  void build_boxes();
  void build_cones(const Progress& progress);
  void widen(Cone& cone, const Stars& stars, std::size_t begin, std::size_t end) const;
  static void widen(Cone& cone, const std::vector<Cone>& others, std::size_t begin, std::size_t end);
  void search(const Vector3& point, std::size_t level, std::size_t node, Nearest& nearest) const;
  Nearest nearest(const Vector3& point, Index start) const;
  static bool look(const Cone& cone, const Vector3& middle, double radius, Chances& chances);
  bool collect(const Vector3& middle, double radius, double reach, std::size_t level, std::size_t node,
               Chances& chances) const;

  const TriangleMesh& mesh_;
  MeshTopology topology_;
  SurfaceSigns signs_;
  WindingNumber winding_;
  std::vector<Index> order_;              ///< faces, neighbours in space after another
  std::vector<Vector3> normals_;          ///< of faces
  std::vector<Cone> faces_;               ///< in `order_`
  std::vector<std::vector<Box>> boxes_;   ///< the first over four faces each, the next over four nodes each
  std::vector<std::vector<Cone>> cones_;  ///< likewise
};

}  // namespace meshcomplete
