// The patch that a labelling means: the faces between volumes of unlike labels.
#pragma once

#include <array>
#include <vector>

#include "common/core/sheets.h"
#include "filter_atomicvolumes/labelling.h"
#include "filter_atomicvolumes/volume_complex.h"

namespace meshcomplete {

/// Triangles between inside and outside, the outside before them. Corners on the rim are boundary vertices of
/// the mesh or Steiner points of boundary edges.
struct LabelledSurface {
  std::vector<VolumeVertex> vertices;
  std::vector<Triangle> triangles;
  struct Between {
    Cell inside, outside;
  };
  std::vector<Between> volumes;  ///< of each triangle
};

/// The faces between unlike labels, every vertex of the complex on their sides used. Its edges may have more
/// than two faces where volumes touch. Cost: O(faces of the complex).
LabelledSurface extract(const LatticeMesh& mesh, const Octree& octree, const VolumeComplex& complex,
                        const Labelling& labelling);

/// The same without what the octree knows of it.
SeparatingSurface separating(const LabelledSurface& surface);

}  // namespace meshcomplete
