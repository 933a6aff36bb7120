#include "filter_curveunfold/triangle_moves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>

#include "filter_curveunfold/loop_ring.h"

namespace meshcomplete {
namespace {

/// How often progress is looked at while points are taken out or put back.
constexpr std::size_t progress_interval = 256;

/// Bumps in the plane are no higher than this, in chord lengths: a point that stuck out far in space would
/// only push its neighbours apart.
constexpr double highest_bump = 0.6;

/// Feet of bumps stay away from the ends of the chord by this share of it, so that no edge becomes tiny.
constexpr double foot_margin = 0.1;

/// A bump is halved so often before it is put on the chord itself.
constexpr int most_bump_halvings = 24;

/// A point is brought so often half-way from its wanted place to its chord before a bump to the other side
/// may do.
constexpr int most_wanted_halvings = 4;

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

  Candidates(const LoopRing& ring, const ReductionLimits& limits) : ring_(ring), limits_(limits) {}

  bool at_short_edge(std::size_t p) const {
    return std::min(edge_before(p), edge_after(p)) < limits_.shortest_edge;
  }

  /// Takes a point into the queue when the limits let it out of a loop of `count` points.
  void offer(std::size_t p, std::size_t count) {
    const std::size_t before = ring_.before[p], after = ring_.after[p];
    const ChordHeight h = height_over_chord(ring_.position[before], ring_.position[p], ring_.position[after]);
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

  const LoopRing& ring_;
  const ReductionLimits& limits_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue_;
};

/// Whether the limits allow to take the point out, and doing so is an isotopy.
bool may_be_removed(const LoopRing& ring, const ReductionLimits& limits, const Candidates::Entry& entry,
                    bool tiny) {
  const double margin =
      tiny ? contact : std::max({contact, limits.least_clearance, limits.clearance_share * entry.height});
  const double least_sine =
      tiny ? contact_angle : std::max(contact_angle, std::sin(std::min(limits.least_angle, 1.5)));
  return ring.is_clean(entry.before, ring.position[entry.point], entry.after, entry.point, margin,
                       least_sine);
}

/// The point on its chord that a point taken out is put over.
Vector3 foot_on_chord(const LoopRing& ring, const Removal& removal, double along) {
  const Vector3 &a = ring.position[removal.before], &b = ring.position[removal.after];
  return a + std::clamp(along, foot_margin, 1 - foot_margin) * (b - a);
}

/// Whether a point put back at `apex` leaves the polygon simple and keeps half its height over the chord as
/// room to all sides, so that the next point finds some as well.
bool has_room(const LoopRing& ring, const Removal& removal, const Vector3& apex, double height) {
  const double chord = (ring.position[removal.after] - ring.position[removal.before]).norm();
  return ring.is_clean(removal.before, apex, removal.after, ring.position.size(), height * chord / 2,
                       std::min(0.5, height));
}

/// A place for the point over its chord, to the outside where the polygon is convex.
Vector3 bump(const LoopRing& ring, const Removal& removal) {
  const std::size_t a = removal.before, b = removal.after;
  const Vector3 chord = ring.position[b] - ring.position[a];
  const Vector3 right(chord.y(), -chord.x(), 0);
  const double turn = turning(ring.position[ring.before[a]], ring.position[a], ring.position[b]) +
                      turning(ring.position[a], ring.position[b], ring.position[ring.after[b]]);
  const double side = turn >= 0 ? 1 : -1;
  const Vector3 foot = foot_on_chord(ring, removal, removal.along);
  double height = std::min(removal.height, highest_bump);
  for (int k = 0; k < most_bump_halvings; ++k, height /= 2) {
    const Vector3 candidate = foot + side * height * right;
    if (has_room(ring, removal, candidate, height)) return candidate;
  }
  return foot;
}

/// The wanted place of a point, or one on the way from there to its chord; none when there is room next to
/// the chord only.
std::optional<Vector3> near_wanted_place(const LoopRing& ring, const Removal& removal,
                                         const Vector2& wanted) {
  const Vector3 place(wanted.x(), wanted.y(), 0);
  const ChordHeight h = height_over_chord(ring.position[removal.before], place, ring.position[removal.after]);
  if (!(h.chord > 0)) return std::nullopt;
  const Vector3 foot = foot_on_chord(ring, removal, h.along);
  double share = 1;
  for (int k = 0; k < most_wanted_halvings; ++k, share /= 2) {
    const Vector3 candidate = foot + share * (place - foot);
    const double height = share * h.height / h.chord;
    if (height <= highest_bump && has_room(ring, removal, candidate, height)) return candidate;
  }
  return std::nullopt;
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
  LoopRing ring(loop, reduced.kept);
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
    const ChordHeight h = height_over_chord(loop[entry.before], loop[p], loop[entry.after]);
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

Polygon reinserted(const Polygon& polygon, const ReducedLoop& reduced, const Polygon* wanted) {
  Loop flat(reduced.kept.size() + reduced.removals.size(), Vector3::Zero());
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    flat[reduced.kept[k]] = Vector3(polygon[k].x(), polygon[k].y(), 0);
  }
  LoopRing ring(flat, reduced.kept);
  for (auto removal = reduced.removals.rbegin(); removal != reduced.removals.rend(); ++removal) {
    std::optional<Vector3> place;
    if (wanted) place = near_wanted_place(ring, *removal, (*wanted)[removal->point]);
    ring.position[removal->point] = place ? *place : bump(ring, *removal);
    ring.insert(removal->point, removal->before, removal->after);
  }
  Polygon result(flat.size());
  for (std::size_t i = 0; i < flat.size(); ++i)
    result[i] = Vector2(ring.position[i].x(), ring.position[i].y());
  return result;
}

}  // namespace meshcomplete
