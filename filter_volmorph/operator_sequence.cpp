#include "filter_volmorph/operator_sequence.h"

#include <openvdb/tree/LeafManager.h>

#include <array>
#include <atomic>
#include <cctype>
#include <cstring>
#include <utility>

#include "common/core/error.h"
#include "common/core/threads.h"
#include "filter_volmorph/volume_box.h"
#include "filter_volmorph/volume_grids.h"
#include "filter_volmorph/volume_operators.h"

namespace meshcomplete {
namespace {

struct OperatorName {
  char letter;
  VolumeOperator name;
  const char* stage;
};

constexpr std::array<OperatorName, 4> operator_names = {{{'e', VolumeOperator::erosion, "Erosion"},
                                                         {'d', VolumeOperator::dilation, "Dilation"},
                                                         {'x', VolumeOperator::expansion, "Expansion"},
                                                         {'v', VolumeOperator::diffusion, "Diffusion"}}};

const OperatorName& name_of(VolumeOperator name) {
  for (const OperatorName& candidate : operator_names)
    if (candidate.name == name) return candidate;
  throw std::logic_error("an operator without a name");
}

[[noreturn]] void refuse(const std::string& why) {
  throw CompletionError("reading the operators",
                        why +
                            " Operators are e (erosion), d (dilation), x (expansion) and v (diffusion), each "
                            "with a count or without, as in \"d2 e2 x1\".");
}

bool is_digit(char character) { return std::isdigit(static_cast<unsigned char>(character)) != 0; }
bool is_blank(char character) { return std::isspace(static_cast<unsigned char>(character)) != 0; }

/// The count that begins at `at`, which is moved behind it; 1 where there is none.
int parse_count(const std::string& text, std::size_t& at) {
  const std::size_t begin = at;
  int count = 0;
  for (; at < text.size() && is_digit(text[at]); ++at) {
    count = 10 * count + (text[at] - '0');
    if (count > largest_operator_count)
      refuse("The count at character " + std::to_string(begin + 1) + " of the operators is larger than " +
             std::to_string(largest_operator_count) + ".");
  }
  if (at == begin) return 1;
  if (count == 0) refuse("The count at character " + std::to_string(begin + 1) + " of the operators is 0.");
  return count;
}

/// Voxels whose distances differ; the states are the same. Cost: proportional to the leaves of both.
std::uint64_t changed_distances(const RangeVolume& before, const RangeVolume& after,
                                const Progress& progress) {
  if (before.grids().distance == after.grids().distance) return 0;
  openvdb::MaskTree stored(before.grids().distance->tree(), false, true, openvdb::TopologyCopy());
  stored.topologyUnion(after.grids().distance->tree());
  stored.voxelizeActiveTiles();
  const openvdb::tree::LeafManager<const openvdb::MaskTree> leaves(stored);
  std::atomic<std::uint64_t> changed{0};
  for_ranges(leaves.leafCount(), 64, progress, [&](std::size_t begin, std::size_t end) {
    const VoxelReader old_voxels(before), new_voxels(after);
    std::uint64_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
      for (auto voxel = leaves.leaf(i).cbeginValueOn(); voxel; ++voxel) {
        const float a = old_voxels.distance(voxel.getCoord()), b = new_voxels.distance(voxel.getCoord());
        if (std::memcmp(&a, &b, sizeof a) != 0) ++count;
      }
    }
    changed += count;
  });
  return changed;
}

OperatorResult apply_once(const RangeVolume& volume, VolumeOperator name, const VoxelBox& box,
                          const Diffusion& diffusion, const Progress& progress) {
  switch (name) {
    case VolumeOperator::erosion:
      return erode(volume, box, progress);
    case VolumeOperator::dilation:
      return dilate(volume, box, progress);
    case VolumeOperator::expansion:
      return expand_isosurface(volume, box, progress);
    case VolumeOperator::diffusion:
      break;
  }
  const std::string stage = name_of(name).stage;
  RangeVolume filled = diffusion(volume, box, progress.part(0, 0.95, stage));
  const std::uint64_t changed = changed_distances(volume, filled, progress.part(0.95, 1, stage));
  return {std::move(filled), changed};
}

}  // namespace

std::vector<OperatorStep> parse_operators(const std::string& text) {
  std::vector<OperatorStep> steps;
  for (std::size_t at = 0; at < text.size();) {
    if (is_blank(text[at])) {
      ++at;
      continue;
    }
    const char letter = static_cast<char>(std::tolower(static_cast<unsigned char>(text[at])));
    const OperatorName* found = nullptr;
    for (const OperatorName& candidate : operator_names)
      if (candidate.letter == letter) found = &candidate;
    const std::string place = " at character " + std::to_string(at + 1) + " of the operators";
    if (!found && is_digit(letter)) refuse("There is no letter before the count" + place + ".");
    if (!found) refuse(std::string("Unknown operator \"") + text[at] + "\"" + place + ".");
    ++at;
    steps.push_back({found->name, parse_count(text, at)});
  }
  if (steps.empty()) refuse("There are no operators in the text.");
  return steps;
}

std::string text_of(const OperatorStep& step) {
  return name_of(step.name).letter + std::to_string(step.count);
}

SequenceResult apply_sequence(const RangeVolume& volume, const std::vector<OperatorStep>& steps,
                              const VoxelBox& given, const Diffusion& diffusion, const Progress& progress) {
  const VoxelBox box = box_in_volume(volume.frame(), given);
  double all = 0, done = 0;
  for (const OperatorStep& step : steps) all += step.count;
  SequenceResult result{volume, {}};
  for (const OperatorStep& step : steps) {
    result.steps.push_back({step, 0});
    for (int i = 0; i < step.count; ++i) {
      const Progress part = progress.part((done + i) / all, (done + i + 1) / all, name_of(step.name).stage);
      OperatorResult once = apply_once(result.volume, step.name, box, diffusion, part);
      result.volume = std::move(once.volume);
      result.steps.back().changed += once.changed;
      // The same operator on the same volume changes nothing again.
      if (once.changed == 0) break;
    }
    done += step.count;
    progress.update(done / all);
  }
  return result;
}

}  // namespace meshcomplete
