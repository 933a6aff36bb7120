// The search for the motion that takes a surface to itself best.
#pragma once

#include <optional>

#include "common/core/progress.h"
#include "filter_atomicvolumes/symmetry.h"
#include "filter_atomicvolumes/symmetry_pose.h"
#include "filter_atomicvolumes/symmetry_registration.h"
#include "filter_atomicvolumes/symmetry_surface.h"

namespace meshcomplete {

/// A pose, in the surface's frame, with how well it does.
struct FoundPose {
  SymmetryPose pose;
  SymmetryFit fit;
};

/// What `detect_symmetry` promises, for options within their ranges. From tens of thousands of poses the
/// better ones are registered, ever fewer of them ever more exactly; the number of samples looked at is the
/// same for every surface.
std::optional<FoundPose> search_symmetry(const SampledSurface& surface,
                                         const SymmetryDetectionOptions& options,
                                         const Progress& progress = Progress());

}  // namespace meshcomplete
