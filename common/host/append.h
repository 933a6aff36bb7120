// The only place where a mesh of MeshLab is changed: a patch is appended to it, or to a copy of it in a new
// layer.
#pragma once

#include <QString>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/vertex_splits.h"
#include "common/host/meshlab_version.h"

namespace meshcomplete {
namespace host {

struct AppendOptions {
  /// The new faces become the face selection, as in MeshLab's own Close Holes; otherwise the selection stays
  /// as it is.
  bool select_new_faces = false;
  /// Positions in `CMeshO::face`, ascending, of faces that a copy lacks. Not for `append_patch`.
  std::vector<Index> left_out;
  /// Vertices that fans of faces in a copy get copies of, with all that the vertex has. Vertices are numbered
  /// as in the layer, faces as in the copy: those that are left of the layer, then the patch's. Not for
  /// `append_patch`.
  std::vector<VertexSplit> splits;
  /// Vertices that only faces left out used are left out of the copy as well.
  bool leave_out_vertices = false;
};

/// Where the patch went: it stands at the end of the vertex and of the face list.
struct Appended {
  std::size_t first_vertex = 0;
  std::size_t vertices = 0;
  std::size_t first_face = 0;
  std::size_t faces = 0;
};

/// Appends `patch` to the layer whose snapshot it was made for. Existing vertices and faces keep their
/// positions, order, normals, colours, quality, texture coordinates, custom attributes and flags (except the
/// face selection, see the options), bit for bit. New vertices get normals; colour, quality, radius and
/// texture coordinates, where the layer has them, are interpolated from the rim, and so are the new faces'
/// colour, quality and wedge texture coordinates. Adjacency that the layer holds is computed anew; the
/// bounding box grows. An empty patch changes nothing. `mesh` is the snapshot's mesh. Throws before anything
/// is changed.
Appended append_patch(MeshModel& model, const TriangleMesh& mesh, const Patch& patch,
                      const AppendOptions& options = AppendOptions());

/// Adds a layer named `name` that is a complete copy of `model` with the patch appended, makes it the current
/// layer and leaves `model` as it is. Deleted elements are not copied, nor are the faces that the options
/// leave out; their vertices are, unless the options say otherwise. Copies of vertices come after the
/// patch's. Custom attributes of the usual types (numbers, points, colours) are copied. When it throws, the
/// document is as before.
MeshModel& append_patch_to_copy(MeshDocument& document, const MeshModel& model, const TriangleMesh& mesh,
                                const Patch& patch, const QString& name,
                                const AppendOptions& options = AppendOptions());

/// Gives an empty layer the vertices and faces of `mesh`, in its order.
void fill_layer(MeshModel& layer, const TriangleMesh& mesh);

/// Adds a layer that holds `mesh` alone, in the coordinates of the layer `beside`: it gets that one's
/// transformation matrix. The current layer stays current. When it throws, the document is as before.
MeshModel& add_layer(MeshDocument& document, const TriangleMesh& mesh, const QString& name,
                     const MeshModel& beside);

}  // namespace host
}  // namespace meshcomplete
