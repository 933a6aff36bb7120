// The parts of poisson_benchmark: each prints its tables.
#pragma once

#include <filesystem>
#include <vector>

#include "benchmarks/known_surfaces.h"

namespace meshcomplete::benchmarks {

/// Screened Poisson on the same samples at the same depths, beside MeshLab's; both by marching cubes.
void solver(const std::vector<KnownSurface>& truths, const std::filesystem::path& programs);

/// Residuals level by level, and what a smaller tolerance brings.
void convergence(const std::vector<KnownSurface>& truths);

/// Values of the function in a second.
void oracle(const std::vector<KnownSurface>& truths);

/// Meshes of the reconstruction, by several programs.
void remeshing(const std::vector<KnownSurface>& truths, const std::filesystem::path& programs);

/// Our meshes by distance and angle.
void criteria(const std::vector<KnownSurface>& truths, const std::filesystem::path& programs);

}  // namespace meshcomplete::benchmarks
