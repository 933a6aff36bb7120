// Reading and writing mesh files for the comparison, without MeshLab: the checker must not share the readers
// of the programs that it checks.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete {
namespace benchmarks {

/// Reads OFF, OBJ, PLY or STL. Coordinates are rounded to floats, which is what every program here works on;
/// polygons become fans; vertices keep their order, except in STL, whose corners at equal positions are
/// merged. Throws std::runtime_error.
TriangleMesh read_mesh(const std::string& path);

using Colour = std::array<std::uint8_t, 3>;

/// Writes binary PLY with float coordinates. `colours`: none, or one per vertex. Throws std::runtime_error.
void write_ply(const std::string& path, const TriangleMesh& mesh, const std::vector<Colour>& colours = {});

}  // namespace benchmarks
}  // namespace meshcomplete
