#include "filter_curveunfold/loop_ring.h"

#include <algorithm>
#include <cmath>

namespace meshcomplete {
namespace {

/// The sine of the angle between the unit vector `w` and the nearest direction s x + t y with s, t >= 0
/// (1 when that angle is a right angle or more).
double sine_to_wedge(const Vector3& w, const Vector3& x, const Vector3& y) {
  const auto to_ray = [&w](const Vector3& ray) {
    const double length = ray.norm();
    if (!(length > 0) || w.dot(ray) <= 0) return 1.0;
    return w.cross(ray).norm() / length;
  };
  double best = std::min(to_ray(x), to_ray(y));
  const Vector3 normal = x.cross(y);
  const double squared = normal.squaredNorm();
  if (squared > 0 && w.cross(y).dot(normal) > 0 && x.cross(w).dot(normal) > 0) {
    best = std::min(best, std::abs(w.dot(normal)) / std::sqrt(squared));
  }
  return best;
}

}  // namespace

LoopRing::LoopRing(const Loop& loop, const std::vector<std::size_t>& members)
    : position(loop), before(loop.size()), after(loop.size()), present(loop.size(), 0), tree(loop) {
  for (std::size_t k = 0; k < members.size(); ++k) {
    const std::size_t next = members[(k + 1) % members.size()];
    present[members[k]] = 1;
    after[members[k]] = next;
    before[next] = members[k];
  }
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (!present[i]) {
      tree.remove_segment(i);
    } else if (after[i] != (i + 1) % loop.size()) {
      tree.set_segment(i, position[i], position[after[i]]);
    }
  }
}

void LoopRing::remove(std::size_t point) {
  present[point] = 0;
  after[before[point]] = after[point];
  before[after[point]] = before[point];
  tree.remove_segment(point);
  tree.set_segment(before[point], position[before[point]], position[after[point]]);
}

void LoopRing::insert(std::size_t point, std::size_t from, std::size_t to) {
  present[point] = 1;
  before[point] = from;
  after[point] = to;
  after[from] = point;
  before[to] = point;
  tree.set_segment(from, position[from], position[point]);
  tree.set_segment(point, position[point], position[to]);
}

bool LoopRing::is_clean(std::size_t from, const Vector3& apex, std::size_t to, std::size_t skip,
                        double margin, double least_sine) const {
  const Vector3 &a = position[from], &b = position[to];
  const std::size_t outer_from = before[from], outer_to = after[to];
  if (outer_from != to && outer_from != outer_to) {
    if (sine_to_wedge((position[outer_from] - a).normalized(), b - a, apex - a) <= least_sine) return false;
    if (sine_to_wedge((position[outer_to] - b).normalized(), a - b, apex - b) <= least_sine) return false;
  }
  LoopTree::Box box = LoopTree::box_of(a, b);
  for (int k = 0; k < 3; ++k) {
    box.low[k] = std::min(box.low[k], apex[k]) - margin;
    box.high[k] = std::max(box.high[k], apex[k]) + margin;
  }
  return tree.for_each_in_box(box, [&](std::size_t s) {
    if (s == from || s == skip || s == outer_from || s == to) return true;
    return squared_distance_to_triangle(position[s], position[after[s]], a, b, apex) > margin * margin;
  });
}

ChordHeight height_over_chord(const Vector3& a, const Vector3& p, const Vector3& b) {
  const Vector3 chord = b - a;
  const double squared = chord.squaredNorm();
  if (!(squared > 0)) return {0.5, (p - a).norm(), 0};
  const double along = (p - a).dot(chord) / squared;
  const double clamped = std::clamp(along, 0.0, 1.0);
  return {along, (p - a - clamped * chord).norm(), std::sqrt(squared)};
}

}  // namespace meshcomplete
