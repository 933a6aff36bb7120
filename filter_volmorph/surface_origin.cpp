#include "filter_volmorph/surface_origin.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "common/core/threads.h"
#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {
namespace {

constexpr std::size_t vertices_at_once = 4096;

/// A place on an edge of the lattice of voxels: `along` is 0 at `low` and 1 at the next voxel on the axis.
struct EdgePlace {
  VoxelIndex low, high;
  double along;
};

/// Two of the numbers are whole but for rounding.
EdgePlace edge_place(const Vector3& voxel) {
  const Vector3 nearest = voxel.array().round();
  Eigen::Index axis = 0;
  (voxel - nearest).cwiseAbs().maxCoeff(&axis);
  EdgePlace place{nearest.cast<int>(), nearest.cast<int>(), 0};
  const double below = std::floor(voxel[axis]);
  place.low[axis] = static_cast<int>(below);
  place.high[axis] = place.low[axis] + 1;
  place.along = voxel[axis] - below;
  return place;
}

class Origins {
 public:
  explicit Origins(const RangeVolume& volume)
      : voxels_(volume), distances_(volume.grids().distance->getConstAccessor()) {}

  std::pair<SurfaceOrigin, float> at(const EdgePlace& place) const {
    const SurfaceOrigin origin = std::max(of(to_coord(place.low)), of(to_coord(place.high)));
    if (origin != SurfaceOrigin::observed) return {origin, 0.f};
    const float low = voxels_.weight(to_coord(place.low)), high = voxels_.weight(to_coord(place.high));
    return {origin, low + static_cast<float>(place.along) * (high - low)};
  }

 private:
  SurfaceOrigin of(const openvdb::Coord& voxel) const {
    if (voxels_.state(voxel) == VoxelState::seen) return SurfaceOrigin::observed;
    return distances_.isValueOn(voxel) ? SurfaceOrigin::filled : SurfaceOrigin::boundary;
  }

  VoxelReader voxels_;
  openvdb::FloatGrid::ConstAccessor distances_;
};

}  // namespace

std::size_t SurfaceOrigins::count(SurfaceOrigin origin) const {
  return static_cast<std::size_t>(std::count(faces.begin(), faces.end(), origin));
}

SurfaceOrigins surface_origins(const RangeVolume& volume, const TriangleMesh& surface,
                               const Progress& progress) {
  SurfaceOrigins result;
  result.weights.resize(surface.vertices.size());
  std::vector<SurfaceOrigin> of_vertex(surface.vertices.size());
  for_ranges(surface.vertices.size(), vertices_at_once, progress, [&](std::size_t begin, std::size_t end) {
    const Origins origins(volume);
    for (std::size_t v = begin; v < end; ++v)
      std::tie(of_vertex[v], result.weights[v]) =
          origins.at(edge_place(volume.frame().voxel(surface.vertices[v])));
  });
  result.faces.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles)
    result.faces.push_back(std::max({of_vertex[t[0]], of_vertex[t[1]], of_vertex[t[2]]}));
  progress.update(1);
  return result;
}

}  // namespace meshcomplete
