#include "tests/host/test_documents.h"

#include <cstring>

#include "common/core/boundary_loops.h"
#include "common/core/mesh_topology.h"

namespace meshcomplete {
namespace test {
namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

template <class T>
void append_bytes(std::string& to, const T& value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  to.append(bytes, sizeof(T));
}

vcg::Color4b some_color(int number) {
  return vcg::Color4b(static_cast<unsigned char>(number % 251), static_cast<unsigned char>(number * 7 % 241),
                      static_cast<unsigned char>(number * 13 % 239), 255);
}

void give_vertex_attributes(CMeshO& mesh) {
  auto custom = Allocator::AddPerVertexAttribute<float>(mesh, "weight");
  for (std::size_t i = 0; i < mesh.vert.size(); ++i) {
    const float x = static_cast<float>(i);
    mesh.vert[i].C() = some_color(static_cast<int>(i));
    mesh.vert[i].Q() = 0.25f * x;
    mesh.vert[i].R() = 1 + x;
    mesh.vert[i].T().U() = 0.001f * x;
    mesh.vert[i].T().V() = 1 - 0.001f * x;
    mesh.vert[i].T().N() = 0;
    mesh.vert[i].N() = Point3m(0.6f, 0.8f, 0.001f * x);
    custom[i] = 3 * x;
    if (i % 5 == 0) mesh.vert[i].SetS();
  }
}

void give_face_attributes(CMeshO& mesh) {
  auto custom = Allocator::AddPerFaceAttribute<int>(mesh, "label");
  for (std::size_t i = 0; i < mesh.face.size(); ++i) {
    CFaceO& face = mesh.face[i];
    face.C() = some_color(static_cast<int>(3 * i));
    face.Q() = 0.5f * static_cast<float>(i);
    face.N() = Point3m(1, 0.001f * static_cast<float>(i), 0);
    for (int corner = 0; corner < 3; ++corner) {
      // A map from positions, the same in all faces at a vertex: a texture without seams.
      face.WT(corner).U() = 0.5f + 0.25f * face.V(corner)->P()[0];
      face.WT(corner).V() = 0.5f + 0.25f * face.V(corner)->P()[1];
      face.WT(corner).N() = 1;
    }
    custom[i] = static_cast<int>(7 * i);
    if (i % 3 == 0) face.SetS();
    if (i % 4 == 0) face.SetF(1);
  }
}

}  // namespace

MeshModel& layer_from(MeshDocument& document, const TriangleMesh& mesh, const char* name) {
  MeshModel& model = *document.addNewMesh("", name, true);
  auto vertex = Allocator::AddVertices(model.cm, mesh.vertices.size());
  for (const Vector3& v : mesh.vertices) (vertex++)->P() = Point3m(float(v.x()), float(v.y()), float(v.z()));
  auto face = Allocator::AddFaces(model.cm, mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) face->V(corner) = &model.cm.vert[triangle[corner]];
    ++face;
  }
  model.UpdateBoxAndNormals();
  return model;
}

void give_all_attributes(MeshModel& model) {
  model.updateDataMask(MeshModel::MM_VERTCOLOR | MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTRADIUS |
                       MeshModel::MM_VERTTEXCOORD | MeshModel::MM_FACECOLOR | MeshModel::MM_FACEQUALITY |
                       MeshModel::MM_WEDGTEXCOORD | MeshModel::MM_FACEFACETOPO | MeshModel::MM_VERTFACETOPO);
  give_vertex_attributes(model.cm);
  give_face_attributes(model.cm);
  model.cm.textures = {"front.png", "back.png"};
  model.cm.Tr.SetTranslate(1, 2, 3);
  model.cm.svn = static_cast<int>(vcg::tri::UpdateSelection<CMeshO>::VertexCount(model.cm));
  model.cm.sfn = static_cast<int>(vcg::tri::UpdateSelection<CMeshO>::FaceCount(model.cm));
}

Patch fans(const TriangleMesh& mesh) {
  Patch patch;
  patch.input_vertices = static_cast<Index>(mesh.vertices.size());
  for (const BoundaryLoop& loop : trace_boundary_loops(mesh, build_topology(mesh))) {
    const Index centre = patch.input_vertices + static_cast<Index>(patch.vertices.size());
    Vector3 mean = Vector3::Zero();
    for (const Index v : loop.vertices) mean += mesh.vertices[v] / static_cast<double>(loop.vertices.size());
    patch.vertices.push_back(as_stored(mean));
    for (std::size_t i = 0; i < loop.vertices.size(); ++i)
      patch.triangles.push_back({loop.vertices[i], loop.vertices[(i + 1) % loop.vertices.size()], centre});
  }
  return patch;
}

std::vector<std::string> vertex_states(const MeshModel& model) {
  const CMeshO& mesh = model.cm;
  auto custom = Allocator::FindPerVertexAttribute<float>(const_cast<CMeshO&>(mesh), "weight");
  std::vector<std::string> states(mesh.vert.size());
  for (std::size_t i = 0; i < mesh.vert.size(); ++i) {
    const CVertexO& vertex = mesh.vert[i];
    std::string& state = states[i];
    append_bytes(state, vertex.cP());
    append_bytes(state, vertex.cN());
    append_bytes(state, vertex.cC());
    append_bytes(state, vertex.cQ());
    append_bytes(state, vertex.cFlags());
    if (mesh.vert.IsRadiusEnabled()) append_bytes(state, vertex.cR());
    if (mesh.vert.IsTexCoordEnabled()) {
      append_bytes(state, vertex.cT().P());
      append_bytes(state, vertex.cT().N());
    }
    if (custom._handle != nullptr) append_bytes(state, custom[i]);
  }
  return states;
}

std::vector<std::string> face_states(const MeshModel& model) {
  const CMeshO& mesh = model.cm;
  auto custom = Allocator::FindPerFaceAttribute<int>(const_cast<CMeshO&>(mesh), "label");
  std::vector<std::string> states(mesh.face.size());
  for (std::size_t i = 0; i < mesh.face.size(); ++i) {
    const CFaceO& face = mesh.face[i];
    std::string& state = states[i];
    append_bytes(state, face.cFlags());
    if (face.IsD()) continue;  // vcg does not look after what a deleted face refers to
    append_bytes(state, face.cN());
    if (mesh.face.IsColorEnabled()) append_bytes(state, face.cC());
    if (mesh.face.IsQualityEnabled()) append_bytes(state, face.cQ());
    for (int corner = 0; corner < 3; ++corner) {
      append_bytes(state, face.cV(corner) - mesh.vert.data());
      if (!mesh.face.IsWedgeTexCoordEnabled()) continue;
      append_bytes(state, face.cWT(corner).P());
      append_bytes(state, face.cWT(corner).N());
    }
    if (custom._handle != nullptr) append_bytes(state, custom[i]);
  }
  return states;
}

std::string layer_state(const MeshModel& model) {
  std::string state = model.label().toStdString();
  for (const std::string& vertex : vertex_states(model)) state += vertex;
  for (const std::string& face : face_states(model)) state += face;
  for (const std::string& texture : model.cm.textures) state += texture;
  for (const int count : {model.cm.vn, model.cm.fn, model.cm.svn, model.cm.sfn, model.dataMask()})
    append_bytes(state, count);
  append_bytes(state, model.cm.bbox);
  append_bytes(state, model.cm.Tr);
  append_bytes(state, model.visible);
  return state;
}

std::string document_state(const MeshDocument& document) {
  std::string state;
  for (const MeshModel* model : document.meshList) state += layer_state(*model);
  append_bytes(state, document.mm());
  return state;
}

}  // namespace test
}  // namespace meshcomplete
