#include "filter_volmorph/diffusion_kernels.h"

#include <algorithm>
#include <limits>

// Sanitizers instrument functions before the loader may choose between them.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define MESHCOMPLETE_WITH_AVX2 __attribute__((target_clones("avx2", "default")))
#else
#define MESHCOMPLETE_WITH_AVX2
#endif

namespace meshcomplete {
namespace {

constexpr int row = block_size;          // voxels along z
constexpr int rows_at_once = 4;          // whose sums fit into the registers
constexpr int side = BlockValues::side;  // of a halo

}  // namespace

MESHCOMPLETE_WITH_AVX2
void sum_neighbours(const std::uint8_t* weights, const Halo<float>& values, Block<float>& sums) {
  for (int x = 0; x < block_size; ++x)
    for (int y = 0; y < block_size; y += rows_at_once) {
      float sum[rows_at_once][row] = {};
      const int to = block_number(x, y, 0);
      for (int place = 0, k = 0; place < 27; ++place) {
        if (place == 13) continue;  // the voxel itself
        const float* from =
            &values[BlockValues::number(x + place / 9 - 1, y + place / 3 % 3 - 1, place % 3 - 1)];
        const std::uint8_t* weight = weights + k++ * block_voxels + to;
        for (int r = 0; r < rows_at_once; ++r)
          for (int z = 0; z < row; ++z) sum[r][z] += float(weight[r * row + z]) * from[r * side + z];
      }
      for (int r = 0; r < rows_at_once; ++r)
        for (int z = 0; z < row; ++z) sums[to + r * row + z] = sum[r][z];
    }
}

MESHCOMPLETE_WITH_AVX2
void blur_neighbours(const Halo<float>& values, Block<float>& sums) {
  constexpr int rows = block_size * block_size;
  std::array<float, side * side * row> along_z;
  std::array<float, side * rows> along_yz;
  for (int i = 0; i < side * side; ++i) {
    const float* from = values.data() + i * side;
    for (int z = 0; z < row; ++z) along_z[i * row + z] = from[z] + 2 * from[z + 1] + from[z + 2];
  }
  for (int x = 0; x < side; ++x) {
    const float* from = along_z.data() + x * side * row;
    for (int i = 0; i < rows; ++i) along_yz[x * rows + i] = from[i] + 2 * from[i + row] + from[i + 2 * row];
  }
  constexpr float face = 4, middle = 8;  // what they have in the blur
  for (int x = 0; x < block_size; ++x)
    for (int y = 0; y < block_size; ++y)
      for (int z = 0; z < row; ++z) {
        const int to = block_number(x, y, z);
        const float* from = along_yz.data() + to;
        const float itself = values[BlockValues::number(x, y, z)];
        sums[to] = (from[0] + 2 * from[rows] + from[2 * rows] - middle * itself) / face;
      }
}

MESHCOMPLETE_WITH_AVX2
void compose_distances(const DistanceRule& rule, const Block<std::uint8_t>& empty,
                       const Block<float>& weights, const Block<float>& sums, Block<float>& distances) {
  constexpr float no_least = -std::numeric_limits<float>::infinity();
  const float ramp = rule.ramp, least_empty = rule.least_empty, empty_weight = rule.empty_weight;
  for (int i = 0; i < block_voxels; ++i) {
    const float part = empty[i] ? empty_weight : 0.f, least = empty[i] ? least_empty : no_least;
    const bool any = weights[i] > 0;
    const float mean = sums[i] / (any ? weights[i] : 1.f);
    const float next = std::max(least, part * ramp + (1 - part) * mean);
    distances[i] = any ? next : distances[i];
  }
}

MESHCOMPLETE_WITH_AVX2
void relax_part(const Block<float>& weights, const Block<float>& sums, float factor, float largest,
                Block<std::int16_t>& part) {
  for (int i = 0; i < block_voxels; ++i) {
    const bool any = weights[i] > 0;
    const float before = part[i], mean = sums[i] / (any ? weights[i] : 1.f);
    const float next = std::min(std::max(before + factor * (mean - before), -largest), largest);
    const float rounded = next + (next < 0 ? -0.5f : 0.5f);
    part[i] = any ? std::int16_t(int(rounded)) : part[i];
  }
}

}  // namespace meshcomplete
