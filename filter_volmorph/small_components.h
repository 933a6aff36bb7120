// A surface without the small pieces that float beside it.
#pragma once

#include <cstddef>

#include "common/core/mesh.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// The mesh without its components (connected over vertices) of fewer than `faces` faces, and without the
/// vertices that only they used; what is left keeps its order. 0 and 1 keep all. Cost: O(faces).
TriangleMesh without_small_components(TriangleMesh mesh, std::size_t faces,
                                      const Progress& progress = Progress());

/// The mesh without its components (connected over vertices) that are narrower than `width`: shorter than it
/// (the longest side of the bounding box), or with an area smaller than a strip of this width and their
/// length. The component with the most faces (of several the one with the first face) always stays. Else
/// as above.
TriangleMesh without_narrow_components(TriangleMesh mesh, double width,
                                       const Progress& progress = Progress());

}  // namespace meshcomplete
