// A function on space that is given by its values at the corners of an octree's cubes.
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "common/core/corner_octree.h"
#include "common/core/implicit_function.h"
#include "common/core/lattice.h"

namespace meshcomplete {

/// How values between the corners of a leaf are found.
enum class FieldInterpolation {
  trilinear,    ///< of the leaf's eight corners: continuous, because the octree is balanced
  tetrahedral,  ///< linear in tetrahedra between the leaf's centre, a face's centre and an edge: Centin,
                ///< Pezzotti and Signoroni, "Poisson-driven seamless completion of triangular meshes" (2015),
                ///< section 2.4
};

/// Corner values on a balanced octree in mesh coordinates. Outside the root the value at the nearest point of
/// it counts.
class OctreeField : public ImplicitFunction {
 public:
  /// `values[d - 1]` are those of the corners of level d. Where a corner lies on a coarser leaf's face or
  /// edge its value must be the mean of the corners round it there. `octree` must outlive this.
  OctreeField(const Lattice& lattice, std::shared_ptr<const CornerOctree> octree,
              std::vector<std::vector<double>> values, double iso_value,
              FieldInterpolation interpolation = FieldInterpolation::trilinear);

  /// Minus the iso-value. Cost: O(depth); trilinear one descent, tetrahedral up to four.
  double value(const Vector3& position) const override;

  void set_interpolation(FieldInterpolation interpolation) { interpolation_ = interpolation; }
  const CornerOctree& octree() const { return *octree_; }
  const Lattice& lattice() const { return lattice_; }
  /// The side of the leaf that holds a position, mesh units.
  double leaf_size(const Vector3& position) const;
  /// At the corners of a cube of depth 1 or more; bit k of a corner's place says whether it is the upper one
  /// along axis k.
  std::array<double, 8> corner_values(Index cube) const;

 private:
  struct Query;
  Query query(const Vector3& position) const;
  double trilinear(const Query& query) const;
  double tetrahedral(const Query& query) const;
  double corner_value(Index cube, int corner) const;
  double mean_of_corners(Index cube, int face_axis, int upper) const;
  std::pair<Index, int> deepest_leaf(const LatticePoint& point, int touching) const;
  double value_on_edge(const std::array<double, 3>& at, int axis) const;
  double value_on_face(const std::array<double, 3>& at, int axis) const;

  Lattice lattice_;
  Vector3 origin_;
  std::shared_ptr<const CornerOctree> octree_;
  std::vector<std::vector<double>> values_;
  FieldInterpolation interpolation_;
};

}  // namespace meshcomplete
