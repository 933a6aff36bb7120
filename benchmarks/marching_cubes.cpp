#include "benchmarks/marching_cubes.h"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace meshcomplete::benchmarks {
namespace {

// An edge of a cube is its lower corner and the axis along which it leads.
constexpr int edges = 3 * 8;
constexpr int no_edge = -1;
int edge_of(int from, int to) {
  const int bit = from ^ to;
  return 3 * (from & to) + (bit == 1 ? 0 : bit == 2 ? 1 : 2);
}

// The corners of a face, counter-clockwise seen from outside.
std::array<int, 4> face_corners(int axis, bool upper) {
  const int a = 1 << (axis + 1) % 3, b = 1 << (axis + 2) % 3, base = upper ? 1 << axis : 0;
  if (upper) return {base, base | a, base | a | b, base | b};
  return {base, base | b, base | a | b, base | a};
}

// Of each crossed edge the one that comes after it round the surface. Where all four edges of a face are
// crossed its two negative corners are apart, whichever of its two cubes is looked at.
std::array<int, edges> successors(const std::array<double, 8>& values) {
  std::array<int, edges> next;
  next.fill(no_edge);
  for (int face = 0; face < 6; ++face) {
    const std::array<int, 4> corner = face_corners(face / 2, face % 2 != 0);
    for (int i = 0; i < 4; ++i) {
      if (values[corner[i]] < 0 || !(values[corner[(i + 1) % 4]] < 0)) continue;
      int last = (i + 1) % 4;
      while (values[corner[(last + 1) % 4]] < 0) last = (last + 1) % 4;
      next[edge_of(corner[i], corner[(i + 1) % 4])] = edge_of(corner[last], corner[(last + 1) % 4]);
    }
  }
  return next;
}

class MarchingCubes {
 public:
  explicit MarchingCubes(const OctreeField& field) : field_(field), octree_(field.octree().octree()) {}

  TriangleMesh run() {
    for (Index cube = 1; cube < octree_.size(); ++cube)
      if (octree_.is_leaf(cube)) add(cube);
    return std::move(mesh_);
  }

 private:
  void add(Index leaf) {
    const std::array<double, 8> values = field_.corner_values(leaf);
    int inside = 0;
    for (double value : values) inside += value < 0;
    if (inside == 0 || inside == 8) return;
    std::array<int, edges> next = successors(values);
    for (int start = 0; start < edges; ++start) {
      std::vector<Index> polygon;
      for (int edge = start; next[edge] != no_edge;) {
        polygon.push_back(vertex(leaf, edge, values));
        const int after = next[edge];
        next[edge] = no_edge;
        edge = after;
      }
      for (std::size_t i = 2; i < polygon.size(); ++i)
        mesh_.triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
    }
  }

  Index vertex(Index leaf, int edge, const std::array<double, 8>& values) {
    const int corner = edge / 3, axis = edge % 3;
    const Octree::Cube& cube = octree_[leaf];
    const std::int64_t side = Octree::side(cube.depth);
    LatticePoint low = cube.low;
    std::uint64_t key = static_cast<std::uint64_t>(cube.depth);
    for (int k = 0; k < 3; ++k) {
      low[k] += corner >> k & 1 ? side : 0;
      key = key << 18 | static_cast<std::uint64_t>(low[k] / side);
    }
    const auto [entry, is_new] = vertex_of_.emplace(3 * key + static_cast<std::uint64_t>(axis),
                                                    static_cast<Index>(mesh_.vertices.size()));
    if (is_new) {
      const double from = values[corner], to = values[corner | 1 << axis];
      const double length = static_cast<double>(side) * field_.lattice().step();
      mesh_.vertices.push_back(field_.lattice().position(low) +
                               from / (from - to) * length * Vector3::Unit(axis));
    }
    return entry->second;
  }

  const OctreeField& field_;
  const Octree& octree_;
  TriangleMesh mesh_;
  std::unordered_map<std::uint64_t, Index> vertex_of_;
};

}  // namespace

TriangleMesh marching_cubes(const OctreeField& field) { return MarchingCubes(field).run(); }

}  // namespace meshcomplete::benchmarks
