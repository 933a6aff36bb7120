// Sequences of operators, written as a short text such as "d2 e2 x1".
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

enum class VolumeOperator { erosion, dilation, expansion, diffusion };

/// One operator, applied so many times.
struct OperatorStep {
  VolumeOperator name = VolumeOperator::erosion;
  int count = 1;
};

/// The largest count of a step.
constexpr int largest_operator_count = 1000;

/// Letters `e`, `d`, `x` and `v` (erosion, dilation, expansion, diffusion), of either case, each with a count
/// behind it or none (once); blanks between them may be left out. CompletionError, which names the place, for
/// any other character, a count that is 0 or too large, or a text without operators.
std::vector<OperatorStep> parse_operators(const std::string& text);

/// The step as `parse_operators` reads it, "d2".
std::string text_of(const OperatorStep& step);

/// The filler `v`: a volume with the same states.
using Diffusion = std::function<RangeVolume(const RangeVolume&, const VoxelBox&, const Progress&)>;

struct StepReport {
  OperatorStep step;
  /// Voxels changed, all times together. Of the diffusion: those whose distances are others than before.
  std::uint64_t changed = 0;
};

struct SequenceResult {
  RangeVolume volume;
  std::vector<StepReport> steps;
};

/// Applies the steps one after another to the voxels of the box (volume_operators.h). CompletionError when
/// nothing of the box lies in the volume, and what the diffusion throws.
SequenceResult apply_sequence(const RangeVolume& volume, const std::vector<OperatorStep>& steps,
                              const VoxelBox& box, const Diffusion& diffusion, const Progress& progress);

}  // namespace meshcomplete
