#include "common/core/lattice.h"

#include <algorithm>
#include <cmath>

namespace meshcomplete {
namespace {

using Wide = __int128;
using WideVector = std::array<Wide, 3>;
using Offset = std::array<std::int64_t, 3>;

int sign(Wide value) { return (value > 0) - (value < 0); }

Offset difference(const LatticePoint& a, const LatticePoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Wide product(std::int64_t a, std::int64_t b) { return static_cast<Wide>(a) * b; }

// 79 bits a component for offsets of 39 bits.
WideVector cross(const Offset& u, const Offset& v) {
  return {product(u[1], v[2]) - product(u[2], v[1]), product(u[2], v[0]) - product(u[0], v[2]),
          product(u[0], v[1]) - product(u[1], v[0])};
}

// 120 bits.
Wide dot(const WideVector& u, const Offset& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }

Wide volume(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c, const LatticePoint& d) {
  return dot(cross(difference(b, a), difference(c, a)), difference(d, a));
}

// Whether the projections of the points on `axis` all lie beyond `reach` on one side of 0.
template <std::size_t n>
bool beyond(const std::array<Wide, n>& projections, Wide reach) {
  const auto [least, most] = std::minmax_element(projections.begin(), projections.end());
  return *least > reach || *most < -reach;
}

// What separating a convex set of points from a box needs: the points relative to the box's centre.
struct Centred {
  Offset half;
  LatticePoint centre;

  explicit Centred(const LatticeBox& box) {
    for (int k = 0; k < 3; ++k) {
      half[k] = (box.high[k] - box.low[k]) / 2;
      centre[k] = box.low[k] + half[k];
    }
  }
  Wide reach(const WideVector& axis) const {
    Wide sum = 0;
    for (int k = 0; k < 3; ++k) sum += (axis[k] < 0 ? -axis[k] : axis[k]) * half[k];
    return sum;
  }
};

// Whether one of the three axes across `edge` and a side of the box separates the points from the box.
template <std::size_t n>
bool separated_across(const Offset& edge, const std::array<Offset, n>& points, const Centred& box) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    // The axis is e_k x edge: components -edge[j] along i and edge[i] along j.
    std::array<Wide, n> projections;
    for (std::size_t p = 0; p < n; ++p)
      projections[p] = product(edge[i], points[p][j]) - product(edge[j], points[p][i]);
    const Wide reach = product(std::abs(edge[j]), box.half[i]) + product(std::abs(edge[i]), box.half[j]);
    if (beyond(projections, reach)) return true;
  }
  return false;
}

template <std::size_t n>
bool separated_along_sides(const std::array<Offset, n>& points, const Centred& box) {
  for (int k = 0; k < 3; ++k) {
    bool above = true, below = true;
    for (const Offset& p : points) {
      above &= p[k] > box.half[k];
      below &= p[k] < -box.half[k];
    }
    if (above || below) return true;
  }
  return false;
}

}  // namespace

LatticePoint Lattice::snap(const Vector3& position) const {
  LatticePoint p;
  for (int k = 0; k < 3; ++k)
    p[k] = 2 * static_cast<std::int64_t>(std::floor((position[k] - origin_[k]) * scale_ * 0.5)) + 1;
  return p;
}

Vector3 Lattice::position(const LatticePoint& p) const {
  const double step = side_ / static_cast<double>(steps);
  return origin_ +
         step * Vector3(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
}

Box Lattice::around(const LatticeBox& box) const {
  // Snapping moves a coordinate by up to two steps, and the rounding of doubles is finer than a step, because
  // both are relative to a cube that holds the mesh, unless the mesh lies very far from the origin.
  const double margin = 4 * step() + 1e-15 * (origin_.cwiseAbs().maxCoeff() + side_);
  const Vector3 low = position(box.low), high = position(box.high);
  Box result;
  for (int k = 0; k < 3; ++k) {
    result.low[k] = low[k] - margin;
    result.high[k] = high[k] + margin;
  }
  return result;
}

int orientation(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c, const LatticePoint& d) {
  return sign(volume(a, b, c, d));
}

int normal_sign(const LatticeTriangle& triangle, int axis) {
  const Offset u = difference(triangle[1], triangle[0]), v = difference(triangle[2], triangle[0]);
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  return sign(product(u[i], v[j]) - product(u[j], v[i]));
}

bool meets(const LatticeTriangle& triangle, const LatticeBox& box) {
  const Centred centred(box);
  std::array<Offset, 3> points;
  for (int k = 0; k < 3; ++k) points[k] = difference(triangle[k], centred.centre);
  if (separated_along_sides(points, centred)) return false;
  if (box.contains(triangle[0]) || box.contains(triangle[1]) || box.contains(triangle[2])) return true;
  const std::array<Offset, 3> edges = {difference(triangle[1], triangle[0]),
                                       difference(triangle[2], triangle[1]),
                                       difference(triangle[0], triangle[2])};
  const WideVector normal = cross(edges[0], edges[1]);
  if (beyond(std::array<Wide, 1>{dot(normal, points[0])}, centred.reach(normal))) return false;
  for (const Offset& edge : edges)
    if (separated_across(edge, points, centred)) return false;
  return true;
}

bool meets(const LatticePoint& a, const LatticePoint& b, const LatticeBox& box) {
  const Centred centred(box);
  const std::array<Offset, 2> points = {difference(a, centred.centre), difference(b, centred.centre)};
  return !separated_along_sides(points, centred) && !separated_across(difference(b, a), points, centred);
}

Passage passage(const LatticePoint& from, const LatticePoint& to, const LatticeTriangle& t) {
  const int start = orientation(t[0], t[1], t[2], from), end = orientation(t[0], t[1], t[2], to);
  if (start != 0 && start == end) return Passage::none;
  std::array<int, 3> sides;
  for (int k = 0; k < 3; ++k) sides[k] = orientation(from, to, t[k], t[(k + 1) % 3]);
  const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
  if (*least < 0 && *most > 0) return Passage::none;
  if (*least == 0 || *most == 0 || start == 0 || end == 0) return Passage::touches;
  return start < 0 ? Passage::to_front : Passage::to_back;
}

double passage_parameter(const LatticePoint& from, const LatticePoint& to, const LatticeTriangle& t) {
  const double start = static_cast<double>(volume(t[0], t[1], t[2], from));
  const double end = static_cast<double>(volume(t[0], t[1], t[2], to));
  return start / (start - end);
}

}  // namespace meshcomplete
