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

/// The faces of the component with the most. Cost: O(faces).
std::size_t largest_component(const TriangleMesh& mesh, const Progress& progress = Progress());

}  // namespace meshcomplete
