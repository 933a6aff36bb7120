#include "filter_atomicvolumes/surface_contacts.h"

#include <algorithm>

#include "common/core/threads.h"
#include "common/core/triangle_intersection.h"
#include "filter_atomicvolumes/rigid_cubes.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;

bool meets_input(const LatticeMesh& mesh, const LabelledSurface& surface, Index triangle,
                 const Corners& corners) {
  std::array<Index, 3> resting;
  for (int k = 0; k < 3; ++k) {
    const Index edge = surface.vertices[surface.triangles[triangle][k]].rim_edge;
    resting[k] = edge == VolumeVertex::none ? VolumeVertex::none : edge / 3;
  }
  bool free = true;
  mesh.neighbourhood.blocks().visit(bounding_box(corners[0], corners[1], corners[2]), [&](Index t) {
    if (std::find(resting.begin(), resting.end(), t) != resting.end()) return true;
    const auto& [a, b, c] = mesh.mesh.triangles[t];
    const Corners other = {mesh.mesh.vertices[a], mesh.mesh.vertices[b], mesh.mesh.vertices[c]};
    free = collinear(other[0], other[1], other[2]) || !meet_improperly(corners, other);
    return free;
  });
  return !free;
}

bool enters_rigid(const LatticeMesh& mesh, const Decomposition& decomposition, const Corners& corners) {
  const std::vector<StoredBox> cubes =
      rigid_cubes_near(mesh, decomposition, bounding_box(corners[0], corners[1], corners[2]));
  return std::any_of(cubes.begin(), cubes.end(),
                     [&](const StoredBox& cube) { return enters(corners, cube.low, cube.high); });
}

void add_pairs(const std::vector<Corners>& all, const std::vector<Index>& changed, std::vector<char>& hit) {
  if (4 * changed.size() > all.size()) {
    std::vector<char> is_changed(all.size(), 0);
    for (Index t : changed) is_changed[t] = 1;
    for (const auto& [i, j] : improper_pairs(all))
      if (is_changed[i] || is_changed[j]) hit[i] = hit[j] = 1;
    return;
  }
  std::vector<Corners> few;
  for (Index t : changed) few.push_back(all[t]);
  for (const auto& [i, j] : improper_pairs_between(few, all))
    if (changed[i] != j) hit[changed[i]] = hit[j] = 1;
}

}  // namespace

std::vector<Index> triangles_in_contact(const LatticeMesh& mesh, const Decomposition& decomposition,
                                        const LabelledSurface& surface, const std::vector<Index>& changed,
                                        const Progress& progress) {
  std::vector<Corners> all;
  for (const auto& [a, b, c] : surface.triangles)
    all.push_back({surface.vertices[a].position, surface.vertices[b].position, surface.vertices[c].position});
  std::vector<char> hit(all.size(), 0);
  for_ranges(changed.size(), 256, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Corners& c = all[changed[i]];
      hit[changed[i]] = collinear(c[0], c[1], c[2]) || meets_input(mesh, surface, changed[i], c) ||
                        enters_rigid(mesh, decomposition, c);
    }
  });
  if (!changed.empty()) add_pairs(all, changed, hit);
  std::vector<Index> found;
  for (Index t = 0; t < hit.size(); ++t)
    if (hit[t]) found.push_back(t);
  return found;
}

}  // namespace meshcomplete
