// The motions that a symmetry may be, by their parameters, so that a registration stays within its family.
#pragma once

#include <Eigen/Core>
#include <array>

#include "common/core/mesh.h"
#include "filter_atomicvolumes/symmetry.h"

namespace meshcomplete {

/// A reflection in the plane through `point` with normal `direction`, a rotation by 360 / `fold` degrees
/// about the axis through `point` along `direction`, or a translation by `point`.
struct SymmetryPose {
  SymmetryKind kind = SymmetryKind::reflection;
  Vector3 point = Vector3::Zero();
  Vector3 direction = Vector3::UnitZ();  ///< of length 1; without meaning for a translation
  int fold = 2;                          ///< of a rotation, at least 2
};

/// What a pose does to a position, x -> linear x + shift; to a normal, linear n.
struct SymmetryMotion {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Vector3 shift = Vector3::Zero();

  explicit SymmetryMotion(const SymmetryPose& pose);
  Vector3 operator()(const Vector3& x) const { return linear * x + shift; }
};

/// The ways in which a pose can change within its family: directions of its parameters and what they do to
/// images.
class PoseFreedom {
 public:
  static constexpr int most = 4;
  using Step = Eigen::Matrix<double, most, 1>;         ///< entries from `count()` on are zero
  using Derivatives = Eigen::Matrix<double, 3, most>;  ///< of an image; a column for each entry of a step

  explicit PoseFreedom(const SymmetryPose& pose);

  int count() const { return pose_.kind == SymmetryKind::rotation ? 4 : 3; }
  Derivatives derivatives(const Vector3& x) const;
  /// The pose a step away; its point is the nearest to the origin of those that describe the same motion.
  SymmetryPose moved(const Step& step) const;

 private:
  SymmetryPose pose_;
  SymmetryMotion motion_;
  Vector3 first_, second_;  // with the direction an orthonormal frame
};

/// The direction, of length 1, in which `x` sets out when the pose moves it gradually; zero where there is
/// none (on the axis of a rotation, and for reflections, which do nothing gradually).
Vector3 direction_of_travel(const SymmetryPose& pose, const Vector3& x);

}  // namespace meshcomplete
