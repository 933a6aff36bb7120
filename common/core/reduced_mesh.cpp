#include "common/core/reduced_mesh.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/core/error.h"
#include "common/core/hole_targets.h"

namespace meshcomplete {
namespace {

constexpr const char* stage = "removing rings of faces";

}  // namespace

ReducedMesh unreduced(const TriangleMesh& mesh, const MeshSelection& selection) {
  ReducedMesh rest{mesh, selection, {}, std::vector<Index>(mesh.triangles.size())};
  std::iota(rest.number.begin(), rest.number.end(), Index(0));
  return rest;
}

void remove_faces(ReducedMesh& rest, const std::vector<Index>& faces, bool select_corners) {
  std::vector<Triangle> triangles;
  std::vector<Index> number;
  std::vector<char> selected;
  if (select_corners) rest.selection.vertices.resize(rest.mesh.vertices.size(), 0);
  auto next = faces.begin();
  for (Index t = 0; t < rest.mesh.triangles.size(); ++t) {
    if (next != faces.end() && *next == t) {
      ++next;
      rest.removed.push_back(rest.number[t]);
      if (select_corners)
        for (Index v : rest.mesh.triangles[t]) rest.selection.vertices[v] = 1;
      continue;
    }
    triangles.push_back(rest.mesh.triangles[t]);
    number.push_back(rest.number[t]);
    if (!rest.selection.faces.empty()) selected.push_back(rest.selection.faces[t]);
  }
  rest.mesh.triangles = std::move(triangles);
  rest.number = std::move(number);
  rest.selection.faces = std::move(selected);
  std::sort(rest.removed.begin(), rest.removed.end());
}

ReducedMesh without_rings(const TriangleMesh& mesh, const MeshSelection& selection,
                          const HoleSelectionOptions& options, int rings, const Progress& progress) {
  ReducedMesh rest = unreduced(mesh, selection);
  const OpenMesh open = find_holes(mesh, selection, options, progress);
  std::vector<char> on_rim(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < open.loops.size(); ++i)
    if (is_targeted(open.holes[i]))
      for (Index v : open.loops[i].vertices) on_rim[v] = 1;
  for (int ring = 0; ring < rings; ++ring) {
    progress.check();
    std::vector<Index> faces;
    for (Index t = 0; t < rest.mesh.triangles.size(); ++t) {
      const Triangle& corners = rest.mesh.triangles[t];
      if (std::any_of(corners.begin(), corners.end(), [&](Index v) { return on_rim[v] != 0; }))
        faces.push_back(t);
    }
    for (Index t : faces)
      for (Index v : rest.mesh.triangles[t]) on_rim[v] = 1;
    remove_faces(rest, faces, options.selected_only);
  }
  if (rest.mesh.triangles.empty() && !mesh.triangles.empty())
    throw CompletionError(stage, "Removing so many rings of faces leaves nothing of the mesh. Remove fewer.");
  return rest;
}

}  // namespace meshcomplete
