#include "common/core/touching_fans.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "common/core/triangle_intersection.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;
constexpr Index none = SheetVertex::none;

/// A closed fan round the origin, vertex 0, over a polygon that is walked counter-clockwise seen from above:
/// its inside is the cone over the polygon.
struct Cone {
  std::vector<SheetVertex> vertices;
  std::vector<Triangle> triangles;

  explicit Cone(const std::vector<Vector3>& polygon) {
    vertices.push_back({Vector3::Zero(), none, none, false});
    for (const Vector3& p : polygon) vertices.push_back({p, none, none, false});
    const Index n = static_cast<Index>(polygon.size());
    for (Index i = 0; i < n; ++i) triangles.push_back({0, 1 + (i + 1) % n, 1 + i});
  }

  std::vector<Corners> fan() const {
    std::vector<Corners> list;
    for (const auto& [a, b, c] : triangles)
      if (a == 0) list.push_back({vertices[a].position, vertices[b].position, vertices[c].position});
    return list;
  }
  double shortest() const {
    double least = vertices[1].position.norm();
    for (std::size_t v = 2; v < vertices.size(); ++v) least = std::min(least, vertices[v].position.norm());
    return least;
  }
};

/// Shaped like a U, seen from above: what is straight behind the fan is the gap between its arms.
Cone u_shaped() {
  return Cone(
      {{-2, -2, 1}, {2, -2, 1}, {2, 2, 1}, {1, 2, 1}, {1, -1, 1}, {-1, -1, 1}, {-1, 2, 1}, {-2, 2, 1}});
}

bool meets(const std::vector<Corners>& fan, const std::vector<Corners>& others) {
  return !improper_pairs(fan, 1).empty() || !improper_pairs_between(fan, others).empty();
}

std::vector<Corners> with_tip_at(const Cone& cone, const Vector3& place) {
  Cone moved = cone;
  moved.vertices[0].position = place;
  return moved.fan();
}

std::vector<Corners> corners_of(const TriangleMesh& mesh) {
  std::vector<Corners> list;
  for (const auto& [a, b, c] : mesh.triangles)
    list.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  return list;
}

const Vector3 up(0, 0, 1);

TEST(TouchingFans, MoveStraightBackWhereThatIsFree) {
  Cone cone({{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}});
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, -1}, {0, 1, -1}}, {{0, 1, 2}}};
  const std::vector<SheetVertex> before = cone.vertices;
  const double expected = 0.1 * cone.shortest();
  retreat(mesh, {{0, 0, none}}, cone.triangles, cone.vertices);
  EXPECT_NEAR((cone.vertices[0].position - expected * up).norm(), 0, 1e-12);
  for (std::size_t v = 1; v < before.size(); ++v) EXPECT_EQ(cone.vertices[v].position, before[v].position);
  retreat(mesh, {}, cone.triangles, cone.vertices);
  EXPECT_NEAR((cone.vertices[0].position - expected * up).norm(), 0, 1e-12) << "no fan, no change";
}

/// The fan lies clear of the mesh but for its tip; straight back it would not.
void expect_another_way(const TriangleMesh& mesh, const TouchingFan& touching) {
  Cone cone = u_shaped();
  const std::vector<Corners> rivals = corners_of(mesh);
  ASSERT_FALSE(meets(cone.fan(), {{rivals[0][0], {0, 2, 0.9}, {0, 2, 1.1}}})) << "only beyond the tip";
  for (double part : {0.1, 0.03, 0.01, 0.003})
    ASSERT_TRUE(meets(with_tip_at(cone, part * cone.shortest() * up), rivals)) << "straight back";
  retreat(mesh, {touching}, cone.triangles, cone.vertices);
  const Vector3 place = cone.vertices[0].position;
  EXPECT_FALSE(meets(cone.fan(), rivals));
  EXPECT_GT(place.norm(), 0.0);
  EXPECT_LE(place.norm(), 0.1 * cone.shortest() + 1e-12);
  EXPECT_NE(place.normalized(), up);
}

TEST(TouchingFans, GoAnotherWayRoundTheMeshAtARimVertex) {
  // In the gap between the arms. The second one is of another vertex and another place.
  const TriangleMesh mesh{{{0, 0, 0}, {0, -1, 2}, {0, 6, 2}, {9, 9, 9}, {9, 8, 9}, {8, 9, 9}},
                          {{0, 1, 2}, {3, 4, 5}}};
  expect_another_way(mesh, {0, 0, none});
}

TEST(TouchingFans, GoAnotherWayRoundTheFaceAtTheMiddleOfARimEdge) {
  // The tip is in the middle of the edge from 0 to 1.
  const TriangleMesh mesh{{{0, 1, -2}, {0, -1, 2}, {0, 6, 2}}, {{0, 1, 2}}};
  expect_another_way(mesh, {0, none, 0});
}

// Where nothing but the fan itself is known at the place, what is in the way is not.
TEST(TouchingFans, OnlyTheMeshAtThePlaceIsLookedAt) {
  const TriangleMesh mesh{{{0, 0, 0}, {0, -1, 2}, {0, 6, 2}}, {{0, 1, 2}}};
  Cone cone = u_shaped();
  retreat(mesh, {{0, none, none}}, cone.triangles, cone.vertices);
  EXPECT_NEAR((cone.vertices[0].position.normalized() - up).norm(), 0, 1e-12) << "doubles away from the rim";
}

// A triangle at one of the fan's other vertices reaches down to its tip.
TEST(TouchingFans, KeepClearOfThePatchRoundThem) {
  Cone cone({{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}});
  const std::vector<Corners> spike = {{Vector3(-1, -1, 1), {0.05, 0.05, 0.1}, {-0.3, 0.3, 0.8}}};
  cone.vertices.push_back({spike[0][1], none, none, false});
  cone.vertices.push_back({spike[0][2], none, none, false});
  cone.triangles.push_back({1, 5, 6});
  ASSERT_FALSE(meets(cone.fan(), spike));
  ASSERT_TRUE(meets(with_tip_at(cone, 0.1 * std::sqrt(3.0) * up), spike)) << "straight back";
  retreat({}, {{0, none, none}}, cone.triangles, cone.vertices);
  EXPECT_FALSE(meets(cone.fan(), spike));
  EXPECT_GT(cone.vertices[0].position.norm(), 0.002);
}

// Two fans at one position, one above the other: each moves into its own inside.
TEST(TouchingFans, TwoFansMoveApart) {
  Cone cone({{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}});
  const Index first = static_cast<Index>(cone.vertices.size());
  const std::vector<Triangle> above = cone.triangles;
  for (std::size_t v = 0; v < first; ++v) {
    SheetVertex below = cone.vertices[v];
    below.position = -below.position;
    cone.vertices.push_back(below);
  }
  for (const auto& [a, b, c] : above) cone.triangles.push_back({first + a, first + c, first + b});
  retreat({}, {{0, none, none}, {first, none, none}}, cone.triangles, cone.vertices);
  EXPECT_GT(cone.vertices[0].position[2], 0.01);
  EXPECT_LT(cone.vertices[first].position[2], -0.01);
}

}  // namespace
}  // namespace meshcomplete
