#include "common/core/lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <random>
#include <vector>

namespace meshcomplete {
namespace {

// Everything is compared with integers of any length; what is no integer is a point over a common
// denominator.
using Integer = boost::multiprecision::cpp_int;
using IntegerPoint = std::array<Integer, 3>;

IntegerPoint integers(const LatticePoint& p) { return {Integer(p[0]), Integer(p[1]), Integer(p[2])}; }

IntegerPoint minus(const IntegerPoint& a, const IntegerPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

IntegerPoint times(const IntegerPoint& a, const Integer& factor) {
  return {a[0] * factor, a[1] * factor, a[2] * factor};
}

IntegerPoint cross(const IntegerPoint& u, const IntegerPoint& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

Integer dot(const IntegerPoint& u, const IntegerPoint& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }

IntegerPoint normal_of(const LatticeTriangle& t) {
  return cross(minus(integers(t[1]), integers(t[0])), minus(integers(t[2]), integers(t[0])));
}

/// Six times the volume of the tetrahedron.
Integer volume(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c, const LatticePoint& d) {
  return dot(normal_of({a, b, c}), minus(integers(d), integers(a)));
}

int sign(const Integer& i) { return (i > 0) - (i < 0); }

/// `at` over `denominator`, which is positive.
struct Fraction {
  IntegerPoint at;
  Integer denominator;
};

/// Whether anything of the convex polygon, or of the segment when it has two corners, is left after cutting
/// it with the six half spaces of the box.
bool anything_left(const std::vector<LatticePoint>& corners, const LatticeBox& box) {
  std::vector<Fraction> polygon, left;
  for (const LatticePoint& p : corners) polygon.push_back({integers(p), 1});
  for (std::size_t k = 0; k < 3; ++k)
    for (int side : {1, -1}) {
      const Integer bound(side > 0 ? box.high[k] : box.low[k]);
      const auto beyond = [&](const Fraction& p) {
        return Integer((p.at[k] - bound * p.denominator) * side);
      };
      left.clear();
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Fraction &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const Integer at_a = beyond(a), at_b = beyond(b);
        if (at_a <= 0) left.push_back(a);
        if (sign(at_a) * sign(at_b) >= 0) continue;
        const Integer of_a = abs(at_b), of_b = abs(at_a);
        Fraction between;
        for (std::size_t m = 0; m < 3; ++m) between.at[m] = a.at[m] * of_a + b.at[m] * of_b;
        between.denominator = a.denominator * of_a + b.denominator * of_b;
        left.push_back(between);
      }
      polygon = left;
    }
  return !polygon.empty();
}

bool truly_meets(const LatticeTriangle& t, const LatticeBox& box) {
  return anything_left({t[0], t[1], t[2]}, box);
}

bool truly_meets(const LatticePoint& a, const LatticePoint& b, const LatticeBox& box) {
  return anything_left({a, b}, box);
}

/// Points of several kinds: anywhere in the cube, on a coarse grid (so that many are collinear, coplanar and
/// equal), and at the corners of the cube (so that numbers are as large as they get).
class Points {
 public:
  Points(unsigned seed, int kind) : random_(seed), kind_(kind) {}

  std::int64_t below(std::int64_t n) { return static_cast<std::int64_t>(random_() % std::uint64_t(n)); }

  LatticePoint point() {
    LatticePoint p;
    for (std::int64_t& c : p) switch (kind_) {
        case 0:
          c = below(Lattice::steps + 1);
          break;
        case 1:
          c = 2 * below(9) + 1;
          break;
        case 2:
          c = below(2) == 0 ? below(3) : Lattice::steps - below(3);
          break;
        default:
          c = below(12);
      }
    return p;
  }

  LatticeTriangle triangle() { return {point(), point(), point()}; }

  /// With even sides, some of them flat along an axis or two.
  LatticeBox box() {
    LatticeBox box{point(), point()};
    const std::int64_t flat = below(8);
    for (std::size_t k = 0; k < 3; ++k) {
      if (box.low[k] > box.high[k]) std::swap(box.low[k], box.high[k]);
      box.low[k] -= box.low[k] % 2;
      box.high[k] += box.high[k] % 2;
      if (flat == static_cast<std::int64_t>(k) || flat == 3) box.high[k] = box.low[k];
    }
    return box;
  }

 private:
  std::mt19937_64 random_;
  int kind_;
};

constexpr int kinds = 4;

TEST(Lattice, SnapsToTheNearestOddCoordinates) {
  std::mt19937_64 random(1);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (double side : {1.0, 0.37, 1e6, 3e-4})
    for (int i = 0; i < 500; ++i) {
      const Vector3 origin = side * Vector3(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5);
      const Lattice lattice(origin, side);
      const Vector3 p = origin + side * Vector3(uniform(), uniform(), uniform());
      const LatticePoint snapped = lattice.snap(p);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(snapped[k] % 2, 1);
        EXPECT_GT(snapped[k], 0);
        EXPECT_LT(snapped[k], Lattice::steps);
      }
      const Vector3 moved = lattice.position(snapped) - p;
      EXPECT_LE(moved.cwiseAbs().maxCoeff(), 1.001 * lattice.step() + 1e-15 * side);
      EXPECT_EQ(lattice.snap(lattice.position(snapped)), snapped);
    }
}

TEST(Lattice, ABoxIsSurroundedByAllThatSnapsIntoIt) {
  std::mt19937_64 random(2);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (double distance : {0.0, 1.0, 1e5, 1e9})
    for (int i = 0; i < 2000; ++i) {
      const Vector3 origin = distance * Vector3(uniform(), -uniform(), uniform());
      const Lattice lattice(origin, 1);
      const Vector3 p = origin + Vector3(uniform(), uniform(), uniform());
      // The smallest even box round the snapped point, and the point on each of its sides in turn.
      const LatticePoint at = lattice.snap(p);
      const LatticeBox box{{at[0] - 1, at[1] - 1, at[2] - 1}, {at[0] + 1, at[1] + 1, at[2] + 1}};
      const Box around = lattice.around(box);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LE(around.low[k], p[static_cast<int>(k)]);
        EXPECT_GE(around.high[k], p[static_cast<int>(k)]);
        EXPECT_LT(around.high[k] - around.low[k], 20 * lattice.step() + 4e-15 * (distance + 1));
      }
    }
}

TEST(Lattice, OrientationIsTheSignOfTheVolume) {
  for (int kind = 0; kind < kinds; ++kind) {
    Points points(3, kind);
    int zeros = 0;
    for (int i = 0; i < 20000; ++i) {
      const LatticePoint a = points.point(), b = points.point(), c = points.point(), d = points.point();
      const int expected = sign(volume(a, b, c, d));
      zeros += expected == 0;
      ASSERT_EQ(orientation(a, b, c, d), expected);
    }
    if (kind != 0) {
      EXPECT_GT(zeros, 50) << "kind " << kind;
    }
  }
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1) << "the side of the normal";
}

// The largest numbers there are, and a volume of one step of 2^-113 of the cube's: doubles would say 0.
TEST(Lattice, OrientationHasNoOverflow) {
  const std::int64_t n = Lattice::steps;
  const LatticePoint a{0, 0, 0}, b{n, n, 0}, c{n, 0, n};
  EXPECT_EQ(orientation(a, b, c, {0, n, n}), sign(volume(a, b, c, {0, n, n})));
  EXPECT_EQ(orientation(a, {n, n - 1, n}, {n - 1, n - 2, n - 1}, {n, n - 1, n}), 0);
  EXPECT_EQ(orientation(a, {n, n - 1, n}, {n - 1, n - 2, n - 1}, {n, n - 1, n - 1}),
            sign(volume(a, {n, n - 1, n}, {n - 1, n - 2, n - 1}, {n, n - 1, n - 1})));
}

TEST(Lattice, NormalSignsAreThoseOfTheNormal) {
  for (int kind = 0; kind < kinds; ++kind) {
    Points points(4, kind);
    for (int i = 0; i < 2000; ++i) {
      const LatticeTriangle t = points.triangle();
      const IntegerPoint normal = normal_of(t);
      for (int axis = 0; axis < 3; ++axis)
        ASSERT_EQ(normal_sign(t, axis), sign(normal[static_cast<std::size_t>(axis)]));
    }
  }
}

TEST(Lattice, TrianglesMeetBoxesWhenAnythingOfThemIsInside) {
  for (int kind = 0; kind < kinds; ++kind) {
    Points points(5, kind);
    int meeting = 0;
    for (int i = 0; i < 20000; ++i) {
      const LatticeTriangle t = points.triangle();
      const LatticeBox box = points.box();
      const bool expected = truly_meets(t, box);
      meeting += expected;
      ASSERT_EQ(meets(t, box), expected) << "kind " << kind << " case " << i;
    }
    EXPECT_GT(meeting, 1000);
    EXPECT_LT(meeting, 19000);
  }
}

TEST(Lattice, SegmentsMeetBoxesWhenAnythingOfThemIsInside) {
  for (int kind = 0; kind < kinds; ++kind) {
    Points points(6, kind);
    int meeting = 0;
    for (int i = 0; i < 20000; ++i) {
      const LatticePoint a = points.point(), b = points.point();
      const LatticeBox box = points.box();
      const bool expected = truly_meets(a, b, box);
      meeting += expected;
      ASSERT_EQ(meets(a, b, box), expected) << "kind " << kind << " case " << i;
    }
    EXPECT_GT(meeting, 1000);
    EXPECT_LT(meeting, 19000);
  }
}

// A triangle whose plane, or one of whose sides, goes exactly through a corner or an edge of the box, and the
// same one step further off.
TEST(Lattice, TouchingABoxIsMeetingIt) {
  const LatticeBox box{{256, 256, 256}, {512, 512, 512}};
  const LatticeTriangle corner = {{{512, 512, 512}, {900, 700, 600}, {700, 900, 600}}};
  EXPECT_TRUE(meets(corner, box));
  const LatticeTriangle plane = {{{1536 + 400, -400, 0}, {-400, 1536 + 400, 0}, {0, 0, 1536}}};
  EXPECT_TRUE(meets(plane, box)) << "x + y + z = 1536 touches the corner";
  LatticeTriangle beyond = plane;
  for (LatticePoint& p : beyond) ++p[0];
  EXPECT_FALSE(meets(beyond, box));
  const LatticeTriangle edge = {{{512, 600, 400}, {600, 512, 400}, {700, 700, 10000}}};
  EXPECT_FALSE(meets(edge, box));
  EXPECT_TRUE(meets(LatticePoint{512, 512, 0}, LatticePoint{512, 512, 1000}, box)) << "along an edge";
  EXPECT_FALSE(meets(LatticePoint{513, 512, 0}, LatticePoint{512, 513, 1000}, box));
  EXPECT_TRUE(meets(LatticePoint{412, 612, 300}, LatticePoint{612, 412, 300}, box)) << "across an edge";
  EXPECT_FALSE(meets(LatticePoint{413, 612, 300}, LatticePoint{613, 412, 300}, box));
}

/// How the segment passes through the triangle, by exact integers.
struct Way {
  bool meets = false;    ///< segment and triangle have a point in common, and do not lie in one plane
  bool through = false;  ///< inner points of both
  bool to_front = false;
  double share = 0;
};

Way true_way(const LatticePoint& from, const LatticePoint& to, const LatticeTriangle& t) {
  Way way;
  const IntegerPoint n = normal_of(t);
  const Integer start = dot(n, minus(integers(from), integers(t[0]))),
                end = dot(n, minus(integers(to), integers(t[0])));
  if (start == end || sign(start) * sign(end) > 0) return way;
  const Integer all = abs(start) + abs(end);
  IntegerPoint p;  // over `all`
  for (std::size_t k = 0; k < 3; ++k) p[k] = abs(end) * from[k] + abs(start) * to[k];
  int least = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const IntegerPoint a = integers(t[k]), b = integers(t[(k + 1) % 3]);
    least = std::min(least, sign(dot(n, cross(minus(b, a), minus(p, times(a, all))))));
  }
  way.meets = least >= 0;
  way.through = least > 0 && start != 0 && end != 0;
  way.to_front = start < 0;
  way.share = static_cast<double>(Integer(abs(start) * (Integer(1) << 53) / all)) * 0x1p-53;
  return way;
}

TEST(Lattice, PassagesAreThoseThroughTheInsideOfATriangle) {
  for (int kind = 0; kind < kinds; ++kind) {
    Points points(7, kind);
    int through = 0, touching = 0;
    for (int i = 0; i < 40000; ++i) {
      const LatticePoint from = points.point(), to = points.point();
      const LatticeTriangle t = points.triangle();
      const Way way = true_way(from, to, t);
      const Passage found = passage(from, to, t);
      if (way.through) {
        ++through;
        ASSERT_EQ(found, way.to_front ? Passage::to_front : Passage::to_back) << "kind " << kind;
        const double share = passage_parameter(from, to, t);
        ASSERT_NEAR(share, way.share, 1e-12);
      } else if (way.meets) {
        ++touching;
        ASSERT_EQ(found, Passage::touches) << "kind " << kind;
      } else if (found != Passage::none) {
        // Only what lies in the triangle's plane may be called touching without meeting it.
        ASSERT_EQ(found, Passage::touches);
        ASSERT_EQ(volume(t[0], t[1], t[2], from) * volume(t[0], t[1], t[2], to), 0) << "kind " << kind;
      }
    }
    EXPECT_GT(through, 50) << "kind " << kind;
    if (kind == 1 || kind == 3) {
      EXPECT_GT(touching, 50);
    }
  }
}

TEST(Lattice, WhatLiesInThePlaneTouches) {
  const LatticeTriangle t = {{{0, 0, 0}, {10, 0, 0}, {0, 10, 0}}};
  EXPECT_EQ(passage({1, 1, 0}, {2, 2, 0}, t), Passage::touches);
  EXPECT_EQ(passage({1, 1, -1}, {1, 1, 0}, t), Passage::touches) << "an end on the inside";
  EXPECT_EQ(passage({1, 1, 0}, {1, 1, 1}, t), Passage::touches);
  EXPECT_EQ(passage({1, 1, -1}, {1, 1, 1}, t), Passage::to_front);
  EXPECT_EQ(passage({1, 1, 1}, {1, 1, -1}, t), Passage::to_back);
  EXPECT_EQ(passage({5, 5, -1}, {5, 5, 1}, t), Passage::touches) << "through a side";
  EXPECT_EQ(passage({6, 6, -1}, {6, 6, 1}, t), Passage::none);
  EXPECT_EQ(passage({1, 1, 1}, {1, 1, 2}, t), Passage::none);
}

}  // namespace
}  // namespace meshcomplete
