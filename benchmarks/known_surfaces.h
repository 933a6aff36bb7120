// Surfaces that are known exactly, with points to reconstruct them from and points to measure with.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "benchmarks/point_file.h"
#include "benchmarks/surface_distance.h"
#include "common/core/mesh.h"

namespace meshcomplete::benchmarks {

struct KnownSurface {
  std::string name;
  OrientedPoints samples;                          ///< single-precision numbers
  std::vector<Vector3> probes;                     ///< other points of the surface
  std::function<double(const Vector3&)> distance;  ///< from the surface
  double diagonal = 0;                             ///< of its bounding box
};

/// Of radius 1.
KnownSurface known_sphere(std::size_t samples);
/// With radii 1 and 0.4.
KnownSurface known_torus(std::size_t samples);
/// A closed mesh, with the faces' normals.
KnownSurface known_mesh(const std::string& name, const TriangleMesh& mesh, std::size_t samples);

/// How far a reconstruction is from the truth, in thousandths of the diagonal.
struct Accuracy {
  double samples = 0;                   ///< from the samples to the result, root mean square
  double from_truth = 0, greatest = 0;  ///< from the truth to the result, root mean square and most
  double to_truth = 0;                  ///< from the result to the truth, root mean square
};
Accuracy accuracy_of(const TriangleMesh& result, const KnownSurface& truth);

}  // namespace meshcomplete::benchmarks
