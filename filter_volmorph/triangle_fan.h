// Hole filling by triangle fans: every hole closed by triangles from its rim to one new vertex, where these
// meet nothing.
// Source: Firestone, "An Exploration of Hole Filling Algorithms", 2008, section 2.2.1.
#pragma once

#include "common/core/hole_selection.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/progress.h"

namespace meshcomplete {

struct TriangleFanOptions {
  HoleSelectionOptions holes;
};

/// Closes the selected holes of `mesh`, each by a fan round the mean of its rim's vertices. A rim of three
/// edges whose fan fails is closed by the one triangle that it is. The patch has passed `check_patch`; a hole
/// whose fan would intersect itself, the mesh or another fan, or has a face without area, stays open. Of fans
/// that meet each other those with fewer edges are kept (then of less perimeter, then the earlier ones).
/// Deterministic whatever the number of threads. Throws as `select_holes`, and `Cancelled`. Cost: O(faces)
/// for tracing, and per hole that of the check, which is O(edges^2) for the fan itself.
Completion close_by_fans(const TriangleMesh& mesh, const MeshSelection& selection,
                         const TriangleFanOptions& options, const Progress& progress = Progress());

}  // namespace meshcomplete
