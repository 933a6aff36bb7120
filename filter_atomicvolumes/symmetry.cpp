#include "filter_atomicvolumes/symmetry.h"

#include <Eigen/LU>
#include <cmath>
#include <sstream>

#include "common/core/error.h"
#include "filter_atomicvolumes/symmetry_pose.h"
#include "filter_atomicvolumes/symmetry_search.h"
#include "filter_atomicvolumes/symmetry_surface.h"

namespace meshcomplete {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr const char* reading = "reading the parameters";

Symmetry with_motion(SymmetryKind kind, const SymmetryMotion& motion) {
  Symmetry symmetry;
  symmetry.kind = kind;
  symmetry.motion.linear() = motion.linear;
  symmetry.motion.translation() = motion.shift;
  return symmetry;
}

Symmetry given(SymmetryKind kind, const Vector3& point, const Vector3& direction, int fold) {
  SymmetryPose pose;
  pose.kind = kind;
  pose.point = point;
  // Scaled first, so that the square of the length neither overflows nor underflows.
  const double largest = direction.cwiseAbs().maxCoeff();
  if (!point.allFinite() || !direction.allFinite() || !(largest > 0))
    throw CompletionError(reading,
                          kind == SymmetryKind::reflection
                              ? "The normal of a mirror plane must have a length, and its point be finite."
                              : "The axis of a rotation must have a length, and its point be finite.");
  pose.direction = (direction / largest).normalized();
  pose.fold = fold;
  return with_motion(kind, SymmetryMotion(pose));
}

// Entries smaller than this share of the whole are noise: registration settles to within 1e-5 of the
// diagonal.
constexpr double noise_of_detection = 1e-6;
// Of given symmetries it is rounding that leaves them.
constexpr double noise_of_rounding = 1e-12;

Vector3 without_noise(Vector3 v, double noise) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(v[k]) < noise) v[k] = 0;
  return v;
}

Symmetry in_mesh_frame(const SampledSurface& surface, const FoundPose& found) {
  SymmetryPose pose = found.pose;
  pose.direction = without_noise(pose.direction, noise_of_detection).normalized();
  pose.point *= surface.diagonal();
  if (pose.kind != SymmetryKind::translation) pose.point += surface.middle();
  // The point of a plane or an axis that `describe` will name.
  const Vector3 along = pose.direction.dot(pose.point) * pose.direction;
  if (pose.kind == SymmetryKind::reflection) pose.point = along;
  if (pose.kind == SymmetryKind::rotation) pose.point -= along;
  pose.point = without_noise(pose.point, noise_of_detection * surface.diagonal());
  Symmetry symmetry = with_motion(pose.kind, SymmetryMotion(pose));
  symmetry.support = found.fit.support;
  symmetry.agreement = found.fit.agreement;
  return symmetry;
}

void check_options(const SymmetryDetectionOptions& options) {
  if (!(options.tolerance >= 1e-5 && options.tolerance <= 0.05))
    throw CompletionError(reading, "The tolerance of symmetries must lie between 0.00001 and 0.05.");
  const auto is_share = [](double share) { return share > 0 && share <= 1; };
  if (!is_share(options.least_support) || !is_share(options.least_agreement))
    throw CompletionError(reading,
                          "The least support and agreement of a symmetry must be more than 0 and at most 1.");
  if (options.highest_fold < 2 || options.highest_fold > 36)
    throw CompletionError(reading, "The highest fold of a rotation must lie between 2 and 36.");
  if (!(options.least_shift > options.tolerance && options.least_shift < 1))
    throw CompletionError(reading, "The least translation must be more than the tolerance and less than 1.");
}

std::string text(const Vector3& v) {
  std::ostringstream out;
  out.precision(4);
  // Adding zero turns a negative zero into a positive one.
  out << '(' << v.x() + 0.0 << ", " << v.y() + 0.0 << ", " << v.z() + 0.0 << ')';
  return out.str();
}

// Of the two normals of a plane the one with a positive greatest entry, and so for the axis of half a turn.
Vector3 canonical(const Vector3& direction) {
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  return direction[largest] < 0 ? Vector3(-direction) : direction;
}

std::string describe_reflection(const Eigen::Matrix3d& linear, const Vector3& shift) {
  // Identity less linear part is twice the normal times its transpose.
  const Eigen::Matrix3d twice = Eigen::Matrix3d::Identity() - linear;
  Eigen::Index column = 0;
  twice.diagonal().maxCoeff(&column);
  const Vector3 normal = without_noise(canonical(twice.col(column).normalized()), noise_of_rounding);
  return "reflection in the plane through " + text(0.5 * shift.dot(normal) * normal) + " with normal " +
         text(normal);
}

std::string describe_rotation(const Eigen::Matrix3d& linear, const Vector3& shift) {
  const Eigen::AngleAxisd turn(linear);
  const bool half = std::abs(turn.angle() - pi) < noise_of_detection;
  const Vector3 axis = without_noise(half ? canonical(turn.axis()) : turn.axis(), noise_of_rounding);
  // The point of the axis that is nearest to the origin: with the axis' own direction added the system is
  // regular.
  const Eigen::Matrix3d regular =
      Eigen::Matrix3d::Identity() - linear + turn.axis() * turn.axis().transpose();
  const Vector3 point = without_noise(regular.inverse() * shift, noise_of_rounding * shift.norm());
  std::ostringstream out;
  out << "rotation by " << std::round(turn.angle() * 180 / pi * 10) / 10 << " degrees about the axis through "
      << text(point) << " along " << text(axis);
  return out.str();
}

}  // namespace

Symmetry reflection(const Vector3& point, const Vector3& normal) {
  return given(SymmetryKind::reflection, point, normal, 2);
}

Symmetry rotation(const Vector3& point, const Vector3& axis, int fold) {
  if (fold < 2) throw CompletionError(reading, "The fold of a rotation must be 2 or more.");
  return given(SymmetryKind::rotation, point, axis, fold);
}

Symmetry translation(const Vector3& shift) {
  if (!shift.allFinite() || shift.isZero(0))
    throw CompletionError(reading, "The vector of a translation must be finite and not zero.");
  Symmetry symmetry;
  symmetry.kind = SymmetryKind::translation;
  symmetry.motion.translation() = shift;
  return symmetry;
}

std::optional<Symmetry> detect_symmetry(const TriangleMesh& mesh, const SymmetryDetectionOptions& options,
                                        const Progress& progress) {
  check_options(options);
  const SampledSurface surface(mesh, progress.part(0, 0.2, "sampling the surface"));
  const std::optional<FoundPose> found =
      search_symmetry(surface, options, progress.part(0.2, 1, "looking for symmetries"));
  progress.update(1);
  if (!found) return std::nullopt;
  return in_mesh_frame(surface, *found);
}

std::string describe(const Symmetry& symmetry) {
  const Eigen::Matrix3d linear = symmetry.motion.linear();
  const Vector3 shift = symmetry.motion.translation();
  std::ostringstream out;
  switch (symmetry.kind) {
    case SymmetryKind::reflection:
      out << describe_reflection(linear, shift);
      break;
    case SymmetryKind::rotation:
      out << describe_rotation(linear, shift);
      break;
    case SymmetryKind::translation:
      out << "translation by " << text(shift);
      break;
  }
  if (symmetry.support) out << ", " << std::round(100 * *symmetry.support) << " % of the area matched";
  return out.str();
}

}  // namespace meshcomplete
