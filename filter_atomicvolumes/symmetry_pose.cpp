#include "filter_atomicvolumes/symmetry_pose.h"

#include <Eigen/Geometry>

namespace meshcomplete {
namespace {

constexpr double pi = 3.14159265358979323846;

// The same motion with the point that is nearest to the origin, about which changes of direction pivot.
SymmetryPose centred(SymmetryPose pose) {
  const double along = pose.direction.dot(pose.point);
  if (pose.kind == SymmetryKind::reflection) pose.point = along * pose.direction;
  if (pose.kind == SymmetryKind::rotation) pose.point -= along * pose.direction;
  return pose;
}

}  // namespace

SymmetryMotion::SymmetryMotion(const SymmetryPose& pose) {
  const Vector3& n = pose.direction;
  switch (pose.kind) {
    case SymmetryKind::reflection:
      linear -= 2 * n * n.transpose();
      shift = 2 * n.dot(pose.point) * n;
      break;
    case SymmetryKind::rotation:
      linear = Eigen::AngleAxisd(2 * pi / pose.fold, n).toRotationMatrix();
      shift = pose.point - linear * pose.point;
      break;
    case SymmetryKind::translation:
      shift = pose.point;
      break;
  }
}

PoseFreedom::PoseFreedom(const SymmetryPose& pose)
    : pose_(centred(pose)),
      motion_(pose_),
      first_(pose.direction.unitOrthogonal()),
      second_(pose.direction.cross(first_)) {}

PoseFreedom::Derivatives PoseFreedom::derivatives(const Vector3& x) const {
  Derivatives d = Derivatives::Zero();
  const Vector3& n = pose_.direction;
  const Vector3 y = x - pose_.point;
  if (pose_.kind == SymmetryKind::translation) {
    d.leftCols<3>().setIdentity();
  } else if (pose_.kind == SymmetryKind::reflection) {
    d.col(0) = -2 * (first_.dot(y) * n + n.dot(y) * first_);
    d.col(1) = -2 * (second_.dot(y) * n + n.dot(y) * second_);
    d.col(2) = 2 * n;
  } else {
    // Turning the axis with angular velocity w turns the image along, and the original back.
    const Vector3 image = motion_.linear * y;
    for (int k = 0; k < 2; ++k) {
      const Vector3& to = k == 0 ? first_ : second_;
      const Vector3 w = n.cross(to);
      d.col(k) = w.cross(image) - motion_.linear * w.cross(y);
      d.col(2 + k) = to - motion_.linear * to;
    }
  }
  return d;
}

SymmetryPose PoseFreedom::moved(const Step& step) const {
  SymmetryPose pose = pose_;
  if (pose.kind == SymmetryKind::translation) {
    pose.point += step.head<3>();
    return pose;
  }
  pose.direction = (pose.direction + step[0] * first_ + step[1] * second_).normalized();
  if (pose.kind == SymmetryKind::reflection)
    pose.point += step[2] * pose_.direction;
  else
    pose.point += step[2] * first_ + step[3] * second_;
  return centred(pose);
}

Vector3 direction_of_travel(const SymmetryPose& pose, const Vector3& x) {
  switch (pose.kind) {
    case SymmetryKind::reflection:
      return Vector3::Zero();
    case SymmetryKind::rotation:
      return pose.direction.cross(x - pose.point).normalized();
    case SymmetryKind::translation:
      return pose.point.normalized();
  }
  return Vector3::Zero();
}

}  // namespace meshcomplete
