// Where a search for symmetries starts: poses so dense that a registration from the best of them finds the
// symmetry.
#pragma once

#include <vector>

#include "filter_atomicvolumes/symmetry_pose.h"
#include "filter_atomicvolumes/symmetry_surface.h"

namespace meshcomplete {

/// Planes in the directions of the principal axes and in directions spread evenly over the sphere, at offsets
/// that leave a part of the surface on either side. Several thousand, in the surface's frame, whatever the
/// surface.
std::vector<SymmetryPose> reflection_starts(const SampledSurface& surface);

/// Axes in the same directions round the middle, for every fold from 2 to `highest_fold`: some thousand for
/// each.
std::vector<SymmetryPose> rotation_starts(const SampledSurface& surface, int highest_fold);

/// Translations longer than `least_shift` that take many pairs of samples to each other; one of each pair of
/// opposite ones, at most a few thousand, those with most pairs first.
std::vector<SymmetryPose> translation_starts(const SampledSurface& surface, double least_shift);

}  // namespace meshcomplete
