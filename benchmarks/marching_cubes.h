// Marching cubes over the leaves of an octree's field, to compare with.
#pragma once

#include "common/core/mesh.h"
#include "common/core/octree_field.h"

namespace meshcomplete::benchmarks {

/// The surface of the field in each leaf that it crosses: a vertex on each edge whose ends differ, polygons
/// as the faces join them, cut into triangles. Edges of one length share their vertices; between leaves of
/// unlike size there are slits as narrow as the two sides differ. Cost: O(leaves).
TriangleMesh marching_cubes(const OctreeField& field);

}  // namespace meshcomplete::benchmarks
