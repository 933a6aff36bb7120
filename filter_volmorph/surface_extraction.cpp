#include "filter_volmorph/surface_extraction.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <utility>

#include "common/core/error.h"
#include "common/core/threads.h"
#include "filter_volmorph/marching_cubes_table.h"
#include "filter_volmorph/small_components.h"
#include "filter_volmorph/volume_blocks.h"

namespace meshcomplete {
namespace {

const char* const stage = "extracting the surface";

// Of a voxel: vertices stay this far from the ends of their edges. Small beside the error of the distances
// themselves; large enough that faces are no thinner than that, and that rounding rarely has to be mended.
constexpr double crossing_margin = 1.0 / 64;

// Floats between neighbouring voxels: two vertices on the edge between them, and its ends rounded.
constexpr double least_float_steps = 4;

constexpr std::size_t most_faces = std::size_t(1) << 30;  // that `build_topology` takes
constexpr std::size_t blocks_at_once = 32;
constexpr std::size_t missing = ~std::size_t(0);
constexpr int edges_in_block = 3 * block_size * block_size * block_size;

// A block's edges are those from its voxels upwards along an axis.
int edge_number(int axis, int x, int y, int z) {
  return ((axis * block_size + x) * block_size + y) * block_size + z;
}

// The edges of a block with some property, numbered.
class EdgeSet {
 public:
  void insert(int edge) { words_[edge / 64] |= std::uint64_t(1) << edge % 64; }
  bool contains(int edge) const { return (words_[edge / 64] >> edge % 64 & 1) != 0; }
  // To be called after the last insertion, before the questions below.
  void count() {
    std::uint16_t sum = 0;
    for (std::size_t word = 0; word < words_.size(); ++word) {
      before_[word] = sum;
      sum = std::uint16_t(sum + std::bitset<64>(words_[word]).count());
    }
    size_ = sum;
  }
  std::size_t size() const { return size_; }
  // How many edges with a lower number are in the set.
  std::size_t rank(int edge) const {
    const std::uint64_t lower = (std::uint64_t(1) << edge % 64) - 1;
    return before_[edge / 64] + std::bitset<64>(words_[edge / 64] & lower).count();
  }

 private:
  std::array<std::uint64_t, edges_in_block / 64> words_{};
  std::array<std::uint16_t, edges_in_block / 64> before_{};
  std::uint16_t size_ = 0;
};

struct Block {
  VoxelIndex index;
  EdgeSet crossed;               // with a vertex
  EdgeSet split;                 // of those, with a second one
  std::size_t first_vertex = 0;  // its number in the mesh, then those of the second ones
  std::size_t triangles = 0;
  std::size_t first_triangle = 0;

  std::size_t vertices() const { return crossed.size() + split.size(); }
};

// What is used of a block's cells; cell (x, y, z), -1 to 7, has its lowest corner at that voxel.
class Cells {
 public:
  Cells(const BlockValues& values, bool observed_only) : values_(values), observed_only_(observed_only) {}

  bool inside(int x, int y, int z) const { return values_.distance[BlockValues::number(x, y, z)] < 0; }

  bool used(const VoxelIndex& cell) const {
    if (!observed_only_) return true;
    for (int corner = 0; corner < 8; ++corner)
      if (!values_.seen[BlockValues::number(cell.x() + (corner & 1), cell.y() + (corner >> 1 & 1),
                                            cell.z() + (corner >> 2))])
        return false;
    return true;
  }

  std::uint8_t corners_inside(int x, int y, int z) const {
    int corners = 0;
    for (int corner = 0; corner < 8; ++corner)
      if (inside(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2))) corners |= 1 << corner;
    return std::uint8_t(corners);
  }

  // How many fans of triangles there are round the vertex on an edge: cells that meet in the edge only are
  // two.
  int fans(int axis, const VoxelIndex& low) const {
    if (!observed_only_) return 1;
    const VoxelIndex b = VoxelIndex::Unit((axis + 1) % 3), c = VoxelIndex::Unit((axis + 2) % 3);
    const bool here = used(low), back = used(low - b), down = used(low - c), both = used(low - b - c);
    const int cells = here + back + down + both;
    return cells == 2 && here == both ? 2 : std::min(cells, 1);
  }

 private:
  const BlockValues& values_;
  bool observed_only_;
};

template <class Visit>
void for_each_voxel(Visit&& visit) {
  for (int x = 0; x < block_size; ++x)
    for (int y = 0; y < block_size; ++y)
      for (int z = 0; z < block_size; ++z) visit(x, y, z);
}

Block count_block(const VoxelIndex& index, const Cells& cells) {
  Block block;
  block.index = index;
  for_each_voxel([&](int x, int y, int z) {
    const std::uint8_t inside = cells.corners_inside(x, y, z);
    if (inside == 0 || inside == 255) return;
    if (cells.used({x, y, z})) block.triangles += cube_triangles(inside).size();
    for (int axis = 0; axis < 3; ++axis) {
      if ((inside & 1) == (inside >> (1 << axis) & 1)) continue;
      const int fans = cells.fans(axis, {x, y, z});
      if (fans > 0) block.crossed.insert(edge_number(axis, x, y, z));
      if (fans > 1) block.split.insert(edge_number(axis, x, y, z));
    }
  });
  block.crossed.count();
  block.split.count();
  return block;
}

// The blocks that have vertices or triangles.
std::vector<Block> count_blocks(const RangeVolume& volume, bool observed_only, const Progress& progress) {
  const std::vector<VoxelIndex> all = blocks_with_sign_changes(volume, progress.part(0, 0.3, stage));
  const Progress counting = progress.part(0.3, 1, stage);
  std::vector<std::vector<Block>> parts((all.size() + blocks_at_once - 1) / blocks_at_once);
  for_ranges(all.size(), blocks_at_once, counting, [&](std::size_t begin, std::size_t end) {
    BlockReader reader(volume);
    BlockValues values;
    for (std::size_t i = begin; i < end; ++i) {
      reader.read(all[i], values);
      const Block block = count_block(all[i], Cells(values, observed_only));
      if (block.vertices() + block.triangles > 0) parts[begin / blocks_at_once].push_back(block);
    }
    counting.advance(double(end - begin) / double(all.size()));
  });
  std::vector<Block> blocks;
  for (std::vector<Block>& part : parts) {
    blocks.insert(blocks.end(), part.begin(), part.end());
    part = {};
  }
  return blocks;
}

struct Sizes {
  std::size_t vertices = 0, triangles = 0;
};

Sizes number_blocks(std::vector<Block>& blocks) {
  Sizes sizes;
  for (Block& block : blocks) {
    block.first_vertex = sizes.vertices;
    block.first_triangle = sizes.triangles;
    sizes.vertices += block.vertices();
    sizes.triangles += block.triangles;
  }
  if (sizes.triangles >= most_faces)
    throw CompletionError(stage, "The surface would have more than a billion faces. Use larger voxels.");
  return sizes;
}

// Floats strictly between the two rounded ends of an edge. Rounding keeps the order of coordinates, so that
// the voxels' planes remain planes, and what holds for cells holds for rounded ones.
class EdgePlace {
 public:
  EdgePlace(double low, double high)
      : low_(low), length_(high - low), first_(after(float(low), high)), last_(after(float(high), low)) {}

  float at(double t) const { return std::clamp(float(low_ + t * length_), first_, last_); }
  // Another place than `at(t)`, towards the middle if there is one.
  float beside(double t) const {
    const float here = at(t), there = at(t < 0.5 ? t + crossing_margin : t - crossing_margin);
    if (there != here) return there;
    return here < last_ ? after(here, last_) : after(here, first_);
  }

 private:
  static float after(float from, double to) { return std::nextafter(from, float(to)); }

  double low_, length_;
  float first_, last_;
};

class Extractor {
 public:
  Extractor(const RangeVolume& volume, const std::vector<Block>& blocks, bool observed_only,
            TriangleMesh& mesh)
      : frame_(volume.frame()), blocks_(blocks), observed_only_(observed_only), mesh_(mesh) {}

  void extract(std::size_t number, const BlockValues& values) const {
    write_vertices(blocks_[number], values);
    write_triangles(number, Cells(values, observed_only_));
  }

 private:
  void write_vertices(const Block& block, const BlockValues& values) const {
    for (int axis = 0; axis < 3; ++axis)
      for_each_voxel([&](int x, int y, int z) {
        const int edge = edge_number(axis, x, y, z);
        if (!block.crossed.contains(edge)) return;
        const VoxelIndex low(x, y, z), high = low + VoxelIndex::Unit(axis);
        const double from = values.distance[BlockValues::number(x, y, z)];
        const double to = values.distance[BlockValues::number(high.x(), high.y(), high.z())];
        const double t = std::clamp(from / (from - to), crossing_margin, 1 - crossing_margin);
        const VoxelIndex voxel = block_size * block.index + low;
        const EdgePlace place(coordinate(axis, voxel[axis]), coordinate(axis, voxel[axis] + 1));
        Vector3 at;
        for (int a = 0; a < 3; ++a) at[a] = float(coordinate(a, voxel[a]));
        at[axis] = place.at(t);
        mesh_.vertices[block.first_vertex + block.crossed.rank(edge)] = at;
        if (!block.split.contains(edge)) return;
        at[axis] = place.beside(t);
        mesh_.vertices[block.first_vertex + block.crossed.size() + block.split.rank(edge)] = at;
      });
  }

  void write_triangles(std::size_t number, const Cells& cells) const {
    if (blocks_[number].triangles == 0) return;
    const std::array<std::size_t, 8> upper = upper_blocks(blocks_[number].index);
    std::size_t next = blocks_[number].first_triangle;
    for_each_voxel([&](int x, int y, int z) {
      const std::uint8_t inside = cells.corners_inside(x, y, z);
      if (inside == 0 || inside == 255 || !cells.used({x, y, z})) return;
      for (const CubeTriangle& edges : cube_triangles(inside)) {
        Triangle& triangle = mesh_.triangles[next++];
        for (int k = 0; k < 3; ++k) triangle[k] = vertex(upper, {x, y, z}, cube_edges()[edges[k]]);
      }
    });
  }

  // The block and those above it along some axes (bits of the place in the array).
  std::array<std::size_t, 8> upper_blocks(const VoxelIndex& index) const {
    std::array<std::size_t, 8> numbers;
    for (int step = 0; step < 8; ++step) {
      const VoxelIndex wanted = index + VoxelIndex(step & 1, step >> 1 & 1, step >> 2);
      const auto found = std::lower_bound(
          blocks_.begin(), blocks_.end(), wanted,
          [](const Block& block, const VoxelIndex& index) { return block_before(block.index, index); });
      const bool there = found != blocks_.end() && found->index == wanted;
      numbers[step] = there ? std::size_t(found - blocks_.begin()) : missing;
    }
    return numbers;
  }

  Index vertex(const std::array<std::size_t, 8>& upper, const VoxelIndex& cell, const CubeEdge& edge) const {
    VoxelIndex at = cell + VoxelIndex(edge.low & 1, edge.low >> 1 & 1, edge.low >> 2);
    int step = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (at[axis] == block_size) {
        at[axis] = 0;
        step |= 1 << axis;
      }
    const Block& block = blocks_[upper[step]];
    const int number = edge_number(edge.axis, at.x(), at.y(), at.z());
    // Of the two cells at a split edge, the one behind it along the next axis has the second vertex.
    if ((edge.low >> (edge.axis + 1) % 3 & 1) != 0 && block.split.contains(number))
      return Index(block.first_vertex + block.crossed.size() + block.split.rank(number));
    return Index(block.first_vertex + block.crossed.rank(number));
  }

  double coordinate(int axis, int voxel) const {
    return frame_.origin[axis] + frame_.voxel_size * double(voxel);
  }

  const VolumeFrame& frame_;
  const std::vector<Block>& blocks_;
  bool observed_only_;
  TriangleMesh& mesh_;
};

void require_fine_floats(const VolumeFrame& frame) {
  if (frame.box.empty()) return;
  const Vector3 low = frame.position(frame.box.low.cast<double>() - Vector3::Ones());
  const Vector3 high = frame.position(frame.box.high.cast<double>() + Vector3::Ones());
  const float largest = float(std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()));
  const float step = std::nextafter(largest, std::numeric_limits<float>::infinity()) - largest;
  if (std::isfinite(step) && frame.voxel_size >= least_float_steps * double(step)) return;
  throw CompletionError(stage,
                        "The voxels are too small for their distance from the origin: single precision, "
                        "in which MeshLab keeps coordinates, cannot tell them apart. Move the scans nearer "
                        "to the origin, or use larger voxels.");
}

}  // namespace

TriangleMesh extract_surface(const RangeVolume& volume, const ExtractionOptions& options,
                             const Progress& progress) {
  require_fine_floats(volume.frame());
  const bool observed_only = options.observed_only;
  std::vector<Block> blocks = count_blocks(volume, observed_only, progress.part(0, 0.5, stage));
  const Sizes sizes = number_blocks(blocks);
  TriangleMesh mesh;
  mesh.vertices.resize(sizes.vertices);
  mesh.triangles.resize(sizes.triangles);
  const Progress writing = progress.part(0.5, 0.9, stage);
  const Extractor extractor(volume, blocks, observed_only, mesh);
  for_ranges(blocks.size(), blocks_at_once, writing, [&](std::size_t begin, std::size_t end) {
    BlockReader reader(volume);
    BlockValues values;
    for (std::size_t i = begin; i < end; ++i) {
      reader.read(blocks[i].index, values);
      extractor.extract(i, values);
    }
    writing.advance(double(end - begin) / double(blocks.size()));
  });
  blocks = {};
  mesh = without_small_components(std::move(mesh), options.smallest_component, progress.part(0.9, 1, stage));
  progress.update(1);
  return mesh;
}

}  // namespace meshcomplete
