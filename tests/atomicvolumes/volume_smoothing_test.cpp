#include "filter_atomicvolumes/volume_smoothing.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/core/patch.h"
#include "common/core/triangle_intersection.h"
#include "filter_atomicvolumes/rigid_cubes.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;
using test::Division;
using test::NamedMesh;
using test::PlacedMesh;

/// A mesh completed by the cut alone.
struct Cut {
  PlacedMesh placed;
  Division division;
  Labelling labelling;
  LabelledSurface surface;

  Cut(TriangleMesh mesh, std::uint64_t seed, const DecompositionOptions& options = {})
      : placed(std::move(mesh), seed) {
    std::optional<Division> found = test::divide(placed, options);
    if (!found) return;
    division = std::move(*found);
    labelling = cut_complex(placed.lattice_mesh, division.complex, CutWeight::area, {});
    surface = extracted(labelling);
  }
  LabelledSurface extracted(const Labelling& labels) const {
    return extract(placed.lattice_mesh, division.decomposition.octree, division.complex, labels);
  }
  VolumeSmoothingFigures smooth(LabelledSurface& patch, const VolumeSmoothingOptions& options,
                                const Progress& progress = Progress()) const {
    return smooth_constrained(placed.lattice_mesh, division.decomposition, division.complex, patch, options,
                              progress);
  }
  LabelledSurface smoothed(const VolumeSmoothingOptions& options) const {
    LabelledSurface patch = surface;
    smooth(patch, options);
    return patch;
  }
  LabelledSurface in_two_passes(const VolumeSmoothingOptions& options) const {
    const std::vector<NodeTie> ties =
        suggest_by_springs(placed.lattice_mesh, division.decomposition, division.complex, surface, options);
    LabelledSurface patch =
        extracted(cut_complex(placed.lattice_mesh, division.complex, CutWeight::area, ties));
    smooth(patch, options);
    return patch;
  }
};

/// As it is stored when nothing is smoothed.
LabelledSurface rounded(LabelledSurface surface) {
  for (VolumeVertex& v : surface.vertices)
    if (is_octree_point(v)) v.position = as_stored(v.position);
  return surface;
}

std::vector<Corners> corners_of(const LabelledSurface& surface) {
  std::vector<Corners> all;
  for (const auto& [a, b, c] : surface.triangles)
    all.push_back({surface.vertices[a].position, surface.vertices[b].position, surface.vertices[c].position});
  return all;
}

/// What meets of a patch: pairs of its triangles, and triangles with those of the mesh (numbered after the
/// patch's) unless they rest on a side of it.
std::set<std::pair<Index, Index>> contacts(const Cut& cut, const LabelledSurface& surface) {
  const std::vector<Corners> all = corners_of(surface);
  std::set<std::pair<Index, Index>> found;
  for (const auto& pair : improper_pairs(all)) found.insert(pair);
  for (Index t = 0; t < all.size(); ++t)
    for (Index other : input_triangles_met(cut.placed.neighbourhood, all[t])) {
      bool rests = false;
      for (Index v : surface.triangles[t]) {
        const Index edge = surface.vertices[v].rim_edge;
        rests |= edge != VolumeVertex::none && edge / 3 == other;
      }
      if (!rests) found.emplace(t, static_cast<Index>(all.size()) + other);
    }
  return found;
}

/// Whether a triangle reaches into a divided cube by more than what rounding to floats moves it. `reach` is
/// that in steps of the lattice, even.
bool reaches_into_divided_cube(const Cut& cut, const LabelledSurface& surface, std::int64_t reach) {
  const Octree& octree = cut.division.decomposition.octree;
  for (const Corners& c : corners_of(surface)) {
    LatticeTriangle triangle;
    for (int k = 0; k < 3; ++k) triangle[k] = cut.placed.lattice_mesh.lattice.snap(c[k]);
    for (Index cube = 0; cube < octree.size(); ++cube) {
      if (!octree.is_leaf(cube) || cut.division.decomposition.volumes[cube].kind != VolumeKind::crossed)
        continue;
      LatticeBox box = octree.box(cube);
      for (int k = 0; k < 3; ++k) {
        box.low[k] += reach;
        box.high[k] -= reach;
      }
      if (box.low[0] < box.high[0] && meets(triangle, box)) return true;
    }
  }
  return false;
}

TriangleMesh completed(const Cut& cut, const LabelledSurface& surface) {
  TriangleMesh mesh = cut.placed.mesh;
  const Index first = static_cast<Index>(mesh.vertices.size());
  for (const VolumeVertex& v : surface.vertices) mesh.vertices.push_back(v.position);
  for (const auto& [a, b, c] : surface.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  return mesh;
}

/// The centres of some volumes, evenly chosen, those at the patch all.
std::vector<VolumePoint> centres(const Cut& cut, const LabelledSurface& surface, std::size_t step) {
  std::set<Cell> at_patch;
  for (const auto& [inside, outside] : surface.volumes) at_patch.insert({inside, outside});
  const VolumeComplex& complex = cut.division.complex;
  std::vector<VolumePoint> found;
  const auto wanted = [&](Cell node) {
    return at_patch.count(node) != 0 || static_cast<std::size_t>(node) % step == 0;
  };
  const Octree& octree = cut.division.decomposition.octree;
  for (Index cube = 0; cube < octree.size(); ++cube)
    if (const Cell node = complex.cube_cells[cube]; node >= 0 && wanted(node))
      found.push_back({node, cut.placed.lattice_mesh.lattice.position(octree.centre(cube))});
  for (std::size_t i = 0; i < complex.free_tetrahedra.size(); ++i) {
    const Cell node = static_cast<Cell>(complex.blank_nodes + i);
    if (!wanted(node)) continue;
    Vector3 sum = complex.vertices[complex.free_tetrahedra[i].apex].position;
    for (Index v : complex.free_tetrahedra[i].base) sum += complex.vertices[v].position;
    found.push_back({node, 0.25 * sum});
  }
  return found;
}

/// How many of the points are not on the side that their volume is on.
std::size_t on_wrong_side(const Cut& cut, const LabelledSurface& surface,
                          const std::vector<VolumePoint>& points) {
  const TriangleMesh solid = completed(cut, surface);
  return static_cast<std::size_t>(std::count_if(points.begin(), points.end(), [&](const VolumePoint& p) {
    const double winding = test::winding_number(solid, p.position);
    return std::abs(winding - (cut.labelling.is_inside(p.node) ? 1 : 0)) > 1e-6;
  }));
}

std::vector<NamedMesh> closed_by_cut() {
  std::vector<NamedMesh> meshes = test::holed_meshes();
  meshes.erase(
      std::remove_if(meshes.begin(), meshes.end(), [](const NamedMesh& m) { return m.name == "sheet"; }),
      meshes.end());
  return meshes;
}

/// Torus and spheres without what lies near random points.
TriangleMesh randomly_holed(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  TriangleMesh mesh = seed % 2 ? test::torus(20, 10) : test::icosphere(3);
  for (int i = 0; i < 3; ++i) {
    const Index at = static_cast<Index>(test::uniform(random) * static_cast<double>(mesh.vertices.size()));
    const Vector3 centre = mesh.vertices[at];
    mesh = test::without_ball(mesh, centre, 0.2 + 0.3 * test::uniform(random));
  }
  return mesh;
}

void expect_sound(const Cut& cut, const VolumeSmoothingOptions& options, bool solid) {
  LabelledSurface patch = cut.surface;
  const VolumeSmoothingFigures figures = cut.smooth(patch, options);
  EXPECT_GT(figures.moved, figures.movable / 4);

  EXPECT_EQ(patch.triangles, cut.surface.triangles);
  ASSERT_EQ(patch.vertices.size(), cut.surface.vertices.size());
  for (std::size_t i = 0; i < patch.volumes.size(); ++i) {
    EXPECT_EQ(patch.volumes[i].inside, cut.surface.volumes[i].inside);
    EXPECT_EQ(patch.volumes[i].outside, cut.surface.volumes[i].outside);
  }
  for (std::size_t v = 0; v < patch.vertices.size(); ++v) {
    const VolumeVertex &now = patch.vertices[v], &before = cut.surface.vertices[v];
    EXPECT_TRUE(now.key == before.key);
    if (now.key.kind == VertexKey::lattice_point)
      EXPECT_EQ(now.position, as_stored(now.position));
    else
      EXPECT_EQ(now.position, before.position) << "the rim moved";
  }

  const auto before = contacts(cut, rounded(cut.surface)), after = contacts(cut, patch);
  EXPECT_TRUE(std::includes(before.begin(), before.end(), after.begin(), after.end()));
  EXPECT_FALSE(reaches_into_divided_cube(cut, patch, 1 << 17));
  if (!options.moving_centres && solid) {
    const std::vector<VolumePoint> points = centres(cut, patch, 50);
    EXPECT_EQ(on_wrong_side(cut, cut.surface, points), 0u);
    EXPECT_EQ(on_wrong_side(cut, patch, points), 0u);
  }
}

TEST(VolumeSmoothing, KeepsLabelsRimsAndCubesAndMeetsNothing) {
  for (const NamedMesh& one : closed_by_cut())
    for (bool moving : {false, true}) {
      SCOPED_TRACE(one.name + (moving ? ", moving centres" : ""));
      const Cut cut(one.mesh, 3);
      if (cut.surface.triangles.empty()) continue;
      VolumeSmoothingOptions options;
      options.moving_centres = moving;
      expect_sound(cut, options, true);
    }
}

TEST(VolumeSmoothing, KeepsThemWithRandomHolesAndRoots) {
  int done = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Cut cut(randomly_holed(seed), seed);
    if (cut.surface.triangles.empty()) continue;
    ++done;
    VolumeSmoothingOptions options;
    options.iterations = seed % 3 == 0 ? 3 : 15;
    options.moving_centres = seed % 4 < 2;
    expect_sound(cut, options, true);
  }
  EXPECT_GE(done, 10);
}

TEST(VolumeSmoothing, KeepsAnOpenSheet) {
  const Cut cut(test::rough_sheet(6, 5, 0.3, 1, 2), 1);
  ASSERT_FALSE(cut.surface.triangles.empty());
  expect_sound(cut, {}, false);
}

// Floats are so coarse there that rounding makes triangles meet.
TEST(VolumeSmoothing, MeetsNothingFarFromTheOrigin) {
  std::size_t put_back = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const Cut cut(test::translated(test::sphere_with_hole(3, 0.5), Vector3(20000, -10000, 5000)), seed);
    if (cut.surface.triangles.empty()) continue;
    LabelledSurface patch = cut.surface;
    VolumeSmoothingOptions options;
    options.moving_centres = true;
    put_back += cut.smooth(patch, options).put_back;
    const auto before = contacts(cut, rounded(cut.surface)), after = contacts(cut, patch);
    EXPECT_TRUE(std::includes(before.begin(), before.end(), after.begin(), after.end()));
  }
  EXPECT_GT(put_back, 0u);
}

// Convex cells in cubes of the greatest depth are not warped.
TEST(VolumeSmoothing, LeavesConvexCellsAlone) {
  DecompositionOptions shallow;
  shallow.max_depth = 4;
  const Cut cut(test::sphere_with_hole(3, 0.9), 2, shallow);
  ASSERT_FALSE(cut.surface.triangles.empty());
  ASSERT_FALSE(cut.division.complex.convex_cells.empty());
  LabelledSurface patch = cut.surface;
  const VolumeSmoothingFigures figures = cut.smooth(patch, {});
  EXPECT_GT(figures.moved, 0u);
  const auto before = contacts(cut, rounded(cut.surface)), after = contacts(cut, patch);
  EXPECT_TRUE(std::includes(before.begin(), before.end(), after.begin(), after.end()));
  const Octree& octree = cut.division.decomposition.octree;
  std::size_t still = 0;
  for (std::size_t v = 0; v < patch.vertices.size(); ++v) {
    const VolumeVertex& one = cut.surface.vertices[v];
    const LatticePoint p = {static_cast<std::int64_t>(one.key.a), static_cast<std::int64_t>(one.key.b),
                            static_cast<std::int64_t>(one.key.c)};
    bool at_cells = false;
    for (const VolumeComplex::ConvexCell& cell : cut.division.complex.convex_cells)
      at_cells |= is_octree_point(one) && octree.box(cell.cube).contains(p);
    if (!at_cells) continue;
    ++still;
    EXPECT_EQ(patch.vertices[v].position, as_stored(one.position));
  }
  EXPECT_GT(still, 0u);
  std::vector<VolumePoint> inner;
  for (const VolumeComplex::ConvexCell& cell : cut.division.complex.convex_cells)
    if (cell.cell >= 0) inner.push_back({cell.cell, cell.centre});
  EXPECT_GT(inner.size(), 0u);
  EXPECT_EQ(on_wrong_side(cut, cut.surface, inner), 0u);
  EXPECT_EQ(on_wrong_side(cut, patch, inner), 0u);
}

TEST(VolumeSmoothing, KeepsTheUsersPointsInTheirVolumes) {
  std::size_t lost_without = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const Cut cut(test::sphere_with_hole(2, 0.8), seed);
    if (cut.surface.triangles.empty()) continue;
    // In every volume at the patch, close to a corner of one of its faces there.
    std::vector<VolumePoint> points = centres(cut, cut.surface, 1000000);
    for (VolumePoint& p : points)
      for (std::size_t t = 0; t < cut.surface.triangles.size(); ++t)
        if (cut.surface.volumes[t].inside == p.node || cut.surface.volumes[t].outside == p.node) {
          const Vector3& corner = cut.surface.vertices[cut.surface.triangles[t][0]].position;
          p.position = corner + 0.1 * (p.position - corner);
          break;
        }
    ASSERT_EQ(on_wrong_side(cut, cut.surface, points), 0u);
    VolumeSmoothingOptions options;
    lost_without += on_wrong_side(cut, cut.smoothed(options), points);
    options.points = points;
    EXPECT_EQ(on_wrong_side(cut, cut.smoothed(options), points), 0u);
    options.moving_centres = true;
    EXPECT_EQ(on_wrong_side(cut, cut.smoothed(options), points), 0u);
  }
  EXPECT_GT(lost_without, 10u);
}

TEST(VolumeWarp, HoldsWhereVerticesAreMovedAndPutBack) {
  std::mt19937_64 random(5);
  std::size_t moved = 0, more = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Cut cut(test::sphere_with_hole(2, 0.8), seed);
    if (cut.surface.triangles.empty()) continue;
    VolumeWarp warp(cut.placed.lattice_mesh, cut.division.decomposition, cut.division.complex, cut.surface,
                    {});
    const Index count = static_cast<Index>(cut.surface.vertices.size());
    for (int round = 0; round < 3; ++round) {
      for (Index v = 0; v < count; ++v) {
        const Vector3 step(test::uniform(random) - 0.5, test::uniform(random) - 0.5,
                           test::uniform(random) - 0.5);
        if (warp.may_move(v)) warp.try_to_place(v, warp.position(v) + 0.1 * step);
      }
      warp.follow_centroids();
    }
    std::vector<Index> some;
    for (Index v = 0; v < count; ++v) {
      moved += warp.moved(v);
      if (warp.moved(v)) {
        EXPECT_TRUE(warp.holds_at(v));
      }
      if (warp.moved(v) && test::uniform(random) < 0.2) some.push_back(v);
    }
    const std::vector<Index> back = warp.put_back(some);
    EXPECT_TRUE(std::includes(back.begin(), back.end(), some.begin(), some.end()));
    more += back.size() - some.size();
    for (Index v : back) EXPECT_EQ(warp.position(v), warp.start(v));
    for (Index v = 0; v < count; ++v)
      if (warp.moved(v)) {
        EXPECT_TRUE(warp.holds_at(v));
      }
  }
  EXPECT_GT(moved, 100u);
  EXPECT_GT(more, 0u);
}

TEST(VolumeSmoothing, MakesPatchesSmoother) {
  double before = 0, constrained = 0, two_pass = 0, moving = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Cut cut(test::sphere_with_hole(3, 0.9), seed);
    if (cut.surface.triangles.empty()) continue;
    VolumeSmoothingOptions options;
    before += mean_normal_jump(cut.surface);
    constrained += mean_normal_jump(cut.smoothed(options));
    two_pass += mean_normal_jump(cut.in_two_passes(options));
    options.moving_centres = true;
    moving += mean_normal_jump(cut.smoothed(options));
  }
  EXPECT_LT(constrained, before);
  EXPECT_LT(two_pass, constrained);
  EXPECT_LT(moving, 0.8 * constrained);
}

TEST(VolumeSmoothing, SuggestsTheSideOfTheSmoothedSurface) {
  const Cut cut(test::sphere_with_hole(3, 0.9), 1);
  ASSERT_FALSE(cut.surface.triangles.empty());
  VolumeSmoothingOptions options;
  const auto& [mesh, division] = std::tie(cut.placed.lattice_mesh, cut.division);
  std::vector<NodeTie> ties =
      suggest_by_springs(mesh, division.decomposition, division.complex, cut.surface, options);
  ASSERT_FALSE(ties.empty());
  // Smoothed without end, the surface is nearly the plane of the rim.
  options.iterations = 2000;
  ties = suggest_by_springs(mesh, division.decomposition, division.complex, cut.surface, options);
  double top = -1;
  for (Index h : cut.placed.topology.boundary_half_edges)
    top = std::max(top, cut.placed.mesh.vertices[cut.placed.lattice_mesh.origin(h)].z());
  std::size_t sure = 0;
  const Octree& octree = division.decomposition.octree;
  for (Index cube = 0; cube < octree.size(); ++cube)
    for (const NodeTie& tie : ties)
      if (tie.node == division.complex.cube_cells[cube]) {
        const double side = mesh.lattice.step() * static_cast<double>(Octree::side(octree[cube].depth));
        EXPECT_NEAR(tie.price, options.suggestion * side * side, 1e-5 * side * side);
        const double height = mesh.lattice.position(octree.centre(cube)).z() - top;
        if (std::abs(height) < 0.1) continue;
        ++sure;
        EXPECT_EQ(tie.inside, height < 0);
      }
  EXPECT_GT(sure, 3u);
}

// The cut needs prices in what it counts, whatever the size of the mesh.
TEST(VolumeSmoothing, SuggestionsCostFacesWhereTheCutCountsFaces) {
  for (const auto& [weight, scale] :
       {std::pair(CutWeight::unit, 1.0), std::pair(CutWeight::unit, 1e-3),
        std::pair(CutWeight::balanced, 1.0), std::pair(CutWeight::balanced, 1e-3)}) {
    const Cut cut(test::scaled(test::sphere_with_hole(3, 0.9), scale), 1);
    ASSERT_FALSE(cut.surface.triangles.empty());
    const VolumeComplex& complex = cut.division.complex;
    const FaceMeasure faces = measure_faces(cut.placed.lattice_mesh, complex, weight);
    VolumeSmoothingOptions options;
    options.cost = weight;
    const std::vector<NodeTie> ties = suggest_by_springs(cut.placed.lattice_mesh, cut.division.decomposition,
                                                         complex, cut.surface, options);
    ASSERT_FALSE(ties.empty());
    for (const NodeTie& tie : ties)
      EXPECT_DOUBLE_EQ(tie.price, options.suggestion * faces.of_node[static_cast<std::size_t>(tie.node)] / 6);
  }
}

TEST(VolumeSmoothing, ChangesNothingWithoutIterations) {
  const Cut cut(test::sphere_with_hole(2, 0.6), 1);
  ASSERT_FALSE(cut.surface.triangles.empty());
  VolumeSmoothingOptions options;
  options.iterations = 0;
  LabelledSurface patch = cut.surface;
  const VolumeSmoothingFigures figures = cut.smooth(patch, options);
  EXPECT_EQ(figures.moved, 0u);
  for (std::size_t v = 0; v < patch.vertices.size(); ++v)
    EXPECT_EQ(patch.vertices[v].position, cut.surface.vertices[v].position);
}

TEST(VolumeSmoothing, CanBeCancelled) {
  const Cut cut(test::sphere_with_hole(2, 0.6), 1);
  ASSERT_FALSE(cut.surface.triangles.empty());
  LabelledSurface patch = cut.surface;
  const Progress stop([](double, const std::string&) { return false; });
  EXPECT_THROW(cut.smooth(patch, {}, stop), Cancelled);
  EXPECT_THROW(suggest_by_springs(cut.placed.lattice_mesh, cut.division.decomposition, cut.division.complex,
                                  cut.surface, {}, stop),
               Cancelled);
}

TEST(VolumeSmoothing, DoesNotDependOnThreads) {
  const Cut cut(test::torus_with_missing_parts(), 2);
  ASSERT_FALSE(cut.surface.triangles.empty());
  std::vector<LabelledSurface> results;
  for (std::size_t threads : {1, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(cut.smoothed({}));
  }
  for (std::size_t v = 0; v < results[0].vertices.size(); ++v)
    EXPECT_EQ(results[0].vertices[v].position, results[1].vertices[v].position);
}

TEST(VolumeSmoothing, MeasuresNormalJumps) {
  LabelledSurface roof;
  for (const Vector3& p : {Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)})
    roof.vertices.push_back({VertexKey::vertex(static_cast<Index>(roof.vertices.size())), p});
  EXPECT_EQ(mean_normal_jump(roof), 0);
  roof.triangles = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_NEAR(mean_normal_jump(roof), 90, 1e-9);
  roof.triangles.push_back({0, 2, 3});  // edges of length 1 to both, at right angles
  EXPECT_NEAR(mean_normal_jump(roof), 90, 1e-9);
  roof.vertices[3].position = Vector3(0, -1, 0);
  roof.triangles.pop_back();
  EXPECT_NEAR(mean_normal_jump(roof), 0, 1e-9);
}

TEST(RigidCubes, TellWhatEntersAndWhatTouches) {
  const Vector3 low(0, 0, 0), high(1, 1, 1);
  const auto in = [&](const Vector3& a, const Vector3& b, const Vector3& c) {
    return enters({a, b, c}, low, high);
  };
  EXPECT_TRUE(in({0.4, 0.4, 0.4}, {0.5, 0.4, 0.4}, {0.4, 0.5, 0.4}));          // inside
  EXPECT_TRUE(in({-5, 0.5, 0.5}, {5, 0.5, 0.6}, {5, 0.6, 0.5}));               // through two faces
  EXPECT_TRUE(in({-10, -10, 0.5}, {10, -10, 0.5}, {0, 20, 0.5}));              // all across
  EXPECT_FALSE(in({0, 0, 1}, {1, 0, 1}, {0, 1, 1}));                           // on a face
  EXPECT_FALSE(in({0, 0, 1}, {1, 0, 1}, {0.5, -1, 7}));                        // at an edge, tilted
  EXPECT_FALSE(in({0, 0, 1}, {1, 0, 1}, {0.5, -1, 1}));                        // at an edge, level
  EXPECT_TRUE(in({0, 0, 1}, {1, 0, 1}, {0.5, 1, 0.999999999}));                // under the face
  EXPECT_FALSE(in({0, 0, 1}, {1, 0, 1}, {0.5, 1, 1.000000001}));               // over it
  EXPECT_FALSE(in({1, 1, 1}, {2, 1, 0.5}, {1, 2, 0.5}));                       // at a corner
  EXPECT_TRUE(in({1.4, 0.5, 0.5}, {0.5, 1.4, 0.5}, {2, 2, 0.5}));              // cuts the edge's corner
  EXPECT_FALSE(in({1.6, 0.5, 0.5}, {0.5, 1.6, 0.5}, {2, 2, 0.5}));             // passes it
  EXPECT_FALSE(in({1.5, 0.5, 0.5}, {0.5, 1.5, 0.5}, {2, 2, 0.5}));             // touches it
  EXPECT_FALSE(enters({low, high, Vector3(1, 0, 0)}, low, Vector3(1, 1, 0)));  // nothing to enter
  EXPECT_FALSE(in({-1, 0.5, 0}, {2, 0.5, 0}, {0.5, 0.5, -3}));                 // its side lies on a face
}

}  // namespace
}  // namespace meshcomplete
