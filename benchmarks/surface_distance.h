// How far surfaces are from each other: points spread over one of them, measured from the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "benchmarks/point_file.h"
#include "common/core/mesh.h"

namespace meshcomplete::benchmarks {

/// So many points spread at random over the faces, evenly by area, with the faces' normals.
OrientedPoints points_on(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed = 1);

/// Random numbers from 0 up to 1, the same everywhere.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : random_(seed) {}
  double operator()() { return static_cast<double>(random_() >> 11) / 9007199254740992.0; }

 private:
  std::mt19937_64 random_;
};

struct Distance {
  double root_mean_square = 0, greatest = 0;  ///< mesh units
};

/// Of points from a surface whose distance function is given.
Distance distance_of(const std::vector<Vector3>& points,
                     const std::function<double(const Vector3&)>& distance);

/// The distance function of a mesh, which may be asked after the mesh is gone.
std::function<double(const Vector3&)> distance_function(const TriangleMesh& mesh);

/// Of the bounding box of all vertices.
double diagonal_of(const TriangleMesh& mesh);

}  // namespace meshcomplete::benchmarks
