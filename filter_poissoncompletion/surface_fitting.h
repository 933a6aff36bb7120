// Faces, and not vertices only, as near to a surface as can be.
#pragma once

#include "common/core/implicit_function.h"
#include "common/core/mesh.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// Moves the vertices of a closed manifold mesh, which are on the surface of `function` or near it, along
/// their normals, so that the integral over the faces of the squared distance from the surface becomes as
/// small as it can. Triangles with all corners on a curved surface lie to one side of it; afterwards they lie
/// on both, and less than half as far. No vertex moves by more than a fifth of its shortest edge, positions
/// are rounded to what will be stored, and where faces would meet that did not before their vertices stay.
/// Deterministic whatever the number of threads. Throws Cancelled. Cost: O(n log n) for n faces, 18 values of
/// the function for each; threaded in part.
void fit_to_surface(const ImplicitFunction& function, TriangleMesh& mesh,
                    const Progress& progress = Progress());

}  // namespace meshcomplete
