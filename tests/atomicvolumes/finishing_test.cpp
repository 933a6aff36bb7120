#include "common/core/finishing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "common/core/mesh_topology.h"
#include "common/core/triangle_intersection.h"
#include "filter_atomicvolumes/atomic_volumes.h"
#include "tests/support/lid.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

/// The lid of a box is finished under a flat roof.
class Finishing : public test::BoxWithLid {
 protected:
  FinishedPatch finish_under_roof(double height, const FinishingOptions& options) {
    const Vector3 a(-2, -2, height), b(10, -2, height), c(10, 10, height), d(-2, 10, height);
    const std::vector<std::array<Vector3, 3>> roof = {{a, b, c}, {a, c, d}};
    const Rim rim = collect_rim(mesh_, build_topology(mesh_), loops_);
    const auto find = [&](const PatchMesh& now) {
      std::vector<std::array<Vector3, 3>> triangles;
      for (const Triangle& t : now.triangles())
        triangles.push_back({now.position(t[0]), now.position(t[1]), now.position(t[2])});
      PatchFault fault;
      for (const auto& pair : improper_pairs_between(triangles, roof)) fault.triangles.push_back(pair.first);
      fault.triangles.erase(std::unique(fault.triangles.begin(), fault.triangles.end()),
                            fault.triangles.end());
      if (!fault.triangles.empty()) fault.defect = "meets the roof";
      return fault;
    };
    return finish(patch_, options, {rim, input_, roof, find});
  }

  static double highest(const PatchMesh& patch) {
    double most = 0;
    for (const Vector3& p : patch.positions()) most = std::max(most, p.z());
    return most;
  }
};

TEST_F(Finishing, TheEnergyThatWasAskedForIsTakenWhereThereIsRoom) {
  const FinishedPatch finished = finish_under_roof(6, {});
  EXPECT_EQ(finished.defect, "");
  EXPECT_EQ(finished.route, "normal variation");
  EXPECT_GT(highest(finished.mesh), 1) << "it goes on with the walls";
}

// Steps that stop at the roof would leave a dome with a flat top.
TEST_F(Finishing, AMembraneIsTakenWhereTheEnergyThatWasAskedForMeetsSomething) {
  const FinishedPatch finished = finish_under_roof(0.4, {});
  EXPECT_EQ(finished.defect, "");
  EXPECT_EQ(finished.route, "membrane instead of normal variation");
  EXPECT_LT(highest(finished.mesh), 1e-3);
}

// The patch passes one vertex of the mesh twice and is so coarse that both places are joined to one vertex.
TEST(FinishingOfPinchedRims, DoubledEdgesDoNotKeepThePatchFromBeingFair) {
  AtomicVolumesOptions options;
  options.weight = CutWeight::unit;
  options.shifts = 1;
  options.seed = 18;
  options.edge_length = 2;
  const AtomicVolumesResult touching =
      fill_by_atomic_volumes(test::sphere_with_touching_holes(), {}, options);
  for (const HoleReport& hole : touching.completion.report.holes) EXPECT_EQ(hole.route, "normal variation");
  options = {};
  options.shifts = 1;
  const AtomicVolumesResult ragged =
      fill_by_atomic_volumes(test::rough_sphere_with_ragged_holes(3, 6, 12, 0.03), {}, options);
  for (const HoleReport& hole : ragged.completion.report.holes) EXPECT_NE(hole.route, "faces of the volumes");
}

// It would take more than ten million vertices; in guarded steps edges are at most halved in each round.
TEST(FinishingAtAnyEdgeLength, TakesNoMoreMemoryThanRemeshingIsAllowed) {
  const TriangleMesh whole = test::icosphere(0);
  const TriangleMesh mesh = test::without_faces(
      whole, [&](Index f) { return std::count(whole.triangles[f].begin(), whole.triangles[f].end(), 0u); });
  const std::vector<BoundaryLoop> loops = test::loops_of(mesh);
  ASSERT_EQ(loops.size(), 1u);
  const Rim rim = collect_rim(mesh, build_topology(mesh), loops);
  std::vector<Vector3> positions = rim.positions;
  const Index n = static_cast<Index>(positions.size());
  positions.push_back(whole.vertices[0]);
  std::vector<Triangle> fan;
  for (Index v = 0; v < n; ++v) fan.push_back({v, rim.next[v], n});
  FinishingOptions options;
  options.edge_length = 4e-4;
  const auto find = [](const PatchMesh&) { return PatchFault(); };
  const FinishedPatch finished =
      finish(PatchMesh(positions, n, fan), options, {rim, InputNeighbourhood(mesh), {}, find});
  EXPECT_EQ(finished.route, "normal variation in guarded steps");
  EXPECT_LT(finished.mesh.vertex_count(), 100000u);
}

}  // namespace
}  // namespace meshcomplete
