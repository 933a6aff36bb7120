#include "filter_curveunfold/crossing_removal.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "filter_curveunfold/loop_ring.h"
#include "filter_curveunfold/triangle_moves.h"

namespace meshcomplete {
namespace {

/// Directions of projection beyond the two fitted planes whose crossings are counted.
constexpr int counted_directions = 12;

/// Planes that are tried, those with the fewest crossings first.
constexpr std::size_t tried_planes = 3;

/// A plane seen steeper than this shows the loop as a sliver: the least share of the greatest projected area.
constexpr double least_area_share = 0.6;

/// Loops whose points stand further from a plane than this share of their extent along it bend on the whole:
/// any projection squeezes them, and the descent gives a more open polygon.
constexpr double nearly_planar = 0.2;

/// More crossings than this share of the points are no matter of a few teeth.
constexpr double most_crossings_share = 0.25;

/// Points that may be taken out: so many for each crossing and so many in any case, but no more than a share
/// of all points.
constexpr std::size_t moves_per_crossing = 6;
constexpr std::size_t spare_moves = 12;
constexpr double most_moves_share = 0.3;

/// What stands further from its chord than this (the loop is about 1 across) is no tooth but part of the
/// shape.
constexpr double highest_tooth = 0.1;

/// A loop and its projection, from which the same points are taken.
class ShadowedLoop {
 public:
  using Pair = std::pair<std::size_t, std::size_t>;

  ShadowedLoop(const Loop& loop, const Polygon& shadow)
      : reduced_(unreduced(loop.size())), space_(loop, reduced_.kept), plane_(flat(shadow), reduced_.kept) {
    for (std::size_t edge = 0; edge < loop.size(); ++edge) add_crossings(edge);
  }

  /// Pairs of edges, by their first points, that meet in the projection as the edges of a simple polygon do
  /// not.
  const std::set<Pair>& crossings() const { return crossings_; }

  /// Takes out the point at this crossing that stands out least, if one may go: the move has to be an
  /// isotopy, and the crossings must not become more.
  bool move_at(const Pair& crossing);

  /// What is left and what was taken out.
  ReducedLoop reduced() const {
    ReducedLoop result = reduced_;
    result.kept.clear();
    for (const std::size_t i : reduced_.kept) {
      if (plane_.present[i]) result.kept.push_back(i);
    }
    return result;
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  static Loop flat(const Polygon& polygon) {
    Loop result;
    for (const Vector2& p : polygon) result.emplace_back(p.x(), p.y(), 0);
    return result;
  }

  Vector2 shadow(std::size_t i) const { return plane_.position[i].head<2>(); }

  std::vector<std::size_t> edges_across(std::size_t from, std::size_t to, std::size_t skipped) const;
  void add_crossings(std::size_t edge);
  void remove_crossings_of(std::size_t edge);
  void remove(std::size_t point, const ChordHeight& height);

  ReducedLoop reduced_;  // `kept` stays as it was at the start
  LoopRing space_, plane_;
  std::set<Pair> crossings_;
};

/// The edges that an edge between the points would cross. The edge that starts at `from` is left out, and the
/// one that starts at `skipped`, too.
std::vector<std::size_t> ShadowedLoop::edges_across(std::size_t from, std::size_t to,
                                                    std::size_t skipped) const {
  std::vector<std::size_t> result;
  const Vector2 a = shadow(from), b = shadow(to);
  const LoopTree::Box box = LoopTree::box_of(plane_.position[from], plane_.position[to]);
  plane_.tree.for_each_in_box(box, [&](std::size_t s) {
    if (s == from || s == skipped) return true;
    const std::size_t end = plane_.after[s];
    bool crosses;
    if (s == to)
      crosses = folds_back(a, b, shadow(end));
    else if (end == from)
      crosses = folds_back(shadow(s), a, b);
    else
      crosses = segments_meet(a, b, shadow(s), shadow(end));
    if (crosses) result.push_back(s);
    return true;
  });
  return result;
}

void ShadowedLoop::add_crossings(std::size_t edge) {
  for (const std::size_t other : edges_across(edge, plane_.after[edge], none))
    crossings_.insert(std::minmax(edge, other));
}

void ShadowedLoop::remove_crossings_of(std::size_t edge) {
  for (const std::size_t other : edges_across(edge, plane_.after[edge], none))
    crossings_.erase(std::minmax(edge, other));
}

void ShadowedLoop::remove(std::size_t point, const ChordHeight& height) {
  const std::size_t before = plane_.before[point], after = plane_.after[point];
  remove_crossings_of(before);
  remove_crossings_of(point);
  reduced_.removals.push_back({point, before, after, height.along, height.height / height.chord});
  space_.remove(point);
  plane_.remove(point);
  add_crossings(before);
}

bool ShadowedLoop::move_at(const Pair& crossing) {
  struct Move {
    bool removes_none;  // the crossing only moves on
    bool outside;       // of the shorter part of the loop that the crossing cuts off
    double height;
    std::size_t point;
    ChordHeight chord;
    bool operator<(const Move& other) const {
      return std::tie(removes_none, outside, height, point) <
             std::tie(other.removes_none, other.outside, other.height, other.point);
    }
  };
  const auto& [first, second] = crossing;
  const std::size_t first_end = plane_.after[first], second_end = plane_.after[second];
  const bool short_between = second - first <= plane_.position.size() / 2;
  std::vector<Move> moves;
  for (const std::size_t point : {first, first_end, second, second_end}) {
    const std::size_t before = plane_.before[point], after = plane_.after[point];
    const ChordHeight chord =
        height_over_chord(space_.position[before], space_.position[point], space_.position[after]);
    if (!(chord.chord > contact) || chord.height > highest_tooth) continue;
    const std::size_t now =
        edges_across(before, point, none).size() + edges_across(point, after, none).size();
    const std::size_t then = edges_across(before, after, point).size();
    if (then > now) continue;
    const bool between = point == first_end || point == second;
    moves.push_back({then == now, between != short_between, chord.height, point, chord});
  }
  std::sort(moves.begin(), moves.end());
  for (const Move& move : moves) {
    const std::size_t before = space_.before[move.point], after = space_.after[move.point];
    if (!space_.is_clean(before, space_.position[move.point], after, move.point, contact, contact_angle))
      continue;
    remove(move.point, move.chord);
    return true;
  }
  return false;
}

/// The loop seen along a direction, counter-clockwise on the whole.
Polygon seen_along(const Loop& loop, const Vector3& normal) {
  Polygon polygon = project(loop, plane_with_normal(normal));
  if (signed_area(polygon) < 0) {
    for (Vector2& p : polygon) std::swap(p.x(), p.y());
  }
  return polygon;
}

/// The projections that look promising, those with the fewest crossings first.
std::vector<Polygon> candidates(const Loop& loop, std::size_t most) {
  std::vector<Vector3> normals = fitted_normals(loop);
  for (const Vector3& normal : spread_normals(loop, counted_directions)) normals.push_back(normal);
  const Vector3 area = area_vector(loop);
  std::vector<std::pair<std::size_t, Polygon>> counted;
  for (const Vector3& normal : normals) {
    if (!(std::abs(normal.dot(area)) >= least_area_share * area.norm())) continue;
    Polygon polygon = seen_along(loop, normal);
    // What is worse than the last of those that will be tried is not counted to its end.
    const std::size_t count = count_crossings(polygon, most);
    if (count >= most) continue;
    counted.emplace_back(count, std::move(polygon));
    std::stable_sort(counted.begin(), counted.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    if (counted.size() < tried_planes) continue;
    counted.resize(tried_planes);
    most = counted.back().first;
  }
  std::vector<Polygon> result;
  for (auto& [count, polygon] : counted) result.push_back(std::move(polygon));
  return result;
}

/// Takes points out until the projection is simple or `most_moves` are used up. Returns whether it is simple.
bool untie(ShadowedLoop& loop, std::size_t most_moves, std::size_t& moves, const Progress& progress) {
  std::size_t left = most_moves;
  ShadowedLoop::Pair last;  // the crossing after which the search goes on
  bool moved = true;
  while (!loop.crossings().empty() && moved) {
    moved = false;
    for (auto it = loop.crossings().begin(); it != loop.crossings().end();) {
      last = *it;
      if (left == 0) return false;
      if (loop.move_at(last)) {
        progress.check();
        --left;
        ++moves;
        moved = true;
      }
      it = loop.crossings().upper_bound(last);
    }
  }
  return loop.crossings().empty();
}

}  // namespace

CrossingRemoval remove_crossings(const Loop& loop, const Progress& progress) {
  CrossingRemoval result;
  const PrincipalSpread spread = principal_spread(loop);
  if (spread.least > nearly_planar * spread.greatest) return result;
  const double points = static_cast<double>(loop.size());
  const auto most_crossings = static_cast<std::size_t>(most_crossings_share * points);
  for (const Polygon& shadow : candidates(loop, most_crossings)) {
    ShadowedLoop shadowed(loop, shadow);
    const std::size_t most_moves = std::min(static_cast<std::size_t>(most_moves_share * points),
                                            spare_moves + moves_per_crossing * shadowed.crossings().size());
    if (!untie(shadowed, most_moves, result.moves, progress)) continue;
    const ReducedLoop reduced = shadowed.reduced();
    Polygon kept;
    for (const std::size_t i : reduced.kept) kept.push_back(shadow[i]);
    if (!(signed_area(kept) > 0)) continue;
    Polygon polygon = reinserted(kept, reduced, &shadow);
    if (!is_simple(polygon)) continue;
    result.polygon = std::move(polygon);
    break;
  }
  return result;
}

}  // namespace meshcomplete
