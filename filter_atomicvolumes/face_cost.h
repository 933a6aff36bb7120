// What the faces between volumes cost the cut.
#pragma once

#include "common/core/implicit_function.h"
#include "filter_atomicvolumes/atomic_volumes.h"

namespace meshcomplete {

/// A weight, and for `CutWeight::poisson` the function whose zero set faces should lie on. Where there is
/// none, faces cost their area. The function must outlive this.
class FaceCost {
 public:
  FaceCost(CutWeight weight, const ImplicitFunction* oracle = nullptr)  // NOLINT: a weight alone will do
      : weight_(weight), oracle_(weight == CutWeight::poisson ? oracle : nullptr) {}

  CutWeight weight() const { return weight_; }
  /// Whether the cost depends on where a face is.
  bool asks_oracle() const { return oracle_ != nullptr; }
  /// Of a face of this area (mesh units squared), wherever it is.
  double most(double area) const;
  /// Which share of that a face costs whose middle and longest side (mesh units, positive) are given:
  /// 0.05 + 0.95 min(1, d)^2, d being the distance of the middle from the zero set in sizes of the face, by
  /// the function's value and slope there. 1 without a function. Cost: four values of the function.
  double closeness(const Vector3& middle, double size) const;

 private:
  CutWeight weight_;
  const ImplicitFunction* oracle_;
};

}  // namespace meshcomplete
