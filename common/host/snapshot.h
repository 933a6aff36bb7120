// What an algorithm sees of MeshLab's mesh: positions, triangles and the selection, in MeshLab's own
// numbering.
#pragma once

#include <vector>

#include "common/core/hole_selection.h"
#include "common/core/mesh.h"
#include "common/host/meshlab_version.h"

namespace meshcomplete {
namespace host {

/// Vertex numbers are positions in `CMeshO::vert`; a deleted vertex keeps its number and is used by no
/// triangle. Triangles are the faces that are not deleted, in order.
struct Snapshot {
  TriangleMesh mesh;
  std::vector<Index> face_of_triangle;  ///< position in `CMeshO::face` of each triangle
  MeshSelection selection;              ///< empty where nothing is selected
};

/// Coordinates are those of the layer itself: its transformation matrix is not applied, so that a patch can
/// be appended to the layer as it is. Faces of polygons (with faux edges) are taken as the triangles that
/// they are. Coordinates of vertices that no face uses are replaced by zero where they are infinite or not
/// numbers. Throws CompletionError when there is nothing to work on (no vertices, no faces) or a face has a
/// corner that is not finite. Cost: one pass.
Snapshot snapshot(const MeshModel& model);

}  // namespace host
}  // namespace meshcomplete
