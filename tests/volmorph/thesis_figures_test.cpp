// What the figures of Firestone 2008 show, made in code: tunnels, noise and pinholes (4.1), an occluded strip
// and a sharp edge (4.2), a partly seen tunnel (4.4), and double buffering (3.2, 3.3).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/core/mesh_statistics.h"
#include "filter_volmorph/operator_sequence.h"
#include "filter_volmorph/published_fans.h"
#include "filter_volmorph/surface_extraction.h"
#include "filter_volmorph/triangle_fan.h"
#include "tests/support/patches.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

using Genus = std::optional<long long>;

// Empty everywhere. Voxel size 1, ramp 4.
DenseVolume empty_volume(const VoxelIndex& size) {
  VolumeFrame frame;
  frame.box = {VoxelIndex::Zero(), size - VoxelIndex::Ones()};
  DenseVolume volume(frame);
  for (Voxel& voxel : volume.voxels) voxel = {VoxelState::empty, 4, 0, {}};
  return volume;
}

void fill(DenseVolume& volume, const VoxelBox& box, VoxelState state) {
  volume.for_each([&](const VoxelIndex& at, const Voxel&) {
    if (box.contains(at)) volume.at(at) = {state, state == VoxelState::unseen ? -4.f : 4.f, 0, {}};
  });
}

RangeVolume treated(const RangeVolume& volume, const std::string& operators) {
  return apply_sequence(volume, parse_operators(operators), volume.frame().box, {}, Progress()).volume;
}

MeshStatistics surface_of(const RangeVolume& volume, bool observed_only = false) {
  return measure(extract_surface(volume, {observed_only, 0}), false);
}

// --- figures 3.2 and 3.3

std::string row_of(const RangeVolume& volume) {
  std::string row;
  DenseVolume(volume).for_each([&](const VoxelIndex&, const Voxel& voxel) {
    row += voxel.state == VoxelState::unseen ? 'u' : voxel.state == VoxelState::empty ? '.' : 's';
  });
  return row;
}

TEST(ThesisFigures, one_step_moves_a_boundary_by_one_voxel) {
  DenseVolume row = empty_volume({6, 1, 1});
  fill(row, {{0, 0, 0}, {2, 0, 0}}, VoxelState::unseen);
  const RangeVolume volume = row.volume();
  ASSERT_EQ(row_of(volume), "uuu...");
  EXPECT_EQ(row_of(treated(volume, "d")), "uuuu..");
  EXPECT_EQ(row_of(treated(volume, "d2")), "uuuuu.");
  EXPECT_EQ(row_of(treated(volume, "e")), "uu....");
  EXPECT_EQ(row_of(treated(volume, "e2")), "u.....");
  EXPECT_EQ(row_of(treated(volume, "d2 e2")), "uuu...");
}

// --- figure 4.1

constexpr int block_low = 10, block_high = 33;  // along each axis

DenseVolume block() {
  DenseVolume volume = empty_volume(VoxelIndex::Constant(44));
  fill(volume, {VoxelIndex::Constant(block_low), VoxelIndex::Constant(block_high)}, VoxelState::unseen);
  return volume;
}

TEST(ThesisFigures, tunnels_and_pinholes_close_and_stay_closed) {
  DenseVolume volume = block();
  fill(volume, {{0, 20, 20}, {43, 21, 21}}, VoxelState::empty);   // a tunnel of two by two voxels
  fill(volume, {{15, 0, 27}, {15, 43, 27}}, VoxelState::empty);   // a pinhole right through
  fill(volume, {{28, 14, 0}, {28, 14, 20}}, VoxelState::empty);   // and one that ends inside
  fill(volume, {{14, 14, 14}, {15, 15, 15}}, VoxelState::empty);  // a bubble
  const MeshStatistics before = surface_of(volume.volume());
  EXPECT_EQ(before.genus, Genus(2));
  EXPECT_EQ(before.components, 2u);
  const RangeVolume after = treated(volume.volume(), "d2 e2");
  const MeshStatistics found = surface_of(after);
  EXPECT_EQ(found.genus, Genus(0));
  EXPECT_EQ(found.components, 1u);
  // The block is as it was, but for dents of one voxel at the mouths: four voxels and four of the tunnel, one
  // and one of the pinhole, and one.
  EXPECT_EQ(after.counts().unseen + 11, block().volume().counts().unseen);
  EXPECT_LT(found.faces, before.faces);
}

TEST(ThesisFigures, a_wide_tunnel_stays_open) {
  DenseVolume volume = block();
  fill(volume, {{0, 18, 18}, {43, 25, 25}}, VoxelState::empty);  // eight voxels wide
  const RangeVolume given = volume.volume();
  ASSERT_EQ(surface_of(given).genus, Genus(1));
  EXPECT_EQ(surface_of(treated(given, "d3 e3")).genus, Genus(1));
  EXPECT_EQ(surface_of(treated(given, "d4 e4")).genus, Genus(0));
}

TEST(ThesisFigures, floating_noise_is_eroded) {
  DenseVolume volume = block();
  for (const VoxelIndex& speck : {VoxelIndex(3, 3, 3), {4, 20, 40}, {40, 38, 5}})
    fill(volume, {speck, speck + VoxelIndex(1, 0, 0)}, VoxelState::unseen);
  const RangeVolume given = volume.volume();
  ASSERT_EQ(surface_of(given).components, 4u);
  EXPECT_EQ(surface_of(treated(given, "d2 e2")).components, 4u) << "far from everything: only erosion helps";
  EXPECT_EQ(surface_of(treated(given, "e1 d1")).components, 1u);
  EXPECT_EQ(surface_of(treated(given, "d2 e2 e1 d1")).components, 1u);
}

// Figure 3.5: the noise and the main part grow together.
TEST(ThesisFigures, noise_near_the_main_part_grows_together_with_it) {
  DenseVolume volume = block();
  for (int y = 14; y < 30; y += 4)
    for (int x = 14; x < 30; x += 4) fill(volume, {{x, y, 36}, {x, y, 36}}, VoxelState::unseen);
  const RangeVolume given = volume.volume();
  ASSERT_EQ(surface_of(given).components, 17u);
  const MeshStatistics found = surface_of(treated(given, "d2 e2"));
  EXPECT_EQ(found.components, 1u);
  EXPECT_EQ(found.genus, Genus(0));
}

// Sequences in the wrong order for a tunnel: erosion first widens it.
TEST(ThesisFigures, erosion_first_keeps_tunnels) {
  DenseVolume volume = block();
  fill(volume, {{0, 20, 20}, {43, 21, 21}}, VoxelState::empty);
  EXPECT_EQ(surface_of(treated(volume.volume(), "e1 d1")).genus, Genus(1));
}

// --- figure 4.4

constexpr double tunnel_radius = 6;

// A block with a round tunnel along x; what is within three voxels of its wall and of the block's sides is
// seen where `wall_seen` says so of the wall, and everywhere of the sides.
DenseVolume armpit(const std::function<bool(const VoxelIndex&)>& wall_seen) {
  DenseVolume volume = empty_volume({48, 44, 44});
  volume.for_each([&](const VoxelIndex& at, const Voxel&) {
    const Vector3 p = at.cast<double>() - Vector3(23.5, 21.5, 21.5);
    const double wall = tunnel_radius - std::hypot(p.y(), p.z());
    const double side = (p.cwiseAbs() - Vector3(16, 15, 15)).maxCoeff();
    const double distance = std::max(wall, side);
    const bool near_wall = wall > side;
    const VoxelState far = distance < 0 ? VoxelState::unseen : VoxelState::empty;
    volume.at(at) = {far, distance < 0 ? -4.f : 4.f, 0, {}};
    if (std::abs(distance) > 3 || (near_wall && !wall_seen(at))) return;
    Vector3 normal = Vector3(0, -p.y(), -p.z()).normalized();
    if (!near_wall) {
      int axis = 0;
      (p.cwiseAbs() - Vector3(16, 15, 15)).maxCoeff(&axis);
      normal = Vector3::Unit(axis) * (p[axis] < 0 ? -1 : 1);
    }
    volume.at(at) = {VoxelState::seen, float(distance), 1, normal.cast<float>()};
  });
  return volume;
}

// The wall is seen from both ends, and unseen all round in the middle.
RangeVolume armpit_with_a_gap(int width) {
  return armpit([=](const VoxelIndex& at) { return std::abs(at.x() - 23.5) > width / 2.0; }).volume();
}

TriangleMesh with_fans(const RangeVolume& volume, bool as_published) {
  TriangleMesh mesh = extract_surface(volume, {true, 0});
  if (!as_published) {
    const Completion fans = close_by_fans(mesh, MeshSelection(), {});
    return test::with_patch(mesh, fans.patch);
  }
  const PublishedFans fans = close_as_published(mesh, MeshSelection(), {});
  for (auto f = fans.removed.rbegin(); f != fans.removed.rend(); ++f)
    mesh.triangles.erase(mesh.triangles.begin() + *f);
  mesh = test::with_patch(mesh, fans.completion.patch);
  apply_splits(mesh, fans.splits);
  return mesh;
}

// What is left of it stays open as long as 2 k dilations do not meet in the middle.
TEST(ThesisFigures, a_partly_seen_tunnel_stays_open_with_vrips_filler) {
  for (const int gap : {4, 10}) {
    const RangeVolume volume = armpit_with_a_gap(gap);
    for (const char* operators : {"d1 e1", "d2 e2", "d3 e3", "d2 e2 x1"}) {
      SCOPED_TRACE(std::to_string(gap) + ", " + operators);
      const MeshStatistics found = surface_of(treated(volume, operators));
      EXPECT_EQ(found.genus, Genus(1));
      EXPECT_EQ(found.components, 1u);
      EXPECT_TRUE(found.watertight());
    }
  }
}

// The condition: the dilations do not meet in the middle, or the erosions open what they have closed, since
// the unseen part is shorter than the tunnel is wide.
TEST(ThesisFigures, many_dilations_close_a_tunnel_whose_unseen_part_is_long) {
  EXPECT_EQ(surface_of(treated(armpit_with_a_gap(16), "d2 e2")).genus, Genus(1));
  EXPECT_EQ(surface_of(treated(armpit_with_a_gap(16), "d8 e8")).genus, Genus(0));
  EXPECT_EQ(surface_of(treated(armpit_with_a_gap(10), "d8 e8")).genus, Genus(1));
  // Where all of it is seen nothing can be closed.
  EXPECT_EQ(surface_of(treated(armpit_with_a_gap(0), "d8 e8")).genus, Genus(1));
}

// Figure 2.1b: two rims across the tunnel, each of them a hole for the fan. No erosion or dilation changes
// that, since they leave alone what is observed.
TEST(ThesisFigures, fans_close_a_tunnel_whose_wall_is_unseen_all_round) {
  const RangeVolume volume = armpit_with_a_gap(6);
  for (const char* operators : {"e1 d1", "d2 e2"}) {
    const RangeVolume after = treated(volume, operators);
    ASSERT_EQ(surface_of(after, true).boundary_loops.size(), 2u);
    for (const bool as_published : {false, true}) {
      const MeshStatistics found = measure(with_fans(after, as_published), true);
      EXPECT_TRUE(found.watertight());
      EXPECT_EQ(found.genus, Genus(0));
      EXPECT_EQ(found.self_intersecting_pairs, std::optional<std::size_t>(0));
    }
  }
}

// The expansion goes on with the wall from both sides, until there is no rim left.
TEST(ThesisFigures, expansion_keeps_the_tunnel_open_for_the_fan) {
  const RangeVolume after = treated(armpit_with_a_gap(6), "x3");
  for (const bool as_published : {false, true}) {
    const MeshStatistics found = measure(with_fans(after, as_published), false);
    EXPECT_TRUE(found.watertight());
    EXPECT_EQ(found.genus, Genus(1));
  }
}

// One strip of the wall is seen from end to end: the rest is one hole in the wall, and no rim goes round.
TEST(ThesisFigures, fans_keep_a_tunnel_open_that_is_seen_along_a_strip) {
  const RangeVolume volume =
      armpit([](const VoxelIndex& at) { return std::abs(at.x() - 23.5) > 5 || at.z() < 25; }).volume();
  ASSERT_EQ(surface_of(volume, true).boundary_loops.size(), 1u);
  for (const char* operators : {"e1 d1", "d2 e2"}) {
    for (const bool as_published : {false, true}) {
      const MeshStatistics found = measure(with_fans(treated(volume, operators), as_published), true);
      EXPECT_TRUE(found.watertight());
      EXPECT_EQ(found.genus, Genus(1));
      EXPECT_EQ(found.self_intersecting_pairs, std::optional<std::size_t>(0));
    }
    EXPECT_EQ(surface_of(treated(volume, operators)).genus, Genus(1));
  }
}

// --- figure 4.2

constexpr int plane = 16;  // z of the flat surface

// Unseen below a plane, empty above it, seen near it but for a strip of `width` voxels across, that nobody
// saw: unseen from top to bottom.
DenseVolume plane_with_strip(int width) {
  DenseVolume volume = empty_volume({40, 20, 32});
  volume.for_each([&](const VoxelIndex& at, const Voxel&) {
    const float distance = float(at.z() - plane) - 0.25f;
    const bool occluded = at.x() >= 16 && at.x() < 16 + width;
    const bool seen = std::abs(distance) < 4 && !occluded;
    const bool unseen = distance < 0 || occluded;
    volume.at(at) = {unseen ? VoxelState::unseen : VoxelState::empty, unseen ? -4.f : 4.f, 0, {}};
    if (seen) volume.at(at) = {VoxelState::seen, distance, 1, Eigen::Vector3f::UnitZ()};
  });
  return volume;
}

TEST(ThesisFigures, expansion_closes_a_flat_strip_after_half_its_width) {
  for (const int width : {2, 4, 6, 7, 10}) {
    SCOPED_TRACE(width);
    const RangeVolume volume = plane_with_strip(width).volume();
    const int needed = (width + 1) / 2;
    ASSERT_EQ(surface_of(volume, true).components, 2u);
    if (needed > 1) {
      EXPECT_EQ(surface_of(treated(volume, "x" + std::to_string(needed - 1)), true).components, 2u);
    }
    const RangeVolume after = treated(volume, "x" + std::to_string(needed));
    EXPECT_EQ(surface_of(after, true).components, 1u);
    // Exactly flat: what is new has the distances of the plane.
    for (const Vector3& vertex : extract_surface(after, {true, 0}).vertices)
      EXPECT_EQ(vertex.z(), plane + 0.25);
  }
}

// The top of a block, seen to its edge, and nothing of the side below: the surface goes on straight, a voxel
// for each application, and does not bend.
TEST(ThesisFigures, expansion_goes_straight_on_over_a_sharp_edge) {
  constexpr int edge = 20;
  DenseVolume volume = empty_volume({40, 20, 32});
  volume.for_each([&](const VoxelIndex& at, const Voxel&) {
    const float distance = float(at.z() - plane) - 0.25f;
    if (at.x() >= edge) return;
    if (distance < 0) volume.at(at) = {VoxelState::unseen, -4, 0, {}};
    if (std::abs(distance) < 4) volume.at(at) = {VoxelState::seen, distance, 1, Eigen::Vector3f::UnitZ()};
  });
  for (int times = 1; times <= 4; ++times) {
    const RangeVolume after = treated(volume.volume(), "x" + std::to_string(times));
    double furthest = 0;
    for (const Vector3& vertex : extract_surface(after, {true, 0}).vertices) {
      EXPECT_EQ(vertex.z(), plane + 0.25);
      furthest = std::max(furthest, vertex.x());
    }
    EXPECT_EQ(furthest, edge - 1 + times);
    // A lip as thick as the ramp hangs over the edge; it makes no handle.
    const MeshStatistics closed = surface_of(after);
    EXPECT_EQ(closed.genus, Genus(0));
    EXPECT_EQ(closed.components, 1u);
    EXPECT_EQ(after.at({edge + times - 1, 10, plane - 3}).state, VoxelState::seen);
    EXPECT_EQ(after.at({edge + times, 10, plane}).state, VoxelState::empty);
  }
}

// Both faces of an edge are seen, the edge itself is not: each face goes on straight until they meet.
TEST(ThesisFigures, expansion_of_two_faces_meets_at_their_edge) {
  constexpr int edge = 20, gap = 5;
  DenseVolume volume = empty_volume({40, 20, 32});
  volume.for_each([&](const VoxelIndex& at, const Voxel&) {
    const float up = float(at.z() - plane) - 0.25f, across = float(at.x() - edge) - 0.25f;
    const float distance = std::max(up, across);
    const bool near_edge = at.x() > edge - gap && at.z() > plane - gap;
    if (distance < 0 || near_edge) volume.at(at) = {VoxelState::unseen, -4, 0, {}};
    if (near_edge || std::abs(distance) >= 4) return;
    volume.at(at) = {VoxelState::seen, distance, 1,
                     up > across ? Eigen::Vector3f(Eigen::Vector3f::UnitZ()) : Eigen::Vector3f::UnitX()};
  });
  const auto observed = [&](int times) {
    return extract_surface(treated(volume.volume(), "x" + std::to_string(times)), {true, 0});
  };
  EXPECT_EQ(measure(observed(gap), false).components, 2u);
  for (const int times : {gap + 1, gap + 3}) {  // the way to the edge, and one voxel for what lies between
    const TriangleMesh mesh = observed(times);
    const MeshStatistics found = measure(mesh, false);
    EXPECT_EQ(found.components, 1u);
    EXPECT_EQ(found.boundary_loops.size(), 1u);
    EXPECT_EQ(found.genus, Genus(0));
    // Neither face goes beyond the other.
    Vector3 furthest = Vector3::Zero();
    for (const Vector3& vertex : mesh.vertices) furthest = furthest.cwiseMax(vertex);
    EXPECT_EQ(furthest.x(), edge + 0.25);
    EXPECT_EQ(furthest.z(), plane + 0.25);
  }
}

}  // namespace
}  // namespace meshcomplete
