// Patches to test with: simple right ones, and the mesh that a patch makes.
#pragma once

#include <functional>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/patch_check.h"

namespace meshcomplete {
namespace test {

/// The boundary loops of a mesh, with and without defects.
std::vector<BoundaryLoop> loops_of(const TriangleMesh& mesh);

/// Pointers to all of them, as `check_patch` takes them.
std::vector<const BoundaryLoop*> pointers(const std::vector<BoundaryLoop>& loops);

/// `check_patch` of a patch that closes all of these loops.
PatchCheck check(const TriangleMesh& mesh, const Patch& patch, const std::vector<BoundaryLoop>& loops);

/// Every edge of the loop joined to one new vertex at `apex` (rounded to floats): rim-many faces.
Patch fan_patch(const TriangleMesh& mesh, const BoundaryLoop& loop, const Vector3& apex);

/// With the apex at the mean of the loop's vertices.
Patch fan_patch(const TriangleMesh& mesh, const BoundaryLoop& loop);

/// No new vertex: every edge of the loop joined to its first vertex.
Patch fan_from_corner(const TriangleMesh& mesh, const BoundaryLoop& loop);

/// The mesh and the patch together: new vertices and faces come after those of the input.
TriangleMesh with_patch(const TriangleMesh& mesh, const Patch& patch);

/// A mesh taken apart: `mesh` without the removed faces (and what only they used), `patch` puts them back.
struct CutOut {
  TriangleMesh mesh;
  Patch patch;
};
CutOut cut_out(const TriangleMesh& mesh, const std::function<bool(Index face)>& remove);

}  // namespace test
}  // namespace meshcomplete
