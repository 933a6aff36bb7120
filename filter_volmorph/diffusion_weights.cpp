#include "filter_volmorph/diffusion_weights.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/threads.h"

namespace meshcomplete {
namespace {

const char* const stage = "spreading the normals";

constexpr std::size_t blocks_at_once = 16;

// What is left of a neighbour's weight when it lies straight along the normal. Not 0: where only such
// neighbours are known, theirs is the distance.
constexpr double weight_across = 0.01;

// Sweeps of relaxing the normals for each step of reach. Fronts carry the normals of the nearest rim on
// unturned, which closes a round hole with a cone; relaxed, they turn evenly from rim to rim. A plain sweep
// moves them by less than a voxel; with Chebyshev's factors so many do across a hole as wide as the reach.
constexpr int sweeps_per_step = 2;

// How much of a wave of unit wave number, per voxel, a plain sweep takes: half the variance of the binomial
// blur without its middle.
constexpr double part_taken = 2. / 7;

constexpr float unit = 32767;  // 1, as it is stored
constexpr float full_weight = 255;

// From a voxel to one of its neighbours.
struct Neighbour {
  int dx, dy, dz;
  float nearness;  // 1 for a face, halved for an edge and again for a corner: the binomial blur
  std::array<float, 3> direction;  // unit
};

std::array<Neighbour, neighbour_count> make_neighbours() {
  std::array<Neighbour, neighbour_count> result{};
  int count = 0;
  for (int place = 0; place < 27; ++place) {
    if (place == 13) continue;
    const int dx = place / 9 - 1, dy = place / 3 % 3 - 1, dz = place % 3 - 1;
    const int steps = dx * dx + dy * dy + dz * dz;
    const float length = std::sqrt(float(steps));
    result[count++] = {
        dx, dy, dz, std::ldexp(1.f, 1 - steps), {float(dx) / length, float(dy) / length, float(dz) / length}};
  }
  return result;
}

const std::array<Neighbour, neighbour_count> all_neighbours = make_neighbours();

// A normal, as it is stored.
using StoredNormal = std::array<std::int16_t, 3>;

// cos^2 of the angle between a neighbour's direction and the normal; of a mean of normals about the mean of
// it, a third where none is known.
float share_along(const StoredNormal& normal, const Neighbour& neighbour) {
  const float x = normal[0] / unit, y = normal[1] / unit, z = normal[2] / unit;
  const float along = x * neighbour.direction[0] + y * neighbour.direction[1] + z * neighbour.direction[2];
  const float rest = 1 - (x * x + y * y + z * z);
  return std::clamp(along * along + rest / 3, 0.f, 1.f);
}

// The share across the normals to its eighth power: the higher, the less of a surface reaches another one
// that is parallel and near, and the less the inside and the outside reach what lies over a hole.
float weight_of(float share, const Neighbour& neighbour) {
  const float squared = (1 - share) * (1 - share), fourth = squared * squared;
  const float least = float(weight_across);
  return neighbour.nearness * (least + (1 - least) * fourth * fourth);
}

struct Around {
  std::array<Halo<std::int16_t>, 3> parts;
  Halo<std::uint8_t> directed;

  StoredNormal normal(int number) const { return {parts[0][number], parts[1][number], parts[2][number]}; }

  void read_part(const std::vector<DiffusionBlock>& blocks, const DiffusionBlock& block, int k) {
    gather(block, std::int16_t(0), parts[k], [&](std::size_t from) {
      return blocks[from].normals.empty() ? nullptr : blocks[from].normals[k].data();
    });
  }

  void read(const std::vector<DiffusionBlock>& blocks, const DiffusionBlock& block) {
    for (int k = 0; k < 3; ++k) read_part(blocks, block, k);
  }

  void read_directed(const std::vector<DiffusionBlock>& blocks, const DiffusionBlock& block) {
    gather(block, std::uint8_t(0), directed, [&](std::size_t from) { return blocks[from].directed.data(); });
  }
};

int halo_number(int number, int dx, int dy, int dz) {
  return BlockValues::number(number / (block_size * block_size) + dx, number / block_size % block_size + dy,
                             number % block_size + dz);
}

struct Arrival {
  int number;
  StoredNormal normal;
};

// The voxels of a block that have neighbours with a normal, but none yet.
std::vector<Arrival> arrivals(const DiffusionBlock& block, const Around& around) {
  std::vector<Arrival> result;
  for (int number = 0; number < block_voxels; ++number) {
    if (!block.within[number] || block.directed[number]) continue;
    float total = 0;
    std::array<float, 3> sum{};
    for (const Neighbour& neighbour : all_neighbours) {
      const int from = halo_number(number, neighbour.dx, neighbour.dy, neighbour.dz);
      if (!around.directed[from]) continue;
      const float weight = weight_of(share_along(around.normal(from), neighbour), neighbour);
      total += weight;
      for (int k = 0; k < 3; ++k) sum[k] += weight * float(around.parts[k][from]);
    }
    if (total == 0) continue;
    StoredNormal normal;
    for (int k = 0; k < 3; ++k) normal[k] = std::int16_t(std::lround(sum[k] / total));
    result.push_back({number, normal});
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
      if (std::none_of(block.neighbours.begin(), block.neighbours.end(),
                       [&](std::int32_t number) { return number >= 0 && fresh[number]; }))
        continue;
      around.read(blocks, block);
      around.read_directed(blocks, block);
      arrived[i] = arrivals(block, around);
    }
  });
  bool any = false;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    fresh[i] = !arrived[i].empty();
    any = any || fresh[i];
    for (const Arrival& arrival : arrived[i]) {
      blocks[i].directed[arrival.number] = 1;
      for (int k = 0; k < 3; ++k) blocks[i].normals[k][arrival.number] = arrival.normal[k];
    }
  }
  return any;
}

// How much of its neighbours has a direction, for each voxel that is within: what sums of theirs are divided
// by. 0 elsewhere.
void weigh_neighbours(const DiffusionBlock& block, const Around& around, Block<float>& weights) {
  Halo<float> directed;
  std::copy(around.directed.begin(), around.directed.end(), directed.begin());
  blur_neighbours(directed, weights);
  for (int number = 0; number < block_voxels; ++number)
    if (!block.within[number]) weights[number] = 0;
}

// Into `normals`, those of the sweep before the last, what the voxels within have after the next: from there
// `factor` times the way to the means of all neighbours, whatever their direction.
void relax_block(const Around& around, const Block<float>& weights, float factor,
                 std::vector<NormalPart>& normals) {
  Halo<float> part;
  Block<float> sums;
  for (int k = 0; k < 3; ++k) {
    std::copy(around.parts[k].begin(), around.parts[k].end(), part.begin());
    blur_neighbours(part, sums);
    relax_part(weights, sums, factor, unit, normals[k]);
  }
}

// Jacobi's sweeps, quickened by Chebyshev's factors (the semi-iterative method) for waves no longer than
// twice the reach: a mean of neighbours only shrinks waves, so that longer ones do not grow either.
void relax(std::vector<DiffusionBlock>& blocks, int reach, const Progress& progress) {
  const double wave_number = M_PI / reach;
  const double shrink = std::max(0., 1 - part_taken * wave_number * wave_number);
  const int sweeps = sweeps_per_step * reach;
  const std::vector<std::size_t> changing = blocks_to_fill(blocks);
  std::vector<std::vector<NormalPart>> other(changing.size());
  std::vector<Block<float>> weights(changing.size());
  for_each(changing.size(), blocks_at_once, progress, [&](std::size_t i) {
    const DiffusionBlock& block = blocks[changing[i]];
    other[i] = block.normals;
    Around around;
    around.read_directed(blocks, block);
    weigh_neighbours(block, around, weights[i]);
  });
  double factor = 1;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for_ranges(changing.size(), blocks_at_once, progress, [&](std::size_t begin, std::size_t end) {
      Around around;
      for (std::size_t i = begin; i < end; ++i) {
        around.read(blocks, blocks[changing[i]]);
        relax_block(around, weights[i], float(factor), other[i]);
      }
      progress.advance(double(end - begin) / double(changing.size()) / sweeps);
    });
    for (std::size_t i = 0; i < changing.size(); ++i) blocks[changing[i]].normals.swap(other[i]);
    factor = 1 / (1 - shrink * shrink * (sweep == 0 ? 0.5 : 0.25 * factor));
  }
}

// Means of different normals are short. For the weights they count as much as any other.
void normalise(DiffusionBlock& block) {
  for (int number = 0; number < block_voxels; ++number) {
    if (!block.within[number]) continue;
    float square = 0;
    for (const NormalPart& part : block.normals) square += float(part[number]) * float(part[number]);
    const float length = std::sqrt(square);
    for (NormalPart& part : block.normals)
      if (length > 0) part[number] = std::int16_t(std::lround(unit * (float(part[number]) / length)));
  }
}

// Both voxels of a pair count each other alike. Weighed by the neighbour's normals alone, the distances drift
// against the turning of the normals, twice as much as keeps a surface's curvature: the cap over a hole in a
// ball becomes a hump. Weighed by the voxel's own they do not drift at all, and the cap sinks.
void make_weights(DiffusionBlock& block, const Around& around) {
  block.weights.resize(neighbour_count * block_voxels);
  for (int k = 0; k < neighbour_count; ++k) {
    const Neighbour& neighbour = all_neighbours[k];
    for (int number = 0; number < block_voxels; ++number) {
      const StoredNormal here = around.normal(halo_number(number, 0, 0, 0));
      const StoredNormal there = around.normal(halo_number(number, neighbour.dx, neighbour.dy, neighbour.dz));
      const float share = (share_along(here, neighbour) + share_along(there, neighbour)) / 2;
      const float weight = full_weight * weight_of(share, neighbour);
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
  relax(blocks, reach, progress.part(0.2, 0.9, stage));
  for_each(blocks.size(), blocks_at_once, progress, [&](std::size_t i) { normalise(blocks[i]); });
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
  for (DiffusionBlock& block : blocks) block.normals = {};
  progress.update(1);
}

}  // namespace meshcomplete
