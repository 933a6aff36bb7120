#include "common/core/octree.h"

namespace meshcomplete {

LatticeBox Octree::box(Index cube) const {
  const LatticePoint& low = cubes_[cube].low;
  const std::int64_t length = side(cubes_[cube].depth);
  return {low, {low[0] + length, low[1] + length, low[2] + length}};
}

LatticePoint Octree::centre(Index cube) const {
  const LatticePoint& low = cubes_[cube].low;
  const std::int64_t half = side(cubes_[cube].depth) / 2;
  return {low[0] + half, low[1] + half, low[2] + half};
}

Index Octree::split(Index leaf) {
  const Index first = static_cast<Index>(cubes_.size());
  const int depth = cubes_[leaf].depth + 1;
  const std::int64_t half = side(depth);
  cubes_[leaf].children = first;
  const LatticePoint low = cubes_[leaf].low;
  for (int place = 0; place < 8; ++place) {
    Cube child;
    child.depth = depth;
    for (int k = 0; k < 3; ++k) child.low[k] = low[k] + ((place >> k & 1) ? half : 0);
    cubes_.push_back(child);
  }
  return first;
}

Index Octree::find(const LatticePoint& point, int depth) const {
  Index cube = 0;
  while (cubes_[cube].children != none && cubes_[cube].depth < depth) {
    const std::int64_t half = side(cubes_[cube].depth + 1);
    Index place = 0;
    for (int k = 0; k < 3; ++k)
      if (point[k] >= cubes_[cube].low[k] + half) place |= 1u << k;
    cube = cubes_[cube].children + place;
  }
  return cube;
}

bool Octree::has_midpoint(const LatticePoint& start, int axis, std::int64_t length) const {
  int depth = 0;
  while (side(depth) > length) ++depth;
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  for (int place = 0; place < 4; ++place) {
    LatticePoint p = start;
    if (place & 1) p[i] -= length;
    if (place & 2) p[j] -= length;
    if (p[i] < 0 || p[j] < 0 || p[i] >= Lattice::steps || p[j] >= Lattice::steps) continue;
    const Cube& cube = cubes_[find(p, depth)];
    if (cube.depth == depth && cube.children != none) return true;
  }
  return false;
}

std::vector<LatticePoint> Octree::corners_on(const LatticePoint& start, int axis, std::int64_t length) const {
  std::vector<LatticePoint> corners = {start};
  const auto append = [&](const auto& self, const LatticePoint& from, std::int64_t part) -> void {
    if (part > Lattice::cell && has_midpoint(from, axis, part)) {
      LatticePoint middle = from;
      middle[axis] += part / 2;
      self(self, from, part / 2);
      self(self, middle, part / 2);
    } else {
      corners.push_back(from);
      corners.back()[axis] += part;
    }
  };
  append(append, start, length);
  return corners;
}

LatticeBox LeafSquare::box() const {
  LatticePoint high = low;
  high[(axis + 1) % 3] += length;
  high[(axis + 2) % 3] += length;
  return {low, high};
}

LatticePoint LeafSquare::centre() const {
  LatticePoint p = low;
  p[(axis + 1) % 3] += length / 2;
  p[(axis + 2) % 3] += length / 2;
  return p;
}

std::array<LatticePoint, 4> LeafSquare::corners() const {
  std::array<LatticePoint, 4> all = {low, low, low, low};
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  all[1][i] += length;
  all[2][i] += length;
  all[2][j] += length;
  all[3][j] += length;
  return all;
}

std::vector<LeafSquare> leaf_squares(const Octree& octree) {
  std::vector<LeafSquare> squares;
  for (Index leaf = 0; leaf < octree.size(); ++leaf) {
    if (!octree.is_leaf(leaf)) continue;
    const Octree::Cube& cube = octree[leaf];
    const std::int64_t length = Octree::side(cube.depth);
    for (int axis = 0; axis < 3; ++axis)
      for (bool up : {false, true}) {
        LatticePoint beside = cube.low, low = cube.low;
        beside[axis] += up ? length : -length;
        if (up) low[axis] += length;
        if (beside[axis] < 0 || beside[axis] >= Lattice::steps) {
          squares.push_back({low, length, axis, up ? leaf : Octree::none, up ? Octree::none : leaf});
          continue;
        }
        const Index other = octree.find(beside, cube.depth);
        // Finer leaves beside it have squares of their own, and of two equal ones the lower leaf makes it.
        if (!octree.is_leaf(other) || (octree[other].depth == cube.depth && !up)) continue;
        squares.push_back({low, length, axis, up ? leaf : other, up ? other : leaf});
      }
  }
  return squares;
}

}  // namespace meshcomplete
