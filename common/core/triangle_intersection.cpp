#include "common/core/triangle_intersection.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/core/box_tree.h"
#include "common/core/threads.h"

namespace meshcomplete {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Corners = std::array<Vector3, 3>;

// Error bounds of the floating-point filters, with u = 2^-53 = 1.1e-16, relative to the greatest magnitudes
// of the factors: a dot product with a difference of points errs by less than 5 u, a component of a cross
// product of differences by 9 u, a dot product of two such cross products by 140 u. The bounds are at least
// twice that. What underflows is below `tiny`, which is therefore no proof of a sign either.
constexpr double error_of_dot = 1.2e-15;
constexpr double error_of_cross = 2.4e-15;
constexpr double error_of_product = 4e-14;
constexpr double tiny = 1e-250;

constexpr std::size_t worth_tree = 48;  // below that many triangles testing all pairs is faster than any tree
constexpr std::size_t worth_threads = 4096;
constexpr std::size_t rows_at_once =
    64;  // triangles held against all others between two looks at the progress

Point point(const Vector3& p) { return Point(p.x(), p.y(), p.z()); }

double magnitude(const Vector3& v) { return v.cwiseAbs().maxCoeff(); }

/// Exact sign of the side of the plane a, b, c on which d lies.
int side(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  return static_cast<int>(CGAL::orientation(point(a), point(b), point(c), point(d)));
}

/// Whether the plane with normal `n` through `apex` provably has both points of `a` strictly on one side and
/// both points of `b` strictly on the other. False proves nothing.
bool separates_at_apex(const Vector3& n, const std::array<Vector3, 2>& a, const std::array<Vector3, 2>& b) {
  const double size = std::max({magnitude(a[0]), magnitude(a[1]), magnitude(b[0]), magnitude(b[1])});
  const double bound = error_of_dot * size * n.cwiseAbs().sum() + tiny;
  const double a0 = n.dot(a[0]), a1 = n.dot(a[1]), b0 = n.dot(b[0]), b1 = n.dot(b[1]);
  return (std::min(a0, a1) > bound && std::max(b0, b1) < -bound) ||
         (std::max(a0, a1) < -bound && std::min(b0, b1) > bound);
}

/// Whether some plane with normal `n` provably lies strictly between the triangles. False proves nothing.
bool separates(const Vector3& n, const Corners& a, const Corners& b) {
  double size = 0, low[2], high[2];
  for (int t = 0; t < 2; ++t)
    for (int i = 0; i < 3; ++i) {
      const Vector3 d = (t ? b : a)[i] - a[0];
      const double along = n.dot(d);
      size = std::max(size, magnitude(d));
      low[t] = i ? std::min(low[t], along) : along;
      high[t] = i ? std::max(high[t], along) : along;
    }
  const double bound = 2 * (error_of_dot * size * n.cwiseAbs().sum() + tiny);
  return low[1] - high[0] > bound || low[0] - high[1] > bound;
}

/// Whether segment p, q meets the triangle; `p_side` and `q_side` are their sides of the triangle's plane.
/// Exact.
bool segment_meets(const Vector3& p, const Vector3& q, int p_side, int q_side, const Corners& t) {
  if (p_side * q_side > 0) return false;
  if (p_side * q_side == 0)
    return CGAL::do_intersect(Kernel::Segment_3(point(p), point(q)),
                              Kernel::Triangle_3(point(t[0]), point(t[1]), point(t[2])));
  int least = 1, greatest = -1;
  for (int i = 0; i < 3; ++i) {
    const int turn = side(p, q, t[i], t[(i + 1) % 3]);
    least = std::min(least, turn);
    greatest = std::max(greatest, turn);
    if (least * greatest < 0) return false;
  }
  return true;
}

/// The sides of the plane of `t` on which the corners of `other` lie; corner `known_zero` (if below 3) is on
/// the plane.
std::array<int, 3> sides(const Corners& t, const Corners& other, int known_zero = 3) {
  std::array<int, 3> s;
  for (int i = 0; i < 3; ++i) s[i] = i == known_zero ? 0 : side(t[0], t[1], t[2], other[i]);
  return s;
}

bool meet_without_shared_corner(const Corners& a, const Corners& b) {
  if (separates((b[0] - a[0]) + (b[1] - a[1]) + (b[2] - a[2]), a, b)) return false;
  const std::array<int, 3> b_sides = sides(a, b);
  if (b_sides[0] == b_sides[1] && b_sides[1] == b_sides[2]) {
    if (b_sides[0] != 0) return false;
    // One plane: try the sides as separating lines before the exact test, which is slow there.
    const Vector3 normal = (a[1] - a[0]).cross(a[2] - a[0]);
    for (int i = 0; i < 3; ++i)
      if (separates(normal.cross(a[(i + 1) % 3] - a[i]), a, b) ||
          separates(normal.cross(b[(i + 1) % 3] - b[i]), a, b))
        return false;
    return CGAL::do_intersect(Kernel::Triangle_3(point(a[0]), point(a[1]), point(a[2])),
                              Kernel::Triangle_3(point(b[0]), point(b[1]), point(b[2])));
  }
  const std::array<int, 3> a_sides = sides(b, a);
  if (a_sides[0] == a_sides[1] && a_sides[1] == a_sides[2]) return false;
  // Two triangles meet where a side of one meets the other.
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (segment_meets(a[i], a[j], a_sides[i], a_sides[j], b)) return true;
    if (segment_meets(b[i], b[j], b_sides[i], b_sides[j], a)) return true;
  }
  return false;
}

/// Corner i of a is corner j of b, nothing else is shared: improper when the side opposite to the corner in
/// one triangle meets the other, for what the triangles have in common is convex and ends at one of these
/// sides.
bool meet_beyond_corner(const Corners& a, int i, const Corners& b, int j) {
  const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
  const std::array<Vector3, 2> from_a = {a[i1] - a[i], a[i2] - a[i]}, from_b = {b[j1] - b[j], b[j2] - b[j]};
  const Vector3 across =
      (from_a[0].normalized() + from_a[1].normalized()) - (from_b[0].normalized() + from_b[1].normalized());
  if (separates_at_apex(across, from_a, from_b)) return false;
  const std::array<int, 3> b_sides = sides(a, b, j);
  if (b_sides[j1] * b_sides[j2] > 0) return false;
  const std::array<int, 3> a_sides = sides(b, a, i);
  if (a_sides[i1] * a_sides[i2] > 0) return false;
  return segment_meets(a[i1], a[i2], a_sides[i1], a_sides[i2], b) ||
         segment_meets(b[j1], b[j2], b_sides[j1], b_sides[j2], a);
}

/// Triangles u, v, p and u, v, q: improper when they are folded flat onto each other.
bool meet_beyond_side(const Vector3& u, const Vector3& v, const Vector3& p, const Vector3& q) {
  const Vector3 along = v - u, to_p = p - u, to_q = q - u;
  // p and q on opposite sides of the line as seen along their own normals: not folded, whether flat or not.
  const double length = magnitude(along);
  const double bound = error_of_product * length * length * magnitude(to_p) * magnitude(to_q) + tiny;
  if (along.cross(to_p).dot(along.cross(to_q)) < -bound) return false;
  return side(u, v, p, q) == 0 &&
         CGAL::coplanar_orientation(point(u), point(v), point(p), point(q)) == CGAL::POSITIVE;
}

Box box_of(const Corners& t) { return bounding_box(t[0], t[1], t[2]); }

/// Box of a triangle; empty when the triangle is to be left out.
Box usable_box(const Corners& t) {
  const Box box = box_of(t);
  return box.low[0] <= box.high[0] && collinear(t[0], t[1], t[2]) ? Box() : box;
}

std::vector<Box> usable_boxes(const std::vector<Corners>& triangles) {
  std::vector<Box> boxes(triangles.size());
  const auto fill = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) boxes[i] = usable_box(triangles[i]);
  };
  if (triangles.size() < worth_threads)
    fill(0, triangles.size());
  else
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, triangles.size(), 1024),
                      [&](const tbb::blocked_range<std::size_t>& r) { fill(r.begin(), r.end()); });
  return boxes;
}

std::vector<Box> reordered(const std::vector<Box>& boxes, const std::vector<Index>& order) {
  std::vector<Box> ordered(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) ordered[i] = boxes[order[i]];
  return ordered;
}

/// Keeps count of pairs and the least `limit` of them.
class PairList {
 public:
  explicit PairList(std::size_t limit) : limit_(limit) {}

  void add(Index i, Index j) {
    ++count_;
    if (limit_ == 0) return;
    pairs_.emplace_back(std::min(i, j), std::max(i, j));
    if (pairs_.size() / 2 > std::max<std::size_t>(limit_, 512)) shorten();
  }
  void add(const PairList& other) {
    count_ += other.count_;
    pairs_.insert(pairs_.end(), other.pairs_.begin(), other.pairs_.end());
  }
  std::size_t count() const { return count_; }
  std::vector<std::pair<Index, Index>> sorted() && {
    std::sort(pairs_.begin(), pairs_.end());
    if (pairs_.size() > limit_) pairs_.resize(limit_);
    return std::move(pairs_);
  }

 private:
  void shorten() {
    std::nth_element(pairs_.begin(), pairs_.begin() + static_cast<std::ptrdiff_t>(limit_), pairs_.end());
    pairs_.resize(limit_);
  }

  std::size_t limit_;
  std::size_t count_ = 0;
  std::vector<std::pair<Index, Index>> pairs_;
};

/// The least `limit` improper pairs among `triangles`, and how many there are.
PairList self_pairs(const std::vector<Corners>& triangles, std::size_t limit, const Progress& progress) {
  PairList found(limit);
  std::vector<Box> boxes = usable_boxes(triangles);
  if (triangles.size() < worth_tree) {
    for (Index i = 0; i < triangles.size(); ++i)
      for (Index j = i + 1; j < triangles.size(); ++j)
        if (boxes[i].meets(boxes[j]) && meet_improperly(triangles[i], triangles[j])) found.add(i, j);
    return found;
  }
  const std::vector<Index> order = spatial_order(boxes);
  const BoxTree tree(reordered(boxes, order));
  std::vector<Box>().swap(boxes);

  const auto search = [&](std::size_t begin, std::size_t end, PairList& list) {
    for (std::size_t i = begin; i < end; ++i) {
      const Corners& triangle = triangles[order[i]];
      tree.visit(
          tree.leaf(i),
          [&](std::size_t j) {
            if (meet_improperly(triangle, triangles[order[j]])) list.add(order[i], order[j]);
            return true;
          },
          i + 1);
    }
  };
  if (triangles.size() < worth_threads) {
    for (std::size_t i = 0; i < triangles.size(); i += rows_at_once) {
      progress.check();
      search(i, std::min(triangles.size(), i + rows_at_once), found);
    }
    return found;
  }
  tbb::enumerable_thread_specific<PairList> lists([limit] { return PairList(limit); });
  for_ranges(triangles.size(), rows_at_once, progress,
             [&](std::size_t begin, std::size_t end) { search(begin, end, lists.local()); });
  for (const PairList& list : lists) found.add(list);
  return found;
}

}  // namespace

bool collinear(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a, ac = c - a;
  if (magnitude(ab.cross(ac)) > error_of_cross * magnitude(ab) * magnitude(ac) + tiny) return false;
  return CGAL::collinear(point(a), point(b), point(c));
}

bool segment_meets_triangle(const Vector3& a, const Vector3& b, const Corners& triangle) {
  return CGAL::do_intersect(Kernel::Segment_3(point(a), point(b)),
                            Kernel::Triangle_3(point(triangle[0]), point(triangle[1]), point(triangle[2])));
}

bool meet_improperly(const Corners& a, const Corners& b) {
  int in_a[3], in_b[3], shared = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (a[i].x() == b[j].x() && a[i].y() == b[j].y() && a[i].z() == b[j].z()) {
        in_a[shared] = i;
        in_b[shared++] = j;
        break;
      }
  switch (shared) {
    case 0:
      return meet_without_shared_corner(a, b);
    case 1:
      return meet_beyond_corner(a, in_a[0], b, in_b[0]);
    case 2:
      return meet_beyond_side(a[in_a[0]], a[in_a[1]], a[3 - in_a[0] - in_a[1]], b[3 - in_b[0] - in_b[1]]);
    default:
      return true;
  }
}

std::vector<std::pair<Index, Index>> improper_pairs(const std::vector<Corners>& triangles, std::size_t limit,
                                                    const Progress& progress) {
  return self_pairs(triangles, limit, progress).sorted();
}

std::size_t count_improper_pairs(const std::vector<Corners>& triangles, const Progress& progress) {
  return self_pairs(triangles, 0, progress).count();
}

std::vector<std::pair<Index, Index>> improper_pairs_between(const std::vector<Corners>& a,
                                                            const std::vector<Corners>& b) {
  // Every triangle of the shorter list is held against the longer one, whose degenerate triangles are only
  // noticed when they come up.
  const bool swapped = a.size() > b.size();
  const std::vector<Corners>&few = swapped ? b : a, &many = swapped ? a : b;
  std::vector<Box> boxes(many.size());
  for (std::size_t i = 0; i < many.size(); ++i) boxes[i] = box_of(many[i]);
  std::vector<std::pair<Index, Index>> pairs;
  const auto test = [&](Index i, Index j) {
    if (!collinear(many[j][0], many[j][1], many[j][2]) && meet_improperly(few[i], many[j]))
      pairs.emplace_back(swapped ? j : i, swapped ? i : j);
    return true;
  };
  if (few.size() * many.size() < worth_tree * worth_tree) {
    for (Index i = 0; i < few.size(); ++i) {
      const Box box = usable_box(few[i]);
      for (Index j = 0; j < many.size(); ++j)
        if (box.meets(boxes[j])) test(i, j);
    }
  } else {
    const std::vector<Index> order = spatial_order(boxes);
    const BoxTree tree(reordered(boxes, order));
    for (Index i = 0; i < few.size(); ++i)
      tree.visit(usable_box(few[i]), [&](std::size_t leaf) { return test(i, order[leaf]); });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace meshcomplete
