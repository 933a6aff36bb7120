#include "common/core/touching_fans.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <unordered_map>

#include "common/core/triangle_intersection.h"

namespace meshcomplete {
namespace {

constexpr Index none = SheetVertex::none;

// Parts of the shortest edge at a vertex by which it moves, those tried first first.
constexpr std::array<double, 4> separations = {0.1, 0.03, 0.01, 0.003};

// How far a way along a triangle of the fan leaves it towards its back.
constexpr double tilt = 0.2;

using Corners = std::array<Vector3, 3>;

class Retreat {
 public:
  Retreat(const TriangleMesh& mesh, const std::vector<Triangle>& triangles,
          std::vector<SheetVertex>& vertices)
      : mesh_(mesh), triangles_(triangles), vertices_(vertices) {}

  void run(const std::vector<TouchingFan>& fans);

 private:
  void list_triangles();
  void collect_stars(const std::vector<TouchingFan>& fans);
  void move(const TouchingFan& fan);
  std::vector<Vector3> directions(Index vertex) const;
  std::vector<Corners> rivals(const TouchingFan& fan) const;
  bool is_free(Index vertex, const Vector3& place, const std::vector<Corners>& rivals) const;
  Corners corners(Index t) const {
    const auto& [a, b, c] = triangles_[t];
    return {vertices_[a].position, vertices_[b].position, vertices_[c].position};
  }
  Corners input_corners(Index t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return {mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]};
  }
  template <class Visit>
  void for_triangles(Index vertex, Visit&& visit) const {
    for (std::size_t i = first_[vertex]; i < first_[vertex + 1]; ++i) visit(at_[i]);
  }

  const TriangleMesh& mesh_;
  const std::vector<Triangle>& triangles_;
  std::vector<SheetVertex>& vertices_;
  std::vector<std::size_t> first_;                      // of each vertex, in `at_`
  std::vector<Index> at_;                               // the triangles at each vertex
  std::unordered_map<Index, std::vector<Index>> star_;  // the mesh's triangles at boundary vertices with fans
};

void Retreat::list_triangles() {
  first_.assign(vertices_.size() + 1, 0);
  for (const Triangle& t : triangles_)
    for (Index v : t) ++first_[v + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  at_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (Index t = 0; t < triangles_.size(); ++t)
    for (Index v : triangles_[t]) at_[next[v]++] = t;
}

void Retreat::collect_stars(const std::vector<TouchingFan>& fans) {
  for (const TouchingFan& fan : fans)
    if (fan.input != none) star_[fan.input];
  if (star_.empty()) return;
  std::vector<char> wanted(mesh_.vertices.size(), 0);
  for (const auto& entry : star_) wanted[entry.first] = 1;
  for (Index t = 0; t < mesh_.triangles.size(); ++t) {
    const Triangle& c = mesh_.triangles[t];
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    for (Index v : c)
      if (wanted[v]) star_[v].push_back(t);
  }
}

// Straight back first, then along each triangle of the fan and a little to its back.
std::vector<Vector3> Retreat::directions(Index vertex) const {
  const Vector3& here = vertices_[vertex].position;
  std::vector<Vector3> found;
  Vector3 sum = Vector3::Zero();
  for_triangles(vertex, [&](Index t) {
    const Corners c = corners(t);
    const Vector3 area = (c[1] - c[0]).cross(c[2] - c[0]);
    sum += area;
    const Vector3 along = (c[0] + c[1] + c[2]) / 3 - here;
    if (area.norm() > 0 && along.norm() > 0)
      found.push_back((along.normalized() - tilt * area.normalized()).normalized());
  });
  if (sum.norm() > 0) found.insert(found.begin(), -sum.normalized());
  return found;
}

// What the fan's triangles must not meet: the mesh at the position, and the patch round the fan.
std::vector<Corners> Retreat::rivals(const TouchingFan& fan) const {
  std::vector<Index> near;
  for_triangles(fan.vertex, [&](Index t) {
    for (Index v : triangles_[t])
      if (v != fan.vertex) for_triangles(v, [&](Index other) { near.push_back(other); });
  });
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  std::vector<Corners> list;
  for (Index t : near) {
    const Triangle& c = triangles_[t];
    if (std::find(c.begin(), c.end(), fan.vertex) == c.end()) list.push_back(corners(t));
  }
  if (fan.rim_edge != none) list.push_back(input_corners(fan.rim_edge / 3));
  if (fan.input != none)
    for (Index t : star_.at(fan.input)) list.push_back(input_corners(t));
  list.erase(
      std::remove_if(list.begin(), list.end(), [](const Corners& c) { return collinear(c[0], c[1], c[2]); }),
      list.end());
  return list;
}

bool Retreat::is_free(Index vertex, const Vector3& place, const std::vector<Corners>& rivals) const {
  std::vector<Corners> moved;
  bool free = true;
  for_triangles(vertex, [&](Index t) {
    moved.push_back(corners(t));
    for (int k = 0; k < 3; ++k)
      if (triangles_[t][k] == vertex) moved.back()[k] = place;
    const Corners& c = moved.back();
    free = free && !collinear(c[0], c[1], c[2]);
  });
  return free && improper_pairs(moved, 1).empty() && improper_pairs_between(moved, rivals).empty();
}

void Retreat::move(const TouchingFan& fan) {
  const Vector3 here = vertices_[fan.vertex].position;
  double shortest = std::numeric_limits<double>::infinity();
  for_triangles(fan.vertex, [&](Index t) {
    for (Index v : triangles_[t])
      if (v != fan.vertex) shortest = std::min(shortest, (vertices_[v].position - here).norm());
  });
  const std::vector<Vector3> ways = directions(fan.vertex);
  const std::vector<Corners> others = rivals(fan);
  for (double part : separations)
    for (const Vector3& way : ways) {
      const Vector3 place = here + part * shortest * way;
      if (!is_free(fan.vertex, place, others)) continue;
      vertices_[fan.vertex].position = place;
      return;
    }
  if (!ways.empty()) vertices_[fan.vertex].position = here + separations.back() * shortest * ways.front();
}

void Retreat::run(const std::vector<TouchingFan>& fans) {
  if (fans.empty()) return;
  list_triangles();
  collect_stars(fans);
  for (const TouchingFan& fan : fans) move(fan);
}

}  // namespace

void retreat(const TriangleMesh& mesh, const std::vector<TouchingFan>& fans,
             const std::vector<Triangle>& triangles, std::vector<SheetVertex>& vertices) {
  Retreat(mesh, triangles, vertices).run(fans);
}

}  // namespace meshcomplete
