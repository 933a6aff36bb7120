#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "filter_volmorph/triangle_fan.h"
#include "tests/support/cancelling.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

constexpr double wave = 0.3;
constexpr int waves = 5;
constexpr std::size_t long_rim = 600;

Vector3 at(double radius, double turn, double height) {
  return Vector3(radius * std::cos(turn), radius * std::sin(turn), height);
}

/// Collars under rims; only the rims are selected.
struct Collars {
  TriangleMesh mesh;
  MeshSelection selection;

  void add(const std::vector<Vector3>& rim) {
    std::vector<Vector3> below = rim;
    for (Vector3& p : below) p.z() -= 1;
    mesh = test::join(mesh, test::collar(rim, below));
    selection.vertices.insert(selection.vertices.end(), rim.size(), 1);
    selection.vertices.insert(selection.vertices.end(), rim.size(), 0);
  }
};

/// A long rim that waves, so that its fan has hills and valleys, and short rims under the hills.
Collars long_rim_over_short_ones() {
  Collars collars;
  std::vector<Vector3> rim;
  for (std::size_t i = 0; i < long_rim; ++i) {
    const double turn = 2 * M_PI * static_cast<double>(i) / long_rim;
    rim.push_back(at(1, turn, wave * std::cos(waves * turn)));
  }
  collars.add(rim);
  for (int hill = 0; hill < waves; ++hill)
    for (int i = 0; i < 8; ++i) {
      const double turn = 2 * M_PI * hill / waves, radius = 0.5 + 0.05 * i;
      collars.add({at(radius, turn - 0.01, 0), at(radius + 0.02, turn, 0.01), at(radius, turn + 0.01, 0),
                   at(radius - 0.02, turn, 0.01)});
    }
  return collars;
}

/// A rim under the long one's fan, from one hill through under a valley to the next: its own fan goes through
/// that valley.
std::vector<Vector3> rim_under_valley(int valley) {
  const double turn = 2 * M_PI * (valley + 0.5) / waves, aside = 25 * M_PI / 180;
  return {at(0.5, turn - aside, 0), at(0.4, turn, -1.5 * 0.4 * wave), at(0.5, turn + aside, 0),
          at(0.6, turn, -1.5 * 0.6 * wave)};
}

Completion close_selected(const Collars& collars, const Progress& progress = Progress()) {
  TriangleFanOptions options;
  options.holes.selected_only = true;
  return close_by_fans(collars.mesh, collars.selection, options, progress);
}

std::size_t count(const Completion& completion, HoleOutcome outcome) {
  return completion.report.count(outcome);
}

TEST(TriangleFanRivals, a_long_rim_is_closed_over_many_short_ones_that_it_does_not_meet) {
  const Completion completion = close_selected(long_rim_over_short_ones());
  EXPECT_EQ(count(completion, HoleOutcome::closed), 1u + 8 * waves);
  EXPECT_EQ(count(completion, HoleOutcome::failed), 0u);
  EXPECT_EQ(completion.patch.triangles.size(), long_rim + 4 * 8 * waves);
}

TEST(TriangleFanRivals, a_long_rim_stays_open_whichever_of_the_short_ones_meets_it) {
  for (int valley = 0; valley < waves; ++valley) {
    Collars collars = long_rim_over_short_ones();
    collars.add(rim_under_valley(valley));
    const Completion completion = close_selected(collars);
    EXPECT_EQ(count(completion, HoleOutcome::closed), 1u + 8 * waves);
    ASSERT_EQ(count(completion, HoleOutcome::failed), 1u);
    const std::vector<HoleReport>& holes = completion.report.holes;
    const auto open = std::find_if(holes.begin(), holes.end(), [](const HoleReport& hole) {
      return hole.outcome == HoleOutcome::failed;
    });
    EXPECT_EQ(open->edges, long_rim);
    EXPECT_EQ(open->reason, "the patch meets the patch of another hole");
  }
}

TEST(TriangleFanRivals, a_short_rim_is_closed_where_no_long_one_is) {
  Collars collars;
  collars.add(rim_under_valley(0));
  EXPECT_EQ(count(close_selected(collars), HoleOutcome::closed), 1u);
}

TEST(TriangleFanRivals, can_be_cancelled_at_any_time) {
  Collars collars = long_rim_over_short_ones();
  collars.add(rim_under_valley(2));
  test::expect_cancels_at_any_step([&](const Progress& progress) { close_selected(collars, progress); });
}

}  // namespace
}  // namespace meshcomplete
