#include "filter_volmorph/volume_size.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <unordered_set>

#include "common/core/box_tree.h"
#include "common/core/parameter_checks.h"

namespace meshcomplete {
namespace {

constexpr double default_ramp = 4, default_margin = 2;  // voxels
constexpr int leaf_side = 8;

/// Distance, weight and normal take 4 bytes each for every voxel of a leaf, its state a bit or two; the rest
/// is nodes above and lists on the way.
constexpr double bytes_per_leaf = 7000;

/// Larger numbers of voxels along an axis are a mistake, and 2^-53 of them is still far below `rounding_pad`.
constexpr double most_voxels = 1 << 20;

/// A surface that lies anyhow meets 1.5 times as many cubes as its area has squares of their side: the mean
/// of |x| + |y| + |z| over unit normals.
constexpr double cubes_per_square = 1.5;

/// How finely surfaces are looked at to estimate memory: cells along the diagonal.
constexpr double coarse_cells = 256;

constexpr std::size_t between_checks = 1024;  // triangles; each is up to some ten thousand coarse cells

/// What is suggested instead keeps this part of the limit, since the estimate is one.
constexpr double suggested_share = 0.8;

std::string number(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", x);
  return text.data();
}

/// (More is written as this much, rather than as infinite.)
std::string gigabytes(double bytes) { return number(std::min(bytes, 1e30) / 1e9) + " GB"; }

Box bounds_of(const std::vector<const TriangleMesh*>& surfaces) {
  Box bounds;
  for (const TriangleMesh* mesh : surfaces)
    for (const Triangle& t : mesh->triangles)
      bounds.include(bounding_box(mesh->vertices[t[0]], mesh->vertices[t[1]], mesh->vertices[t[2]]));
  return bounds;
}

/// About how many cells of a side meet the surfaces.
class CellCount {
 public:
  CellCount(const Vector3& low, double side) : low_(low), side_(side) {}

  void add(const Vector3& a, const Vector3& b, const Vector3& c) {
    // Steps along the two shorter edges, from the corner between them.
    std::array<const Vector3*, 3> corners{&a, &b, &c};
    const auto opposite = [&](int k) {
      return (*corners[(k + 1) % 3] - *corners[(k + 2) % 3]).squaredNorm();
    };
    int start = 0;
    for (int k = 1; k < 3; ++k)
      if (opposite(k) > opposite(start)) start = k;
    const Vector3& from = *corners[start];
    const Vector3 u = *corners[(start + 1) % 3] - from, v = *corners[(start + 2) % 3] - from;
    const int m = 1 + static_cast<int>(u.norm() / side_), n = 1 + static_cast<int>(v.norm() / side_);
    for (int i = 0; i <= m; ++i)
      for (int j = 0; j * m <= (m - i) * n; ++j) add(from + u * (double(i) / m) + v * (double(j) / n));
  }
  std::size_t count() const { return cells_.size(); }

 private:
  void add(const Vector3& point) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      key = key << 21 | static_cast<std::uint64_t>(std::max(0.0, (point[axis] - low_[axis]) / side_));
    }
    cells_.insert(key);
  }
  Vector3 low_;
  double side_;
  std::unordered_set<std::uint64_t> cells_;
};

/// The surfaces' extent, once they were looked at.
struct Extent {
  Vector3 low, high;
  double cell = 0;   ///< mesh units
  double cells = 0;  ///< how many meet a surface
};

Extent measure(const std::vector<const TriangleMesh*>& surfaces, double least_cell,
               const Progress& progress) {
  const Box bounds = bounds_of(surfaces);
  Extent extent;
  extent.low = Vector3(bounds.low[0], bounds.low[1], bounds.low[2]);
  extent.high = Vector3(bounds.high[0], bounds.high[1], bounds.high[2]);
  extent.cell = std::max(least_cell, (extent.high - extent.low).norm() / coarse_cells);
  CellCount count(extent.low, extent.cell);
  double total = 0, done = 0;
  for (const TriangleMesh* mesh : surfaces) total += static_cast<double>(mesh->triangles.size());
  for (const TriangleMesh* mesh : surfaces) {
    for (std::size_t f = 0; f < mesh->triangles.size(); ++f) {
      if (f % between_checks == 0) progress.update((done + static_cast<double>(f)) / total);
      const Triangle& t = mesh->triangles[f];
      count.add(mesh->vertices[t[0]], mesh->vertices[t[1]], mesh->vertices[t[2]]);
    }
    done += static_cast<double>(mesh->triangles.size());
  }
  extent.cells = static_cast<double>(count.count());
  return extent;
}

Vector3 box_size(const Extent& extent, const VolumeSizeOptions& options) {
  const double border = ramp_of(options) + options.margin.value_or(default_margin * options.voxel_size);
  return (extent.high - extent.low).array() + 2 * border;
}

/// Bytes that a volume will take.
double estimate(const Extent& extent, const VolumeSizeOptions& options) {
  const double leaf = leaf_side * options.voxel_size;
  const double squares = extent.cells / cubes_per_square * std::pow(extent.cell / leaf, 2);
  const double leaves = squares * (cubes_per_square + 2 * ramp_of(options) / leaf);
  const double all = (box_size(extent, options) / leaf).array().ceil().prod();
  return bytes_per_leaf * std::min(leaves, all);
}

/// Rounded up to two digits.
double two_digits_up(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 1);
  return std::ceil(x / unit) * unit;
}

double longest_side(const Extent& extent, const VolumeSizeOptions& options, int* axis = nullptr) {
  int any = 0;
  return box_size(extent, options).maxCoeff(axis != nullptr ? axis : &any) / options.voxel_size;
}

[[noreturn]] void throw_too_long(const Extent& extent, const VolumeSizeOptions& options, std::size_t surfaces,
                                 double fitting) {
  int axis = 0;
  const double voxels = longest_side(extent, options, &axis);
  throw CompletionError(
      "choosing the volume",
      (surfaces > 1 ? "The visible layers span " : "The mesh spans ") + number(voxels) + " voxels of " +
          number(options.voxel_size) + " along " + "xyz"[axis] + "; at most " +
          std::to_string(static_cast<long>(most_voxels)) + " are possible. " +
          (surfaces > 1
               ? "Are the layers aligned, in the same unit, and without vertices far away?"
               : "Is the voxel size in the unit of the mesh, and has the mesh no vertices far away?") +
          " Voxels of " + number(fitting) + " would fit.");
}

[[noreturn]] void throw_too_large(const VolumeSizeOptions& options, double bytes, double fitting) {
  throw CompletionError("choosing the volume",
                        "Voxels of " + number(options.voxel_size) + " would need about " + gigabytes(bytes) +
                            " of memory; " + gigabytes(options.max_memory) + " are allowed. Voxels of " +
                            number(fitting) + " would fit.");
}

}  // namespace

void check_options(const VolumeSizeOptions& options) {
  require(positive(options.voxel_size), "The voxel size must be a number above 0.");
  require(!options.ramp || std::isfinite(*options.ramp), "The ramp must be a number.");
  require(!options.ramp || *options.ramp >= options.voxel_size,
          "The ramp must be at least as long as a voxel: otherwise the surface would fall between voxels.");
  require(!options.margin || (std::isfinite(*options.margin) && *options.margin >= 0),
          "The margin round the surfaces must be at least 0.");
  require(positive(options.max_memory), "The memory limit must be above 0.");
}

double ramp_of(const VolumeSizeOptions& options) {
  return options.ramp.value_or(default_ramp * options.voxel_size);
}

VolumeFrame choose_frame(const std::vector<const TriangleMesh*>& surfaces, const VolumeSizeOptions& options,
                         const Progress& progress) {
  check_options(options);
  const Extent extent = measure(surfaces, leaf_side * options.voxel_size, progress);
  const auto fits = [&](const VolumeSizeOptions& tried, double share) {
    return longest_side(extent, tried) < most_voxels && estimate(extent, tried) <= share * options.max_memory;
  };
  if (!fits(options, 1)) {
    VolumeSizeOptions larger = options;
    constexpr double step = 1.05;
    while (!fits(larger, suggested_share)) {
      larger.voxel_size *= step;
      if (larger.ramp) larger.ramp = std::max(*larger.ramp, larger.voxel_size);
    }
    const double fitting = two_digits_up(larger.voxel_size);
    if (!(longest_side(extent, options) < most_voxels))
      throw_too_long(extent, options, surfaces.size(), fitting);
    throw_too_large(options, estimate(extent, options), fitting);
  }
  VolumeFrame frame;
  frame.voxel_size = options.voxel_size;
  frame.ramp = ramp_of(options);
  const double border = (box_size(extent, options) - (extent.high - extent.low)).x() / 2;
  const Vector3 low = ((extent.low.array() - border) / options.voxel_size).floor();
  frame.origin = low * options.voxel_size;
  const Vector3 size = (frame.voxel(extent.high.array() + border).array().ceil() + 1) / leaf_side;
  frame.box.low = VoxelIndex::Zero();
  frame.box.high = (leaf_side * size.array().ceil() - 1).cast<int>();
  return frame;
}

void check_memory(std::size_t near_blocks, const VolumeSizeOptions& options, double seen_share) {
  const double bytes = bytes_per_leaf * seen_share * static_cast<double>(near_blocks);
  if (bytes <= options.max_memory) return;
  const double share = bytes / (suggested_share * options.max_memory);
  throw_too_large(options, bytes, two_digits_up(options.voxel_size * std::sqrt(share)));
}

}  // namespace meshcomplete
