#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "common/core/error.h"
#include "common/core/mesh_statistics.h"
#include "filter_atomicvolumes/offending_faces.h"
#include "filter_atomicvolumes/volume_solution.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

constexpr int depth = 9;

/// A sphere with holes, one rim edge of the first `pinches` holes drawn together to a hundredth of a per
/// cent: the octree goes deep there and nowhere else.
TriangleMesh pinched_sphere(int holes, int pinches) {
  TriangleMesh mesh = test::sphere_with_holes(holes, 3, 0.35);
  const MeshTopology topology = build_topology(mesh);
  const std::vector<BoundaryLoop> loops = trace_boundary_loops(mesh, topology);
  for (int i = 0; i < pinches; ++i) {
    const std::vector<Index>& rim = loops.at(static_cast<std::size_t>(i)).vertices;
    const Vector3 near = mesh.vertices[rim[0]] + 1e-4 * (mesh.vertices[rim[1]] - mesh.vertices[rim[0]]);
    for (int k = 0; k < 3; ++k) mesh.vertices[rim[1]][k] = static_cast<float>(near[k]);
  }
  return mesh;
}

AtomicVolumesOptions options_with_limit() {
  AtomicVolumesOptions options;
  options.max_depth = depth;
  return options;
}

/// The unresolved cubes of the division that a completion of `mesh` with this seed makes.
std::size_t unresolved_cubes(const TriangleMesh& mesh, std::uint64_t seed) {
  const MeshTopology topology = build_topology(mesh);
  const InputNeighbourhood neighbourhood(mesh);
  const PreparedConstraints none(mesh, topology, neighbourhood, {});
  const VolumeSolution solution =
      solve_volumes(mesh, topology, neighbourhood, options_with_limit(), none, seed);
  std::size_t count = 0;
  for (Index cube = 0; cube < solution.decomposition.octree.size(); ++cube)
    count += solution.decomposition.octree.is_leaf(cube) &&
             solution.decomposition.volumes[cube].kind == VolumeKind::unresolved;
  return count;
}

TriangleMesh completed(const TriangleMesh& mesh, const Patch& patch) {
  TriangleMesh whole = mesh;
  whole.vertices.insert(whole.vertices.end(), patch.vertices.begin(), patch.vertices.end());
  whole.triangles.insert(whole.triangles.end(), patch.triangles.begin(), patch.triangles.end());
  return whole;
}

TEST(FaceRemoval, ComesToAnEndWithoutUnresolvedCubes) {
  const TriangleMesh mesh = pinched_sphere(3, 3);
  const AtomicVolumesOptions options = options_with_limit();
  EXPECT_GT(unresolved_cubes(mesh, 1), 0u);
  const FaceRemoval removal = remove_offending_faces(mesh, {}, options);
  EXPECT_GT(removal.rounds, 0);
  EXPECT_GT(removal.faces.size(), 0u);
  EXPECT_LT(removal.faces.size(), 60u);
  EXPECT_EQ(unresolved_cubes(removal.mesh, removal.seed), 0u);
}

TEST(FaceRemoval, ListsExactlyTheFacesThatAreGone) {
  const TriangleMesh mesh = pinched_sphere(2, 2);
  const FaceRemoval removal = remove_offending_faces(mesh, {}, options_with_limit());
  EXPECT_TRUE(std::is_sorted(removal.faces.begin(), removal.faces.end()));
  EXPECT_TRUE(std::adjacent_find(removal.faces.begin(), removal.faces.end()) == removal.faces.end());
  std::vector<Triangle> rest;
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    if (!std::binary_search(removal.faces.begin(), removal.faces.end(), t)) rest.push_back(mesh.triangles[t]);
  EXPECT_EQ(removal.mesh.triangles, rest);
  EXPECT_EQ(removal.mesh.vertices, mesh.vertices);
}

TEST(FaceRemoval, TheCompletionOfTheRestIsClean) {
  const TriangleMesh mesh = pinched_sphere(3, 2);
  const ReducedCompletion reduced = fill_without_offending_faces(mesh, {}, options_with_limit());
  EXPECT_EQ(reduced.result.completion.report.count(HoleOutcome::closed), 3u);
  EXPECT_GT(reduced.removed.size(), 0u);
  TriangleMesh rest = mesh;
  for (auto t = reduced.removed.rbegin(); t != reduced.removed.rend(); ++t)
    rest.triangles.erase(rest.triangles.begin() + *t);
  EXPECT_TRUE(measure(completed(rest, reduced.result.completion.patch), true).solid());
}

// Whatever the holes are like, what comes out has no defect that the input has not.
TEST(FaceRemoval, HolesOfAllKinds) {
  std::size_t removed = 0, done = 0;
  for (const auto& [name, mesh] : test::holed_meshes()) {
    AtomicVolumesOptions options;
    options.max_depth = 8;
    options.shifts = 2;
    ReducedCompletion reduced;
    try {
      reduced = fill_without_offending_faces(mesh, {}, options);
    } catch (const CompletionError& error) {
      EXPECT_EQ(error.stage(), "removing faces") << name << ": " << error.what();
      continue;
    }
    ++done;
    removed += reduced.removed.size();
    TriangleMesh rest = mesh;
    for (auto t = reduced.removed.rbegin(); t != reduced.removed.rend(); ++t)
      rest.triangles.erase(rest.triangles.begin() + *t);
    const MeshStatistics before = measure(mesh, true),
                         after = measure(completed(rest, reduced.result.completion.patch), true);
    EXPECT_EQ(reduced.result.completion.report.count(HoleOutcome::failed), 0u) << name;
    EXPECT_EQ(after.boundary_edges > 0, reduced.result.completion.report.count(HoleOutcome::skipped) > 0)
        << name;
    EXPECT_LE(after.self_intersecting_pairs, before.self_intersecting_pairs) << name;
    EXPECT_EQ(after.inconsistent_edges, 0u) << name;
    EXPECT_LE(after.non_manifold_edges, before.non_manifold_edges) << name;
  }
  EXPECT_GT(done, 8u);
  EXPECT_GT(removed, 0u);
}

// Two rim vertices at one place, not joined by any face: no cube can hold just one of them.
TEST(FaceRemoval, OpensWhatTouchesWithoutBeingJoined) {
  TriangleMesh mesh = test::sphere_with_touching_holes();
  std::vector<Index> visits(mesh.vertices.size(), 0);
  const MeshTopology topology = build_topology(mesh);
  for (Index h : topology.boundary_half_edges) ++visits[mesh.triangles[h / 3][h % 3]];
  const auto pinch = static_cast<Index>(std::find(visits.begin(), visits.end(), 2) - visits.begin());
  ASSERT_LT(pinch, mesh.vertices.size());
  // One of the two fans gets a vertex of its own.
  const auto first = std::find_if(topology.boundary_half_edges.begin(), topology.boundary_half_edges.end(),
                                  [&](Index h) { return mesh.triangles[h / 3][h % 3] == pinch; });
  const auto beginning_at_pinch = [&](Index t) {
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
      if (mesh.triangles[t][h % 3] == pinch) return h;
    return MeshTopology::boundary;
  };
  const Index copy = static_cast<Index>(mesh.vertices.size());
  std::vector<Index> fan;  // half-edges that begin at the pinch
  for (Index h = *first; h != MeshTopology::boundary;) {
    fan.push_back(h);
    const Index across = topology.opposite[3 * (h / 3) + (h % 3 + 2) % 3];
    h = across == MeshTopology::boundary ? across : beginning_at_pinch(across / 3);
  }
  for (Index h : fan) mesh.triangles[h / 3][h % 3] = copy;
  mesh.vertices.push_back(mesh.vertices[pinch]);

  AtomicVolumesOptions options;
  options.max_depth = 16;
  const ReducedCompletion reduced = fill_without_offending_faces(mesh, {}, options);
  EXPECT_GT(reduced.removed.size(), 0u);
  EXPECT_LT(reduced.removed.size(), 20u);
  EXPECT_EQ(reduced.result.completion.report.count(HoleOutcome::closed),
            reduced.result.completion.report.holes.size());
  TriangleMesh rest = mesh;
  for (auto t = reduced.removed.rbegin(); t != reduced.removed.rend(); ++t)
    rest.triangles.erase(rest.triangles.begin() + *t);
  EXPECT_TRUE(measure(completed(rest, reduced.result.completion.patch), true).solid());
}

// Only what is to be closed loses faces; a hole that was asked for stays so when the selected faces go.
TEST(FaceRemoval, LeavesOtherHolesAlone) {
  const TriangleMesh mesh = pinched_sphere(3, 3);
  const std::vector<BoundaryLoop> loops = trace_boundary_loops(mesh, build_topology(mesh));
  AtomicVolumesOptions options = options_with_limit();
  options.holes.selected_only = true;
  MeshSelection selection;
  selection.faces.assign(mesh.triangles.size(), 0);
  selection.faces[loops[1].faces[0]] = 1;
  const ReducedCompletion reduced = fill_without_offending_faces(mesh, selection, options);
  EXPECT_EQ(reduced.result.completion.report.count(HoleOutcome::closed), 1u);
  EXPECT_EQ(reduced.result.completion.report.count(HoleOutcome::skipped), 2u);
  EXPECT_GT(reduced.removed.size(), 0u);
  for (std::size_t i : {0u, 2u})
    for (Index t : loops[i].faces)
      EXPECT_FALSE(std::binary_search(reduced.removed.begin(), reduced.removed.end(), t));
}

TEST(FaceRemoval, RemovesNothingWhereAllIsSimple) {
  const TriangleMesh mesh = pinched_sphere(2, 0);
  AtomicVolumesOptions options = options_with_limit();
  options.max_depth = 20;
  const ReducedCompletion reduced = fill_without_offending_faces(mesh, {}, options);
  EXPECT_TRUE(reduced.removed.empty());
  options.shifts = 1;
  EXPECT_EQ(reduced.result.completion.patch.triangles,
            fill_by_atomic_volumes(mesh, {}, options).completion.patch.triangles);
}

TEST(FaceRemoval, SaysWhenTheLimitIsTooSmall) {
  const TriangleMesh mesh = test::sphere_with_hole(3, 0.6);
  AtomicVolumesOptions options;
  EXPECT_THROW(remove_offending_faces(mesh, {}, options), CompletionError) << "no limit";
  options.max_depth = 3;
  try {
    remove_offending_faces(mesh, {}, options);
    FAIL() << "cubes of this size cannot be simple";
  } catch (const CompletionError& error) {
    EXPECT_NE(std::string(error.what()).find("MaxDepth is too small"), std::string::npos);
  }
}

}  // namespace
}  // namespace meshcomplete
