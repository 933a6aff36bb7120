#include "common/core/completion_oracle.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "common/core/edge_length_field.h"
#include "common/core/rim.h"
#include "common/core/wall_thickness.h"

namespace meshcomplete {
namespace {

// Where walls are thinner than edges, cubes are as small as they are thick, but for so much: with larger ones
// the two sides run into one. Still smaller ones make the seams no better, and where a wall thins out, as at
// the edges of wings, they follow its noise.
constexpr double smallest_in_wall = 0.5;
// Thinner walls than this part of an edge are taken for flaws of the scan.
constexpr double thinnest_wall = 0.25;

// Cubes grow by this share of the distance from the rims: a quarter of what a balanced octree allows, so that
// the surroundings of a hole are known well.
constexpr double cube_growth = 0.125;

// How fine the octree has to be at the rims: as their edges, and finer in thin walls.
EdgeLengthField resolution(const TriangleMesh& mesh, const OpenMesh& open, const InputNeighbourhood& input) {
  std::vector<RimSample> samples;
  for (const BoundaryLoop* loop : loops_to_close(open.loops, open.holes)) {
    const Rim rim = collect_rim(mesh, open.topology, *loop);
    std::vector<double> lengths = rim.edge_length;
    for (std::size_t k = 0; k < loop->faces.size(); ++k) {
      const Triangle& t = mesh.triangles[loop->faces[k]];
      const Vector3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      const Vector3 normal = (b - a).cross(c - a).normalized();
      const auto wall =
          wall_thickness(input.blocks(), (a + b + c) / 3, normal, thinnest_wall * lengths[k], lengths[k]);
      if (wall) lengths[k] = std::max(*wall, smallest_in_wall * lengths[k]);
    }
    const std::vector<RimSample> more = smoothed_samples(rim.positions, lengths);
    samples.insert(samples.end(), more.begin(), more.end());
  }
  return EdgeLengthField(std::move(samples));
}

}  // namespace

PoissonOracle make_completion_oracle(const TriangleMesh& mesh, const OpenMesh& open,
                                     const InputNeighbourhood& input, const OrientedSurfaces& guides,
                                     const PoissonOracleOptions& options, const Progress& progress) {
  const EdgeLengthField cubes = resolution(mesh, open, input);
  const CubeSizes sizes{
      [&](const Vector3& at) { return std::max(cubes.at(at), cube_growth * cubes.distance(at)); },
      cubes.shortest()};
  return make_oracle(&mesh, guides, sizes, options, progress);
}

}  // namespace meshcomplete
