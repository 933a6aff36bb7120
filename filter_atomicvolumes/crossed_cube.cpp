#include "filter_atomicvolumes/crossed_cube.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "common/core/disjoint_sets.h"
#include "common/core/triangle_intersection.h"

namespace meshcomplete {
namespace {

// How many triangles of a piece are aimed at before it is given up.
constexpr std::size_t most_targets = 6;

// A segment goes on behind its target by this share of the cube's side (and by some steps at least), so that
// rounding its end to the lattice does not make it end before the target.
constexpr double overshoot = 1e-4;
constexpr double least_overshoot = 16;

constexpr Index no_piece = 0xffffffffu;

struct Crossing {
  double at;
  bool to_front;
  Index triangle;  // position in the cube's list
};

Vector3 as_vector(const LatticePoint& p) {
  return Vector3(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
}

// Even coordinates: mesh vertices have odd ones.
LatticePoint even_point(const Vector3& position, const LatticeBox& cube) {
  LatticePoint p;
  for (int k = 0; k < 3; ++k) {
    p[k] = 2 * static_cast<std::int64_t>(std::llround(0.5 * position[k]));
    p[k] = std::clamp(p[k], cube.low[k], cube.high[k]);
  }
  return p;
}

// The mean corner of the part of a triangle that lies in the cube, in steps.
std::optional<Vector3> middle_inside(const LatticeTriangle& triangle, const LatticeBox& cube) {
  std::vector<Vector3> polygon = {as_vector(triangle[0]), as_vector(triangle[1]), as_vector(triangle[2])},
                       clipped;
  for (int k = 0; k < 3; ++k)
    for (double sign : {1.0, -1.0}) {
      const double bound = static_cast<double>(sign > 0 ? cube.high[k] : -cube.low[k]);
      clipped.clear();
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vector3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double beyond_a = sign * a[k] - bound, beyond_b = sign * b[k] - bound;
        if (beyond_a <= 0) clipped.push_back(a);
        if ((beyond_a < 0 && beyond_b > 0) || (beyond_a > 0 && beyond_b < 0))
          clipped.push_back(a + (b - a) * (beyond_a / (beyond_a - beyond_b)));
      }
      polygon.swap(clipped);
    }
  if (polygon.empty()) return std::nullopt;
  Vector3 sum = Vector3::Zero();
  for (const Vector3& p : polygon) sum += p;
  return sum / static_cast<double>(polygon.size());
}

class CrossedCube {
 public:
  CrossedCube(const LatticeMesh& mesh, const std::vector<Index>& triangles, const LatticeBox& cube)
      : mesh_(mesh), triangles_(triangles), cube_(cube) {
    corners_.reserve(triangles.size());
    for (Index t : triangles) corners_.push_back(mesh.triangle(t));
  }

  bool sides_agree();
  std::optional<bool> is_inside(const LatticePoint& point) const;

 private:
  void find_pieces();
  bool agrees(Index piece);
  bool intersect(Index a, Index b) const;
  std::optional<std::vector<Crossing>> crossings(const LatticePoint& from, const LatticePoint& to) const;
  double reach() const {
    return std::max(least_overshoot, overshoot * static_cast<double>(cube_.high[0] - cube_.low[0]));
  }

  const LatticeMesh& mesh_;
  const std::vector<Index>& triangles_;
  const LatticeBox cube_;
  std::vector<LatticeTriangle> corners_;
  std::vector<std::vector<Index>> pieces_;  // positions in the list
  std::vector<Index> piece_of_;
};

// Triangles hang together where an edge that they share meets the cube, also one with more than two faces.
void CrossedCube::find_pieces() {
  struct Side {
    Index low, high, triangle;
    bool operator<(const Side& other) const {
      return std::tie(low, high, triangle) < std::tie(other.low, other.high, other.triangle);
    }
  };
  DisjointSets sets(triangles_.size());
  std::vector<Side> sides;
  sides.reserve(3 * triangles_.size());
  for (Index i = 0; i < triangles_.size(); ++i) {
    const Triangle& t = mesh_.mesh.triangles[triangles_[i]];
    for (int k = 0; k < 3; ++k) {
      const LatticePoint &a = corners_[i][k], &b = corners_[i][(k + 1) % 3];
      if (!cube_.contains(a) && !cube_.contains(b) && !meets(a, b, cube_)) continue;
      sides.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3]), i});
    }
  }
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 1; i < sides.size(); ++i)
    if (sides[i].low == sides[i - 1].low && sides[i].high == sides[i - 1].high)
      sets.unite(sides[i].triangle, sides[i - 1].triangle);
  piece_of_.assign(triangles_.size(), 0);
  std::vector<Index> number(triangles_.size(), no_piece);
  for (Index i = 0; i < triangles_.size(); ++i) {
    Index& piece = number[sets.root(i)];
    if (piece == no_piece) {
      piece = static_cast<Index>(pieces_.size());
      pieces_.emplace_back();
    }
    piece_of_[i] = piece;
    pieces_[piece].push_back(i);
  }
}

std::optional<std::vector<Crossing>> CrossedCube::crossings(const LatticePoint& from,
                                                            const LatticePoint& to) const {
  LatticePoint low, high;
  for (int k = 0; k < 3; ++k) {
    low[k] = std::min(from[k], to[k]);
    high[k] = std::max(from[k], to[k]);
  }
  std::vector<Crossing> found;
  for (Index i = 0; i < corners_.size(); ++i) {
    const LatticeTriangle& t = corners_[i];
    bool apart = false;
    for (int k = 0; k < 3; ++k)
      apart |= (t[0][k] < low[k] && t[1][k] < low[k] && t[2][k] < low[k]) ||
               (t[0][k] > high[k] && t[1][k] > high[k] && t[2][k] > high[k]);
    if (apart) continue;
    const Passage way = passage(from, to, t);
    if (way == Passage::none) continue;
    if (way == Passage::touches) return std::nullopt;
    found.push_back({passage_parameter(from, to, t), way == Passage::to_front, i});
  }
  std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) {
    return std::tie(a.at, a.triangle) < std::tie(b.at, b.triangle);
  });
  return found;
}

bool CrossedCube::intersect(Index a, Index b) const {
  const auto corners = [&](Index piece) {
    std::vector<std::array<Vector3, 3>> list;
    for (Index i : pieces_[piece]) {
      const Triangle& t = mesh_.mesh.triangles[triangles_[i]];
      list.push_back({mesh_.mesh.vertices[t[0]], mesh_.mesh.vertices[t[1]], mesh_.mesh.vertices[t[2]]});
    }
    return list;
  };
  return !improper_pairs_between(corners(a), corners(b)).empty();
}

// Shoots from triangles of the piece at triangles of the first one.
bool CrossedCube::agrees(Index piece) {
  for (std::size_t i = 0; i < most_targets; ++i) {
    const auto pick = [&](Index p) {
      const std::vector<Index>& list = pieces_[p];
      return corners_[list[(i * list.size() / most_targets + i) % list.size()]];
    };
    const std::optional<Vector3> a = middle_inside(pick(piece), cube_), b = middle_inside(pick(0), cube_);
    if (!a || !b || !((*b - *a).norm() > 0)) continue;
    const Vector3 further = (*b - *a).normalized() * reach();
    const auto list = crossings(even_point(*a - further, cube_), even_point(*b + further, cube_));
    if (!list) continue;
    bool seen = false;
    for (std::size_t c = 0; c < list->size(); ++c) {
      seen |= piece_of_[(*list)[c].triangle] == piece;
      if (c == 0 || (*list)[c].to_front != (*list)[c - 1].to_front) continue;
      const Index before = piece_of_[(*list)[c - 1].triangle], here = piece_of_[(*list)[c].triangle];
      if (before != here && !intersect(before, here)) return false;
    }
    if (seen && list->size() > 1) return true;
  }
  return true;
}

bool CrossedCube::sides_agree() {
  find_pieces();
  for (Index piece = 1; piece < pieces_.size(); ++piece)
    if (!agrees(piece)) return false;
  return true;
}

std::optional<bool> CrossedCube::is_inside(const LatticePoint& point) const {
  // Near triangles first: their segments are short and meet little else.
  const Vector3 here = as_vector(point);
  std::vector<std::pair<double, Vector3>> targets;
  const std::size_t stride = corners_.size() / 512 + 1;
  for (std::size_t i = 0; i < corners_.size(); i += stride)
    if (const std::optional<Vector3> middle = middle_inside(corners_[i], cube_))
      targets.emplace_back((*middle - here).squaredNorm(), *middle);
  const std::size_t tried = std::min(targets.size(), 4 * most_targets);
  std::partial_sort(targets.begin(), targets.begin() + static_cast<std::ptrdiff_t>(tried), targets.end(),
                    [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < tried; ++i) {
    const Vector3& target = targets[i].second;
    if (!(targets[i].first > 0)) continue;
    const Vector3 further = (target - here).normalized() * reach();
    const auto list = crossings(point, even_point(target + further, cube_));
    if (list && !list->empty()) return list->front().to_front;
  }
  return std::nullopt;
}

}  // namespace

bool sides_agree(const LatticeMesh& mesh, const std::vector<Index>& triangles, const LatticeBox& cube) {
  return CrossedCube(mesh, triangles, cube).sides_agree();
}

std::optional<bool> is_inside(const LatticeMesh& mesh, const std::vector<Index>& triangles,
                              const LatticeBox& cube, const LatticePoint& point) {
  return CrossedCube(mesh, triangles, cube).is_inside(point);
}

}  // namespace meshcomplete
