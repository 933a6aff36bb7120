// The attributes of a patch in MeshLab's terms, computed before MeshLab's mesh is touched.
#pragma once

#include <array>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/host/meshlab_version.h"

namespace meshcomplete {
namespace host {

/// What is interpolated for the new vertices and faces. Members for attributes that the layer lacks stay
/// empty; colour and quality of vertices are always there, as in MeshLab's mesh.
struct PatchAttributes {
  std::vector<Vector3> vertex_normals;
  std::vector<Vector3> face_normals;
  std::vector<vcg::Color4b> vertex_colors;
  std::vector<float> vertex_qualities;
  std::vector<float> vertex_radii;
  std::vector<vcg::TexCoord2f> vertex_texcoords;
  std::vector<vcg::Color4b> face_colors;
  std::vector<float> face_qualities;
  std::vector<std::array<vcg::TexCoord2f, 3>> wedge_texcoords;
};

/// Attributes for `patch`, interpolated harmonically from the rim. Values of faces (colour, quality, wedge
/// texture coordinates) are first averaged at each rim vertex over the faces of the layer that hold a rim
/// edge; at a rim edge a new face has exactly the wedge coordinates of the face across, so that the texture
/// continues without a seam. Where several textures meet at one hole, the one that most of its rim has is
/// taken. Faces at the positions `left_out` in `CMeshO::face`, ascending, tell nothing. Cost: one pass over
/// the faces when the layer has face values, and the interpolation's.
PatchAttributes patch_attributes(const MeshModel& model, const TriangleMesh& mesh, const Patch& patch,
                                 const std::vector<Index>& left_out = {});

}  // namespace host
}  // namespace meshcomplete
