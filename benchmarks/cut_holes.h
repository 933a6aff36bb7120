// Holes cut into whole meshes, to measure with: long ones that wind over the surface, and round ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete {
namespace benchmarks {

/// Where a cut may begin.
struct Region {
  Vector3 centre = Vector3::Zero();
  double radius = 0;  ///< 0: anywhere
};

/// What a winding cut has to be like, apart from its length.
enum class Rim {
  any,
  strongly_curved,  ///< neither the best-fitting plane nor the plane of the greatest area shows it simple
  overlapping,      ///< no projection along 50 directions is simple
};

struct CutMesh {
  TriangleMesh mesh;         ///< without the faces cut away and the vertices that only they used
  std::vector<Vector3> rim;  ///< in the order of the loop
  std::uint32_t seed = 0;    ///< that led to the cut
};

/// Cuts away the faces round a path that winds over the surface, so that the rim has `size` vertices and
/// bounds what was a disk, not touching any other boundary. The path: from a random vertex in `region` along
/// a direction that turns in waves, from vertex to vertex. The first seed from `seed` on is taken that gives
/// such a rim; none if there is none among `tries`. `rings`: rings of faces cut away on each side of the
/// path.
std::optional<CutMesh> cut_winding_hole(const TriangleMesh& mesh, std::size_t size, Rim rim,
                                        std::uint32_t seed = 1, const Region& region = Region(),
                                        int rings = 1, int tries = 20000);

/// Cuts away the faces of which a corner lies in the ball and that hang together with the vertex nearest to
/// its centre. None when what is cut away is no disk.
std::optional<CutMesh> cut_round_hole(const TriangleMesh& mesh, const Region& ball);

/// Every face split into four, corners and edge midpoints where they are, rounded to floats.
TriangleMesh subdivided(const TriangleMesh& mesh);

}  // namespace benchmarks
}  // namespace meshcomplete
