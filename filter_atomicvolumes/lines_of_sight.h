// Space carving: what a camera or scanner saw through is outside (paper, section 4.3).
#pragma once

#include <string>
#include <vector>

#include "common/core/progress.h"
#include "common/core/triangle_blocks.h"
#include "filter_atomicvolumes/atomic_volumes.h"
#include "filter_atomicvolumes/volume_complex.h"

namespace meshcomplete {

/// The part of a line of sight that is known to be empty.
struct LineOfSight {
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();
};

struct LinesOfSight {
  std::vector<LineOfSight> lines;
  std::vector<std::string> notes;  ///< for the user
};

/// A line ends where it meets the mesh, at the latest at the point seen, and in either case earlier by
/// `spacing`, so that neither noise nor a volume round the point itself is carved. Left out are lines that
/// meet the mesh from behind (what lies before is inside according to the mesh; the scan is not registered to
/// it there) and those with coordinates that are not finite. `spacing`: the distance between the mesh's
/// samples, mesh units. Cost: O(log faces + triangles near the line) a line; threaded.
LinesOfSight lines_of_sight(const TriangleBlocks& blocks, const std::vector<VolumeConstraints::View>& views,
                            double spacing, const Progress& progress = Progress());

/// Per cube of the octree, whether it is a blank leaf that is seen through: a line passes through it for at
/// least half the mean length of chords (4 volumes over surface). What is only grazed is not, nor what a line
/// ends in. Lines have no width: giving them that of the samples changed no result, since cubes away from the
/// rims are larger than that. Cost: O(leaves passed * depth) a line; threaded.
std::vector<char> leaves_seen_through(const Lattice& lattice, const Decomposition& decomposition,
                                      const std::vector<LineOfSight>& lines,
                                      const Progress& progress = Progress());

/// The same for the nodes of the complex: blank leaves and free tetrahedra.
std::vector<char> nodes_seen_through(const Lattice& lattice, const Decomposition& decomposition,
                                     const VolumeComplex& complex, const std::vector<LineOfSight>& lines,
                                     const Progress& progress = Progress());

}  // namespace meshcomplete
