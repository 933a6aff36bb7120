#include "filter_volmorph/volume_diffusion.h"

#include <algorithm>
#include <vector>

#include "common/core/error.h"
#include "common/core/parameter_checks.h"
#include "common/core/threads.h"
#include "filter_volmorph/diffusion_blocks.h"
#include "filter_volmorph/diffusion_weights.h"

namespace meshcomplete {
namespace {

const char* const stage = "diffusing distances";

constexpr std::size_t blocks_at_once = 16;

// Of a voxel: how near to an empty one the surface comes. The empty voxel's middle is known to be outside,
// and the surface lies on average that far from the last such one.
constexpr float least_empty_distance = 0.5f;

// What a block becomes in a step.
struct Filled {
  std::array<float, block_voxels> distance;
  std::bitset<block_voxels> known;
};

class Diffusion {
 public:
  Diffusion(const VolumeFrame& frame, const DiffusionOptions& options)
      : ramp_(float(frame.ramp)),
        least_empty_(std::min(ramp_, least_empty_distance * float(frame.voxel_size))),
        empty_weight_(float(options.empty_weight)),
        line_of_sight_(options.line_of_sight),
        plain_weights_(weights_by_distance()) {}

  void step(const std::vector<DiffusionBlock>& blocks, const DiffusionBlock& block, Filled& filled) const {
    filled = {block.distance, block.known};
    if (!reached(blocks, block)) return;
    Sums sums;
    add_neighbours(blocks, block, sums);
    for (int number = 0; number < block_voxels; ++number) {
      if (!block.within[number] || !(sums.weight[number] > 0)) continue;
      filled.known[number] = true;
      filled.distance[number] = composed(sums.distance[number] / sums.weight[number], block.empty[number]);
    }
  }

 private:
  struct Sums {
    std::array<float, block_voxels> weight{}, distance{};
  };

  // Whether anything is known in the block or beside it.
  static bool reached(const std::vector<DiffusionBlock>& blocks, const DiffusionBlock& block) {
    return std::any_of(block.neighbours.begin(), block.neighbours.end(), [&](std::int32_t number) {
      return number >= 0 && blocks[static_cast<std::size_t>(number)].known.any();
    });
  }

  float composed(float blurred, bool empty) const {
    if (!empty || !line_of_sight_) return blurred;
    return std::max(least_empty_, empty_weight_ * ramp_ + (1 - empty_weight_) * blurred);
  }

  void add_neighbours(const std::vector<DiffusionBlock>& blocks, const DiffusionBlock& block,
                      Sums& sums) const {
    Halo<float> distance, known;
    gather(blocks, block, 0.f, distance,
           [](const DiffusionBlock& from, int number) { return from.distance[number]; });
    gather(blocks, block, 0.f, known,
           [](const DiffusionBlock& from, int number) { return from.known[number] ? 1.f : 0.f; });
    const std::uint8_t* weights = block.weights.empty() ? plain_weights_.data() : block.weights.data();
    for (int place = 0; place < 27; ++place) {
      if (place == 13) continue;  // the voxel itself
      const int dx = place / 9 - 1, dy = place / 3 % 3 - 1, dz = place % 3 - 1;
      for (int x = 0; x < block_side; ++x)
        for (int y = 0; y < block_side; ++y) {
          const int from = BlockValues::number(x + dx, y + dy, dz), to = block_number(x, y, 0);
          for (int z = 0; z < block_side; ++z) {
            const float weight = weights[to + z];
            sums.weight[to + z] += weight * known[from + z];
            sums.distance[to + z] += weight * distance[from + z];  // 0 where it is not known
          }
        }
      weights += block_voxels;
    }
  }

  float ramp_, least_empty_, empty_weight_;
  bool line_of_sight_;
  std::vector<std::uint8_t> plain_weights_;
};

void check_options(const RangeVolume& volume, const VoxelBox& box, const DiffusionOptions& options) {
  require(options.iterations >= 1, "The iterations of the diffusion must be at least 1.");
  require(options.reach >= 1, "The reach of the diffusion must be at least 1 voxel.");
  require(options.empty_weight >= 0 && options.empty_weight <= 1,
          "The weight of empty voxels must be between 0 and 1.");
  require(!box.common(volume.frame().box).empty(), "The box lies outside the volume.");
}

// The numbers of the blocks in which something is to be filled.
std::vector<std::size_t> blocks_to_fill(const std::vector<DiffusionBlock>& blocks) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (blocks[i].within.any()) numbers.push_back(i);
  return numbers;
}

}  // namespace

RangeVolume diffuse(const RangeVolume& volume, const VoxelBox& box, const DiffusionOptions& options,
                    const Progress& progress) {
  check_options(volume, box, options);
  std::vector<DiffusionBlock> blocks = diffusion_blocks(volume, box.common(volume.frame().box), options.reach,
                                                        options.normals, progress.part(0, 0.1, stage));
  if (options.normals)
    make_weights_by_normals(blocks, options.reach, progress.part(0.1, 0.45, "spreading the normals"));
  const Progress stepping = progress.part(options.normals ? 0.45 : 0.1, 0.95, stage);
  const std::vector<std::size_t> changing = blocks_to_fill(blocks);
  std::vector<Filled> filled(changing.size());
  const Diffusion diffusion(volume.frame(), options);
  const double share = 1 / (double(options.iterations) * double(std::max<std::size_t>(changing.size(), 1)));
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    for_ranges(changing.size(), blocks_at_once, stepping, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) diffusion.step(blocks, blocks[changing[i]], filled[i]);
      stepping.advance(double(end - begin) * share);
    });
    for_each(changing.size(), blocks_at_once, stepping, [&](std::size_t i) {
      blocks[changing[i]].distance = filled[i].distance;
      blocks[changing[i]].known = filled[i].known;
    });
  }
  RangeVolume result = with_distances(volume, blocks, progress);
  progress.update(1);
  return result;
}

}  // namespace meshcomplete
