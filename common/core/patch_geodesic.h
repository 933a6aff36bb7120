// Straightest ways over a patch.
#pragma once

#include <vector>

#include "common/core/mesh.h"
#include "common/core/patch.h"

namespace meshcomplete {

/// The shortest way over some triangles of a patch from one vertex to another, as points where it crosses
/// edges, both ends included. Vertices are named as the patch's triangles do. Empty when there is none. The
/// patch must be manifold and consistently oriented. Source: Xin and Wang, "Improving Chen and Han's
/// algorithm on the discrete geodesic problem" (2009), as in CGAL. Cost: as a rule near-linear in the
/// triangles.
std::vector<Vector3> geodesic(const TriangleMesh& mesh, const Patch& patch,
                              const std::vector<Index>& triangles, Index from, Index to);

}  // namespace meshcomplete
