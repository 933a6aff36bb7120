// The paper's smoothing (section 5): the patch's vertices are pulled as if springs joined them to their
// neighbours, and no volume loses its centre.
#pragma once

#include <cstddef>
#include <vector>

#include "common/core/progress.h"
#include "filter_atomicvolumes/extraction.h"
#include "filter_atomicvolumes/volume_warp.h"

namespace meshcomplete {

struct VolumeSmoothingOptions {
  int iterations = 20;          ///< 0 or more
  bool moving_centres = false;  ///< the centres follow their volumes' centroids (section 7)
  /// Points that must stay in their volumes, in place of the centroids. Nodes as in the complex.
  std::vector<VolumePoint> points;
  /// Price of going against one suggestion, as a share of the area of the cube's face, positive. With a fifth
  /// to a half the second patch comes out smoother than the first; near 1 the surface is ruled by suggestions
  /// and has more stairs.
  double suggestion = 0.3;
  /// What the cut after the suggestions makes small. Where that is the number of faces, a suggestion costs
  /// this share of a sixth of the cube's faces.
  FaceCost cost = CutWeight::area;
};

struct VolumeSmoothingFigures {
  std::size_t movable = 0;   ///< vertices that are not on the rim
  std::size_t moved = 0;     ///< of these, in the end
  std::size_t put_back = 0;  ///< because their triangles met something, or because of a neighbour that did
};

/// Moves the vertices of the surface that are points of the octree; rim, triangles and labels stay. In every
/// iteration all are pulled to the mean of where their neighbours were before it. One after the other, by
/// number, goes there, or half the way, a quarter, and so on, if with all that have gone before it every
/// volume at it keeps its centre (it stays star-shaped about it) and no triangle at it enters a cube that the
/// mesh divides; otherwise it stays for this iteration. In the end vertices of triangles that meet the input
/// or each other, which rounding to floats and cubes nearby make possible, go back to where they started.
/// With 0 iterations nothing changes, otherwise all movable vertices are rounded to floats. Deterministic.
/// Throws `Cancelled`. Cost: that of `VolumeWarp` and O(faces of volumes at the patch) for each iteration.
VolumeSmoothingFigures smooth_constrained(const LatticeMesh& mesh, const Decomposition& decomposition,
                                          const VolumeComplex& complex, LabelledSurface& surface,
                                          const VolumeSmoothingOptions& options,
                                          const Progress& progress = Progress());

/// Smooths without constraints, and suggests to each blank cube that the smoothed surface passes through the
/// side of the surface on which its centre lies: ties for a new cut, ascending by node, with prices in its
/// unit (paper, section 5). `surface` should not be smoothed yet; the new cut's is then smoothed with
/// constraints. Cost: O(triangles * iterations) and the cubes that the surface meets.
std::vector<NodeTie> suggest_by_springs(const LatticeMesh& mesh, const Decomposition& decomposition,
                                        const VolumeComplex& complex, const LabelledSurface& surface,
                                        const VolumeSmoothingOptions& options,
                                        const Progress& progress = Progress());

/// The mean angle between the normals of neighbouring triangles, in degrees, every edge weighted by its
/// length; 0 without such. Edges where more than two triangles meet are left out.
double mean_normal_jump(const LabelledSurface& surface);

}  // namespace meshcomplete
