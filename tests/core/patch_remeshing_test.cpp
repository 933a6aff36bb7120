#include "common/core/patch_remeshing.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

constexpr double pi = 3.14159265358979323846;

/// A polygon with a fan of triangles at its first vertex.
PatchMesh fan(const std::vector<Vector3>& polygon) {
  std::vector<Triangle> triangles;
  for (Index i = 1; i + 1 < polygon.size(); ++i) triangles.push_back({0, i, i + 1});
  return PatchMesh(polygon, polygon.size(), triangles);
}

std::vector<Vector3> ring(std::size_t n, double height = 0) {
  std::vector<Vector3> polygon;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = 2 * pi * static_cast<double>(i) / static_cast<double>(n);
    polygon.emplace_back(std::cos(t), std::sin(t), height * std::cos(2 * t));
  }
  return polygon;
}

std::vector<double> uniform_target(const PatchMesh& patch, double length) {
  return std::vector<double>(patch.vertex_count(), length);
}

template <class Visit>
void for_inner_edges(const PatchMesh& patch, Visit visit) {
  for (Index h = 0; h < 3 * patch.triangle_count(); ++h)
    if (patch.alive(h / 3) && !patch.is_boundary(h) && h < patch.opposite(h)) visit(h);
}

double area(const PatchMesh& patch) {
  double sum = 0;
  for (Index t = 0; t < patch.triangle_count(); ++t)
    if (patch.alive(t)) sum += 0.5 * patch.area_normal(t).norm();
  return sum;
}

double smallest_angle(const PatchMesh& patch, Index triangle) {
  double least = pi;
  for (Index h = 3 * triangle; h < 3 * triangle + 3; ++h) {
    const Vector3 p = patch.position(patch.origin(h));
    const Vector3 a = patch.position(patch.target(h)) - p, b = patch.position(patch.apex(h)) - p;
    least = std::min(least, std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  return least;
}

/// The rim is where it was and walked once, by boundary edges only, and no edge that is forbidden exists.
void expect_rim_kept(const PatchMesh& patch, const std::vector<Vector3>& rim,
                     const ForbiddenEdges& forbidden) {
  ASSERT_EQ(patch.rim_size(), rim.size());
  for (Index v = 0; v < rim.size(); ++v) EXPECT_EQ(patch.position(v), rim[v]);
  std::size_t boundary = 0;
  for (Index h = 0; h < 3 * patch.triangle_count(); ++h)
    if (patch.alive(h / 3) && patch.is_boundary(h)) {
      ++boundary;
      EXPECT_EQ(patch.target(h), (patch.origin(h) + 1) % rim.size());
    }
  EXPECT_EQ(boundary, rim.size());
  for (const auto& [a, b] : forbidden) EXPECT_FALSE(patch.joined(a, b)) << a << " " << b;
}

// --- refine
// --------------------------------------------------------------------------------------------------

TEST(Refine, NoInnerEdgeStaysTooLong) {
  for (double length : {0.5, 0.2, 0.05}) {
    const std::vector<Vector3> rim = ring(static_cast<std::size_t>(2 * pi / length), 0.3);
    PatchMesh patch = fan(rim);
    std::vector<double> target = uniform_target(patch, length);
    const RemeshOptions options;
    refine(patch, target, options);
    expect_rim_kept(patch, rim, {});
    ASSERT_EQ(target.size(), patch.vertex_count());
    for (double t : target) EXPECT_DOUBLE_EQ(t, length);
    for_inner_edges(patch, [&](Index h) { EXPECT_LE(patch.length(h), options.longest * length); });
    // As many vertices as equilateral triangles of that side need, within a factor.
    const double needed = area(patch) / (std::sqrt(3.0) / 2 * length * length);
    EXPECT_LT(static_cast<double>(patch.vertex_count() - rim.size()), 3 * needed);
  }
}

// Triangles at rim edges that are longer than twice the target have sides that are too long whatever is done.
TEST(Refine, OnlyTrianglesAtTheRimStayTooLongOnACoarseRim) {
  const std::vector<Vector3> rim = ring(24, 0.3);
  PatchMesh patch = fan(rim);
  std::vector<double> target = uniform_target(patch, 0.05);
  const RemeshOptions options;
  refine(patch, target, options);
  expect_rim_kept(patch, rim, {});
  for_inner_edges(patch, [&](Index h) {
    const bool at_rim = patch.on_rim(patch.origin(h)) || patch.on_rim(patch.target(h));
    if (!at_rim) {
      EXPECT_LE(patch.length(h), 3 * options.longest * 0.05);
    }
  });
  EXPECT_LT(static_cast<double>(patch.vertex_count()), 6 * area(patch) / (std::sqrt(3.0) / 2 * 0.05 * 0.05));
}

TEST(Refine, FlatStaysFlatAndKeepsItsArea) {
  PatchMesh patch = fan(ring(24));
  const double before = area(patch);
  std::vector<double> target = uniform_target(patch, 0.1);
  refine(patch, target, {});
  EXPECT_NEAR(area(patch), before, 1e-12);
  for (Index t = 0; t < patch.triangle_count(); ++t) EXPECT_GT(patch.area_normal(t).z(), 0);
  for (const Vector3& p : patch.positions()) EXPECT_EQ(p.z(), 0);
}

// Every edge of a flat patch that is not Delaunay would become too long by the flip.
TEST(Refine, FlatPatchesBecomeDelaunay) {
  PatchMesh patch = fan(ring(17));
  std::vector<double> target = uniform_target(patch, 0.15);
  const RemeshOptions options;
  refine(patch, target, options);
  const auto angle_at_apex = [&](Index h) {
    const Vector3 c = patch.position(patch.apex(h));
    const Vector3 a = patch.position(patch.origin(h)) - c, b = patch.position(patch.target(h)) - c;
    return std::atan2(a.cross(b).norm(), a.dot(b));
  };
  std::size_t edges = 0, delaunay = 0;
  for_inner_edges(patch, [&](Index h) {
    ++edges;
    const Index g = patch.opposite(h);
    if (angle_at_apex(h) + angle_at_apex(g) <= pi + 1e-6) {
      ++delaunay;
    } else {
      EXPECT_GT((patch.position(patch.apex(h)) - patch.position(patch.apex(g))).norm(),
                options.longest * 0.15);
    }
  });
  EXPECT_GT(delaunay * 10, edges * 9);
}

TEST(Refine, TargetsAreInterpolated) {
  const std::vector<Vector3> rim = ring(160);
  PatchMesh patch = fan(rim);
  std::vector<double> target;
  for (const Vector3& p : rim) target.push_back(p.x() > 0 ? 0.05 : 0.4);
  RemeshOptions options;
  refine(patch, target, options);
  expect_rim_kept(patch, rim, {});
  std::size_t fine = 0, coarse = 0;
  for_inner_edges(patch, [&](Index h) {
    const Index a = patch.origin(h), b = patch.target(h);
    EXPECT_LE(patch.length(h), options.longest * 0.5 * (target[a] + target[b]));
    (patch.position(a).x() > 0 ? fine : coarse) += 1;
  });
  for (double t : target) {
    EXPECT_GE(t, 0.05);
    EXPECT_LE(t, 0.4);
  }
  EXPECT_GT(fine, 2 * coarse);
}

TEST(Refine, NothingToDoForLongTargets) {
  PatchMesh patch = fan(ring(12));
  std::vector<double> target = uniform_target(patch, 10);
  refine(patch, target, {});
  EXPECT_EQ(patch.vertex_count(), 12u);
  EXPECT_EQ(patch.triangle_count(), 10u);
}

TEST(Refine, TooManyVerticesAreAnError) {
  PatchMesh patch = fan(ring(12));
  std::vector<double> target = uniform_target(patch, 0.01);
  RemeshOptions options;
  options.max_vertices = 500;
  try {
    refine(patch, target, options);
    FAIL() << "made " << patch.vertex_count() << " vertices";
  } catch (const CompletionError& error) {
    EXPECT_EQ(error.stage(), "refining the patch");
    EXPECT_NE(std::string(error.what()).find("500"), std::string::npos) << error.what();
  }
  EXPECT_LE(patch.vertex_count(), 500u);
}

TEST(Remesh, TooManyVerticesAreAnErrorBeforeAnyIsMade) {
  PatchMesh patch = fan(ring(12));
  std::vector<double> target = uniform_target(patch, 0.01);
  RemeshOptions options;
  options.max_vertices = 500;
  EXPECT_THROW(remesh(patch, target, options), CompletionError);
  EXPECT_EQ(patch.vertex_count(), 12u);
}

// --- forbidden edges
// --------------------------------------------------------------------------------------------------

// The quad's better diagonal is one that the input has: there from the start, or what a flip would make.
TEST(Refine, ForbiddenEdgesOfAQuad) {
  const std::vector<Vector3> rim = {{0, -0.5, 0}, {1, 0, 0}, {0, 0.5, 0}, {-1, 0, 0}};
  for (const std::vector<Triangle>& start :
       {std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}, std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}}})
    for (double length : {0.3, 100.0}) {
      RemeshOptions options;
      options.forbidden = {{0, 2}};
      PatchMesh patch(rim, 4, start);
      std::vector<double> target = uniform_target(patch, length);
      refine(patch, target, options);
      expect_rim_kept(patch, rim, options.forbidden);
      ASSERT_EQ(target.size(), patch.vertex_count());
      remesh(patch, target, options);
      expect_rim_kept(patch, rim, options.forbidden);
      ASSERT_EQ(target.size(), patch.vertex_count());
    }
}

TEST(Refine, EveryChordForbidden) {
  const std::vector<Vector3> rim = ring(9, 0.2);
  RemeshOptions options;
  for (Index a = 0; a < 9; ++a)
    for (Index b = a + 2; b < 9; ++b)
      if (b - a < 8) options.forbidden.emplace_back(a, b);
  for (double length : {0.2, 0.7, 100.0}) {
    PatchMesh patch = fan(rim);
    std::vector<double> target = uniform_target(patch, length);
    refine(patch, target, options);
    expect_rim_kept(patch, rim, options.forbidden);
    remesh(patch, target, options);
    expect_rim_kept(patch, rim, options.forbidden);
  }
}

// --- remesh
// --------------------------------------------------------------------------------------------------

TEST(Remesh, ReachesTheTargetLengthWithGoodTriangles) {
  for (double height : {0.0, 0.3})
    for (double length : {0.2, 0.1}) {
      const std::vector<Vector3> rim = ring(static_cast<std::size_t>(std::lround(2 * pi / length)), height);
      PatchMesh patch = fan(rim);
      std::vector<double> target = uniform_target(patch, length);
      refine(patch, target, {});
      remesh(patch, target, {});
      expect_rim_kept(patch, rim, {});
      ASSERT_EQ(target.size(), patch.vertex_count());
      double sum = 0, count = 0, longest = 0, shortest = 1e300;
      for_inner_edges(patch, [&](Index h) {
        sum += patch.length(h);
        ++count;
        longest = std::max(longest, patch.length(h));
        shortest = std::min(shortest, patch.length(h));
      });
      EXPECT_NEAR(sum / count, length, 0.15 * length);
      EXPECT_LT(longest, 1.8 * length);
      EXPECT_GT(shortest, 0.35 * length);
      double angles = 0;
      for (Index t = 0; t < patch.triangle_count(); ++t) {
        ASSERT_TRUE(patch.alive(t)) << "compact";
        EXPECT_GT(smallest_angle(patch, t), 15 * pi / 180);
        angles += smallest_angle(patch, t);
      }
      EXPECT_GT(angles / static_cast<double>(patch.triangle_count()), 40 * pi / 180);
    }
}

TEST(Remesh, FlatPatchesStayFlatWithoutFolds) {
  const std::vector<Vector3> rim = ring(40);
  PatchMesh patch = fan(rim);
  const double before = area(patch);
  std::vector<double> target = uniform_target(patch, 0.12);
  refine(patch, target, {});
  remesh(patch, target, {});
  for (const Vector3& p : patch.positions()) EXPECT_NEAR(p.z(), 0, 1e-14);
  for (Index t = 0; t < patch.triangle_count(); ++t) EXPECT_GT(patch.area_normal(t).z(), 0);
  EXPECT_NEAR(area(patch), before, 1e-12);
}

TEST(Remesh, CoarsensWhatIsTooFine) {
  const std::vector<Vector3> rim = ring(12);
  PatchMesh patch = fan(rim);
  std::vector<double> target = uniform_target(patch, 0.03);
  refine(patch, target, {});
  const std::size_t before = patch.vertex_count();
  std::fill(target.begin(), target.end(), 0.3);
  RemeshOptions options;
  options.rounds = 6;
  remesh(patch, target, options);
  expect_rim_kept(patch, rim, {});
  EXPECT_LT(patch.vertex_count() * 10, before);
}

TEST(Remesh, NoRoundsOnlyCompacts) {
  PatchMesh patch = fan(ring(12));
  std::vector<double> target = uniform_target(patch, 0.2);
  refine(patch, target, {});
  const std::vector<Vector3> positions = patch.positions();
  const std::vector<Triangle> triangles = patch.triangles();
  RemeshOptions options;
  options.rounds = 0;
  remesh(patch, target, options);
  EXPECT_EQ(patch.positions(), positions);
  EXPECT_EQ(patch.triangles(), triangles);
}

TEST(Remesh, TheSameTwice) {
  const auto run = [] {
    PatchMesh patch = fan(ring(31, 0.4));
    std::vector<double> target = uniform_target(patch, 0.1);
    refine(patch, target, {});
    remesh(patch, target, {});
    return std::pair(patch.positions(), patch.triangles());
  };
  EXPECT_EQ(run(), run());
}

TEST(Remesh, CanBeCancelled) {
  PatchMesh patch = fan(ring(31));
  std::vector<double> target = uniform_target(patch, 0.1);
  const Progress cancelled([](double, const std::string&) { return false; });
  EXPECT_THROW(
      {
        refine(patch, target, {}, cancelled);
        remesh(patch, target, {}, cancelled);
      },
      Cancelled);
}

// --- what must not go on for ever
// --------------------------------------------------------------------------------------------------

/// Refines and remeshes, and expects a rim that is untouched and a bounded number of vertices.
void expect_ends(const std::vector<Vector3>& rim, double length, std::size_t most) {
  PatchMesh patch = fan(rim);
  std::vector<double> target = uniform_target(patch, length);
  RemeshOptions options;
  options.max_vertices = 1000000;
  refine(patch, target, options);
  EXPECT_LT(patch.vertex_count(), most);
  remesh(patch, target, options);
  expect_rim_kept(patch, rim, {});
  EXPECT_LT(patch.vertex_count(), most);
  for (const Vector3& p : patch.positions()) EXPECT_TRUE(p.allFinite());
}

TEST(RemeshingEnds, OnNeedles) {
  for (double width : {1e-2, 1e-4, 1e-8}) {
    std::vector<Vector3> rim;
    for (int i = 0; i <= 20; ++i) rim.emplace_back(i, 0, 0);
    for (int i = 20; i >= 0; --i) rim.emplace_back(i + 0.5, width, 0);
    expect_ends(rim, 1.0, 2000);
    expect_ends(rim, 0.1, 20000);
  }
}

TEST(RemeshingEnds, OnTrianglesWithoutArea) {
  std::vector<Vector3> rim;  // there and back again on the same line
  for (int i = 0; i <= 10; ++i) rim.emplace_back(i, 0, 0);
  for (int i = 9; i > 0; --i) rim.emplace_back(i + 0.25, 0, 0);
  expect_ends(rim, 0.5, 5000);
  expect_ends(rim, 5, 5000);
}

TEST(RemeshingEnds, OnCoincidentVertices) {
  std::vector<Vector3> rim = ring(16);
  rim[8] = rim[0];
  rim[4] = rim[12];
  expect_ends(rim, 0.1, 20000);
  expect_ends(std::vector<Vector3>(6, Vector3(1, 2, 3)), 0.1, 100);
}

TEST(RemeshingEnds, OnARimWithOneCorner) {
  std::vector<Vector3> rim = {{5, 3, 0}};  // all the others on one line
  for (int i = 0; i <= 30; ++i) rim.emplace_back(-i + 20.0, 0, 0);
  expect_ends(rim, 1, 5000);
}

TEST(RemeshingEnds, OnTargetsThatDifferByAThousand) {
  const std::vector<Vector3> rim = ring(50);
  PatchMesh patch = fan(rim);
  std::vector<double> target = uniform_target(patch, 0.5);
  target[7] = 0.0005;
  refine(patch, target, {});
  remesh(patch, target, {});
  expect_rim_kept(patch, rim, {});
  EXPECT_LT(patch.vertex_count(), 20000u);
}

TEST(RemeshingEnds, OnRandomRims) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    const auto coordinate = [&] { return static_cast<double>(random() % 7); };  // many coincidences
    std::vector<Vector3> rim;
    for (unsigned i = 0; i < 4 + seed % 20; ++i) rim.emplace_back(coordinate(), coordinate(), coordinate());
    expect_ends(rim, 0.7, 50000);
  }
}

}  // namespace
}  // namespace meshcomplete
