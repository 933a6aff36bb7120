#include "filter_volmorph/scan_merge.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tests/support/cancelling.h"
#include "tests/volmorph/scans.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

using namespace test;

constexpr double degree = M_PI / 180;

std::vector<LineOfSight> axis_views(int count, bool perspective) {
  const Vector3 ways[] = {Vector3::UnitZ(),  -Vector3::UnitX(), Vector3(1, 2, 0.5),
                          -Vector3::UnitZ(), Vector3(0, -1, 1), Vector3::UnitX()};
  std::vector<LineOfSight> views;
  for (int i = 0; i < count; ++i) {
    const Vector3 way = ways[i].normalized();
    views.push_back(perspective ? LineOfSight::from(5 * way) : LineOfSight::parallel(3 * way));
  }
  return views;
}

std::vector<RangeScan> scans_of(const Solid& solid, const std::vector<LineOfSight>& views, double spacing,
                                int n) {
  std::vector<RangeScan> scans;
  for (const LineOfSight& view : views) scans.push_back(scan(solid, view, Vector3::Zero(), spacing, n));
  return scans;
}

ScanMergeOptions with_voxels(double size) {
  ScanMergeOptions options;
  options.size.voxel_size = size;
  return options;
}

/// The voxels of a merge against what the formulas say a scanner sees, away from where it is doubtful.
struct Judge {
  Solid solid;
  std::vector<LineOfSight> views;
  double doubt;                     ///< lengths that the triangulation may be wrong by along a line of sight
  double beside;                    ///< how far beside a line of sight it must look the same
  std::size_t sure[3] = {0, 0, 0};  ///< voxels of each state that were sure

  /// Unseen, empty, seen, or nothing where it is doubtful, and the distance.
  std::optional<VoxelState> look(const LineOfSight& view, const Vector3& at, double ramp,
                                 double& distance) const {
    const Sight sight = sight_through(view, at);
    const auto hit = solid(sight);
    const auto clear = [&](double offset_u, double offset_v) {
      const Vector3 right = sight.direction.unitOrthogonal(), up = sight.direction.cross(right);
      const Sight other = sight_through(view, at + offset_u * right + offset_v * up);
      const auto other_hit = solid(other);
      if (other_hit.has_value() != hit.has_value()) return false;
      if (!hit) return true;
      const double angle = std::acos(std::min(1.0, -other_hit->normal.dot(other.direction))) / degree;
      return angle < 70 || angle > 85;
    };
    for (const auto& [u, v] : {std::pair{0, 0}, {0, 1}, {1, 0}, {0, -1}, {-1, 0}})
      if (!clear(u * beside, v * beside)) return {};
    if (!hit || -hit->normal.dot(sight.direction) < std::cos(75 * degree)) return VoxelState::unseen;
    distance = hit->distance - (at - sight.sensor).norm();
    if (std::abs(std::abs(distance) - ramp) < doubt) return {};
    if (distance < -ramp) return VoxelState::unseen;
    return distance > ramp ? VoxelState::empty : VoxelState::seen;
  }

  void check(const RangeVolume& volume) {
    const DenseVolume dense(volume);
    const double ramp = volume.frame().ramp;
    dense.for_each([&](const VoxelIndex& index, const Voxel& voxel) {
      const Vector3 at = volume.frame().position(index.cast<double>());
      VoxelState expected = VoxelState::unseen;
      double low = ramp, high = -ramp;
      for (const LineOfSight& view : views) {
        double distance = 0;
        const auto state = look(view, at, ramp, distance);
        if (!state) return;
        if (*state == VoxelState::seen) {
          low = std::min(low, distance);
          high = std::max(high, distance);
        }
        expected = std::max(expected, *state);  // unseen, empty, seen: the later wins
      }
      ++sure[static_cast<int>(expected)];
      ASSERT_EQ(voxel.state, expected) << at.transpose();
      if (expected != VoxelState::seen) return;
      ASSERT_GT(voxel.distance, low - doubt) << at.transpose();
      ASSERT_LT(voxel.distance, high + doubt) << at.transpose();
    });
  }
};

class Sphere : public testing::TestWithParam<std::pair<int, bool>> {};

TEST_P(Sphere, is_seen_carved_and_left_unseen_as_the_formulas_say) {
  const auto [count, perspective] = GetParam();
  const double spacing = 0.03;
  const Solid solid = sphere(Vector3(0.1, 0, 0), 1);
  const auto views = axis_views(count, perspective);
  const ScanMerge merge = merge_scans(scans_of(solid, views, spacing, 50), with_voxels(0.0625));
  // A chord of a slope of 70 degrees: spacing^2 / (8 cos^3).
  Judge judge{solid, views, 0.003 + spacing * spacing / 8 / std::pow(std::cos(70 * degree), 3), 3 * spacing};
  judge.check(merge.volume);
  for (const std::size_t sure : judge.sure) EXPECT_GT(sure, 1000u);
}

INSTANTIATE_TEST_SUITE_P(Views, Sphere,
                         testing::Values(std::pair{1, false}, std::pair{2, false}, std::pair{6, false},
                                         std::pair{1, true}, std::pair{3, true}, std::pair{6, true}));

TEST(ScanMerge, distance_normal_and_weight_of_a_tilted_plane_are_exact) {
  const Vector3 normal = Vector3(0.5, 0.25, 1).normalized();
  const Solid solid = half_space(Vector3(0.1, 0, 0), normal);
  const LineOfSight view = LineOfSight::parallel(Vector3::UnitZ());
  ScanMergeOptions options = with_voxels(0.125);
  options.boundary_falloff = 0;
  const ScanMerge merge = merge_scans({scan(solid, view, Vector3::Zero(), 0.1, 20)}, options);
  const VolumeFrame& frame = merge.volume.frame();
  std::size_t seen = 0;
  DenseVolume(merge.volume).for_each([&](const VoxelIndex& index, const Voxel& voxel) {
    if (voxel.state != VoxelState::seen) return;
    ++seen;
    const Vector3 at = frame.position(index.cast<double>());
    const double distance = normal.dot(at - Vector3(0.1, 0, 0)) / normal.z();
    ASSERT_NEAR(voxel.distance, distance, 1e-5);
    ASSERT_TRUE(voxel.normal.has_value());
    ASSERT_GT(voxel.normal->cast<double>().dot(normal), std::cos(0.2 * degree));
    const double behind = -distance / frame.ramp;
    ASSERT_NEAR(voxel.weight, normal.z() * std::min(1.0, 2 * (1 - behind)), 1e-4);
  });
  EXPECT_GT(seen, 1000u);
}

TEST(ScanMerge, weights_fall_towards_the_boundary_and_where_the_surface_is_grazing) {
  const Solid flat = half_space(Vector3::Zero(), Vector3::UnitZ());
  const Vector3 slope = Vector3(std::sin(60 * degree), 0, std::cos(60 * degree));
  const LineOfSight view = LineOfSight::parallel(Vector3::UnitZ());
  ScanMergeOptions options = with_voxels(0.125);
  options.boundary_falloff = 1;
  const auto weight = [&](const Solid& solid, const ScanMergeOptions& with, double x) {
    const RangeVolume volume = merge_scans({scan(solid, view, Vector3::Zero(), 0.125, 20)}, with).volume;
    for (double z = -5; z < 5; z += 0.0625) {
      const VoxelIndex at = volume.frame().voxel(Vector3(x, 0, z)).array().round().cast<int>();
      if (!volume.frame().box.contains(at)) continue;
      const Voxel voxel = volume.at(at);
      if (voxel.state == VoxelState::seen && std::abs(voxel.distance) < 0.2) return double(voxel.weight);
    }
    ADD_FAILURE() << "nothing seen at " << x;
    return 0.0;
  };
  EXPECT_NEAR(weight(flat, options, 0), 1, 1e-5);
  EXPECT_NEAR(weight(flat, options, 2), 0.5, 1e-5);  // the boundary is at 2.5
  EXPECT_NEAR(weight(flat, options, 2.25), 0.25, 1e-5);
  EXPECT_NEAR(weight(half_space(Vector3::Zero(), slope), options, 0), 0.5, 1e-4);
  options.grazing_power = 2;
  EXPECT_NEAR(weight(half_space(Vector3::Zero(), slope), options, 0), 0.25, 1e-4);
  options.grazing_power = 0;
  EXPECT_NEAR(weight(half_space(Vector3::Zero(), slope), options, 0), 1, 1e-5);
}

/// The plane z = 0 for x < 0 and the plane z = -2 for x > 0.
Solid step() {
  return both(
      part_of(half_space(Vector3::Zero(), Vector3::UnitZ()), [](const Vector3& p) { return p.x() < 0; }),
      half_space(Vector3(0, 0, -2), Vector3::UnitZ()));
}

TEST(ScanMerge, what_is_across_a_depth_step_is_no_surface) {
  const LineOfSight view = LineOfSight::parallel(Vector3::UnitZ());
  const RangeScan steep = scan(step(), view, Vector3(0.03, 0.01, 0), 0.1, 20);
  const ScanMerge merge = merge_scans({steep}, with_voxels(0.125));
  EXPECT_EQ(merge.scans[0].faces.long_edge, 80u);
  const auto state = [&](double x, double z) {
    return merge.volume.at(merge.volume.frame().voxel(Vector3(x, 0, z)).array().round().cast<int>()).state;
  };
  EXPECT_EQ(state(-0.5, 0.25), VoxelState::seen);
  EXPECT_EQ(state(-0.5, -0.25), VoxelState::seen);
  EXPECT_EQ(state(-0.5, -1), VoxelState::unseen);
  EXPECT_EQ(state(0.5, -1), VoxelState::empty);
  EXPECT_EQ(state(0.5, -2), VoxelState::seen);
  EXPECT_EQ(state(0, -1), VoxelState::unseen);  // the line of sight there meets nothing

  ScanMergeOptions uncut = with_voxels(0.125);
  uncut.depth_steps.longest_edge = 10;
  uncut.depth_steps.grazing_angle = 90;
  const RangeVolume joined = merge_scans({steep}, uncut).volume;
  EXPECT_EQ(joined.at(joined.frame().voxel(Vector3(0, 0, -1)).array().round().cast<int>()).state,
            VoxelState::seen);
}

TEST(ScanMerge, only_the_sheet_nearest_to_the_sensor_is_observed) {
  // Two sheets in one scan, one before the other.
  const LineOfSight view = LineOfSight::parallel(Vector3::UnitZ());
  RangeScan folded = scan(half_space(Vector3::Zero(), Vector3::UnitZ()), view, Vector3::Zero(), 0.1, 10);
  const RangeScan behind =
      scan(half_space(Vector3(0, 0, -3), Vector3::UnitZ()), view, Vector3::Zero(), 0.1, 20);
  const Index first = static_cast<Index>(folded.mesh.vertices.size());
  for (const Vector3& p : behind.mesh.vertices) folded.mesh.vertices.push_back(p);
  for (Triangle t : behind.mesh.triangles) {
    for (Index& v : t) v += first;
    folded.mesh.triangles.push_back(t);
  }
  const RangeVolume volume = merge_scans({folded}, with_voxels(0.125)).volume;
  const auto state = [&](double x, double z) {
    return volume.at(volume.frame().voxel(Vector3(x, 0, z)).array().round().cast<int>()).state;
  };
  EXPECT_EQ(state(0, 0), VoxelState::seen);
  EXPECT_EQ(state(0, -1.5), VoxelState::unseen);
  EXPECT_EQ(state(0, -3), VoxelState::unseen);
  EXPECT_EQ(state(1.5, -3), VoxelState::seen);
  EXPECT_EQ(state(1.5, -1.5), VoxelState::empty);
}

/// Where the distance along z crosses zero at x = y = 0 from below, between two heights.
double crossing_above(const RangeVolume& volume, double from, double to) {
  const double h = volume.frame().voxel_size;
  for (double z = from; z < to; z += h) {
    const VoxelIndex at = volume.frame().voxel(Vector3(0, 0, z)).array().round().cast<int>();
    const Voxel below = volume.at(at), above = volume.at(at + VoxelIndex(0, 0, 1));
    if (below.distance < 0 && above.distance >= 0) {
      return volume.frame().position(at.cast<double>()).z() +
             h * below.distance / (below.distance - above.distance);
    }
  }
  return to;
}

TEST(ScanMerge, a_thin_wall_is_drawn_apart_less_the_sooner_the_weight_falls_behind) {
  const auto wall = [](double thickness, double full_behind) {
    ScanMergeOptions options = with_voxels(0.0625);
    options.full_behind = full_behind;
    const auto side = [&](double z) {
      const Vector3 up = Vector3(0, 0, z > 0 ? 1 : -1);
      return scan(half_space(Vector3(0, 0, z), up), LineOfSight::parallel(up), Vector3::Zero(), 0.1, 10);
    };
    const RangeVolume volume = merge_scans({side(thickness / 2), side(-thickness / 2)}, options).volume;
    return crossing_above(volume, 0, 1) - thickness / 2;
  };
  const double ramp = 0.25;
  EXPECT_NEAR(wall(2 * ramp, 0.5), 0, 1e-5);
  EXPECT_NEAR(wall(ramp, 0.5), 0, 1e-5);  // the far side's weight has just fallen to 0 at the surface
  EXPECT_GT(wall(0.5 * ramp, 0.5), 0.1 * ramp);
  EXPECT_LT(wall(0.5 * ramp, 0), 0.6 * wall(0.5 * ramp, 0.75));
}

TEST(ScanMerge, a_viewpoint_amid_a_cavity_sees_all_round) {
  const Vector3 eye(0.2, 0.1, -0.1);
  const Solid solid = cavity(Vector3::Zero(), 1);
  const ScanMerge merge = merge_scans({scan_all_around(solid, eye, 100)}, with_voxels(0.0625));
  DenseVolume(merge.volume).for_each([&](const VoxelIndex& index, const Voxel& voxel) {
    const Vector3 at = merge.volume.frame().position(index.cast<double>());
    const Vector3 way = (at - eye).normalized();
    if (std::abs(way.z()) > std::cos(6 * degree)) return;  // round the poles nothing was measured
    const double distance = solid({eye, way})->distance - (at - eye).norm();
    if (std::abs(std::abs(distance) - 0.25) < 0.01) return;
    ASSERT_EQ(voxel.state, distance < -0.25  ? VoxelState::unseen
                           : distance > 0.25 ? VoxelState::empty
                                             : VoxelState::seen)
        << at.transpose();
    if (voxel.state == VoxelState::seen) {
      ASSERT_NEAR(voxel.distance, distance, 0.003);
    }
  });
  EXPECT_GT(merge.counts.empty, 1000u);
}

TEST(ScanMerge, without_carving_nothing_is_empty) {
  const auto scans = scans_of(sphere(Vector3::Zero(), 1), axis_views(3, false), 0.05, 30);
  ScanMergeOptions options = with_voxels(0.125);
  const ScanMerge carved = merge_scans(scans, options);
  options.carving = false;
  const ScanMerge kept = merge_scans(scans, options);
  EXPECT_EQ(kept.counts.empty, 0u);
  EXPECT_EQ(kept.counts.seen, carved.counts.seen);
  EXPECT_GT(carved.counts.empty, 0u);
}

void expect_same(const RangeVolume& a, const RangeVolume& b) {
  const DenseVolume first(a), second(b);
  ASSERT_EQ(first.voxels.size(), second.voxels.size());
  for (std::size_t i = 0; i < first.voxels.size(); ++i)
    ASSERT_TRUE(same_voxel(first.voxels[i], second.voxels[i])) << i;
}

TEST(ScanMerge, is_the_same_in_every_bit_whatever_the_number_of_threads) {
  const auto scans = scans_of(sphere(Vector3::Zero(), 1), axis_views(6, true), 0.04, 40);
  const RangeVolume many = merge_scans(scans, with_voxels(0.05)).volume;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  expect_same(many, merge_scans(scans, with_voxels(0.05)).volume);
}

TEST(ScanMerge, another_order_of_scans_only_rounds_differently) {
  auto scans = scans_of(sphere(Vector3::Zero(), 1), axis_views(6, false), 0.05, 30);
  const DenseVolume first(merge_scans(scans, with_voxels(0.1)).volume);
  std::reverse(scans.begin(), scans.end());
  const DenseVolume second(merge_scans(scans, with_voxels(0.1)).volume);
  for (std::size_t i = 0; i < first.voxels.size(); ++i) {
    ASSERT_EQ(first.voxels[i].state, second.voxels[i].state);
    if (first.voxels[i].state != VoxelState::seen) continue;
    ASSERT_NEAR(first.voxels[i].distance, second.voxels[i].distance, 1e-6);
    ASSERT_NEAR(first.voxels[i].weight, second.voxels[i].weight, 1e-6);
  }
}

TEST(ScanMerge, moving_by_whole_voxels_moves_the_volume) {
  auto scans = scans_of(sphere(Vector3::Zero(), 1), axis_views(3, false), 0.05, 30);
  for (RangeScan& scan : scans)  // few bits, so that moving rounds nothing
    for (Vector3& p : scan.mesh.vertices) p = (p * 4096).array().round() / 4096;
  const double h = 0.125;
  const RangeVolume here = merge_scans(scans, with_voxels(h)).volume;
  const Vector3 way = h * Vector3(3, -50, 1);
  for (RangeScan& scan : scans)
    for (Vector3& p : scan.mesh.vertices) p += way;
  const RangeVolume there = merge_scans(scans, with_voxels(h)).volume;
  EXPECT_EQ(there.frame().origin, here.frame().origin + way);
  expect_same(here, there);
}

TEST(ScanMerge, stops_at_any_step_when_cancelled) {
  const auto scans = scans_of(sphere(Vector3::Zero(), 1), axis_views(4, false), 0.05, 30);
  expect_cancels_at_any_step(
      [&](const Progress& progress) { merge_scans(scans, with_voxels(0.02), progress); });
}

TEST(ScanMerge, finds_the_scans_own_axis_from_its_depth_steps) {
  const LineOfSight view = LineOfSight::parallel(Vector3(1, 2, 3));
  const Solid solid =
      both(sphere(Vector3::Zero(), 1), half_space(Vector3(-3, 0, -2), Vector3(1, 0, 1).normalized()));
  RangeScan with_steps = scan(solid, view, Vector3::Zero(), 0.05, 40);
  with_steps.line_of_sight = LineOfSight::own_axis();
  ScanMergeOptions options = with_voxels(0.125);
  const ScanMerge merge = merge_scans({with_steps}, options);
  EXPECT_GT(merge.scans[0].line_of_sight.vector.dot(view.vector.normalized()), std::cos(5 * degree));
  RangeScan flat = scan(half_space(Vector3::Zero(), Vector3(0, 0.6, 0.8)), view, Vector3::Zero(), 0.05, 40);
  flat.line_of_sight = LineOfSight::own_axis();
  EXPECT_GT(merge_scans({flat}, options).scans[0].line_of_sight.vector.dot(Vector3(0, 0.6, 0.8)), 1 - 1e-9);
}

TEST(ScanMerge, takes_the_memory_it_said_and_four_times_as_much_for_half_the_voxels) {
  const auto scans = scans_of(sphere(Vector3::Zero(), 1), axis_views(6, false), 0.02, 60);
  const double coarse = static_cast<double>(merge_scans(scans, with_voxels(0.04)).volume.memory());
  const double fine = static_cast<double>(merge_scans(scans, with_voxels(0.02)).volume.memory());
  EXPECT_LT(fine, 5 * coarse);
  ScanMergeOptions options = with_voxels(0.02);
  options.size.max_memory = fine / 2.5;
  EXPECT_THROW(merge_scans(scans, options), CompletionError);
  options.size.max_memory = 3 * fine;
  EXPECT_NO_THROW(merge_scans(scans, options));
}

/// What a merge says when it fails.
std::string message(const std::vector<RangeScan>& scans, const ScanMergeOptions& options) {
  try {
    merge_scans(scans, options);
  } catch (const CompletionError& error) {
    return error.what();
  }
  return "it did not fail";
}

TEST(ScanMerge, says_what_is_wrong_with_the_parameters) {
  const auto scans = scans_of(sphere(Vector3::Zero(), 1), axis_views(1, false), 0.05, 30);
  const auto fails = [&](auto&& change, const std::string& part) {
    ScanMergeOptions options = with_voxels(0.1);
    change(options);
    EXPECT_NE(message(scans, options).find(part), std::string::npos) << message(scans, options);
  };
  for (const double size : {0.0, -1.0, std::nan(""), HUGE_VAL})
    fails([&](auto& options) { options.size.voxel_size = size; }, "voxel size");
  fails([](auto& options) { options.size.ramp = 0.05; }, "at least as long as a voxel");
  fails([](auto& options) { options.size.ramp = std::nan(""); }, "ramp");
  fails([](auto& options) { options.size.margin = -1; }, "margin");
  fails([](auto& options) { options.size.max_memory = 0; }, "memory limit");
  fails([](auto& options) { options.depth_steps.longest_edge = 0; }, "longest edge");
  fails([](auto& options) { options.depth_steps.grazing_angle = 91; }, "grazing angle");
  fails([](auto& options) { options.grazing_power = -1; }, "power");
  fails([](auto& options) { options.boundary_falloff = -1; }, "boundary");
  fails([](auto& options) { options.full_behind = 1; }, "behind");
  fails([](auto& options) { options.depth_steps.longest_edge = 1e-6; }, "Raise the longest edge");
  fails([](auto& options) { options.depth_steps.grazing_angle = 1e-3; }, "Raise the grazing angle");
}

TEST(ScanMerge, an_absurd_voxel_size_is_refused_with_what_it_needs_and_one_that_fits) {
  const auto scans = scans_of(sphere(Vector3::Zero(), 1), axis_views(2, false), 0.05, 30);
  for (const double size : {1e-4, 1e-9, 1e-300}) {
    const std::string text = message(scans, with_voxels(size));
    const char* const needed =
        size < 1e-6 ? "; at most 1048576 are possible" : "GB of memory; 4 GB are allowed";
    EXPECT_NE(text.find(needed), std::string::npos) << text;
    const std::size_t at = text.rfind("Voxels of ");
    ASSERT_NE(at, std::string::npos);
    const double fitting = std::stod(text.substr(at + 10));
    EXPECT_GT(fitting, 4e-4);
    EXPECT_LT(fitting, 2e-3);
  }
  ScanMergeOptions options = with_voxels(1e-3);
  options.size.max_memory = 5e7;
  const std::string text = message(scans, options);
  options.size.voxel_size = std::stod(text.substr(text.rfind("Voxels of ") + 10));
  EXPECT_NO_THROW(merge_scans(scans, options));
}

TEST(ScanMerge, names_the_scan_that_is_wrong) {
  auto scans = scans_of(sphere(Vector3::Zero(), 1), axis_views(3, false), 0.05, 30);
  const ScanMergeOptions options = with_voxels(0.1);
  EXPECT_EQ(message({}, options), "There are no scans to merge.");
  const auto fails = [&](auto&& change, const std::string& part) {
    auto changed = scans;
    changed[1].name = "back.ply";
    change(changed[1]);
    const std::string text = message(changed, options);
    EXPECT_NE(text.find("back.ply"), std::string::npos) << text;
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  fails([](RangeScan& scan) { scan.mesh.triangles.clear(); }, "no faces");
  fails([](RangeScan& scan) { scan.line_of_sight.vector *= -1; }, "reversed");
  fails([](RangeScan& scan) { scan.line_of_sight.vector.setZero(); }, "no direction");
  fails([](RangeScan& scan) { scan.line_of_sight = LineOfSight::from(Vector3(0, std::nan(""), 0)); },
        "not a number");
  fails([](RangeScan& scan) { scan.line_of_sight = LineOfSight::from(Vector3(-1.1, 0, 0)); },
        "nearer to it than the ramp");
  fails(
      [](RangeScan& scan) {
        const auto other = scan.mesh.triangles;
        for (const Triangle& t : other) scan.mesh.triangles.push_back({t[0], t[2], t[1]});
        scan.line_of_sight = LineOfSight::own_axis();
      },
      "cannot be estimated");
  fails(
      [](RangeScan& scan) {
        for (Triangle& t : scan.mesh.triangles) t[1] = t[0];
      },
      "none of them has an area");
}

}  // namespace
}  // namespace meshcomplete
