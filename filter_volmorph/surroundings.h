// The space round the scanned objects, emptied as far as it lies before what was observed.
#pragma once

#include <cstdint>

#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

struct SurroundingsResult {
  RangeVolume volume;
  std::uint64_t emptied = 0;  ///< voxels that were unseen
};

/// Components of the observed surface that are narrower than so many ramps, or so many voxels if that is
/// wider (`without_narrow_components`), are noise and decide nothing; the largest always decides. It is no
/// share of the largest: a coin on a backdrop has its inside, too. Specks and slivers between scans are a
/// few voxels wide, but often long.
constexpr double widest_noise_ramps = 2;
constexpr double widest_noise_voxels = 8;

/// Scans without a backdrop leave large regions unseen outside the object, where no line of sight went
/// through: the closed surface would show them as solid. Every unseen voxel that lies before the observed
/// surface (`SurfaceSides`, from `extract_surface` with `observed_only`) becomes empty. Behind the surface
/// all stays unseen, so that a single scan keeps what it hides; at holes the membrane of the winding number
/// divides the two. Seen voxels stay, and so do all grids but the state's; distances that a filler has
/// stored at changed voxels are forgotten. A volume without observed surface stays as it is.
///
/// The thesis's volumes have nothing unseen outside the object (figure 3.1) and do not say how; this is our
/// own. The same whatever the number of threads. Throws Cancelled. Cost: O(surface), and for every unseen
/// voxel where before and behind are near each other a search of O(log faces); other regions are decided as
/// cubes of up to 4096 voxels a side.
SurroundingsResult empty_surroundings(const RangeVolume& volume, const Progress& progress = Progress());

}  // namespace meshcomplete
