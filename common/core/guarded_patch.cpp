#include "common/core/guarded_patch.h"

#include <algorithm>

#include "common/core/patch.h"
#include "common/core/triangle_blocks.h"
#include "common/core/triangle_intersection.h"

namespace meshcomplete {
namespace {

Box box_round(const std::array<Vector3, 3>& c) { return bounding_box(c[0], c[1], c[2]); }

bool contains(const std::vector<Index>& list, Index value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

}  // namespace

GuardedPatch::GuardedPatch(PatchMesh& patch, const InputNeighbourhood& input, const ForbiddenEdges& forbidden,
                           const std::vector<Corners>& obstacles)
    : patch_(patch), input_(input), forbidden_(forbidden), obstacles_(obstacles) {
  for (Index t = 0; t < patch.triangle_count(); ++t)
    if (patch.alive(t)) update(t);
  for (Index i = 0; i < obstacles.size(); ++i) obstacle_boxes_.set(i, box_round(obstacles[i]));
}

void GuardedPatch::rest(Index vertex, Index input_triangle) {
  if (vertex >= resting_.size()) resting_.resize(vertex + 1, none);
  resting_[vertex] = input_triangle;
}

GuardedPatch::Corners GuardedPatch::corners(const Triangle& t) const {
  return {patch_.position(t[0]), patch_.position(t[1]), patch_.position(t[2])};
}

void GuardedPatch::update(Index triangle) {
  boxes_.set(triangle, box_round(corners(patch_.triangles()[triangle])));
}

void GuardedPatch::star(Index vertex, std::vector<Index>& triangles) const {
  triangles.clear();
  patch_.for_outgoing(vertex, [&](Index h) { triangles.push_back(h / 3); });
}

bool GuardedPatch::forbidden(Index a, Index b) const {
  if (!patch_.on_rim(a) || !patch_.on_rim(b)) return false;
  return std::binary_search(forbidden_.begin(), forbidden_.end(),
                            std::make_pair(std::min(a, b), std::max(a, b)));
}

bool GuardedPatch::input_is_free(const Fresh& one) const {
  std::array<Index, 3> ignored;
  for (int k = 0; k < 3; ++k)
    ignored[k] = one.vertices[k] < resting_.size() ? resting_[one.vertices[k]] : none;
  const TriangleMesh& mesh = input_.mesh();
  bool free = true;
  input_.blocks().visit(box_round(one.corners), [&](Index t) {
    if (t == ignored[0] || t == ignored[1] || t == ignored[2]) return true;
    const auto& [a, b, c] = mesh.triangles[t];
    const Corners other = {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
    free = collinear(other[0], other[1], other[2]) || !meet_improperly(one.corners, other);
    return free;
  });
  return free;
}

bool GuardedPatch::is_free(const Fresh& one, const std::vector<Index>& replaced) const {
  if (collinear(one.corners[0], one.corners[1], one.corners[2])) return false;
  const Box box = box_round(one.corners);
  return boxes_.visit(box, [&](Index t) {
    if (contains(replaced, t)) return true;
    const Corners other = corners(patch_.triangles()[t]);
    return collinear(other[0], other[1], other[2]) || !meet_improperly(one.corners, other);
  }) && obstacle_boxes_.visit(box, [&](Index i) {
    return !meet_improperly(one.corners, obstacles_[i]);
  }) && input_is_free(one);
}

bool GuardedPatch::all_free(const std::vector<Fresh>& fresh, const std::vector<Index>& replaced) const {
  for (const Fresh& one : fresh)
    if (collinear(one.corners[0], one.corners[1], one.corners[2])) return false;
  for (std::size_t i = 0; i < fresh.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (meet_improperly(fresh[i].corners, fresh[j].corners)) return false;
  return std::all_of(fresh.begin(), fresh.end(), [&](const Fresh& one) { return is_free(one, replaced); });
}

bool GuardedPatch::is_clean(Index triangle) const {
  const Triangle& t = patch_.triangles()[triangle];
  return is_free({corners(t), t}, {triangle});
}

bool GuardedPatch::move(Index vertex, const Vector3& to) {
  const Vector3 place = as_stored(to), before = patch_.position(vertex);
  if (patch_.on_rim(vertex) || !place.allFinite()) return false;
  if (place == before) return true;
  std::vector<Index> triangles;
  star(vertex, triangles);
  std::vector<Fresh> fresh;
  for (Index t : triangles) {
    const Triangle& v = patch_.triangles()[t];
    Corners c = corners(v);
    for (int k = 0; k < 3; ++k)
      if (v[k] == vertex) c[k] = place;
    fresh.push_back({c, v});
  }
  if (!all_free(fresh, triangles)) return false;
  patch_.move(vertex, place);
  for (Index t : triangles) update(t);
  return true;
}

Index GuardedPatch::split(Index h, const Vector3& position) {
  if (patch_.is_boundary(h)) return none;
  const Vector3 place = as_stored(position);
  const Index g = patch_.opposite(h);
  const Index a = patch_.origin(h), b = patch_.target(h), c = patch_.apex(h), d = patch_.apex(g);
  const Vector3 &pa = patch_.position(a), &pb = patch_.position(b), &pc = patch_.position(c),
                &pd = patch_.position(d);
  const std::vector<Fresh> fresh = {{{pa, place, pc}, {a, none, c}},
                                    {{place, pb, pc}, {none, b, c}},
                                    {{pb, place, pd}, {b, none, d}},
                                    {{place, pa, pd}, {none, a, d}}};
  if (!place.allFinite() || !all_free(fresh, {h / 3, g / 3})) return none;
  const Index first_new = static_cast<Index>(patch_.triangle_count());
  const Index vertex = patch_.split(h, place);
  for (Index t : {h / 3, g / 3, first_new, first_new + 1}) update(t);
  return vertex;
}

bool GuardedPatch::flip(Index h) {
  if (!can_flip(patch_, h, forbidden_)) return false;
  const Index g = patch_.opposite(h);
  const Index a = patch_.origin(h), b = patch_.target(h), c = patch_.apex(h), d = patch_.apex(g);
  const Vector3 &pa = patch_.position(a), &pb = patch_.position(b), &pc = patch_.position(c),
                &pd = patch_.position(d);
  if (!all_free({{{pc, pd, pb}, {c, d, b}}, {{pd, pc, pa}, {d, c, a}}}, {h / 3, g / 3})) return false;
  patch_.flip(h);
  update(h / 3);
  update(g / 3);
  return true;
}

// Whether the triangles round `gone` are free when it lies on `kept`, and no edge is made that must not be.
bool GuardedPatch::collapse_is_free(Index gone, Index kept) const {
  std::vector<Index> triangles;
  star(gone, triangles);
  std::vector<Fresh> fresh;
  for (Index t : triangles) {
    Triangle v = patch_.triangles()[t];
    if (std::find(v.begin(), v.end(), kept) != v.end()) continue;
    for (Index& corner : v) {
      if (corner == gone)
        corner = kept;
      else if (forbidden(corner, kept))
        return false;
    }
    fresh.push_back({corners(v), v});
  }
  return all_free(fresh, triangles);
}

bool GuardedPatch::collapse(Index h) {
  const Index gone = patch_.origin(h), kept = patch_.target(h);
  if (!patch_.can_collapse(h) || !collapse_is_free(gone, kept)) return false;
  std::vector<Index> triangles;
  star(gone, triangles);
  patch_.collapse(h);
  for (Index t : triangles)
    if (patch_.alive(t))
      update(t);
    else
      boxes_.remove(t);
  return true;
}

bool GuardedPatch::collapse_at_boundary(Index h, bool onto_target) {
  if (!patch_.can_collapse_at_boundary(h, onto_target)) return false;
  const Index gone = onto_target ? patch_.origin(h) : patch_.target(h);
  const Index kept = onto_target ? patch_.target(h) : patch_.origin(h);
  if (!collapse_is_free(gone, kept)) return false;
  std::vector<Index> triangles;
  star(gone, triangles);
  patch_.collapse_at_boundary(h, onto_target);
  for (Index t : triangles)
    if (patch_.alive(t))
      update(t);
    else
      boxes_.remove(t);
  return true;
}

bool GuardedPatch::remove_ear(Index vertex) {
  if (!patch_.can_remove_ear(vertex)) return false;
  const Index triangle = patch_.leaving_along_boundary(vertex) / 3;
  patch_.remove_ear(vertex);
  boxes_.remove(triangle);
  return true;
}

bool GuardedPatch::fill_at_boundary(Index vertex, const Vector3& position) {
  const Vector3 place = as_stored(position);
  if (!place.allFinite() || !patch_.can_fill_at_boundary(vertex)) return false;
  const Index a = patch_.origin(patch_.arriving_along_boundary(vertex)),
              b = patch_.target(patch_.leaving_along_boundary(vertex));
  if (forbidden(a, b)) return false;
  std::vector<Index> triangles;
  star(vertex, triangles);
  // The vertex rests on nothing at its new place.
  std::vector<Fresh> fresh = {{{patch_.position(a), patch_.position(b), place}, {a, b, none}}};
  for (Index t : triangles) {
    Triangle v = patch_.triangles()[t];
    Corners c = corners(v);
    for (int k = 0; k < 3; ++k)
      if (v[k] == vertex) {
        c[k] = place;
        v[k] = none;
      }
    fresh.push_back({c, v});
  }
  if (!all_free(fresh, triangles)) return false;
  patch_.move(vertex, place);
  triangles.push_back(patch_.fill_at_boundary(vertex));
  for (Index t : triangles) update(t);
  if (vertex < resting_.size()) resting_[vertex] = none;
  return true;
}

}  // namespace meshcomplete
