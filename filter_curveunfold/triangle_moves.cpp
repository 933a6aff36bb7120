#include "filter_curveunfold/triangle_moves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include "filter_curveunfold/loop_tree.h"

namespace meshcomplete {
namespace {

/// Distances below this share of the loop's size (about 1) are indistinguishable from contact after the
/// rounding of the distance computations; a triangle that comes as near to another strand counts as met.
constexpr double contact = 1e-12;

/// Likewise for directions, radians.
constexpr double contact_angle = 1e-9;

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

/// The loop as a ring from which points are taken and into which they are put.
struct Ring {
  Loop position;
  std::vector<std::size_t> before, after;
  std::vector<char> present;
  LoopTree tree;

  Ring(const Loop& loop, const std::vector<std::size_t>& members)
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

  void remove(std::size_t point) {
    present[point] = 0;
    after[before[point]] = after[point];
    before[after[point]] = before[point];
    tree.remove_segment(point);
    tree.set_segment(before[point], position[before[point]], position[after[point]]);
  }

  void insert(std::size_t point, std::size_t from, std::size_t to) {
    present[point] = 1;
    before[point] = from;
    after[point] = to;
    after[from] = point;
    before[to] = point;
    tree.set_segment(from, position[from], position[point]);
    tree.set_segment(point, position[point], position[to]);
  }

  /// Whether no part of the loop but the edges at `from` and `to` themselves comes nearer than `margin` to
  /// the triangle from - apex - to, and those edges leave it by an angle with a sine above `least_sine`.
  /// `skip` is the point at the apex when it is in the ring.
  bool is_clean(std::size_t from, const Vector3& apex, std::size_t to, std::size_t skip, double margin,
                double least_sine) const {
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
};

struct Height {
  double along;
  double height;
  double chord;
};

Height height_over_chord(const Vector3& a, const Vector3& p, const Vector3& b) {
  const Vector3 chord = b - a;
  const double squared = chord.squaredNorm();
  if (!(squared > 0)) return {0.5, (p - a).norm(), 0};
  const double along = (p - a).dot(chord) / squared;
  const double clamped = std::clamp(along, 0.0, 1.0);
  return {along, (p - a - clamped * chord).norm(), std::sqrt(squared)};
}

/// How often progress is looked at while points are taken out or put back.
constexpr std::size_t progress_interval = 256;

/// Bumps in the plane are no higher than this, in chord lengths: a point that stuck out far in space would
/// only push its neighbours apart.
constexpr double highest_bump = 0.6;

/// Feet of bumps stay away from the ends of the chord by this share of it, so that no edge becomes tiny.
constexpr double foot_margin = 0.1;

/// A bump is halved so often before it is put on the chord itself.
constexpr int most_bump_halvings = 24;

double turning(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 u = b - a, v = c - b;
  return std::atan2(u.x() * v.y() - u.y() * v.x(), u.x() * v.x() + u.y() * v.y());
}

/// The points that may be taken out next, those nearest to their chord first.
class Candidates {
 public:
  struct Entry {
    double height;
    std::size_t point, before, after;  // with the neighbours at the time it was offered
    bool operator>(const Entry& other) const {
      return std::tie(height, point, before, after) >
             std::tie(other.height, other.point, other.before, other.after);
    }
  };

  Candidates(const Ring& ring, const ReductionLimits& limits) : ring_(ring), limits_(limits) {}

  bool at_short_edge(std::size_t p) const {
    return std::min(edge_before(p), edge_after(p)) < limits_.shortest_edge;
  }

  /// Takes a point into the queue when the limits let it out of a loop of `count` points.
  void offer(std::size_t p, std::size_t count) {
    const std::size_t before = ring_.before[p], after = ring_.after[p];
    const Height h = height_over_chord(ring_.position[before], ring_.position[p], ring_.position[after]);
    if (!(h.chord > contact)) return;
    if (!at_short_edge(p)) {
      if (h.height > limits_.largest_height || count <= limits_.least_points) return;
      if (h.chord > limits_.longest_chord && h.chord > std::max(edge_before(p), edge_after(p))) return;
    }
    queue_.push({h.height, p, before, after});
  }

  bool empty() const { return queue_.empty(); }

  Entry pop() {
    const Entry entry = queue_.top();
    queue_.pop();
    return entry;
  }

 private:
  double edge_before(std::size_t p) const {
    return (ring_.position[p] - ring_.position[ring_.before[p]]).norm();
  }
  double edge_after(std::size_t p) const {
    return (ring_.position[p] - ring_.position[ring_.after[p]]).norm();
  }

  const Ring& ring_;
  const ReductionLimits& limits_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue_;
};

/// Whether the limits allow to take the point out, and doing so is an isotopy.
bool may_be_removed(const Ring& ring, const ReductionLimits& limits, const Candidates::Entry& entry,
                    bool tiny) {
  const double margin =
      tiny ? contact : std::max({contact, limits.least_clearance, limits.clearance_share * entry.height});
  const double least_sine =
      tiny ? contact_angle : std::max(contact_angle, std::sin(std::min(limits.least_angle, 1.5)));
  return ring.is_clean(entry.before, ring.position[entry.point], entry.after, entry.point, margin,
                       least_sine);
}

}  // namespace

ReducedLoop unreduced(std::size_t points) {
  ReducedLoop reduced;
  reduced.kept.resize(points);
  for (std::size_t i = 0; i < points; ++i) reduced.kept[i] = i;
  return reduced;
}

Loop kept_points(const Loop& loop, const ReducedLoop& reduced) {
  Loop result;
  result.reserve(reduced.kept.size());
  for (const std::size_t i : reduced.kept) result.push_back(loop[i]);
  return result;
}

void reduce(const Loop& loop, const ReductionLimits& limits, ReducedLoop& reduced, const Progress& progress) {
  Ring ring(loop, reduced.kept);
  Candidates candidates(ring, limits);
  std::size_t count = reduced.kept.size();
  for (const std::size_t p : reduced.kept) candidates.offer(p, count);
  // A point whose triangle was met gets another chance in the next round: what was in its way may be gone by
  // then.
  std::vector<std::size_t> refused;
  std::size_t removed_in_round = 0, looked_at = 0;
  const std::size_t fewest =
      limits.shortest_edge > 0 ? std::min<std::size_t>(6, limits.least_points) : limits.least_points;
  while (count > fewest) {
    if (candidates.empty()) {
      if (refused.empty() || removed_in_round == 0) break;
      removed_in_round = 0;
      for (const std::size_t p : refused) {
        if (ring.present[p]) candidates.offer(p, count);
      }
      refused.clear();
      if (candidates.empty()) break;
    }
    const Candidates::Entry entry = candidates.pop();
    const std::size_t p = entry.point;
    if (!ring.present[p] || ring.before[p] != entry.before || ring.after[p] != entry.after) continue;
    if (++looked_at % progress_interval == 0) progress.check();
    const bool tiny = candidates.at_short_edge(p);
    if (!tiny && count <= limits.least_points) continue;
    if (!may_be_removed(ring, limits, entry, tiny)) {
      refused.push_back(p);
      continue;
    }
    const Height h = height_over_chord(loop[entry.before], loop[p], loop[entry.after]);
    reduced.removals.push_back({p, entry.before, entry.after, h.along, h.height / h.chord});
    ring.remove(p);
    --count;
    ++removed_in_round;
    candidates.offer(entry.before, count);
    candidates.offer(entry.after, count);
  }
  std::vector<std::size_t> kept;
  for (const std::size_t p : reduced.kept) {
    if (ring.present[p]) kept.push_back(p);
  }
  reduced.kept = std::move(kept);
}

Polygon reinserted(const Polygon& polygon, const ReducedLoop& reduced) {
  Loop flat(reduced.kept.size() + reduced.removals.size(), Vector3::Zero());
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    flat[reduced.kept[k]] = Vector3(polygon[k].x(), polygon[k].y(), 0);
  }
  Ring ring(flat, reduced.kept);
  for (auto removal = reduced.removals.rbegin(); removal != reduced.removals.rend(); ++removal) {
    const std::size_t a = removal->before, b = removal->after;
    const Vector3 chord = ring.position[b] - ring.position[a];
    const Vector3 right(chord.y(), -chord.x(), 0);
    const double turn = turning(ring.position[ring.before[a]], ring.position[a], ring.position[b]) +
                        turning(ring.position[a], ring.position[b], ring.position[ring.after[b]]);
    const double side = turn >= 0 ? 1 : -1;
    const double along = std::clamp(removal->along, foot_margin, 1 - foot_margin);
    const Vector3 foot = ring.position[a] + along * chord;
    double height = std::min(removal->height, highest_bump);
    Vector3 apex = foot;
    for (int k = 0; k < most_bump_halvings; ++k, height /= 2) {
      const Vector3 candidate = foot + side * height * right;
      // The bump keeps half its own height of room, so that the next one finds some as well.
      const double margin = height * chord.norm() / 2;
      if (ring.is_clean(a, candidate, b, flat.size(), margin, std::min(0.5, height))) {
        apex = candidate;
        break;
      }
    }
    ring.position[removal->point] = apex;
    ring.insert(removal->point, a, b);
  }
  Polygon result(flat.size());
  for (std::size_t i = 0; i < flat.size(); ++i)
    result[i] = Vector2(ring.position[i].x(), ring.position[i].y());
  return result;
}

}  // namespace meshcomplete
