#include "common/host/append.h"

#include <vcg/complex/append.h>

#include <stdexcept>

#include "common/host/layers.h"
#include "common/host/patch_attributes.h"

namespace meshcomplete {
namespace host {
namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

/// A patch of another mesh would be appended at random places: that is a programming error.
void refuse_foreign(const MeshModel& model, const TriangleMesh& mesh, const Patch& patch) {
  if (patch.input_vertices != model.cm.vert.size() || mesh.vertices.size() != model.cm.vert.size())
    throw std::logic_error("the patch was made for another mesh");
  for (const Triangle& triangle : patch.triangles)
    for (const Index v : triangle)
      if (v < patch.input_vertices ? model.cm.vert[v].IsD()
                                   : v - patch.input_vertices >= patch.vertices.size())
        throw std::logic_error("the patch uses a vertex that is not there");
}

void add_vertices(CMeshO& to, const Patch& patch, const PatchAttributes& attributes) {
  auto vertex = Allocator::AddVertices(to, patch.vertices.size());
  const bool grow_box = !to.bbox.IsNull();
  for (std::size_t i = 0; i < patch.vertices.size(); ++i, ++vertex) {
    vertex->P() = as_point(patch.vertices[i]);
    vertex->N() = as_point(attributes.vertex_normals[i]);
    vertex->C() = attributes.vertex_colors[i];
    vertex->Q() = attributes.vertex_qualities[i];
    if (!attributes.vertex_radii.empty()) vertex->R() = attributes.vertex_radii[i];
    if (!attributes.vertex_texcoords.empty()) vertex->T() = attributes.vertex_texcoords[i];
    if (grow_box) to.bbox.Add(vertex->cP());
  }
  if (!grow_box) vcg::tri::UpdateBounding<CMeshO>::Box(to);
}

/// `corner_of[v]` is the position in `to.vert` of patch corner v.
void add_faces(CMeshO& to, const Patch& patch, const PatchAttributes& attributes,
               const std::vector<std::size_t>& corner_of) {
  auto face = Allocator::AddFaces(to, patch.triangles.size());
  for (std::size_t i = 0; i < patch.triangles.size(); ++i, ++face) {
    for (int corner = 0; corner < 3; ++corner)
      face->V(corner) = &to.vert[corner_of[patch.triangles[i][corner]]];
    face->N() = as_point(attributes.face_normals[i]);
    if (!attributes.face_colors.empty()) face->C() = attributes.face_colors[i];
    if (!attributes.face_qualities.empty()) face->Q() = attributes.face_qualities[i];
    if (attributes.wedge_texcoords.empty()) continue;
    for (int corner = 0; corner < 3; ++corner) face->WT(corner) = attributes.wedge_texcoords[i][corner];
  }
}

/// Adjacency is per-layer data that filters share: MeshLab expects it to be right wherever it is switched on.
void refresh_adjacency(MeshModel& model) {
  CMeshO& mesh = model.cm;
  if (mesh.face.IsFFAdjacencyEnabled()) vcg::tri::UpdateTopology<CMeshO>::FaceFace(mesh);
  if (mesh.face.IsVFAdjacencyEnabled() && mesh.vert.IsVFAdjacencyEnabled())
    vcg::tri::UpdateTopology<CMeshO>::VertexFace(mesh);
}

Appended append_computed(MeshModel& model, const Patch& patch, const PatchAttributes& attributes,
                         std::vector<std::size_t> corner_of, const AppendOptions& options) {
  CMeshO& mesh = model.cm;
  const Appended where{mesh.vert.size(), patch.vertices.size(), mesh.face.size(), patch.triangles.size()};
  for (std::size_t i = 0; i < patch.vertices.size(); ++i) corner_of.push_back(where.first_vertex + i);
  if (!patch.vertices.empty()) add_vertices(mesh, patch, attributes);
  add_faces(mesh, patch, attributes, corner_of);
  if (options.select_new_faces) {
    vcg::tri::UpdateSelection<CMeshO>::FaceClear(mesh);
    for (std::size_t f = where.first_face; f < mesh.face.size(); ++f) mesh.face[f].SetS();
    mesh.sfn = static_cast<int>(where.faces);
  }
  refresh_adjacency(model);
  return where;
}

template <class Value>
void copy_attribute_layout(const CMeshO& from, CMeshO& to) {
  for (const auto& attribute : from.vert_attr)
    if (!attribute._name.empty() && attribute._type == typeid(Value))
      Allocator::template AddPerVertexAttribute<Value>(to, attribute._name);
  for (const auto& attribute : from.face_attr)
    if (!attribute._name.empty() && attribute._type == typeid(Value))
      Allocator::template AddPerFaceAttribute<Value>(to, attribute._name);
}

/// vcg copies the custom attributes that both meshes have, so the copy is given them first.
template <class... Values>
void copy_attribute_layouts(const CMeshO& from, CMeshO& to) {
  (copy_attribute_layout<Values>(from, to), ...);
}

void copy_layer(const MeshModel& from, MeshModel& to) {
  to.updateDataMask(from.dataMask() & ~(MeshModel::MM_FACEFACETOPO | MeshModel::MM_VERTFACETOPO));
  copy_attribute_layouts<float, double, int, short, char, unsigned char, bool, vcg::Point3f, vcg::Point3d,
                         vcg::Color4b>(from.cm, to.cm);
  // vcg takes the source by a non-const reference, and changes it only when asked for selected elements.
  vcg::tri::Append<CMeshO, CMeshO>::Mesh(to.cm, const_cast<CMeshO&>(from.cm));
  to.cm.bbox = from.cm.bbox;
  to.cm.Tr = from.cm.Tr;
  to.cm.shot = from.cm.shot;
  to.cm.sfn = from.cm.sfn;
  to.cm.svn = from.cm.svn;
  to.cm.pvn = from.cm.pvn;
  to.cm.pfn = from.cm.pfn;
}

/// Takes faces out of a copy; they are given by their positions in the original.
void remove_faces(const CMeshO& from, const std::vector<Index>& faces, CMeshO& copy) {
  if (faces.empty()) return;
  auto next = faces.begin();
  std::size_t place = 0;  // in the copy, which lacks the deleted ones
  for (Index f = 0; f < from.face.size(); ++f) {
    if (from.face[f].IsD()) continue;
    if (next != faces.end() && *next == f) {
      if (copy.face[place].IsS()) --copy.sfn;
      Allocator::DeleteFace(copy, copy.face[place]);
      ++next;
    }
    ++place;
  }
  Allocator::CompactFaceVector(copy);
}

/// Gives fans of faces copies of their vertices. `position_of[v]` is the position in `to.vert` of vertex v.
void split_vertices(CMeshO& to, const std::vector<VertexSplit>& splits,
                    const std::vector<std::size_t>& position_of) {
  if (splits.empty()) return;
  std::size_t copy = to.vert.size();
  Allocator::AddVertices(to, splits.size());
  for (const VertexSplit& split : splits) {
    const std::size_t place = position_of[split.vertex];
    CVertexO& original = to.vert[place];
    to.vert[copy].ImportData(original);
    if (original.IsS()) ++to.svn;
    for (const auto& attribute : to.vert_attr)
      if (!attribute._name.empty()) attribute._handle->CopyValue(copy, place, attribute._handle);
    for (const Index face : split.faces)
      for (int corner = 0; corner < 3; ++corner)
        if (to.face[face].V(corner) == &original) to.face[face].V(corner) = &to.vert[copy];
    ++copy;
  }
}

/// Deletes the vertices that faces left out used and no face of the copy does.
void remove_stray_vertices(const CMeshO& from, const std::vector<Index>& left_out, CMeshO& copy,
                           const std::vector<std::size_t>& position_of) {
  std::vector<char> stray(copy.vert.size(), 0);
  for (const Index face : left_out)
    for (int corner = 0; corner < 3; ++corner)
      stray[position_of[static_cast<std::size_t>(from.face[face].cV(corner) - from.vert.data())]] = 1;
  for (const CFaceO& face : copy.face)
    for (int corner = 0; corner < 3; ++corner)
      stray[static_cast<std::size_t>(face.cV(corner) - copy.vert.data())] = 0;
  for (std::size_t v = 0; v < stray.size(); ++v) {
    if (!stray[v]) continue;
    if (copy.vert[v].IsS()) --copy.svn;
    Allocator::DeleteVertex(copy, copy.vert[v]);
  }
  Allocator::CompactVertexVector(copy);
}

/// Where each vertex of a layer stands in a copy that leaves out the deleted ones.
std::vector<std::size_t> positions_in_copy(const CMeshO& mesh) {
  std::vector<std::size_t> positions(mesh.vert.size(), 0);
  std::size_t next = 0;
  for (std::size_t v = 0; v < mesh.vert.size(); ++v)
    if (!mesh.vert[v].IsD()) positions[v] = next++;
  return positions;
}

std::vector<std::size_t> same_positions(const CMeshO& mesh) {
  std::vector<std::size_t> positions(mesh.vert.size());
  for (std::size_t v = 0; v < positions.size(); ++v) positions[v] = v;
  return positions;
}

}  // namespace

Appended append_patch(MeshModel& model, const TriangleMesh& mesh, const Patch& patch,
                      const AppendOptions& options) {
  refuse_foreign(model, mesh, patch);
  if (!options.left_out.empty() || !options.splits.empty())
    throw std::logic_error("faces are left out of copies only, and vertices split there only");
  if (patch.empty()) return {model.cm.vert.size(), 0, model.cm.face.size(), 0};
  const PatchAttributes attributes = patch_attributes(model, mesh, patch);
  return append_computed(model, patch, attributes, same_positions(model.cm), options);
}

MeshModel& append_patch_to_copy(MeshDocument& document, const MeshModel& model, const TriangleMesh& mesh,
                                const Patch& patch, const QString& name, const AppendOptions& options) {
  refuse_foreign(model, mesh, patch);
  const PatchAttributes attributes = patch_attributes(model, mesh, patch, options.left_out);
  MeshModel& made = add_layer_with(document, name, [&](MeshModel& copy) {
    copy_layer(model, copy);
    remove_faces(model.cm, options.left_out, copy.cm);
    const std::vector<std::size_t> positions = positions_in_copy(model.cm);
    append_computed(copy, patch, attributes, positions, options);
    split_vertices(copy.cm, options.splits, positions);
    if (options.leave_out_vertices) remove_stray_vertices(model.cm, options.left_out, copy.cm, positions);
  });
  document.setCurrentMesh(made.id());
  return made;
}

void fill_layer(MeshModel& layer, const TriangleMesh& mesh) {
  CMeshO& to = layer.cm;
  auto vertex = Allocator::AddVertices(to, mesh.vertices.size());
  for (const Vector3& position : mesh.vertices) (vertex++)->P() = as_point(position);
  auto face = Allocator::AddFaces(to, mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) face->V(corner) = &to.vert[triangle[corner]];
    ++face;
  }
  layer.UpdateBoxAndNormals();
}

MeshModel& add_layer(MeshDocument& document, const TriangleMesh& mesh, const QString& name,
                     const MeshModel& beside) {
  const Matrix44m placed = beside.cm.Tr;
  return add_layer_with(document, name, [&](MeshModel& layer) {
    layer.cm.Tr = placed;
    fill_layer(layer, mesh);
  });
}

}  // namespace host
}  // namespace meshcomplete
