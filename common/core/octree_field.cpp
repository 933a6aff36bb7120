#include "common/core/octree_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshcomplete {

// A position in steps of the lattice, and the leaf that holds it.
struct OctreeField::Query {
  std::array<double, 3> at;
  Index leaf;
};

namespace {

LatticePoint lattice_point(const std::array<double, 3>& at) {
  LatticePoint p;
  for (int k = 0; k < 3; ++k)
    p[k] = std::clamp(static_cast<std::int64_t>(std::floor(at[k])), std::int64_t{0}, Lattice::steps);
  return p;
}

// A coordinate in the half-open range of a cube: what lies on its upper side must not be looked for beyond.
double within(const Octree::Cube& cube, int axis, double x) {
  const double low = static_cast<double>(cube.low[axis]);
  return std::clamp(x, low, std::nextafter(low + static_cast<double>(Octree::side(cube.depth)), low));
}

}  // namespace

OctreeField::OctreeField(const Lattice& lattice, std::shared_ptr<const CornerOctree> octree,
                         std::vector<std::vector<double>> values, double iso_value,
                         FieldInterpolation interpolation)
    : lattice_(lattice),
      origin_(lattice.position({0, 0, 0})),
      octree_(std::move(octree)),
      values_(std::move(values)),
      interpolation_(interpolation) {
  for (std::vector<double>& level : values_)
    for (double& value : level) value -= iso_value;
}

OctreeField::Query OctreeField::query(const Vector3& position) const {
  constexpr double last = static_cast<double>(Lattice::steps - 1);
  Query query;
  LatticePoint p;
  for (int k = 0; k < 3; ++k) {
    query.at[k] = std::clamp((position[k] - origin_[k]) / lattice_.step(), 0.0, last);
    p[k] = static_cast<std::int64_t>(query.at[k]);
  }
  query.leaf = octree_->octree().find(p);
  return query;
}

double OctreeField::value(const Vector3& position) const {
  const Query at = query(position);
  return interpolation_ == FieldInterpolation::trilinear ? trilinear(at) : tetrahedral(at);
}

double OctreeField::leaf_size(const Vector3& position) const {
  return static_cast<double>(Octree::side(octree_->octree()[query(position).leaf].depth)) * lattice_.step();
}

double OctreeField::corner_value(Index cube, int corner) const {
  const Index block = CornerOctree::block_of(cube);
  const int depth = octree_->octree()[cube].depth;
  const CornerOctree::Level& level = octree_->level(depth);
  return values_[depth - 1][level.corners[block - level.first_block]
                                         [CornerOctree::corner_place((cube - 1) % 8, corner)]];
}

std::array<double, 8> OctreeField::corner_values(Index cube) const {
  const std::array<Index, 8> corners = octree_->corners(cube);
  const std::vector<double>& values = values_[octree_->octree()[cube].depth - 1];
  std::array<double, 8> result;
  for (int c = 0; c < 8; ++c) result[c] = values[corners[c]];
  return result;
}

double OctreeField::trilinear(const Query& query) const {
  const Octree::Cube& cube = octree_->octree()[query.leaf];
  const double side = static_cast<double>(Octree::side(cube.depth));
  std::array<double, 8> v = corner_values(query.leaf);
  for (int k = 0, count = 4; k < 3; ++k, count /= 2) {
    const double share = (query.at[k] - static_cast<double>(cube.low[k])) / side;
    for (int i = 0; i < count; ++i) v[i] = v[2 * i] + share * (v[2 * i + 1] - v[2 * i]);
  }
  return v[0];
}

// The mean of a cube's corners, or of those on one face of it.
double OctreeField::mean_of_corners(Index cube, int face_axis, int upper) const {
  double sum = 0;
  for (int c = 0; c < 8; ++c)
    if (face_axis < 0 || (c >> face_axis & 1) == upper) sum += corner_value(cube, c);
  return sum / (face_axis < 0 ? 8 : 4);
}

// The deepest of the leaves that touch a point whose coordinates along the axes in `touching` lie on planes
// between cubes; with its corner bits on these axes.
std::pair<Index, int> OctreeField::deepest_leaf(const LatticePoint& point, int touching) const {
  const Octree& octree = octree_->octree();
  std::pair<Index, int> best = {Octree::none, 0};
  for (int lower = 0; lower < 8; ++lower) {
    if (lower & ~touching) continue;
    LatticePoint p = point;
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
      if (lower >> k & 1) --p[k];
      inside &= p[k] >= 0 && p[k] < Lattice::steps;
    }
    if (!inside) continue;
    const Index leaf = octree.find(p);
    if (best.first == Octree::none || octree[leaf].depth > octree[best.first].depth) best = {leaf, lower};
  }
  return best;
}

// Value at a point of an edge along `axis`; the coordinates on the other axes lie on planes between cubes.
double OctreeField::value_on_edge(const std::array<double, 3>& at, int axis) const {
  const auto [leaf, upper] = deepest_leaf(lattice_point(at), 7 & ~(1 << axis));
  const Octree::Cube& cube = octree_->octree()[leaf];
  const double side = static_cast<double>(Octree::side(cube.depth));
  const double share = std::clamp((at[axis] - static_cast<double>(cube.low[axis])) / side, 0.0, 1.0);
  const double a = corner_value(leaf, upper), b = corner_value(leaf, upper | 1 << axis);
  return a + share * (b - a);
}

// Value at a point of a leaf's face across `axis`, by projection from the centre of the smallest face there
// onto one of its edges.
double OctreeField::value_on_face(const std::array<double, 3>& at, int axis) const {
  const auto [leaf, upper] = deepest_leaf(lattice_point(at), 1 << axis);
  const Octree::Cube& cube = octree_->octree()[leaf];
  const double half = 0.5 * static_cast<double>(Octree::side(cube.depth));
  const double middle = mean_of_corners(leaf, axis, upper >> axis & 1);
  int far = (axis + 1) % 3;  // the axis along which the point is farthest from the centre
  std::array<double, 3> offset{};
  for (int k : {(axis + 1) % 3, (axis + 2) % 3}) {
    offset[k] = at[k] - (static_cast<double>(cube.low[k]) + half);
    if (std::abs(offset[k]) > std::abs(offset[far])) far = k;
  }
  const double reach = std::min(std::abs(offset[far]) / half, 1.0);
  if (reach == 0) return middle;
  const int along = 3 - axis - far;
  std::array<double, 3> edge = at;
  edge[far] = static_cast<double>(cube.low[far]) + (offset[far] > 0 ? 2 * half : 0);
  edge[along] = within(cube, along, at[along] - offset[along] + offset[along] / reach);
  return middle + reach * (value_on_edge(edge, along) - middle);
}

double OctreeField::tetrahedral(const Query& query) const {
  const Octree::Cube& cube = octree_->octree()[query.leaf];
  const double half = 0.5 * static_cast<double>(Octree::side(cube.depth));
  const double middle = mean_of_corners(query.leaf, -1, 0);
  std::array<double, 3> offset;
  int axis = 0;
  for (int k = 0; k < 3; ++k) {
    offset[k] = query.at[k] - (static_cast<double>(cube.low[k]) + half);
    if (std::abs(offset[k]) > std::abs(offset[axis])) axis = k;
  }
  const double reach = std::min(std::abs(offset[axis]) / half, 1.0);
  if (reach == 0) return middle;
  std::array<double, 3> face;
  for (int k = 0; k < 3; ++k) face[k] = within(cube, k, query.at[k] - offset[k] + offset[k] / reach);
  face[axis] = static_cast<double>(cube.low[axis]) + (offset[axis] > 0 ? 2 * half : 0);
  return middle + reach * (value_on_face(face, axis) - middle);
}

}  // namespace meshcomplete
