#include "filter_volmorph/handle_measure.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "filter_volmorph/surface_extraction.h"
#include "tests/support/cancelling.h"
#include "tests/support/meshes.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

// Of a distance function, all voxels seen.
template <class Distance>
TriangleMesh surface_of(const VoxelBox& box, double voxel_size, Distance&& distance) {
  VolumeFrame frame;
  frame.box = box;
  frame.voxel_size = voxel_size;
  DenseVolume volume(frame);
  volume.for_each([&](const VoxelIndex& at, const Voxel&) {
    const double d = distance(frame.position(at.cast<double>()));
    volume.at(at) = {VoxelState::seen, float(std::clamp(d, -frame.ramp, frame.ramp)), 1, {}};
  });
  return extract_surface(volume.volume(), {});
}

// A plate of half thickness 3 with round tunnels through it, at 12 to each other along x.
TriangleMesh pierced_plate(const std::vector<double>& radii) {
  const int right = int(12 * radii.size());
  return surface_of({{-10, -10, -6}, {right, 10, 6}}, 1, [&](const Vector3& at) {
    double d = std::max({std::abs(at.z()) - 3, std::abs(at.y()) - 8.2, -6.3 - at.x(), at.x() - right + 5.1});
    for (std::size_t i = 0; i < radii.size(); ++i)
      d = std::max(d, radii[i] - std::hypot(at.x() - 12. * double(i), at.y()));
    return d;
  });
}

std::vector<Handle> handles_of(const TriangleMesh& mesh) {
  const HandleReport report = measure_handles(mesh);
  EXPECT_TRUE(report.handles.has_value());
  EXPECT_EQ(report.handles->size(), std::size_t(*report.statistics.genus));
  for (const Handle& handle : *report.handles) {
    double length = 0;
    const std::set<Index> different(handle.loop.begin(), handle.loop.end());
    EXPECT_EQ(different.size(), handle.loop.size());
    for (std::size_t i = 0; i < handle.loop.size(); ++i)
      length +=
          (mesh.vertices[handle.loop[i]] - mesh.vertices[handle.loop[(i + 1) % handle.loop.size()]]).norm();
    EXPECT_NEAR(length, handle.length, 1e-9 * length);
  }
  EXPECT_TRUE(std::is_sorted(report.handles->begin(), report.handles->end(),
                             [](const Handle& a, const Handle& b) { return a.length < b.length; }));
  return *report.handles;
}

TEST(HandleMeasure, finds_the_loop_round_a_torus) {
  const std::vector<Handle> thin = handles_of(test::torus(64, 24, 1, 0.2));
  ASSERT_EQ(thin.size(), 1u);
  EXPECT_NEAR(thin[0].length, 2 * M_PI * 0.2, 0.02);  // 24 straight edges
  EXPECT_NEAR(thin[0].centre.head<2>().norm(), 1, 0.02);
  EXPECT_NEAR(thin[0].centre.z(), 0, 0.02);
}

TEST(HandleMeasure, finds_the_loop_through_a_fat_torus) {
  // Round the hole 2 pi 0.2, round the tube 2 pi 0.8.
  const std::vector<Handle> fat = handles_of(test::torus(96, 96, 1, 0.8));
  ASSERT_EQ(fat.size(), 1u);
  EXPECT_GE(fat[0].length, 2 * M_PI * 0.2 * 0.99);
  EXPECT_LE(fat[0].length, 2 * M_PI * 0.2 * 1.5);
  EXPECT_LT(fat[0].centre.norm(), 0.3);
}

TEST(HandleMeasure, measures_each_of_several_handles) {
  const std::vector<double> radii = {4, 1.2, 2.5, 1.5};
  const std::vector<Handle> handles = handles_of(pierced_plate(radii));
  ASSERT_EQ(handles.size(), 4u);
  const std::vector<std::size_t> ascending = {1, 3, 2};
  for (std::size_t i = 0; i < ascending.size(); ++i) {
    const double radius = radii[ascending[i]];
    EXPECT_GE(handles[i].length, 2 * M_PI * radius * 0.8) << i;
    EXPECT_LE(handles[i].length, 2 * M_PI * radius * 1.6) << i;
    EXPECT_NEAR(handles[i].centre.x(), 12. * double(ascending[i]), radius) << i;
  }
  // Round the widest, or over the plate's rim and through it: from 3.1 to 4.2 wide and 6 high.
  EXPECT_GE(handles[3].length, 16);
  EXPECT_LE(handles[3].length, 2 * M_PI * 4 * 1.3);
}

TEST(HandleMeasure, finds_tiny_handles_on_a_large_ring) {
  // A torus with three thin bows on it, each a handle.
  const double radius = 18, tube = 7;
  const std::vector<double> angles = {0.4, 2.1, 4.4};
  const TriangleMesh mesh = surface_of({{-34, -34, -15}, {34, 34, 20}}, 1, [&](const Vector3& at) {
    double d = std::hypot(std::hypot(at.x(), at.y()) - radius, at.z()) - tube;
    for (const double angle : angles) {
      const Vector3 foot(radius * std::cos(angle), radius * std::sin(angle), tube);
      const Vector3 from = at - foot, along(-std::sin(angle), std::cos(angle), 0);
      const double around = std::hypot(from.dot(along), from.z()) - 4;
      d = std::min(d, std::hypot(around, from.dot(Vector3(std::cos(angle), std::sin(angle), 0))) - 1.2);
    }
    return d;
  });
  const std::vector<Handle> handles = handles_of(mesh);
  ASSERT_EQ(handles.size(), 4u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_GE(handles[i].length, 2 * M_PI * 1.2 * 0.8);
    EXPECT_LE(handles[i].length, 2 * M_PI * 1.2 * 1.7);
    double nearest = 100;
    for (const double angle : angles)
      nearest = std::min(
          nearest,
          (handles[i].centre - Vector3(radius * std::cos(angle), radius * std::sin(angle), tube + 3)).norm());
    EXPECT_LT(nearest, 5);
  }
  EXPECT_GE(handles[3].length, 2 * M_PI * tube * 0.9);
  EXPECT_LE(handles[3].length, 2 * M_PI * tube * 1.4);
}

TEST(HandleMeasure, goes_over_all_components) {
  const TriangleMesh small = test::torus(32, 16, 1, 0.1), sphere = test::icosphere(2, 1, Vector3(5, 0, 0));
  const TriangleMesh large = test::translated(test::torus(32, 16, 10, 2), Vector3(100, 0, 0));
  const std::vector<Handle> handles = handles_of(test::join(large, test::join(sphere, small)));
  ASSERT_EQ(handles.size(), 2u);
  EXPECT_NEAR(handles[0].length, 2 * M_PI * 0.1, 0.02);
  EXPECT_NEAR(handles[1].length, 2 * M_PI * 2, 0.2);
  EXPECT_LT(handles[0].centre.norm(), 2);
  EXPECT_NEAR((handles[1].centre - Vector3(100, 0, 0)).norm(), 10, 0.5);
}

TEST(HandleMeasure, does_not_take_holes_for_handles) {
  EXPECT_TRUE(handles_of(test::sphere_with_holes(6)).empty());
  EXPECT_TRUE(handles_of(test::open_cylinder()).empty());
  EXPECT_TRUE(handles_of(test::rough_sphere_with_ragged_holes(4, 6, 3)).empty());
  const TriangleMesh torus = test::torus(64, 24, 1, 0.3);
  const TriangleMesh holed =
      test::without_ball(test::without_ball(torus, Vector3(1.3, 0, 0), 0.25), Vector3(-1, 0, 0.3), 0.2);
  const std::vector<Handle> handles = handles_of(holed);
  ASSERT_EQ(handles.size(), 1u);
  EXPECT_NEAR(handles[0].length, 2 * M_PI * 0.3, 0.3);
}

TEST(HandleMeasure, keeps_the_fans_of_a_vertex_apart) {
  // Two tori that share one vertex.
  TriangleMesh tori = test::join(test::torus(24, 12, 1, 0.25), test::torus(24, 12, 1, 0.25));
  const Index second = Index(tori.vertices.size() / 2);
  for (Triangle& face : tori.triangles)
    for (Index& corner : face)
      if (corner == second) corner = 0;
  const HandleReport report = measure_handles(tori);
  ASSERT_TRUE(report.handles.has_value());
  EXPECT_EQ(report.handles->size(), 2u);
}

TEST(HandleMeasure, counts_all_handles_of_noise) {
  const DenseVolume volume = random_volume({{0, 0, 0}, {24, 24, 24}}, 5);
  const std::vector<Handle> handles = handles_of(extract_surface(volume.volume(), {}));
  EXPECT_GT(handles.size(), 100u);
}

TEST(HandleMeasure, says_nothing_where_there_is_no_genus) {
  EXPECT_FALSE(measure_handles(test::moebius_strip()).handles.has_value());
  EXPECT_FALSE(measure_handles(test::book()).handles.has_value());
  TriangleMesh turned = test::torus(24, 12);
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_FALSE(measure_handles(turned).handles.has_value());
  EXPECT_TRUE(measure_handles(TriangleMesh()).handles->empty());
}

TEST(HandleMeasure, is_the_same_for_any_number_of_threads) {
  const TriangleMesh mesh = pierced_plate({2, 3});
  const std::vector<Handle> threaded = handles_of(mesh);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const std::vector<Handle> single = handles_of(mesh);
  ASSERT_EQ(threaded.size(), single.size());
  for (std::size_t i = 0; i < single.size(); ++i) EXPECT_EQ(threaded[i].loop, single[i].loop);
}

TEST(HandleMeasure, can_be_cancelled) {
  const TriangleMesh mesh = test::torus(400, 200);
  test::expect_cancels_at_any_step([&](const Progress& progress) { measure_handles(mesh, progress); });
}

}  // namespace
}  // namespace meshcomplete
