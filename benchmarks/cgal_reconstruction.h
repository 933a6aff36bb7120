// CGAL's poisson_surface_reconstruction_delaunay, to compare with.
#pragma once

#include "benchmarks/point_file.h"
#include "common/core/mesh.h"

namespace meshcomplete::benchmarks {

/// With the points' average distance from their six neighbours as the spacing, as CGAL's manual has it, and
/// its defaults otherwise. Throws std::runtime_error.
TriangleMesh reconstruct_with_cgal(const OrientedPoints& set);

}  // namespace meshcomplete::benchmarks
