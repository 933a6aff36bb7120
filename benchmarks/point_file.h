// Point sets with normals in files, for programs that are measured in processes of their own.
#pragma once

#include <string>
#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete::benchmarks {

struct OrientedPoints {
  std::vector<Vector3> points, normals;
};

/// Binary PLY with floats. Throws std::runtime_error.
void write_points(const std::string& path, const OrientedPoints& set);

/// Reads PLY points with normals. Throws std::runtime_error.
OrientedPoints read_points(const std::string& path);

}  // namespace meshcomplete::benchmarks
