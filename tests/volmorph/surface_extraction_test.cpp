#include "filter_volmorph/surface_extraction.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "common/core/error.h"
#include "common/core/mesh_statistics.h"
#include "filter_volmorph/marching_cubes_table.h"
#include "tests/support/cancelling.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

VoxelBox box_of(const VoxelIndex& low, int side) { return {low, low + VoxelIndex::Constant(side - 1)}; }

// Every voxel by itself anything: the worst topology there is. Some distances are exactly 0.
DenseVolume noise(const VoxelBox& box, std::uint32_t seed, const Vector3& origin = Vector3::Zero(),
                  double voxel_size = 1) {
  VolumeFrame frame;
  frame.box = box;
  frame.origin = origin;
  frame.voxel_size = voxel_size;
  frame.ramp = 4 * voxel_size;
  DenseVolume volume(frame);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (Voxel& voxel : volume.voxels) {
    const unsigned kind = random() % 8;
    voxel.state = kind == 0 ? VoxelState::empty : kind == 1 ? VoxelState::unseen : VoxelState::seen;
    voxel.weight = 1;
    voxel.distance = kind == 2 ? 0.f : float(frame.ramp) * unit(random);
    if (kind == 3) voxel.distance *= 1e-6f;
  }
  return volume;
}

// All seen, of a function of the position.
template <class Distance>
RangeVolume seen_volume(const VolumeFrame& frame, Distance&& distance) {
  DenseVolume volume(frame);
  volume.for_each([&](const VoxelIndex& at, const Voxel&) {
    const double d = distance(frame.position(at.cast<double>()));
    Voxel& voxel = volume.at(at);
    voxel.state = std::abs(d) < frame.ramp ? VoxelState::seen
                  : d < 0                  ? VoxelState::unseen
                                           : VoxelState::empty;
    voxel.distance = float(d);
    voxel.weight = 1;
  });
  return volume.volume();
}

double torus_distance(const Vector3& at, double major, double minor) {
  return std::hypot(std::hypot(at.x(), at.y()) - major, at.z()) - minor;
}

bool all_floats(const TriangleMesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const Vector3& at) { return at == at.cast<float>().cast<double>(); });
}

void expect_manifold(const TriangleMesh& mesh, bool intersections) {
  const MeshStatistics found = measure(mesh, intersections);
  EXPECT_TRUE(found.manifold());
  EXPECT_EQ(found.inconsistent_edges, 0u);
  EXPECT_EQ(found.degenerate_faces, 0u);
  EXPECT_EQ(found.duplicate_faces, 0u);
  EXPECT_EQ(found.duplicated_vertices, 0u);
  EXPECT_EQ(found.unreferenced_vertices, 0u);
  EXPECT_EQ(found.self_intersecting_pairs.value_or(0), 0u);
  EXPECT_TRUE(all_floats(mesh));
}

void expect_solid(const TriangleMesh& mesh) {
  expect_manifold(mesh, true);
  const MeshStatistics found = measure(mesh, true);
  EXPECT_TRUE(found.solid());
  EXPECT_EQ(found.boundary_edges, 0u);
}

VolumeFrame frame_of(const VoxelBox& box, double voxel_size, const Vector3& origin) {
  VolumeFrame frame;
  frame.box = box;
  frame.voxel_size = voxel_size;
  frame.origin = origin;
  frame.ramp = 3 * voxel_size;
  return frame;
}

TEST(MarchingCubesTable, covers_every_crossed_edge_once_and_no_face_twice) {
  for (int inside = 0; inside < 256; ++inside) {
    std::set<int> crossed, used;
    for (int edge = 0; edge < 12; ++edge) {
      const CubeEdge& e = cube_edges()[edge];
      if ((inside >> e.low & 1) != (inside >> (e.low | 1 << e.axis) & 1)) crossed.insert(edge);
    }
    std::set<std::pair<int, int>> sides;
    for (const CubeTriangle& triangle : cube_triangles(std::uint8_t(inside)))
      for (int k = 0; k < 3; ++k) {
        used.insert(triangle[k]);
        EXPECT_TRUE(sides.insert({triangle[k], triangle[(k + 1) % 3]}).second) << inside;
      }
    EXPECT_EQ(used, crossed) << inside;
  }
}

TEST(MarchingCubesTable, is_marching_cubes_where_nothing_is_ambiguous) {
  EXPECT_TRUE(cube_triangles(0).empty());
  EXPECT_TRUE(cube_triangles(255).empty());
  for (int corner = 0; corner < 8; ++corner) EXPECT_EQ(cube_triangles(std::uint8_t(1 << corner)).size(), 1u);
  EXPECT_EQ(cube_triangles(0x0f).size(), 2u);
  EXPECT_EQ(cube_triangles(0x69).size(), 4u);  // alternating corners: each by itself
}

// Each case with outside voxels round it, distances at random.
TEST(SurfaceExtraction, is_solid_in_every_case) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> amount(1e-6f, 1);
  for (int inside = 1; inside < 256; ++inside) {
    DenseVolume volume(frame_of(box_of({-1, -1, -1}, 4), 1, Vector3::Zero()));
    volume.for_each([&](const VoxelIndex& at, const Voxel&) {
      const bool corner = (at.array() >= 0).all() && (at.array() <= 1).all();
      const bool negative = corner && (inside >> (at.x() + 2 * at.y() + 4 * at.z()) & 1) != 0;
      volume.at(at) = {VoxelState::seen, amount(random) * (negative ? -1.f : 1.f), 1, {}};
    });
    SCOPED_TRACE(inside);
    expect_solid(extract_surface(volume.volume(), {}));
  }
}

TEST(SurfaceExtraction, of_noise_is_solid) {
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    const RangeVolume volume = noise(box_of({-5, 3, -9}, 21), seed).volume();
    const TriangleMesh mesh = extract_surface(volume, {});
    EXPECT_GT(mesh.triangles.size(), 10000u);
    expect_solid(mesh);
  }
}

TEST(SurfaceExtraction, of_noise_is_solid_far_from_the_origin) {
  const RangeVolume near = noise(box_of({10000, -10000, 20000}, 17), 7).volume();
  expect_solid(extract_surface(near, {}));
  // Floats are 2^-10 apart at 10000: four of them to a voxel, the least that is taken.
  const double step = std::ldexp(1, -10);
  const DenseVolume coarse = noise(box_of({0, 0, 0}, 17), 8, Vector3(10000, -9999.7, 9990.123), 4 * step);
  expect_solid(extract_surface(coarse.volume(), {}));
  const DenseVolume odd = noise(box_of({-8, 0, -4}, 17), 9, Vector3(9000.1, 0.3, -1e-3), 4.7 * step);
  expect_solid(extract_surface(odd.volume(), {}));
}

TEST(SurfaceExtraction, refuses_voxels_that_floats_cannot_tell_apart) {
  const DenseVolume fine = noise(box_of({0, 0, 0}, 5), 8, Vector3(10000, 0, 0), std::ldexp(1, -9));
  EXPECT_THROW(extract_surface(fine.volume(), {}), CompletionError);
  const DenseVolume huge = noise(box_of({0, 0, 0}, 5), 8, Vector3(1e39, 0, 0), 1e36);
  EXPECT_THROW(extract_surface(huge.volume(), {}), CompletionError);
}

TEST(SurfaceExtraction, of_noise_observed_only_is_manifold_with_boundary) {
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    const RangeVolume volume = noise(box_of({-5, 3, -9}, 21), seed).volume();
    ExtractionOptions options;
    options.observed_only = true;
    const TriangleMesh mesh = extract_surface(volume, options);
    EXPECT_GT(mesh.triangles.size(), 2000u);
    expect_manifold(mesh, true);
    EXPECT_GT(measure(mesh, false).boundary_edges, 1000u);
  }
}

TEST(SurfaceExtraction, splits_the_vertex_where_two_observed_cells_meet_in_an_edge_only) {
  // Two cells with the edge from (1, 1, 0) to (1, 1, 1) in common; the surface crosses it.
  DenseVolume volume(frame_of(box_of({0, 0, 0}, 3), 1, Vector3::Zero()));
  volume.for_each([&](const VoxelIndex& at, const Voxel&) {
    const bool seen = at.z() <= 1 && (at.x() - 1) * (at.y() - 1) >= 0;
    volume.at(at) = {seen ? VoxelState::seen : VoxelState::empty, at.z() == 0 ? -0.5f : 0.5f, 1, {}};
  });
  ExtractionOptions options;
  options.observed_only = true;
  const TriangleMesh mesh = extract_surface(volume.volume(), options);
  expect_manifold(mesh, true);
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(measure(mesh, false).components, 2u);
}

TEST(SurfaceExtraction, of_a_sphere_is_within_a_fraction_of_a_voxel) {
  const double h = 0.25, radius = 3;
  const RangeVolume volume = seen_volume(frame_of(box_of({-16, -16, -16}, 33), h, Vector3(0.03, -0.02, 0)),
                                         [&](const Vector3& at) { return at.norm() - radius; });
  const TriangleMesh mesh = extract_surface(volume, {});
  expect_solid(mesh);
  const MeshStatistics found = measure(mesh, false);
  EXPECT_EQ(*found.genus, 0);
  EXPECT_EQ(found.components, 1u);
  EXPECT_NEAR(found.volume, 4. / 3 * M_PI * 27, 0.01 * found.volume);
  // Interpolation along an edge errs by h^2 / 8 over the radius of curvature, and the margin is h / 64.
  for (const Vector3& at : mesh.vertices) EXPECT_NEAR(at.norm(), radius, h * h / radius + h / 64);
}

TEST(SurfaceExtraction, of_a_torus_has_its_genus) {
  const RangeVolume volume = seen_volume(frame_of(box_of({-30, -30, -12}, 61), 0.1, Vector3::Zero()),
                                         [](const Vector3& at) { return torus_distance(at, 2, 0.6); });
  const TriangleMesh mesh = extract_surface(volume, {});
  expect_solid(mesh);
  EXPECT_EQ(*measure(mesh, false).genus, 1);
  for (const Vector3& at : mesh.vertices)
    EXPECT_LT(std::abs(torus_distance(at, 2, 0.6)), 0.1 * 0.1 / 0.6 + 0.1 / 64);
}

TEST(SurfaceExtraction, closes_the_inside_at_the_box) {
  const VoxelBox box = box_of({0, 0, 0}, 16);  // just two blocks along each axis
  for (const int shift : {0, 3}) {
    VolumeFrame frame = frame_of(box, 1, Vector3::Zero());
    frame.box.low += VoxelIndex::Constant(shift);
    frame.box.high += VoxelIndex::Constant(shift);
    const TriangleMesh mesh = extract_surface(VolumeBuilder(frame).finish(), {});  // all unseen
    expect_solid(mesh);
    const MeshStatistics found = measure(mesh, false);
    EXPECT_EQ(*found.genus, 0);
    EXPECT_EQ(found.components, 1u);
    // Half a voxel beyond the outermost ones, cut at edges and corners.
    EXPECT_NEAR(found.volume, 16. * 16 * 16, 12 * 16 * 0.125 + 1);
    for (const Vector3& at : mesh.vertices) {
      EXPECT_GE(at.minCoeff(), shift - 0.5);
      EXPECT_LE(at.maxCoeff(), shift + 15.5);
    }
  }
}

TEST(SurfaceExtraction, finds_the_boundary_between_constant_tiles) {
  VolumeFrame frame = frame_of(box_of({0, 0, 0}, 512), 1, Vector3::Zero());
  VolumeBuilder builder(frame);
  builder.fill(frame.box, VoxelState::empty);
  builder.fill({{128, 128, 128}, {383, 255, 263}}, VoxelState::unseen);
  const RangeVolume volume = builder.finish();
  EXPECT_EQ(volume.grids().state->tree().leafCount(), 0u);
  const TriangleMesh mesh = extract_surface(volume, {});
  const MeshStatistics found = measure(mesh, false);
  EXPECT_TRUE(found.watertight());
  EXPECT_EQ(*found.genus, 0);
  EXPECT_NEAR(found.volume, 256. * 128 * 136, 4 * (256 + 128 + 136) * 0.125 + 1);
}

TEST(SurfaceExtraction, leaves_out_small_components) {
  const RangeVolume volume = seen_volume(
      frame_of(box_of({-12, -12, -12}, 41), 1, Vector3::Zero()),
      [](const Vector3& at) { return std::min(at.norm() - 8, (at - Vector3(20, 20, 20)).norm() - 3); });
  const TriangleMesh both = extract_surface(volume, {});
  EXPECT_EQ(measure(both, false).components, 2u);
  ExtractionOptions options;
  options.smallest_component = 500;
  const TriangleMesh large = extract_surface(volume, options);
  expect_solid(large);
  EXPECT_EQ(measure(large, false).components, 1u);
  EXPECT_GT(large.triangles.size(), 500u);
  for (const Vector3& at : large.vertices) EXPECT_NEAR(at.norm(), 8, 0.2);
  options.smallest_component = 1 << 20;
  EXPECT_TRUE(extract_surface(volume, options).triangles.empty());
}

TEST(SurfaceExtraction, is_the_same_for_any_number_of_threads) {
  const RangeVolume volume = noise(box_of({-20, -3, 5}, 60), 3).volume();
  for (const bool observed_only : {false, true}) {
    const TriangleMesh threaded = extract_surface(volume, {observed_only, 10});
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const TriangleMesh single = extract_surface(volume, {observed_only, 10});
    EXPECT_EQ(threaded.vertices, single.vertices);
    EXPECT_EQ(threaded.triangles, single.triangles);
  }
}

TEST(SurfaceExtraction, can_be_cancelled) {
  const RangeVolume volume = noise(box_of({0, 0, 0}, 60), 3).volume();
  test::expect_cancels_at_any_step([&](const Progress& progress) {
    extract_surface(volume, {false, 10}, progress);
  });
}

TEST(SurfaceExtraction, of_nothing_is_empty) {
  VolumeFrame frame = frame_of(box_of({0, 0, 0}, 20), 1, Vector3::Zero());
  VolumeBuilder builder(frame);
  builder.fill(frame.box, VoxelState::empty);
  const RangeVolume volume = builder.finish();
  EXPECT_TRUE(extract_surface(volume, {}).vertices.empty());
}

}  // namespace
}  // namespace meshcomplete
