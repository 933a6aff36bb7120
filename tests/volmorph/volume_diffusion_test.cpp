#include "filter_volmorph/volume_diffusion.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/core/error.h"
#include "common/core/mesh_statistics.h"
#include "filter_volmorph/diffusion_blocks.h"
#include "filter_volmorph/surface_extraction.h"
#include "tests/support/cancelling.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

struct Sample {
  double distance;
  Vector3 normal;
  bool hidden;  // from the scanners
  bool looked_through = false;
};

// What scanners know of a body: seen within the ramp of its surface and empty outside, but unseen where
// hidden.
template <class Body>
RangeVolume scanned(const VoxelBox& box, Body&& body) {
  VolumeFrame frame;
  frame.box = box;
  DenseVolume volume(frame);
  volume.for_each([&](const VoxelIndex& at, const Voxel&) {
    const Sample sample = body(Vector3(at.cast<double>()));
    Voxel& voxel = volume.at(at);
    const bool near = std::abs(sample.distance) < frame.ramp;
    if (sample.looked_through)
      voxel.state = VoxelState::empty;
    else if (sample.hidden || (!near && sample.distance < 0))
      voxel.state = VoxelState::unseen;
    else if (!near)
      voxel.state = VoxelState::empty;
    else
      voxel = {VoxelState::seen, float(sample.distance), 1, Eigen::Vector3f(sample.normal.cast<float>())};
  });
  return volume.volume();
}

VoxelBox cube_of(int half) { return {VoxelIndex::Constant(-half), VoxelIndex::Constant(half)}; }

constexpr double sphere_radius = 16;

// Not seen within a cone round +z. Beyond the ramp somebody looked through.
Sample sphere(const Vector3& at) {
  const double distance = at.norm() - sphere_radius;
  const bool cone = at.z() > 0.8 * at.norm();
  return {distance, at.norm() > 0 ? Vector3(at.normalized()) : Vector3(0, 0, 1), cone && distance < 8};
}

Sample torus(const Vector3& at) {
  const double flat = at.head<2>().norm();
  const Vector3 middle = flat > 0 ? Vector3(at.x() / flat * 15, at.y() / flat * 15, 0) : Vector3(15, 0, 0);
  const double distance = (at - middle).norm() - 6;
  const bool hidden = at.x() > 0 && std::abs(at.y()) < 5;
  return {distance, (at - middle).normalized(), hidden && distance < 6};
}

// Figure 2.3: a body above and one below, a gap between them of six voxels, and in both faces a hole, one
// across from the other, 24 wide. Perhaps somebody looked through the middle of the gap.
Sample two_bodies(const Vector3& at, bool looked_through) {
  const double gap = 3 - std::abs(at.z()), above = std::abs(at.z()) - 18;
  const int side = std::abs(at.x()) > std::abs(at.y()) ? 0 : 1;
  const double beside = std::abs(at[side]) - 24;
  const double distance = std::max({gap, above, beside});
  Vector3 normal = Vector3::Unit(2) * (at.z() > 0 ? 1 : -1);
  if (distance == gap) normal = -normal;
  if (distance == beside) normal = Vector3::Unit(side) * (at[side] > 0 ? 1 : -1);
  const bool hidden = at.head<2>().norm() < 12 && std::abs(at.z()) < 11;
  return {distance, normal, hidden, hidden && looked_through && std::abs(at.z()) < 1};
}

RangeVolume two_bodies_scanned(bool looked_through) {
  return scanned({{-28, -28, -22}, {28, 28, 22}},
                 [&](const Vector3& at) { return two_bodies(at, looked_through); });
}

DiffusionOptions diffusion(bool line_of_sight, bool normals) {
  DiffusionOptions options;
  options.line_of_sight = line_of_sight;
  options.normals = normals;
  return options;
}

MeshStatistics filled(const RangeVolume& volume, const DiffusionOptions& options = DiffusionOptions()) {
  const RangeVolume result = diffuse(volume, volume.frame().box, options);
  return measure(extract_surface(result, {}), true);
}

void expect_only_distances_changed(const RangeVolume& before, const RangeVolume& after, const VoxelBox& box) {
  EXPECT_EQ(&*before.grids().state, &*after.grids().state);
  EXPECT_EQ(&*before.grids().weight, &*after.grids().weight);
  EXPECT_EQ(&*before.grids().normal, &*after.grids().normal);
  const DenseVolume a(before), b(after);
  a.for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    if (voxel.state == VoxelState::seen || !box.contains(at)) {
      ASSERT_TRUE(same_voxel(voxel, b.at(at))) << at.transpose();
    }
    ASSERT_LE(std::abs(b.at(at).distance), float(before.frame().ramp));
  });
}

// How far the volume is off when it is filled with line of sight and normals, and without.
std::pair<double, double> volume_errors(const RangeVolume& volume, double truth) {
  return {std::abs(filled(volume).volume - truth),
          std::abs(filled(volume, diffusion(false, false)).volume - truth)};
}

// These two holes are narrow: without line of sight and normals they are closed as well, only flatter. Where
// that fails is shown by the wide ones below.
TEST(VolumeDiffusion, closes_a_hole_in_a_sphere) {
  const RangeVolume volume = scanned(cube_of(26), sphere);
  const double ball = 4. / 3 * M_PI * std::pow(sphere_radius, 3);
  const MeshStatistics before = measure(extract_surface(volume, {}), false);
  EXPECT_GT(before.volume, 1.15 * ball);  // the cone as far as nobody looked
  for (const bool normals : {false, true}) {
    const MeshStatistics found = filled(volume, diffusion(true, normals));
    EXPECT_TRUE(found.solid());
    EXPECT_EQ(*found.genus, 0);
    EXPECT_EQ(found.components, 1u);
    EXPECT_NEAR(found.volume, ball, 0.04 * ball) << normals;
  }
  const auto [with, without] = volume_errors(volume, ball);
  EXPECT_LT(3 * with, without);
}

TEST(VolumeDiffusion, closes_a_hole_in_a_torus) {
  const RangeVolume volume = scanned({{-28, -28, -14}, {28, 28, 14}}, torus);
  const double ring = 2 * M_PI * M_PI * 15 * 36;
  EXPECT_GT(measure(extract_surface(volume, {}), false).volume, 1.1 * ring);
  for (const bool normals : {false, true}) {
    const MeshStatistics found = filled(volume, diffusion(true, normals));
    EXPECT_TRUE(found.solid());
    EXPECT_EQ(*found.genus, 1);
    EXPECT_EQ(found.components, 1u);
    EXPECT_NEAR(found.volume, ring, 0.05 * ring) << normals;
  }
  const auto [with, without] = volume_errors(volume, ring);
  EXPECT_LT(2 * with, without);
}

// A hole round an axis from `middle`, `height` from it: nothing seen within half of `width`, and nothing
// known there up to `looked` above the surface.
struct Hole {
  Vector3 middle, axis;
  double height, width, looked;

  bool hides(const Vector3& at) const {
    const Vector3 from = at - middle;
    const double along = from.dot(axis);
    return along > 0 && (from - along * axis).norm() < width / (2 * height) * from.norm();
  }
};

// Where the surface crosses the axis, from within; the box's border where it does not.
double height_over(const RangeVolume& volume, const Hole& hole) {
  double height = 0;
  const auto distance = [&](double along) {
    return volume.at((hole.middle + along * hole.axis).array().round().cast<int>()).distance;
  };
  while (volume.frame().box.contains((hole.middle + (height + 1) * hole.axis).array().round().cast<int>())) {
    const double here = distance(height), next = distance(height + 1);
    if (here < 0 && next >= 0) return height + here / (here - next);
    ++height;
  }
  return height;
}

constexpr double never = 1e9;

RangeVolume sphere_with_hole(const Hole& hole, int border) {
  const int half = int(hole.height) + border;
  const VoxelBox box{{-half, -half, 0}, {half, half, half}};
  return scanned(box, [&](const Vector3& at) {
    const double distance = at.norm() - hole.height;
    const bool hidden = hole.hides(at);
    const Vector3 normal = at.norm() > 0 ? Vector3(at.normalized()) : hole.axis;
    return Sample{distance, normal, hidden, hidden && distance > hole.looked};
  });
}

// How far the surface over a hole may be from where the body's was, voxels.
constexpr double height_tolerance = 1.25;

void expect_height(const RangeVolume& volume, const Hole& hole) {
  EXPECT_NEAR(height_over(diffuse(volume, volume.frame().box, {}), hole), hole.height, height_tolerance)
      << hole.height << ' ' << hole.width << ' ' << volume.frame().box.high.transpose() << ' ' << hole.looked;
}

void expect_wrong_height_without_line_of_sight_and_normals(const RangeVolume& volume, const Hole& hole) {
  const RangeVolume result = diffuse(volume, volume.frame().box, diffusion(false, false));
  EXPECT_GT(std::abs(height_over(result, hole) - hole.height), height_tolerance)
      << hole.height << ' ' << hole.width << ' ' << volume.frame().box.high.transpose();
}

// Without line of sight and normals narrow holes come out as high, or a voxel lower; wide ones, and those
// wide for how far the box goes on behind and before them, do not.
TEST(VolumeDiffusion, closes_holes_in_spheres_at_the_spheres_height) {
  struct Case {
    double radius, width;
    int border;
    bool wide;
  };
  const Case cases[] = {{22, 10, 6, false}, {22, 23, 6, false}, {22, 23, 14, false},
                        {22, 30, 6, false}, {22, 40, 6, true},  {40, 30, 6, true}};
  for (const Case& c : cases) {
    for (const double looked : {8., never}) {
      const Hole hole{Vector3::Zero(), Vector3::UnitZ(), c.radius, c.width, looked};
      expect_height(sphere_with_hole(hole, c.border), hole);
    }
    const Hole hole{Vector3::Zero(), Vector3::UnitZ(), c.radius, c.width, never};
    if (c.wide) expect_wrong_height_without_line_of_sight_and_normals(sphere_with_hole(hole, c.border), hole);
  }
}

constexpr double torus_ring = 24, torus_tube = 12;

RangeVolume torus_with_hole(const Hole& hole, int border) {
  const int half = int(torus_ring + torus_tube) + border;
  return scanned({{0, -24, -18}, {half, 24, 18}}, [&](const Vector3& at) {
    const double flat = std::max(at.head<2>().norm(), 1.);
    const Vector3 middle = Vector3(at.x(), at.y(), 0) * (torus_ring / flat);
    const Vector3 from = at - middle;
    const double distance = from.norm() - torus_tube;
    const Vector3 normal = from.norm() > 0 ? Vector3(from.normalized()) : hole.axis;
    const bool hidden = hole.hides(at);
    return Sample{distance, normal, hidden, hidden && distance > hole.looked};
  });
}

TEST(VolumeDiffusion, closes_holes_in_a_torus_at_its_height) {
  const auto hole_of = [](double width, double looked) {
    return Hole{{torus_ring, 0, 0}, Vector3::UnitX(), torus_tube, width, looked};
  };
  for (const double width : {10., 20.})
    for (const double looked : {8., never})
      expect_height(torus_with_hole(hole_of(width, looked), 6), hole_of(width, looked));
  // Nearly as wide as the tube, with much unseen before it.
  const Hole wide = hole_of(22, never);
  expect_height(torus_with_hole(wide, 14), wide);
  expect_wrong_height_without_line_of_sight_and_normals(torus_with_hole(wide, 14), wide);
}

TEST(VolumeDiffusion, merges_two_near_holes_without_line_of_sight_and_normals) {
  for (const bool looked_through : {false, true}) {
    const MeshStatistics found = filled(two_bodies_scanned(looked_through), diffusion(false, false));
    EXPECT_TRUE(found.solid());
    EXPECT_EQ(found.components, 1u);
  }
}

TEST(VolumeDiffusion, keeps_two_near_holes_apart_by_the_line_of_sight) {
  const MeshStatistics found = filled(two_bodies_scanned(true), diffusion(true, false));
  EXPECT_TRUE(found.solid());
  EXPECT_EQ(found.components, 2u);
  EXPECT_EQ(*found.genus, 0);
}

TEST(VolumeDiffusion, keeps_two_near_holes_apart_by_the_normals) {
  for (const bool line_of_sight : {false, true}) {
    const RangeVolume volume = two_bodies_scanned(false);
    EXPECT_EQ(measure(extract_surface(volume, {}), false).components, 1u);
    const MeshStatistics found = filled(volume, diffusion(line_of_sight, true));
    EXPECT_TRUE(found.solid());
    EXPECT_EQ(found.components, 2u);
    EXPECT_EQ(*found.genus, 0);
  }
}

TEST(VolumeDiffusion, fills_two_near_holes_each_across_itself) {
  const RangeVolume volume = two_bodies_scanned(true);
  const RangeVolume result = diffuse(volume, volume.frame().box, {});
  // The faces go on within two voxels of where they are round the holes.
  for (const int x : {0, 4, 8, -8})
    for (const int side : {-1, 1}) {
      EXPECT_LT(result.at({x, 0, 5 * side}).distance, 0) << x;
      EXPECT_GT(result.at({x, 0, 1 * side}).distance, 0) << x;
    }
}

TEST(VolumeDiffusion, keeps_voxels_that_are_known_to_be_empty_outside) {
  const DenseVolume noise = random_volume({{0, 0, 0}, {30, 25, 20}}, 3);
  const RangeVolume volume = noise.volume();
  const DenseVolume with(diffuse(volume, volume.frame().box, diffusion(true, true)));
  const DenseVolume without(diffuse(volume, volume.frame().box, diffusion(false, true)));
  std::size_t inside = 0;
  noise.for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    if (voxel.state != VoxelState::empty) return;
    EXPECT_GE(with.at(at).distance, 0.5f);
    if (without.at(at).distance < 0) ++inside;
  });
  EXPECT_GT(inside, 100u);
}

TEST(VolumeDiffusion, changes_only_distances_of_voxels_in_the_box_that_are_not_seen) {
  const RangeVolume volume = random_volume({{-7, 2, 0}, {24, 25, 20}}, 4).volume();
  const VoxelBox box{{-3, 5, 2}, {12, 40, 9}};
  const RangeVolume result = diffuse(volume, box, {});
  expect_only_distances_changed(volume, result, box);
  std::size_t changed = 0;
  const DenseVolume before(volume), after(result);
  before.for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    if (!same_voxel(voxel, after.at(at))) ++changed;
  });
  EXPECT_GT(changed, 500u);
  const MeshStatistics found = measure(extract_surface(result, {}), true);
  EXPECT_TRUE(found.watertight());
  EXPECT_TRUE(found.manifold());
  EXPECT_EQ(*found.self_intersecting_pairs, 0u);
}

TEST(VolumeDiffusion, leaves_what_is_out_of_reach_as_it_was) {
  const RangeVolume volume = scanned(cube_of(26), sphere);
  DiffusionOptions options;
  options.reach = 3;
  const RangeVolume result = diffuse(volume, volume.frame().box, options);
  EXPECT_EQ(result.at({0, 0, 16}).distance, -4);  // nine from the rim
  EXPECT_EQ(result.at({0, 0, 0}).distance, -4);
  EXPECT_EQ(result.at({25, 25, 25}).distance, 4);
  EXPECT_NE(result.at({9, 0, 14}).distance, -4);
  const MeshStatistics found = measure(extract_surface(result, {}), false);
  EXPECT_TRUE(found.watertight());
  options.reach = 32;
  options.iterations = 3;  // steps are as far as a front comes
  EXPECT_EQ(diffuse(volume, volume.frame().box, options).at({0, 0, 16}).distance, -4);
}

TEST(VolumeDiffusion, goes_on_where_it_stopped) {
  const RangeVolume volume = scanned(cube_of(26), sphere);
  DiffusionOptions half;
  half.iterations = 6;
  DiffusionOptions whole = half;
  whole.iterations = 12;
  const VoxelBox& box = volume.frame().box;
  const DenseVolume twice(diffuse(diffuse(volume, box, half), box, half)), once(diffuse(volume, box, whole));
  once.for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    ASSERT_TRUE(same_voxel(voxel, twice.at(at))) << at.transpose();
  });
}

TEST(VolumeDiffusion, changes_nothing_where_nothing_is_seen) {
  VolumeFrame frame;
  frame.box = cube_of(20);
  VolumeBuilder builder(frame);
  builder.fill({{0, 0, 0}, {20, 20, 20}}, VoxelState::empty);
  const RangeVolume volume = builder.finish();
  const RangeVolume result = diffuse(volume, frame.box, {});
  EXPECT_EQ(result.grids().distance->activeVoxelCount(), 0u);
}

TEST(VolumeDiffusion, is_the_same_for_any_number_of_threads) {
  const RangeVolume volume = random_volume(cube_of(20), 6).volume();
  const DenseVolume threaded(diffuse(volume, volume.frame().box, {}));
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const DenseVolume single(diffuse(volume, volume.frame().box, {}));
  single.for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    ASSERT_TRUE(same_voxel(voxel, threaded.at(at))) << at.transpose();
  });
}

TEST(VolumeDiffusion, can_be_cancelled) {
  const RangeVolume volume = scanned(cube_of(26), sphere);
  test::expect_cancels_at_any_step(
      [&](const Progress& progress) { diffuse(volume, volume.frame().box, {}, progress); });
}

TEST(VolumeDiffusion, says_what_memory_it_needs_before_it_takes_it) {
  const RangeVolume volume = sphere_volume(32);
  DiffusionOptions options;
  options.max_memory = 2 * bytes_per_diffusion_block;
  try {
    diffuse(volume, volume.frame().box, options);
    FAIL() << "not refused";
  } catch (const CompletionError& error) {
    EXPECT_NE(std::string(error.what()).find("GB of memory"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("Lower Reach"), std::string::npos) << error.what();
  }
  options.max_memory = 0;
  EXPECT_THROW(diffuse(volume, volume.frame().box, options), CompletionError);
}

TEST(VolumeDiffusion, refuses_options_out_of_range) {
  const RangeVolume volume = random_volume(cube_of(4), 6).volume();
  const auto refused = [&](const VoxelBox& box, int iterations, int reach, double weight) {
    DiffusionOptions options;
    options.iterations = iterations;
    options.reach = reach;
    options.empty_weight = weight;
    EXPECT_THROW(diffuse(volume, box, options), CompletionError);
  };
  const VoxelBox& all = volume.frame().box;
  refused(all, 0, 1, 0);
  refused(all, 1, 0, 0);
  refused(all, 1, 1, -0.1);
  refused(all, 1, 1, 1.1);
  refused(all, 1, 1, std::nan(""));
  refused({{10, 10, 10}, {12, 12, 12}}, 1, 1, 0);
}

}  // namespace
}  // namespace meshcomplete
