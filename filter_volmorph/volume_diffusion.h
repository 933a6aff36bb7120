// Filling holes in a volume by diffusion of the distances.
#pragma once

#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

struct DiffusionOptions {
  /// Steps of blurring; each fills one voxel more, seen from the rims of the observed surface. At least 1.
  /// A hole is closed by half its width and smoothed by what is left.
  int iterations = 100;

  /// Voxels farther than this from every rim, counted in steps to one of 26 neighbours, stay as they are. At
  /// least 1. A hole needs half its width.
  int reach = 32;

  /// Whether voxels known to be empty stay outside, at least half a voxel from the surface, and pull their
  /// surroundings outwards.
  bool line_of_sight = true;

  /// How much of an empty voxel's distance is the ramp in each step and not the blurred distance, 0 to 1: the
  /// confidence in the line of sight.
  double empty_weight = 0.2;

  /// Whether distances spread along the surface, perpendicular to the normals, rather than across it.
  bool normals = true;

  /// Bytes that the voxels within reach may take, above 0.
  double max_memory = 4e9;
};

/// Davis, Marschner, Garr and Levoy (2002), sections 3 and 4.3, in a box (cut to the volume's): in each step
/// every voxel within reach takes the mean of its known neighbours, seen voxels keep their distances. A
/// neighbour counts more the nearer it is, and the more its direction is perpendicular to the normal there
/// (Firestone 2008, chapter 5), which spreads from the seen voxels, too. What an earlier diffusion filled is
/// known from the start: two runs of n steps are one of 2 n. Only distances of voxels that are not seen
/// change; states, weights and normals are shared with `volume`, and what stays unfilled is filled as VRIP
/// does. Throws CompletionError when the box lies outside the volume, an option is out of its range, or the
/// voxels within reach take more memory than allowed. Deterministic. Cost: proportional to iterations times
/// the voxels within reach; about 60 bytes for each of these; threaded.
RangeVolume diffuse(const RangeVolume& volume, const VoxelBox& box, const DiffusionOptions& options,
                    const Progress& progress = Progress());

}  // namespace meshcomplete
