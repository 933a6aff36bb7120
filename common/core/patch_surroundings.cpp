#include "common/core/patch_surroundings.h"

#include "common/core/triangle_intersection.h"

#include <algorithm>

namespace meshcomplete {

PatchSurroundings::PatchSurroundings(const PatchMesh& patch, const InputNeighbourhood& input,
                                     const std::vector<std::array<Vector3, 3>>& obstacles)
    : patch_(patch), input_(input) {
  TriangleBox all({patch.position(0), patch.position(0), patch.position(0)});
  for (Index t = 0; t < patch.triangle_count(); ++t)
    if (patch.alive(t)) all.extend(TriangleBox(corners(t)));
  all.widen((all.high - all.low).maxCoeff());
  for (const auto& c : obstacles)
    if (all.meets(TriangleBox(c))) obstacles_.push_back(c);
}

std::array<Vector3, 3> PatchSurroundings::corners(Index triangle) const {
  const Triangle& t = patch_.triangles()[triangle];
  return {patch_.position(t[0]), patch_.position(t[1]), patch_.position(t[2])};
}

void PatchSurroundings::focus(const std::vector<Index>& triangles) {
  in_focus_.clear();
  first_after_ = patch_.triangle_count();
  if (triangles.empty()) return;
  TriangleBox box(corners(triangles.front()));
  for (Index t : triangles) box.extend(TriangleBox(corners(t)));
  box.widen((box.high - box.low).maxCoeff());
  for (Index t = 0; t < first_after_; ++t)
    if (patch_.alive(t) && box.meets(TriangleBox(corners(t)))) in_focus_.push_back(t);
}

void PatchSurroundings::collect(const TriangleBox& box, const std::function<bool(Index)>& left_out) {
  nearby_.clear();
  const auto remember = [&](const std::array<Vector3, 3>& c) {
    const TriangleBox own(c);
    if (box.meets(own) && !collinear(c[0], c[1], c[2])) nearby_.push_back({own, c});
  };
  const auto look_at = [&](Index t) {
    if (patch_.alive(t) && !left_out(t)) remember(corners(t));
  };
  for (Index t : in_focus_) look_at(t);
  for (Index t = static_cast<Index>(first_after_); t < patch_.triangle_count(); ++t) look_at(t);
  const TriangleMesh& mesh = input_.mesh();
  for (Index t : input_.triangles_in_box(box.low, box.high)) {
    const Triangle& c = mesh.triangles[t];
    remember({mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]});
  }
  for (const auto& c : obstacles_) remember(c);
}

void PatchSurroundings::collect_round(const std::vector<Index>& star, double reach) {
  TriangleBox box(corners(star.front()));
  for (Index t : star) box.extend(TriangleBox(corners(t)));
  box.widen(reach);
  collect(box, [&](Index t) { return std::find(star.begin(), star.end(), t) != star.end(); });
}

std::size_t PatchSurroundings::met_by(const std::array<Vector3, 3>& triangle, std::size_t enough) const {
  if (collinear(triangle[0], triangle[1], triangle[2])) return 0;
  std::size_t sum = 0;
  const TriangleBox box(triangle);
  for (const Nearby& other : nearby_)
    if (box.meets(other.box) && meet_improperly(triangle, other.corners) && ++sum >= enough) break;
  return sum;
}

std::size_t PatchSurroundings::met_by_star(const std::vector<Index>& star, std::size_t enough) const {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < star.size() && sum < enough; ++i) {
    const auto c = corners(star[i]);
    if (collinear(c[0], c[1], c[2])) {
      sum += degenerate_cost;
      continue;
    }
    for (std::size_t j = 0; j < i; ++j) {
      const auto other = corners(star[j]);
      if (!collinear(other[0], other[1], other[2]) && meet_improperly(c, other)) ++sum;
    }
    if (sum < enough) sum += met_by(c, enough - sum);
  }
  return std::min(sum, enough);
}

}  // namespace meshcomplete
