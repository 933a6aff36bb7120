#include "filter_volmorph/voxelize_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "common/core/closest_point.h"
#include "common/core/error.h"
#include "common/core/threads.h"
#include "common/core/triangle_blocks.h"
#include "filter_volmorph/block_descent.h"
#include "filter_volmorph/surface_signs.h"
#include "filter_volmorph/voxel_blocks.h"
#include "filter_volmorph/winding_number.h"

namespace meshcomplete {
namespace {

constexpr std::size_t blocks_at_once = 16;
constexpr std::size_t between_checks = 4096;  // vertices or triangles

/// Coordinates of up to 2^20 voxels, and distances between them, are rounded by far less voxels than this.
constexpr double rounding_pad = 1e-6;

TriangleMesh in_voxels(TriangleMesh mesh, const VolumeFrame& frame, const Progress& progress) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (v % between_checks == 0) progress.check();
    mesh.vertices[v] = frame.voxel(mesh.vertices[v]);
  }
  return mesh;
}

/// Without faces that are no triangles. Those with three vertices on a line stay: without them their
/// neighbours would seem to end there.
TriangleMesh usable(const TriangleMesh& mesh, const Progress& progress) {
  TriangleMesh result;
  result.vertices = mesh.vertices;
  result.triangles.reserve(mesh.triangles.size());
  bool area = false;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (f % between_checks == 0) progress.check();
    const Triangle& t = mesh.triangles[f];
    const Vector3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    if (!a.allFinite() || !b.allFinite() || !c.allFinite()) continue;
    result.triangles.push_back(t);
    area = area || (b - a).cross(c - a).squaredNorm() > 0;
  }
  if (area) return result;
  throw CompletionError("reading the mesh",
                        "There is no surface to voxelize: the mesh has no faces with an "
                        "area. A point cloud has to be triangulated first.");
}

struct Block {
  VoxelIndex low = VoxelIndex::Zero();
  bool near = false;  ///< a surface may be within the ramp of some voxel
};

/// The nearest point of the mesh to a voxel.
struct Nearest {
  double square = std::numeric_limits<double>::infinity();
  Index triangle = 0;
  ClosestPoint point;
};
using NearestPoints = std::array<Nearest, VoxelBlock::count>;

class Voxelizer {
 public:
  Voxelizer(const TriangleMesh& mesh, const VolumeFrame& frame, const Progress& progress)
      : mesh_(mesh),
        frame_(frame),
        ramp_(frame.ramp / frame.voxel_size),
        topology_(build_topology(mesh, progress.part(0, 0.3, "preparing the mesh"))),
        triangles_(mesh),
        winding_(mesh, topology_, progress.part(0.3, 0.7, "preparing the mesh")),
        signs_(mesh, topology_, progress.part(0.7, 1, "preparing the mesh")),
        blocks_(frame) {}

  std::size_t rim_edges() const { return topology_.boundary_half_edges.size(); }

  RangeVolume run(const VolumeSizeOptions& size, const Progress& progress) {
    const Progress descent = progress.part(0, 0.15, "finding the blocks near the surface");
    std::vector<Block> blocks = descend_to_blocks(
        frame_.box, Block(),
        [&](std::vector<Block>& all, std::size_t begin, std::size_t end, int side,
            std::vector<char>& undecided) {
          for (std::size_t i = begin; i < end; ++i) {
            descent.check();
            undecided[i] = !decide_cube(all[i], side, descent);
          }
        },
        descent);
    // Nearly all of them have seen voxels, since triangles were looked at and not only their boxes.
    constexpr double seen_share = 1;
    check_memory(static_cast<std::size_t>(
                     std::count_if(blocks.begin(), blocks.end(), [](const Block& b) { return b.near; })),
                 size, seen_share);

    const Progress filling = progress.part(0.15, 0.95, "measuring distances");
    for_ranges(blocks.size(), blocks_at_once, filling, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        blocks_.add(fill(blocks[i], filling));
        filling.advance(1.0 / static_cast<double>(blocks.size()));
      }
    });
    blocks = {};
    RangeVolume volume = blocks_.finish(progress.part(0.95, 1, "making the volume"));
    progress.update(1);
    return volume;
  }

 private:
  /// The box of a block's voxel middles, and of all that is within the ramp of them.
  Box reach(const VoxelIndex& low, int side) const {
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
      box.low[static_cast<std::size_t>(axis)] = low[axis] - ramp_;
      box.high[static_cast<std::size_t>(axis)] = low[axis] + side - 1 + ramp_;
    }
    return box;
  }

  /// Calls `visit(triangle)` until it returns false, for the triangles that may be within the ramp of a voxel
  /// middle of a cube.
  template <class Visit>
  void visit_near(const VoxelIndex& low, int side, const Progress& progress, Visit&& visit) const {
    constexpr std::size_t triangles_between_checks = 1024;
    const double half = (side - 1) / 2.0;
    const Vector3 middle = low.cast<double>().array() + half;
    std::size_t seen = 0;
    triangles_.visit(reach(low, side), [&](Index triangle) {
      if (++seen % triangles_between_checks == 0) progress.check();
      return beyond_ramp(triangle, middle, half) || visit(triangle);
    });
  }

  /// Whether a triangle is farther than the ramp from all of a cube: their projections onto the way from the
  /// cube's middle to the triangle's nearest point are. (Projections onto any line would prove it, so that it
  /// does not matter how well that point is known; on this line they are far apart where boxes of large
  /// tilted triangles are not.)
  bool beyond_ramp(Index triangle, const Vector3& middle, double half) const {
    const Triangle& t = mesh_.triangles[triangle];
    const Vector3 a = mesh_.vertices[t[0]] - middle, b = mesh_.vertices[t[1]] - middle,
                  c = mesh_.vertices[t[2]] - middle;
    const Vector3 way = closest_point(Vector3::Zero(), a, b, c).position;
    const double triangle_low = std::min({way.dot(a), way.dot(b), way.dot(c)});
    return triangle_low > half * way.lpNorm<1>() + (ramp_ + rounding_pad) * way.norm();
  }

  /// Whether all points of a ball without surface are inside, or all outside; nothing when it is not sure.
  std::optional<bool> inside(const Vector3& middle, double radius, double way) const {
    const double change = winding_.steepest(middle, radius);
    if (!std::isfinite(change)) return {};
    const double winding = winding_.at(middle);
    if (!(std::abs(winding - 0.5) > way * change + WindingNumber::largest_error)) return {};
    return winding > 0.5;
  }

  /// Whether all of a cube is on one side of the surface and beyond the ramp.
  bool decide_cube(Block& cube, int side, const Progress& progress) {
    cube.near = false;
    visit_near(cube.low, side, progress, [&](Index) {
      cube.near = true;
      return false;
    });
    if (cube.near) return false;
    const double half = (side - 1) / 2.0, radius = std::sqrt(3) * half;
    const Vector3 middle = cube.low.cast<double>().array() + half;
    const std::optional<bool> in = inside(middle, radius, radius);
    if (in && !*in) blocks_.add_empty(cube.low, side);
    return in.has_value();
  }

  static Vector3 position(const VoxelIndex& low, int i) {
    return (low + VoxelIndex(i / 64, i / 8 % 8, i % 8)).cast<double>();
  }

  /// Takes note of a triangle at the voxels within the ramp of its box.
  void measure(Index triangle, const VoxelIndex& low, NearestPoints& nearest) const {
    const Triangle& t = mesh_.triangles[triangle];
    const Box box = triangles_.triangle_box(triangle);
    int from[3], to[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double first = low[static_cast<int>(axis)], last = first + VoxelBlock::side - 1;
      from[axis] = static_cast<int>(std::ceil(std::max(box.low[axis] - ramp_, first) - first));
      to[axis] = static_cast<int>(std::floor(std::min(box.high[axis] + ramp_, last) - first));
    }
    for (int x = from[0]; x <= to[0]; ++x) {
      for (int y = from[1]; y <= to[1]; ++y) {
        for (int z = from[2]; z <= to[2]; ++z) {
          const Vector3 at = (low + VoxelIndex(x, y, z)).cast<double>();
          Nearest& best = nearest[static_cast<std::size_t>(VoxelBlock::number(x, y, z))];
          if (squared_distance(box, at) > std::min(best.square, ramp_ * ramp_)) continue;
          const ClosestPoint point =
              closest_point(at, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
          const double square = (point.position - at).squaredNorm();
          if (square < best.square || (square == best.square && triangle < best.triangle)) {
            best = {square, triangle, point};
          }
        }
      }
    }
  }

  VoxelBlock fill(const Block& source, const Progress& progress) const {
    VoxelBlock block;
    block.low = source.low;
    NearestPoints nearest;
    if (source.near) {
      visit_near(source.low, VoxelBlock::side, progress, [&](Index triangle) {
        measure(triangle, source.low, nearest);
        return true;
      });
    }
    std::array<bool, VoxelBlock::count> open{};  // the surface is not within the ramp
    for (int i = 0; i < VoxelBlock::count; ++i) {
      open[static_cast<std::size_t>(i)] = !(nearest[static_cast<std::size_t>(i)].square <= ramp_ * ramp_);
      if (!open[static_cast<std::size_t>(i)]) see(nearest[static_cast<std::size_t>(i)], i, block);
    }
    const double half = (VoxelBlock::side - 1) / 2.0;
    const Vector3 middle = source.low.cast<double>().array() + half;
    const double change = winding_.steepest(middle, std::sqrt(3) * half);
    for (int i = 0; i < VoxelBlock::count; ++i)
      if (open[static_cast<std::size_t>(i)]) decide(i, change, open, block);
    return block;
  }

  VoxelState side_of(const Vector3& at) const {
    return winding_.inside(at) ? VoxelState::unseen : VoxelState::empty;
  }

  /// A voxel within the ramp of the surface or of its rim.
  void see(const Nearest& nearest, int i, VoxelBlock& block) const {
    const auto at = static_cast<std::size_t>(i);
    const Vector3 voxel = position(block.low, i);
    const SurfacePlace place = signs_.place(nearest.triangle, nearest.point);
    if (place == SurfacePlace::rim) {
      block.state[at] = side_of(voxel);
      return;
    }
    const Vector3 normal = signs_.normal(nearest.triangle, nearest.point);
    const bool negative = place == SurfacePlace::ambiguous ? winding_.inside(voxel)
                                                           : (voxel - nearest.point.position).dot(normal) < 0;
    const double distance = std::sqrt(nearest.square) * frame_.voxel_size;
    const float ramp = static_cast<float>(frame_.ramp);
    block.state[at] = VoxelState::seen;
    block.distance[at] = std::clamp(static_cast<float>(negative ? -distance : distance), -ramp, ramp);
    block.weight[at] = 1;
    if (!normal.isZero()) block.normal[at] = pack_normal(normal.cast<float>());
  }

  /// The side of a voxel away from the surface, and of those joined to it within the block by a way that is
  /// too short for the winding number, which changes by `change` a voxel, to pass a half.
  void decide(int start, double change, std::array<bool, VoxelBlock::count>& open, VoxelBlock& block) const {
    const double winding = winding_.at(position(block.low, start));
    const VoxelState side = winding > 0.5 ? VoxelState::unseen : VoxelState::empty;
    const double room = std::abs(winding - 0.5) - WindingNumber::largest_error;
    std::array<short, VoxelBlock::count> queue, steps;
    std::size_t begin = 0, end = 0;
    const auto take = [&](int i, int way) {
      if (!open[static_cast<std::size_t>(i)] || (way > 0 && !(way * change < room))) return;
      open[static_cast<std::size_t>(i)] = false;
      block.state[static_cast<std::size_t>(i)] = side;
      steps[end] = static_cast<short>(way);
      queue[end++] = static_cast<short>(i);
    };
    take(start, 0);
    for (; begin < end; ++begin) {
      const int i = queue[begin];
      for (const int step : {64, 8, 1}) {
        const int place = i / step % VoxelBlock::side;
        if (place > 0) take(i - step, steps[begin] + 1);
        if (place + 1 < VoxelBlock::side) take(i + step, steps[begin] + 1);
      }
    }
  }

  const TriangleMesh& mesh_;
  const VolumeFrame& frame_;
  double ramp_;  ///< voxels
  MeshTopology topology_;
  TriangleBlocks triangles_;
  WindingNumber winding_;
  SurfaceSigns signs_;
  VoxelBlocks blocks_;
};

}  // namespace

VoxelizedMesh voxelize_mesh(const TriangleMesh& mesh, const VolumeSizeOptions& options,
                            const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  check_options(options);
  const Progress preparing = progress.part(0, 0.2, "preparing the mesh");
  TriangleMesh solid = usable(mesh, preparing);
  preparing.update(0.1);
  const VolumeFrame frame = choose_frame({&solid}, options, preparing.part(0.1, 0.3, "choosing the volume"));
  const TriangleMesh in_frame = in_voxels(std::move(solid), frame, preparing);
  Voxelizer voxelizer(in_frame, frame, preparing.part(0.3, 1, "preparing the mesh"));
  const double prepared = seconds();
  VoxelizedMesh result{
      voxelizer.run(options, progress.part(0.2, 1, "measuring distances")), {}, voxelizer.rim_edges(), {}};
  result.counts = result.volume.counts();
  result.stage_seconds = {{"preparing the mesh", prepared}, {"measuring distances", seconds() - prepared}};
  return result;
}

}  // namespace meshcomplete
