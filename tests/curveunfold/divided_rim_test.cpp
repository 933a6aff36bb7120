#include "filter_curveunfold/divided_rim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/core/error.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch.h"
#include "common/core/triangle_intersection.h"
#include "tests/support/loop_families.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

/// The rim of a narrow collar round a closed polygon.
struct Collar {
  explicit Collar(const std::vector<Vector3>& loop, double scale = 1.05)
      : mesh(test::collar(loop, scaled(loop, scale))), input(mesh) {
    const std::vector<BoundaryLoop> loops = test::loops_of(mesh);
    for (const BoundaryLoop& one : loops)
      if (std::find(one.vertices.begin(), one.vertices.end(), 0u) != one.vertices.end())
        rim = collect_rim(mesh, build_topology(mesh), one);
  }
  static std::vector<Vector3> scaled(std::vector<Vector3> loop, double scale) {
    for (Vector3& p : loop) p *= scale;
    return loop;
  }
  TriangleMesh mesh;
  InputNeighbourhood input;
  Rim rim;
};

/// A dumbbell in the plane: two disks joined by a narrow neck.
std::vector<Vector3> dumbbell(int points) {
  return testing::sampled(points, [](double t) {
    const double c = std::cos(t);
    return Vector3(2 * c, std::sin(t) * (0.15 + 0.85 * c * c), 0);
  });
}

std::vector<std::array<Vector3, 3>> corners_of(const PatchMesh& patch) {
  std::vector<std::array<Vector3, 3>> list;
  for (const Triangle& t : patch.triangles())
    list.push_back(
        {as_stored(patch.position(t[0])), as_stored(patch.position(t[1])), as_stored(patch.position(t[2]))});
  return list;
}

TEST(DividedRim, TheBestChordCutsTheNeck) {
  const Collar collar(dumbbell(80));
  const std::vector<Chord> best = chords(collar.rim, collar.input, 3);
  ASSERT_FALSE(best.empty());
  const Vector3 &a = collar.rim.positions[best[0].first], &b = collar.rim.positions[best[0].second];
  EXPECT_LT((a - b).norm(), 0.4);
  EXPECT_LT(std::abs(a.x()), 0.3);
  EXPECT_LT(best[0].first, best[0].second);
  const std::set<Chord> distinct(best.begin(), best.end());
  EXPECT_EQ(distinct.size(), best.size());
}

TEST(DividedRim, NoChordThroughAFaceOfTheInput) {
  const std::vector<Vector3> loop = dumbbell(80);
  const Collar free(loop);
  const Chord first = chords(free.rim, free.input, 1).at(0);
  const Vector3 middle = 0.5 * (free.rim.positions[first.first] + free.rim.positions[first.second]);
  TriangleMesh wall = free.mesh;
  const Index v = static_cast<Index>(wall.vertices.size());
  for (const Vector3& p : {Vector3(-3, 0, -1), Vector3(3, 0, -1), Vector3(0, 0, 4)})
    wall.vertices.push_back(middle + p);
  wall.triangles.push_back({v, v + 1, v + 2});
  const InputNeighbourhood input(wall);
  const std::vector<Chord> best = chords(free.rim, input, 4);
  ASSERT_FALSE(best.empty());
  for (const auto& [i, k] : best)
    EXPECT_FALSE(free.rim.positions[i].y() * free.rim.positions[k].y() < 0) << "crosses the wall y = 0";
}

TEST(DividedRim, BothPartsAreLongEnough) {
  const Collar collar(testing::rough_rim(120, 3));
  const std::size_t n = collar.rim.positions.size();
  double all = 0;
  std::vector<double> way = {0};
  for (std::size_t i = 0; i < n; ++i)
    way.push_back(all += (collar.rim.positions[(i + 1) % n] - collar.rim.positions[i]).norm());
  const std::vector<Chord> best = chords(collar.rim, collar.input, 10);
  ASSERT_FALSE(best.empty());
  for (const auto& [i, k] : best) {
    EXPECT_GE(way[k] - way[i], 0.2 * all);
    EXPECT_GE(all - (way[k] - way[i]), 0.2 * all);
  }
}

TEST(DividedRim, TheSidesFitTogether) {
  const Collar collar(dumbbell(80));
  const Chord chord = chords(collar.rim, collar.input, 1).at(0);
  EmbeddingOptions options;
  options.energy = SurfaceEnergy::membrane;
  const DividedRim divided = divide(collar.rim, chord, collar.input, {}, 2);
  EXPECT_EQ(divided.sides.size(), 2u) << "both project as simple polygons";
  const PatchMesh patch = embed(collar.rim, divided, options);
  EXPECT_EQ(patch.rim_size(), collar.rim.positions.size());
  for (Index v = 0; v < patch.rim_size(); ++v) EXPECT_EQ(patch.position(v), collar.rim.positions[v]);
  // A disk: V - E + F = 1, every rim edge on the boundary, every other edge inside.
  std::size_t boundary = 0;
  for (Index h = 0; h < 3 * patch.triangle_count(); ++h) boundary += patch.is_boundary(h);
  EXPECT_EQ(boundary, patch.rim_size());
  const std::size_t edges = (3 * patch.triangle_count() + boundary) / 2;
  EXPECT_EQ(patch.vertex_count() + patch.triangle_count(), edges + 1);
  EXPECT_TRUE(improper_pairs(corners_of(patch)).empty());
}

TEST(DividedRim, TheEdgeLengthHoldsForTheChordToo) {
  const Collar collar(dumbbell(80));
  EmbeddingOptions options;
  options.edge_length = 0.05;
  const PatchMesh patch = embed(collar.rim, divide(collar.rim, {10, 50}, collar.input, 0.05, 0), options);
  const Vector3 &a = collar.rim.positions[10], &b = collar.rim.positions[50];
  std::vector<double> along;
  for (Index v = static_cast<Index>(patch.rim_size()); v < patch.vertex_count(); ++v) {
    const Vector3 from_a = patch.position(v) - a;
    if (from_a.cross(b - a).norm() < 1e-6 * (b - a).squaredNorm()) along.push_back(from_a.norm());
  }
  std::sort(along.begin(), along.end());
  ASSERT_EQ(along.size(), static_cast<std::size_t>(std::lround((b - a).norm() / 0.05)) - 1);
  for (std::size_t i = 1; i < along.size(); ++i) EXPECT_NEAR(along[i] - along[i - 1], 0.05, 0.005);
}

// Two knots, one on each side of the chord.
TEST(DividedRim, ASideThatDoesNotUnfoldIsAnError) {
  const std::vector<Vector3> loop =
      testing::connected_sum(testing::torus_knot(60, 2, 3), testing::torus_knot(60, 2, 3));
  const Collar collar(loop, 1.01);
  try {
    divide(collar.rim, {60, static_cast<Index>(loop.size()) - 1}, collar.input, {}, 0);
    ADD_FAILURE() << "a knot unfolded";
  } catch (const CompletionError& error) {
    EXPECT_NE(std::string(error.what()).find("could not be unfolded"), std::string::npos) << error.what();
  }
}

TEST(DividedRim, AChordOfTooManyEdgesIsAnError) {
  const Collar collar(dumbbell(80));
  EXPECT_THROW(divide(collar.rim, {10, 50}, collar.input, 1e-5, 0), CompletionError);
}

// Wound five times: what one chord leaves twisted is divided again.
TEST(DividedRim, SidesAreDividedAgain) {
  const Collar collar(testing::wound_rim(200, 5), 1.02);
  const std::vector<Chord> best = chords(collar.rim, collar.input, 1);
  ASSERT_FALSE(best.empty());
  const DividedRim divided = divide(collar.rim, best.front(), collar.input, {}, 2);
  EXPECT_GT(divided.sides.size(), 2u);
  const std::size_t points = collar.rim.positions.size() + divided.points.size();
  for (const FlatSide& side : divided.sides) {
    ASSERT_EQ(side.vertex.size(), side.rim.positions.size());
    ASSERT_EQ(side.vertex.size(), side.polygon.size());
    for (std::size_t i = 0; i < side.vertex.size(); ++i) {
      const Index v = side.vertex[i];
      ASSERT_LT(v, points);
      const std::size_t n = collar.rim.positions.size();
      EXPECT_EQ(side.rim.positions[i], v < n ? collar.rim.positions[v] : divided.points[v - n]);
    }
  }
}

TEST(DividedRim, CanBeCancelled) {
  const Collar collar(dumbbell(80));
  const Progress stop([](double, const std::string&) { return false; });
  EXPECT_THROW(chords(collar.rim, collar.input, 3, stop), Cancelled);
}

}  // namespace
}  // namespace meshcomplete
