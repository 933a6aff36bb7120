// CGAL's triangulate_refine_and_fair_hole, to compare with.
#pragma once

#include <cstddef>

#include "common/core/mesh.h"

namespace meshcomplete {
namespace benchmarks {

struct CgalFilling {
  TriangleMesh mesh;
  std::size_t holes = 0;
  std::size_t filled = 0;
  double seconds = 0;  ///< finding the holes and filling them, on CGAL's mesh
};

/// Closes every hole. CGAL fills holes of orientable 2-manifold meshes only, so that the mesh is first
/// oriented, and split at vertices and edges that are not manifold, by CGAL's own tools; that is not in the
/// seconds.
CgalFilling fill_with_cgal(const TriangleMesh& mesh);

}  // namespace benchmarks
}  // namespace meshcomplete
