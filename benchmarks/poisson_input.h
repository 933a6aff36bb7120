// The octree and the oracle that the benchmarks compare with MeshLab's Screened Poisson.
#pragma once

#include "benchmarks/point_file.h"
#include "common/core/poisson_oracle.h"

namespace meshcomplete::benchmarks {

/// MeshLab's scale: with it an octree of one depth has cubes of one size in both programs.
constexpr double meshlab_scale = 1.1;

/// The reconstruction of a point set in an octree as deep as that at the points, where they are dense enough.
PoissonOracle oracle_of(const OrientedPoints& set, int depth, const ScreenedPoissonOptions& options = {});

}  // namespace meshcomplete::benchmarks
