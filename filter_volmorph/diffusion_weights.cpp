#include "filter_volmorph/diffusion_weights.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/threads.h"

namespace meshcomplete {
namespace {

const char* const stage = "spreading the normals";

constexpr std::size_t blocks_at_once = 16;
constexpr int neighbours = 26;

// What is left of a neighbour's weight when it lies straight along the normal. Not 0: where only such
// neighbours are known, theirs is the distance.
constexpr double weight_across = 0.01;

// Sweeps of relaxing the tensors for each step of reach. Fronts carry the tensors of the nearest rim on
// unturned, which closes a round hole with a cone; relaxed, they turn evenly from rim to rim. A sweep moves
// them by about a voxel, so that this is enough for what lies across half a hole to tell.
constexpr int sweeps_per_step = 2;

constexpr float full_tensor = 32767;  // a whole part, as it is stored
constexpr float full_weight = 255;

// From a voxel to one of its neighbours.
struct Neighbour {
  int dx, dy, dz;
  float nearness;  // 1 for a face, halved for an edge and again for a corner: the binomial blur
  std::array<float, 6>
      direction;  // u u^T of the unit direction, so that a tensor's share is the sum of products
};

std::array<Neighbour, neighbours> make_neighbours() {
  std::array<Neighbour, neighbours> result{};
  int count = 0;
  for (int place = 0; place < 27; ++place) {
    if (place == 13) continue;
    const int dx = place / 9 - 1, dy = place / 3 % 3 - 1, dz = place % 3 - 1;
    const int steps = dx * dx + dy * dy + dz * dz;
    const auto part = [&](int product, int times) { return float(times * product) / float(steps); };
    result[count++] = {dx,
                       dy,
                       dz,
                       std::ldexp(1.f, 1 - steps),
                       {part(dx * dx, 1), part(dy * dy, 1), part(dz * dz, 1), part(dx * dy, 2),
                        part(dx * dz, 2), part(dy * dz, 2)}};
  }
  return result;
}

const std::array<Neighbour, neighbours> all_neighbours = make_neighbours();

// cos^2 of the angle between a neighbour's direction and the normals there.
float share_along(const NormalTensor& tensor, const Neighbour& neighbour) {
  float sum = 0;
  for (int k = 0; k < 6; ++k) sum += float(tensor[k]) * neighbour.direction[k];
  return std::clamp(sum / full_tensor, 0.f, 1.f);
}

// The share across the normals to its fourth power: the higher, the less of a surface reaches another one
// that is parallel and near. So two faces six voxels apart stay apart over a gap of 24; with the square they
// merge.
float weight_of(const NormalTensor& tensor, const Neighbour& neighbour) {
  const float perpendicular = 1 - share_along(tensor, neighbour);
  const float squared = perpendicular * perpendicular;
  const float least = float(weight_across);
  return neighbour.nearness * (least + (1 - least) * squared * squared);
}

// Both voxels of a pair count each other alike. Weighed by the neighbour's normals alone, the distances drift
// to where the surface curves away, as a surface of more curvature would: the cap over a hole in a ball
// becomes a hump. By the voxel's alone they do not drift at all, and the cap sinks towards a plane.
NormalTensor between(const NormalTensor& a, const NormalTensor& b) {
  NormalTensor mean;
  for (int k = 0; k < 6; ++k) mean[k] = std::int16_t((int(a[k]) + int(b[k])) / 2);
  return mean;
}

// No direction is known: what a tensor of all directions alike says.
const NormalTensor undirected = {10922, 10922, 10922, 0, 0, 0};

struct Around {
  Halo<NormalTensor> tensors;
  Halo<std::uint8_t> directed;

  void read(const std::vector<DiffusionBlock>& blocks, const DiffusionBlock& block) {
    gather(blocks, block, undirected, tensors, [](const DiffusionBlock& from, int number) {
      return from.directed[number] ? from.tensors[number] : undirected;
    });
    gather(blocks, block, std::uint8_t(0), directed,
           [](const DiffusionBlock& from, int number) { return std::uint8_t(from.directed[number]); });
  }
};

int halo_number(int number, int dx, int dy, int dz) {
  return BlockValues::number(number / (block_side * block_side) + dx, number / block_side % block_side + dy,
                             number % block_side + dz);
}

struct Arrival {
  int number;
  NormalTensor tensor;
};

// The voxels of a block that have neighbours with a tensor, but none yet.
std::vector<Arrival> arrivals(const DiffusionBlock& block, const Around& around) {
  std::vector<Arrival> result;
  for (int number = 0; number < block_voxels; ++number) {
    if (!block.within[number] || block.directed[number]) continue;
    float total = 0;
    std::array<float, 6> sum{};
    for (const Neighbour& neighbour : all_neighbours) {
      const int from = halo_number(number, neighbour.dx, neighbour.dy, neighbour.dz);
      if (!around.directed[from]) continue;
      const float weight = weight_of(around.tensors[from], neighbour);
      total += weight;
      for (int k = 0; k < 6; ++k) sum[k] += weight * float(around.tensors[from][k]);
    }
    if (total == 0) continue;
    NormalTensor tensor;
    for (int k = 0; k < 6; ++k) tensor[k] = std::int16_t(std::lround(sum[k] / total));
    result.push_back({number, tensor});
  }
  return result;
}

// One step of all fronts; `fresh` are the blocks that changed in the last one. Returns whether any did.
bool spread(std::vector<DiffusionBlock>& blocks, std::vector<char>& fresh, const Progress& progress) {
  std::vector<std::vector<Arrival>> arrived(blocks.size());
  for_ranges(blocks.size(), blocks_at_once, progress, [&](std::size_t begin, std::size_t end) {
    Around around;
    for (std::size_t i = begin; i < end; ++i) {
      const DiffusionBlock& block = blocks[i];
      if ((block.within & ~block.directed).none()) continue;
      if (std::none_of(block.neighbours.begin(), block.neighbours.end(),
                       [&](std::int32_t number) { return number >= 0 && fresh[number]; }))
        continue;
      around.read(blocks, block);
      arrived[i] = arrivals(block, around);
    }
  });
  bool any = false;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    fresh[i] = !arrived[i].empty();
    any = any || fresh[i];
    for (const Arrival& arrival : arrived[i]) {
      blocks[i].directed[arrival.number] = true;
      blocks[i].tensors[arrival.number] = arrival.tensor;
    }
  }
  return any;
}

// The tensors of the voxels within: means of all neighbours', whatever their direction.
std::vector<NormalTensor> relaxed(const DiffusionBlock& block, const Around& around) {
  std::array<std::array<float, block_voxels>, 6> sums{};
  std::array<float, block_voxels> total{};
  Halo<float> part;
  for (int k = -1; k < 6; ++k) {  // the sum of weights, then the parts
    for (int i = 0; i < BlockValues::count; ++i)
      part[i] = around.directed[i] ? (k < 0 ? 1.f : float(around.tensors[i][std::max(k, 0)])) : 0.f;
    std::array<float, block_voxels>& sum = k < 0 ? total : sums[k];
    for (const Neighbour& neighbour : all_neighbours)
      for (int row = 0; row < block_voxels; row += block_side) {
        const int from = halo_number(row, neighbour.dx, neighbour.dy, neighbour.dz);
        for (int z = 0; z < block_side; ++z) sum[row + z] += neighbour.nearness * part[from + z];
      }
  }
  std::vector<NormalTensor> tensors = block.tensors;
  for (int number = 0; number < block_voxels; ++number)
    for (int k = 0; k < 6 && block.within[number] && total[number] > 0; ++k)
      tensors[number][k] = std::int16_t(std::lround(sums[k][number] / total[number]));
  return tensors;
}

void relax(std::vector<DiffusionBlock>& blocks, int sweeps, const Progress& progress) {
  std::vector<std::vector<NormalTensor>> next(blocks.size());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for_ranges(blocks.size(), blocks_at_once, progress, [&](std::size_t begin, std::size_t end) {
      Around around;
      for (std::size_t i = begin; i < end; ++i) {
        if (blocks[i].within.none()) continue;
        around.read(blocks, blocks[i]);
        next[i] = relaxed(blocks[i], around);
      }
      progress.advance(double(end - begin) / double(blocks.size()) / sweeps);
    });
    for (std::size_t i = 0; i < blocks.size(); ++i)
      if (blocks[i].within.any()) blocks[i].tensors.swap(next[i]);
  }
}

void make_weights(DiffusionBlock& block, const Around& around) {
  block.weights.resize(neighbours * block_voxels);
  for (int k = 0; k < neighbours; ++k) {
    const Neighbour& neighbour = all_neighbours[k];
    for (int number = 0; number < block_voxels; ++number) {
      const NormalTensor& here = around.tensors[halo_number(number, 0, 0, 0)];
      const NormalTensor& there =
          around.tensors[halo_number(number, neighbour.dx, neighbour.dy, neighbour.dz)];
      const float weight = full_weight * weight_of(between(here, there), neighbour);
      block.weights[k * block_voxels + number] = std::uint8_t(std::max(1L, std::lround(weight)));
    }
  }
}

}  // namespace

std::vector<std::uint8_t> weights_by_distance() {
  std::vector<std::uint8_t> weights;
  for (const Neighbour& neighbour : all_neighbours)
    weights.insert(weights.end(), block_voxels, std::uint8_t(full_weight * neighbour.nearness));
  return weights;
}

void make_weights_by_normals(std::vector<DiffusionBlock>& blocks, int reach, const Progress& progress) {
  std::vector<char> fresh(blocks.size(), 1);
  for (int step = 0; step < reach && spread(blocks, fresh, progress); ++step)
    progress.update(0.2 * step / reach);
  relax(blocks, sweeps_per_step * reach, progress.part(0.2, 0.9, stage));
  const Progress weighing = progress.part(0.9, 1, stage);
  for_ranges(blocks.size(), blocks_at_once, weighing, [&](std::size_t begin, std::size_t end) {
    Around around;
    for (std::size_t i = begin; i < end; ++i) {
      if (blocks[i].within.none()) continue;
      around.read(blocks, blocks[i]);
      make_weights(blocks[i], around);
    }
    weighing.advance(double(end - begin) / double(blocks.size()));
  });
  for (DiffusionBlock& block : blocks) block.tensors = {};
  progress.update(1);
}

}  // namespace meshcomplete
