// How well a motion takes a surface to itself, and the registration that makes it do so better.
#pragma once

#include <cstddef>
#include <vector>

#include "filter_atomicvolumes/symmetry_pose.h"
#include "filter_atomicvolumes/symmetry_surface.h"

namespace meshcomplete {

/// What becomes of the samples under a motion.
struct SymmetryFit {
  double support = 0;  ///< share of the area whose image lies on the surface, facing the same way
  /// Of the area whose image tells something, the share that agrees. An image beyond a rim, or for a
  /// translation beyond the bounding box, tells nothing; one that only slid along the surface tells little.
  double agreement = 0;
  double closeness = 0;  ///< as agreement, but what agrees counts the more the nearer its image is
  double score = 0;      ///< to compare poses: closeness, and somewhat of the support
};

/// By which neighbours images are judged.
enum class Neighbours {
  rough,  ///< tangent planes from the surface's table: fast, and does not know the sides of a thin plate
          ///< apart
  exact,  ///< the closest points of the mesh that face the same way
};

/// Looks at every `stride`-th sample. `radius` is how far an image may be from the surface, in diagonals.
SymmetryFit fit_of(const SampledSurface& surface, const SymmetryPose& pose, Neighbours neighbours,
                   double radius, std::size_t stride);

/// Iterative closest points within the family of the pose: a Gauss-Newton step for each radius, on the
/// distances to the neighbours within it along the mean of both normals; what is further off does not pull.
/// Ends before the last radii when these are equal and nothing moves any more. Sources: Rusinkiewicz, "A
/// symmetric objective function for ICP", 2019; the trimming is Tukey's biweight.
SymmetryPose registered(const SampledSurface& surface, SymmetryPose pose, Neighbours neighbours,
                        const std::vector<double>& radii, std::size_t stride);

}  // namespace meshcomplete
