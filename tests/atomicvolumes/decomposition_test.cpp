#include "filter_atomicvolumes/decomposition.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <map>
#include <vector>

#include "common/core/error.h"
#include "filter_atomicvolumes/crossed_cube.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::PlacedMesh;

/// A cube as the definitions in decomposition.h have it, by looking at everything.
struct Verdict {
  bool trivial = true;
  Volume volume;
};

Verdict judge(const LatticeMesh& mesh, const LatticeBox& box) {
  Verdict verdict;
  Volume& v = verdict.volume;
  for (Index t = 0; t < mesh.mesh.triangles.size(); ++t)
    if (meets(mesh.triangle(t), box)) v.triangles.push_back(t);
  std::vector<Index> edges, vertices;
  for (Index h : mesh.topology.boundary_half_edges) {
    const Index a = mesh.origin(h), b = mesh.target(h);
    if (meets(mesh.vertex(a), mesh.vertex(b), box)) edges.push_back(h);
    for (Index end : {a, b})
      if (box.contains(mesh.vertex(end)) && std::count(vertices.begin(), vertices.end(), end) == 0)
        vertices.push_back(end);
  }
  if (v.triangles.empty()) return verdict;
  if (edges.empty()) {
    v.kind = VolumeKind::crossed;
    verdict.trivial = sides_agree(mesh, v.triangles, box);
    return verdict;
  }
  if (vertices.size() == 1) {
    v.kind = VolumeKind::vertex;
    v.apex = vertices[0];
    for (Index h : edges) verdict.trivial &= mesh.origin(h) == v.apex || mesh.target(h) == v.apex;
    for (Index t : v.triangles) {
      const Triangle& c = mesh.mesh.triangles[t];
      verdict.trivial &= c[0] == v.apex || c[1] == v.apex || c[2] == v.apex;
    }
    return verdict;
  }
  v.kind = VolumeKind::edge;
  v.apex = edges[0];
  verdict.trivial = vertices.empty() && edges.size() == 1 && v.triangles == std::vector<Index>{edges[0] / 3};
  return verdict;
}

std::map<VolumeKind, int> expect_definitions(const LatticeMesh& mesh, const DecompositionOptions& options,
                                             const Decomposition& d) {
  std::map<VolumeKind, int> kinds;
  EXPECT_EQ(d.volumes.size(), d.octree.size());
  for (Index cube = 0; cube < d.octree.size(); ++cube) {
    const LatticeBox box = d.octree.box(cube);
    const Verdict verdict = judge(mesh, box);
    const bool last = d.octree[cube].depth >= options.max_depth;
    const bool must_split = !last && !verdict.trivial;
    EXPECT_EQ(!d.octree.is_leaf(cube), must_split) << "cubes are split just where they must be";
    if (!d.octree.is_leaf(cube) || must_split) continue;
    const Volume& volume = d.volumes[cube];
    ++kinds[volume.kind];
    EXPECT_EQ(volume.kind, verdict.trivial ? verdict.volume.kind : VolumeKind::unresolved);
    EXPECT_EQ(volume.triangles, verdict.volume.triangles);
    if (volume.kind == VolumeKind::vertex || volume.kind == VolumeKind::edge) {
      EXPECT_EQ(volume.apex, verdict.volume.apex);
    }
  }
  return kinds;
}

TEST(Decomposition, LeavesAreWhatTheDefinitionsSay) {
  std::map<VolumeKind, int> kinds;
  for (const test::NamedMesh& named : test::holed_meshes()) {
    if (named.mesh.triangles.size() > 400) continue;
    SCOPED_TRACE(named.name);
    const PlacedMesh placed(named.mesh, 4);
    const Decomposition d = decompose(placed.lattice_mesh, {});
    for (const auto& [kind, count] : expect_definitions(placed.lattice_mesh, {}, d)) kinds[kind] += count;
  }
  for (VolumeKind kind : {VolumeKind::blank, VolumeKind::vertex, VolumeKind::edge, VolumeKind::crossed})
    EXPECT_GT(kinds[kind], 100);
  EXPECT_EQ(kinds[VolumeKind::unresolved], 0) << "no depth is too great";
}

TEST(Decomposition, AtTheGreatestDepthWhatIsNotTrivialIsUnresolved) {
  const PlacedMesh placed(test::sphere_with_holes(6, 2, 0.4), 4);
  for (int depth : {0, 2, 4, 5}) {
    DecompositionOptions options;
    options.max_depth = depth;
    const Decomposition d = decompose(placed.lattice_mesh, options);
    const auto kinds = expect_definitions(placed.lattice_mesh, options, d);
    EXPECT_TRUE(kinds.count(VolumeKind::unresolved));
  }
}

// Any leaves may be split once more; what comes of them is as trivial as before.
TEST(Decomposition, SplittingFurther) {
  const PlacedMesh placed(test::sphere_with_hole(2, 0.6), 2);
  const LatticeMesh& mesh = placed.lattice_mesh;
  Decomposition d = decompose(mesh, {});
  std::map<VolumeKind, std::vector<Index>> of_kind;
  for (Index cube = 0; cube < d.octree.size(); ++cube)
    if (d.octree.is_leaf(cube)) of_kind[d.volumes[cube].kind].push_back(cube);
  std::vector<Index> leaves;
  for (const auto& [kind, cubes] : of_kind) leaves.insert(leaves.end(), cubes.begin(), cubes.begin() + 5);
  EXPECT_TRUE(split_further(d, mesh, {}, leaves));
  ASSERT_EQ(d.volumes.size(), d.octree.size());
  for (Index leaf : leaves) EXPECT_FALSE(d.octree.is_leaf(leaf));
  for (Index cube = 0; cube < d.octree.size(); ++cube) {
    if (!d.octree.is_leaf(cube)) continue;
    const Verdict verdict = judge(mesh, d.octree.box(cube));
    EXPECT_TRUE(verdict.trivial);
    EXPECT_EQ(d.volumes[cube].kind, verdict.volume.kind);
    EXPECT_EQ(d.volumes[cube].triangles, verdict.volume.triangles);
  }
  DecompositionOptions shallow;
  shallow.max_depth = 1;
  const std::size_t size = d.octree.size();
  EXPECT_FALSE(split_further(d, mesh, shallow, {d.octree.find({1, 1, 1})})) << "too deep already";
  EXPECT_FALSE(split_further(d, mesh, {}, {}));
  EXPECT_EQ(d.octree.size(), size);
}

TEST(Decomposition, BeyondTheBudgetAnErrorTellsWhatToDo) {
  const PlacedMesh placed(test::sphere_with_hole(2, 0.6), 2);
  DecompositionOptions options;
  options.cube_budget = decompose(placed.lattice_mesh, {}).octree.size();
  EXPECT_NO_THROW(decompose(placed.lattice_mesh, options));
  --options.cube_budget;
  try {
    decompose(placed.lattice_mesh, options);
    FAIL();
  } catch (const CompletionError& error) {
    EXPECT_NE(std::string(error.what()).find("NodeBudget"), std::string::npos);
  }
}

TEST(Decomposition, CanBeCancelled) {
  const PlacedMesh placed(test::sphere_with_hole(2, 0.6), 2);
  EXPECT_THROW(decompose(placed.lattice_mesh, {}, Progress([](double, const std::string&) { return false; })),
               Cancelled);
}

TEST(Decomposition, DoesNotDependOnThreads) {
  const PlacedMesh placed(test::sphere_with_holes(6, 2, 0.4), 2);
  const Decomposition many = decompose(placed.lattice_mesh, {});
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Decomposition one = decompose(placed.lattice_mesh, {});
  ASSERT_EQ(many.octree.size(), one.octree.size());
  for (Index cube = 0; cube < one.octree.size(); ++cube) {
    ASSERT_EQ(many.octree[cube].low, one.octree[cube].low);
    ASSERT_EQ(many.volumes[cube].kind, one.volumes[cube].kind);
    ASSERT_EQ(many.volumes[cube].triangles, one.volumes[cube].triangles);
  }
}

// Two sheets that touch in a point of the boundary can never be told apart; the budget ends it.
TEST(Decomposition, TouchingSheetsStopWithinTheBudget) {
  TriangleMesh mesh = test::sphere_with_hole(2, 0.6);
  const Index h = build_topology(mesh).boundary_half_edges[0];
  const Vector3 tip = mesh.vertices[mesh.triangles[h / 3][h % 3]];
  mesh = test::join(mesh, test::translated(test::tetrahedron(0.5), tip));
  const PlacedMesh placed(mesh, 1);
  DecompositionOptions options;
  options.cube_budget = 20000;
  const Decomposition d = decompose(placed.lattice_mesh, options);
  int unresolved = 0, deepest = 0;
  for (Index cube = 0; cube < d.octree.size(); ++cube) {
    unresolved += d.octree.is_leaf(cube) && d.volumes[cube].kind == VolumeKind::unresolved;
    deepest = std::max(deepest, d.octree[cube].depth);
  }
  EXPECT_GE(unresolved, 1);
  EXPECT_EQ(deepest, Lattice::depth);
}

// Beside a sphere with a hole a cube with a smaller one in it, whose right-hand face all but lies on the
// larger one's. Both say that inside is behind them, so no cube may hold the two, and only tiny ones do not.
// Where no rim is near, that does not matter to the patch.
TEST(Decomposition, SheetsOnEachOtherFarFromTheRimsAreNotTakenApart) {
  const TriangleMesh cubes = test::join(test::cube(0.5, Vector3(1.5, 0, 0)),
                                        test::cube(0.25, Vector3(1.75 - 0x1p-19, 0.125, 0.125)));
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const PlacedMesh placed(test::join(test::sphere_with_hole(2, 0.6), cubes), seed);
    DecompositionOptions options;
    options.cube_budget = 40000;
    EXPECT_THROW(decompose(placed.lattice_mesh, options), CompletionError) << "tiny cubes all over the face";
    options.least_contradiction = Octree::side(7);
    const Decomposition d = decompose(placed.lattice_mesh, options);
    int contradicting = 0;
    for (Index cube = 0; cube < d.octree.size(); ++cube) {
      if (!d.octree.is_leaf(cube)) continue;
      const Verdict verdict = judge(placed.lattice_mesh, d.octree.box(cube));
      EXPECT_EQ(d.volumes[cube].kind, verdict.volume.kind);
      EXPECT_EQ(d.volumes[cube].triangles, verdict.volume.triangles);
      if (verdict.trivial) continue;
      ++contradicting;
      EXPECT_EQ(verdict.volume.kind, VolumeKind::crossed) << "cubes at rims are always split";
      EXPECT_EQ(d.octree[cube].depth, 7) << "not before it is small enough";
    }
    EXPECT_GT(contradicting, 30);
  }
}

// A cylinder in the middle of a root that is shifted at random: no plane of the octree runs along its sides.
TEST(Decomposition, ASymmetricCylinderStaysShallow) {
  TriangleMesh mesh = test::translated(test::open_cylinder(24, 4), Vector3(0, 0, -1));
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const PlacedMesh placed(mesh, seed);
    const Decomposition d = decompose(placed.lattice_mesh, {});
    int deepest = 0;
    for (Index cube = 0; cube < d.octree.size(); ++cube) deepest = std::max(deepest, d.octree[cube].depth);
    EXPECT_LT(deepest, 18) << "seed " << seed;
  }
}

}  // namespace
}  // namespace meshcomplete
