#include "filter_volmorph/operator_sequence.h"

#include <gtest/gtest.h>

#include <string>

#include "common/core/error.h"
#include "tests/support/cancelling.h"
#include "tests/volmorph/dense_operators.h"

namespace meshcomplete {
namespace {

const Progress silent;

std::string canonical(const std::string& text) {
  std::string all;
  for (const OperatorStep& step : parse_operators(text)) all += text_of(step) + " ";
  return all;
}

std::string message_of(const std::string& text) {
  try {
    parse_operators(text);
  } catch (const CompletionError& error) {
    return error.what();
  }
  return "no error";
}

void expect_says(const std::string& text, const std::string& part) {
  EXPECT_NE(message_of(text).find(part), std::string::npos) << text << ": " << message_of(text);
}

RangeVolume no_diffusion(const RangeVolume& volume, const VoxelBox&, const Progress&) {
  ADD_FAILURE() << "called";
  return volume;
}

TEST(OperatorSequence, is_read_from_a_text) {
  EXPECT_EQ(canonical("d2 e2 x1 v"), "d2 e2 x1 v1 ");
  EXPECT_EQ(canonical("  D2E12\tx  V3\n"), "d2 e12 x1 v3 ");
  EXPECT_EQ(canonical("ddee"), "d1 d1 e1 e1 ");
  EXPECT_EQ(canonical("e1000"), "e1000 ");
}

TEST(OperatorSequence, says_what_is_wrong_and_where) {
  expect_says("d2 q e", "Unknown operator \"q\" at character 4");
  expect_says("d2-e", "Unknown operator \"-\" at character 3");
  expect_says("2d", "no letter before the count at character 1");
  expect_says("d 2", "no letter before the count at character 3");
  expect_says("d0", "count at character 2 of the operators is 0");
  expect_says("e d1001", "count at character 4 of the operators is larger than 1000");
  expect_says("e99999999999999999999", "larger than 1000");
  expect_says("", "no operators");
  expect_says("  ", "no operators");
}

TEST(OperatorSequence, applies_the_steps_in_their_order) {
  const VoxelBox box{{-11, -3, 5}, {9, 17, 22}};
  const VoxelBox part{{-5, -2, 6}, {30, 9, 20}};
  const DenseVolume before = random_volume(box, 4);
  const SequenceResult result =
      apply_sequence(before.volume(), parse_operators("d2 x e"), part, no_diffusion, silent);
  const DenseVolume once = dense_dilation(before, part);
  const DenseVolume twice = dense_dilation(once, part);
  const DenseVolume expanded = dense_expansion(twice, part);
  const DenseVolume expected = dense_erosion(expanded, part);
  EXPECT_EQ(count_differences(DenseVolume(result.volume), expected), 0u);
  ASSERT_EQ(result.steps.size(), 3u);
  EXPECT_EQ(result.steps[0].changed, count_differences(before, once) + count_differences(once, twice));
  EXPECT_EQ(result.steps[1].changed, count_differences(twice, expanded));
  EXPECT_EQ(result.steps[2].changed, count_differences(expanded, expected));
  EXPECT_GT(result.steps[1].changed, 0u);
}

TEST(OperatorSequence, hands_volume_and_box_to_the_diffusion) {
  const VoxelBox box{{0, 0, 0}, {19, 19, 19}};
  const RangeVolume volume = random_volume(box, 8).volume();
  int calls = 0;
  const Diffusion fill = [&](const RangeVolume& given, const VoxelBox& where, const Progress&) {
    EXPECT_EQ(where.high, VoxelIndex(9, 19, 19)) << "cut to the volume";
    return ++calls == 1 ? with_filler_distances(given) : given;
  };
  const SequenceResult result =
      apply_sequence(volume, parse_operators("v3"), {{0, 0, 0}, {9, 30, 30}}, fill, silent);
  EXPECT_EQ(result.steps[0].changed,
            count_differences(DenseVolume(volume), DenseVolume(with_filler_distances(volume))));
  EXPECT_EQ(calls, 2) << "what changes nothing is not done again";
}

TEST(OperatorSequence, ends_early_when_nothing_changes_any_more) {
  VolumeFrame frame;
  frame.box = {{0, 0, 0}, {299, 299, 299}};
  VolumeBuilder builder(frame);
  builder.set({150, 150, 150}, {VoxelState::empty, 0, 0, {}});
  const SequenceResult result =
      apply_sequence(builder.finish(), parse_operators("d1000"), frame.box, no_diffusion, silent);
  EXPECT_EQ(result.steps[0].changed, 1u);
  EXPECT_EQ(result.volume.counts().empty, 0u);
}

TEST(OperatorSequence, stops_when_cancelled_and_passes_errors_on) {
  const RangeVolume volume = sphere_volume(60);
  const auto steps = parse_operators("d2 e2 x1");
  test::expect_cancels_at_any_step([&](const Progress& progress) {
    apply_sequence(volume, steps, volume.frame().box, no_diffusion, progress);
  });
  EXPECT_THROW(apply_sequence(volume, steps, {{500, 0, 0}, {501, 1, 1}}, no_diffusion, silent),
               CompletionError);
}

}  // namespace
}  // namespace meshcomplete
