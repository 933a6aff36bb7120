#include "common/core/patch_surroundings.h"

#include <algorithm>

#include "common/core/triangle_intersection.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;

// Of the input only so many triangles are remembered; where there are more, each question goes to the input's
// own tree.
constexpr std::size_t most_remembered = 2000;

// A box in focus is wider than the triangles by this many times its longest side on each side.
constexpr double focus_margin = 2.0;

Box box_round(const Corners& c) { return bounding_box(c[0], c[1], c[2]); }

void widen(Box& box, double margin) {
  for (int k = 0; k < 3; ++k) {
    box.low[k] -= margin;
    box.high[k] += margin;
  }
}

bool contains(const Box& outer, const Box& inner) {
  for (int k = 0; k < 3; ++k)
    if (inner.low[k] < outer.low[k] || inner.high[k] > outer.high[k]) return false;
  return true;
}

}  // namespace

PatchSurroundings::PatchSurroundings(const PatchMesh& patch, const InputNeighbourhood& input,
                                     const std::vector<Corners>& obstacles)
    : patch_(patch), input_(input) {
  for (const Corners& c : obstacles) obstacles_.push_back({box_round(c), c});
}

Corners PatchSurroundings::corners(Index triangle) const {
  const Triangle& t = patch_.triangles()[triangle];
  return {patch_.position(t[0]), patch_.position(t[1]), patch_.position(t[2])};
}

Box PatchSurroundings::box_of(const std::vector<Index>& triangles) const {
  Box box;
  for (Index t : triangles) box.include(box_round(corners(t)));
  return box;
}

void PatchSurroundings::focus(const std::vector<Index>& triangles) {
  in_focus_.clear();
  obstacles_near_.clear();
  first_later_ = patch_.triangle_count();
  focused_ = true;
  focus_ = box_of(triangles);
  double longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, focus_.high[k] - focus_.low[k]);
  widen(focus_, focus_margin * longest);
  for (Index t = 0; t < first_later_; ++t)
    if (patch_.alive(t) && focus_.meets(box_round(corners(t)))) in_focus_.push_back(t);
  for (std::size_t i = 0; i < obstacles_.size(); ++i)
    if (focus_.meets(obstacles_[i].box)) obstacles_near_.push_back(i);
}

void PatchSurroundings::collect(const Box& box, const std::function<bool(Index)>& left_out) {
  nearby_.clear();
  const auto remember = [&](const Nearby& one) {
    if (box.meets(one.box) && !collinear(one.corners[0], one.corners[1], one.corners[2]))
      nearby_.push_back(one);
  };
  const auto look_at = [&](Index t) {
    if (!patch_.alive(t) || left_out(t)) return;
    const Corners c = corners(t);
    remember({box_round(c), c});
  };
  const bool near = focused_ && contains(focus_, box);
  if (near)
    for (Index t : in_focus_) look_at(t);
  for (Index t = near ? static_cast<Index>(first_later_) : 0; t < patch_.triangle_count(); ++t) look_at(t);
  if (near)
    for (std::size_t i : obstacles_near_) remember(obstacles_[i]);
  else
    for (const Nearby& one : obstacles_) remember(one);

  const std::vector<Index> found = input_.triangles_in_box(Vector3(box.low[0], box.low[1], box.low[2]),
                                                           Vector3(box.high[0], box.high[1], box.high[2]));
  ask_input_ = found.size() > most_remembered;
  if (ask_input_) return;
  const TriangleMesh& mesh = input_.mesh();
  for (Index t : found) {
    const Triangle& v = mesh.triangles[t];
    add({mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]});
  }
}

void PatchSurroundings::collect_round(const std::vector<Index>& star, double reach) {
  Box box = box_of(star);
  widen(box, reach);
  collect(box, [&](Index t) { return std::find(star.begin(), star.end(), t) != star.end(); });
}

void PatchSurroundings::add(const Corners& c) {
  if (!collinear(c[0], c[1], c[2])) nearby_.push_back({box_round(c), c});
}

std::size_t PatchSurroundings::met_by(const Corners& triangle, std::size_t enough) const {
  if (collinear(triangle[0], triangle[1], triangle[2])) return 0;
  std::size_t sum = 0;
  const Box box = box_round(triangle);
  for (const Nearby& other : nearby_)
    if (box.meets(other.box) && meet_improperly(triangle, other.corners) && ++sum >= enough) return sum;
  return ask_input_ ? sum + input_triangles_met(input_, triangle, enough - sum).size() : sum;
}

std::size_t PatchSurroundings::met_by_star(const std::vector<Index>& star, std::size_t enough) const {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < star.size() && sum < enough; ++i) {
    const Corners c = corners(star[i]);
    if (collinear(c[0], c[1], c[2])) {
      sum += degenerate_cost;
      continue;
    }
    for (std::size_t j = 0; j < i; ++j) {
      const Corners other = corners(star[j]);
      if (!collinear(other[0], other[1], other[2]) && meet_improperly(c, other)) ++sum;
    }
    if (sum < enough) sum += met_by(c, enough - sum);
  }
  return std::min(sum, enough);
}

}  // namespace meshcomplete
