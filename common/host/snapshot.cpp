#include "common/host/snapshot.h"

#include <cmath>
#include <string>

#include "common/core/error.h"

namespace meshcomplete {
namespace host {
namespace {

const char* const stage = "reading the mesh";

/// Half-edges are numbered by `Index` too, and its two greatest values mean something else.
constexpr std::size_t most_faces = 0xfffffffdu / 3;
constexpr std::size_t most_vertices = 0xfffffffdu;

void refuse_unusable(const MeshModel& model) {
  const std::string name = model.label().toStdString();
  const CMeshO& mesh = model.cm;
  if (mesh.vn == 0) throw CompletionError(stage, "The layer \"" + name + "\" is empty: it has no vertices.");
  if (mesh.fn == 0)
    throw CompletionError(stage, "The layer \"" + name + "\" has no faces, it is a cloud of " +
                                     std::to_string(mesh.vn) +
                                     " points. Make a surface of it first, for example with \"Surface "
                                     "Reconstruction: Screened Poisson\".");
  if (mesh.face.size() > most_faces || mesh.vert.size() > most_vertices)
    throw CompletionError(stage, "The layer \"" + name + "\" is too large: at most " +
                                     std::to_string(most_faces) + " faces can be handled.");
}

bool finite(const Point3m& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); }

template <class Elements>
std::vector<char> selected(const Elements& elements) {
  std::vector<char> flags;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (elements[i].IsD() || !elements[i].IsS()) continue;
    if (flags.empty()) flags.resize(elements.size(), 0);
    flags[i] = 1;
  }
  return flags;
}

}  // namespace

Snapshot snapshot(const MeshModel& model) {
  refuse_unusable(model);
  const CMeshO& from = model.cm;
  Snapshot result;
  std::size_t not_finite = 0;
  std::vector<char> usable(from.vert.size(), 1);
  result.mesh.vertices.resize(from.vert.size(), Vector3::Zero());
  for (std::size_t v = 0; v < from.vert.size(); ++v) {
    const Point3m& p = from.vert[v].cP();
    if (from.vert[v].IsD() || !finite(p))
      usable[v] = 0;
    else
      result.mesh.vertices[v] = Vector3(p[0], p[1], p[2]);
  }
  result.mesh.triangles.reserve(static_cast<std::size_t>(from.fn));
  result.face_of_triangle.reserve(static_cast<std::size_t>(from.fn));
  const CVertexO* const first = from.vert.data();
  for (std::size_t f = 0; f < from.face.size(); ++f) {
    const CFaceO& face = from.face[f];
    if (face.IsD()) continue;
    Triangle triangle;
    for (int corner = 0; corner < 3; ++corner) {
      triangle[corner] = static_cast<Index>(face.cV(corner) - first);
      if (usable[triangle[corner]] == 1) continue;
      if (usable[triangle[corner]] == 0) ++not_finite;
      usable[triangle[corner]] = 2;  // counted
    }
    result.mesh.triangles.push_back(triangle);
    result.face_of_triangle.push_back(static_cast<Index>(f));
  }
  if (not_finite > 0)
    throw CompletionError(stage,
                          std::to_string(not_finite) + (not_finite == 1 ? " vertex has" : " vertices have") +
                              " coordinates that are infinite or not numbers. Save the mesh and open it "
                              "again: MeshLab removes such vertices when it opens a file.");
  result.selection.vertices = selected(from.vert);
  const std::vector<char> faces = selected(from.face);
  if (!faces.empty()) {
    result.selection.faces.reserve(result.face_of_triangle.size());
    for (const Index f : result.face_of_triangle) result.selection.faces.push_back(faces[f]);
  }
  return result;
}

}  // namespace host
}  // namespace meshcomplete
