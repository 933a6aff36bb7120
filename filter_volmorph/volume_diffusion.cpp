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

// A block that changes: what it becomes in a step, and what lasts from step to step.
struct Changing {
  std::size_t number;     // of the block
  Block<float> distance;  // after the step
  Block<float> weight;    // of all known neighbours; 0 where there is none, or nothing is to be filled
  bool reached = false;   // whether any voxel has a weight
};

class Diffusion {
 public:
  Diffusion(std::vector<DiffusionBlock>& blocks, const VolumeFrame& frame, const DiffusionOptions& options)
      : blocks_(blocks), fresh_(blocks.size(), 1), plain_weights_(weights_by_distance()) {
    rule_.ramp = float(frame.ramp);
    rule_.least_empty = std::min(rule_.ramp, least_empty_distance * float(frame.voxel_size));
    rule_.empty_weight = float(options.empty_weight);
    for (const std::size_t number : blocks_to_fill(blocks)) changing_.push_back({number, {}, {}});
    if (!options.line_of_sight)
      for (DiffusionBlock& block : blocks) block.empty = {};
  }

  void run(int iterations, const Progress& progress) {
    const double share = 1 / (double(iterations) * double(std::max<std::size_t>(changing_.size(), 1)));
    for (int iteration = 0; iteration < iterations; ++iteration) {
      for_ranges(changing_.size(), blocks_at_once, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) step(changing_[i]);
        progress.advance(double(end - begin) * share);
      });
      std::fill(fresh_.begin(), fresh_.end(), 0);
      for_each(changing_.size(), blocks_at_once, progress, [&](std::size_t i) { take_over(changing_[i]); });
    }
  }

 private:
  const std::uint8_t* weights_of(const DiffusionBlock& block) const {
    return block.weights.empty() ? plain_weights_.data() : block.weights.data();
  }

  void step(Changing& changing) const {
    const DiffusionBlock& block = blocks_[changing.number];
    if (std::any_of(block.neighbours.begin(), block.neighbours.end(),
                    [&](std::int32_t number) { return number >= 0 && fresh_[std::size_t(number)]; }))
      weigh(block, changing);
    if (!changing.reached) return;
    Halo<float> around;
    gather(block, 0.f, around, [&](std::size_t number) { return blocks_[number].distance.data(); });
    Block<float> sums;
    sum_neighbours(weights_of(block), around, sums);  // 0 where a distance is not known
    changing.distance = block.distance;
    compose_distances(rule_, block.empty, changing.weight, sums, changing.distance);
  }

  void weigh(const DiffusionBlock& block, Changing& changing) const {
    Halo<std::uint8_t> known;
    gather(block, std::uint8_t(0), known, [&](std::size_t number) { return blocks_[number].known.data(); });
    Halo<float> values;
    std::copy(known.begin(), known.end(), values.begin());
    sum_neighbours(weights_of(block), values, changing.weight);
    changing.reached = false;
    for (int i = 0; i < block_voxels; ++i) {
      if (!block.within[i]) changing.weight[i] = 0;
      changing.reached = changing.reached || changing.weight[i] > 0;
    }
  }

  void take_over(const Changing& changing) {
    if (!changing.reached) return;
    DiffusionBlock& block = blocks_[changing.number];
    block.distance = changing.distance;
    std::uint8_t gained = 0;
    for (int i = 0; i < block_voxels; ++i) {
      const std::uint8_t known = block.known[i] | std::uint8_t(changing.weight[i] > 0);
      gained |= known ^ block.known[i];
      block.known[i] = known;
    }
    fresh_[changing.number] = char(gained);
  }

  std::vector<DiffusionBlock>& blocks_;
  std::vector<Changing> changing_;
  std::vector<char> fresh_;  // of each block: whether more of it is known than before the last step
  DistanceRule rule_;
  std::vector<std::uint8_t> plain_weights_;
};

void check_options(const RangeVolume& volume, const VoxelBox& box, const DiffusionOptions& options) {
  require(options.iterations >= 1, "The iterations of the diffusion must be at least 1.");
  require(options.reach >= 1, "The reach of the diffusion must be at least 1 voxel.");
  require(options.empty_weight >= 0 && options.empty_weight <= 1,
          "The weight of empty voxels must be between 0 and 1.");
  require(positive(options.max_memory), "The memory limit must be above 0.");
  require(!box.common(volume.frame().box).empty(), "The box lies outside the volume.");
}

}  // namespace

RangeVolume diffuse(const RangeVolume& volume, const VoxelBox& box, const DiffusionOptions& options,
                    const Progress& progress) {
  check_options(volume, box, options);
  std::vector<DiffusionBlock> blocks =
      diffusion_blocks(volume, box.common(volume.frame().box), options.reach, options.normals,
                       options.max_memory, progress.part(0, 0.1, stage));
  if (options.normals)
    make_weights_by_normals(blocks, options.reach, progress.part(0.1, 0.45, "spreading the normals"));
  Diffusion(blocks, volume.frame(), options)
      .run(options.iterations, progress.part(options.normals ? 0.45 : 0.1, 0.95, stage));
  RangeVolume result = with_distances(volume, blocks, progress);
  progress.update(1);
  return result;
}

}  // namespace meshcomplete
