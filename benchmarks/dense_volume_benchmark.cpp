// Dilation and erosion of a range volume beside the same on a plain array of all its voxels.
//
//   dense_volume_benchmark VOLUME.vdb        two dilations, then two erosions
//
// Prints one JSON object. Both use all processors.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "common/core/threads.h"
#include "filter_volmorph/volume_blocks.h"
#include "filter_volmorph/volume_file.h"
#include "filter_volmorph/volume_operators.h"

namespace {

using namespace meshcomplete;

constexpr std::size_t slabs_at_once = 1;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// A byte for each voxel of a box that starts and ends with whole blocks.
class DenseStates {
 public:
  explicit DenseStates(const RangeVolume& volume)
      : low_(volume.frame().box.low), size_(volume.frame().box.size()) {
    states_.resize(std::size_t(size_.x()) * std::size_t(size_.y()) * std::size_t(size_.z()));
    for_ranges(std::size_t(size_.x() / block_size), slabs_at_once, Progress(),
               [&](std::size_t begin, std::size_t end) {
                 BlockReader reader(volume);
                 for (std::size_t x = begin; x < end; ++x) read_slab(reader, int(x));
               });
  }

  std::size_t bytes() const { return states_.size(); }
  bool operator==(const DenseStates& other) const { return states_ == other.states_; }

  // Voxels in state `from` with a neighbour in state `to` get that, too.
  void spread(VoxelState from, VoxelState to) {
    std::vector<VoxelState> next = states_;
    for_ranges(std::size_t(size_.x()), slabs_at_once, Progress(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t x = begin; x < end; ++x) spread_slice(int(x), from, to, next);
    });
    states_.swap(next);
  }

 private:
  std::size_t number(int x, int y, int z) const {
    return (std::size_t(x) * std::size_t(size_.y()) + std::size_t(y)) * std::size_t(size_.z()) +
           std::size_t(z);
  }

  void read_slab(BlockReader& reader, int x) {
    BlockValues values;
    for (int y = 0; y < size_.y() / block_size; ++y)
      for (int z = 0; z < size_.z() / block_size; ++z) {
        const VoxelIndex block(x, y, z);
        reader.read(block_of(low_) + block, values);
        for (int i = 0; i < block_size; ++i)
          for (int j = 0; j < block_size; ++j)
            for (int k = 0; k < block_size; ++k) {
              const auto from = static_cast<std::size_t>(BlockValues::number(i, j, k));
              states_[number(block_size * x + i, block_size * y + j, block_size * z + k)] =
                  values.seen[from]           ? VoxelState::seen
                  : values.distance[from] < 0 ? VoxelState::unseen
                                              : VoxelState::empty;
            }
      }
  }

  void spread_slice(int x, VoxelState from, VoxelState to, std::vector<VoxelState>& next) const {
    const std::size_t dy = std::size_t(size_.z()), dx = dy * std::size_t(size_.y());
    for (int y = 0; y < size_.y(); ++y)
      for (int z = 0; z < size_.z(); ++z) {
        const std::size_t at = number(x, y, z);
        if (states_[at] != from) continue;
        if ((x > 0 && states_[at - dx] == to) || (x + 1 < size_.x() && states_[at + dx] == to) ||
            (y > 0 && states_[at - dy] == to) || (y + 1 < size_.y() && states_[at + dy] == to) ||
            (z > 0 && states_[at - 1] == to) || (z + 1 < size_.z() && states_[at + 1] == to))
          next[at] = to;
      }
  }

  VoxelIndex low_, size_;
  std::vector<VoxelState> states_;
};

void run(const std::string& path) {
  RangeVolume volume = open_volume(path, Progress());
  DenseStates dense(volume);
  auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 2; ++i) dense.spread(VoxelState::empty, VoxelState::unseen);
  for (int i = 0; i < 2; ++i) dense.spread(VoxelState::unseen, VoxelState::empty);
  const double dense_seconds = seconds_since(start);
  const VoxelBox box = volume.frame().box;
  start = std::chrono::steady_clock::now();
  for (int i = 0; i < 2; ++i) volume = dilate(volume, box, Progress()).volume;
  for (int i = 0; i < 2; ++i) volume = erode(volume, box, Progress()).volume;
  const double seconds = seconds_since(start);
  std::printf("{\"voxels\": %zu, \"dense_seconds\": %.6f, \"seconds\": %.6f, \"equal\": %s}\n", dense.bytes(),
              dense_seconds, seconds, DenseStates(volume) == dense ? "true" : "false");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 2) {
      std::fprintf(stderr, "usage: dense_volume_benchmark VOLUME.vdb\n");
      return 2;
    }
    run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
