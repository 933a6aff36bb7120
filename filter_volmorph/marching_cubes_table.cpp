#include "filter_volmorph/marching_cubes_table.h"

#include <Eigen/Core>
#include <limits>
#include <stdexcept>

namespace meshcomplete {
namespace {

using Loop = std::vector<std::uint8_t>;  // of edges

constexpr std::uint8_t no_edge = 255;

std::array<CubeEdge, 12> make_edges() {
  std::array<CubeEdge, 12> edges{};
  int count = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int corner = 0; corner < 8; ++corner)
      if ((corner >> axis & 1) == 0) edges[count++] = {std::uint8_t(corner), std::uint8_t(axis)};
  return edges;
}

std::uint8_t edge_between(int a, int b) {
  for (std::uint8_t edge = 0; edge < 12; ++edge)
    if (cube_edges()[edge].low == (a & b) && (1 << cube_edges()[edge].axis) == (a ^ b)) return edge;
  throw std::logic_error("no edge of a cube");
}

// Corners of a face, counter-clockwise seen from outside the cube.
std::array<int, 4> face_corners(int axis, bool high) {
  const int b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3;
  const int base = high ? 1 << axis : 0;
  if (high) return {base, base | b, base | b | c, base | c};
  return {base, base | c, base | b | c, base | b};
}

// Where the surface goes on from each edge that it crosses. Round a face, each run of inside corners is cut
// off by a segment from the edge where the run is entered to the edge where it is left.
std::array<std::uint8_t, 12> next_edges(int inside) {
  std::array<std::uint8_t, 12> next;
  next.fill(no_edge);
  for (int face = 0; face < 6; ++face) {
    const std::array<int, 4> corners = face_corners(face / 2, face % 2 == 1);
    const auto is_inside = [&](int i) { return (inside >> corners[i % 4] & 1) != 0; };
    for (int i = 0; i < 4; ++i) {
      if (is_inside(i) || !is_inside(i + 1)) continue;
      int last = i + 1;
      while (is_inside(last + 1)) ++last;
      next[edge_between(corners[i], corners[(i + 1) % 4])] =
          edge_between(corners[last % 4], corners[(last + 1) % 4]);
    }
  }
  return next;
}

std::vector<Loop> loops_of(int inside) {
  std::array<std::uint8_t, 12> next = next_edges(inside);
  std::vector<Loop> loops;
  for (std::uint8_t first = 0; first < 12; ++first) {
    Loop loop;
    for (std::uint8_t edge = first; next[edge] != no_edge;) {
      loop.push_back(edge);
      const std::uint8_t after = next[edge];
      next[edge] = no_edge;
      edge = after;
    }
    if (!loop.empty()) loops.push_back(loop);
  }
  return loops;
}

Eigen::Vector3d middle(std::uint8_t edge) {
  Eigen::Vector3d at;
  const CubeEdge& e = cube_edges()[edge];
  for (int axis = 0; axis < 3; ++axis) at[axis] = axis == e.axis ? 0.5 : e.low >> axis & 1;
  return at;
}

// Whether the two edges bound a face of the cube in common.
bool share_face(std::uint8_t a, std::uint8_t b) {
  const Eigen::Vector3d u = middle(a), v = middle(b);
  return ((u - v).array() == 0 && (u.array() == 0 || u.array() == 1)).any();
}

struct Fan {
  double cost = std::numeric_limits<double>::infinity();  // squared lengths of the diagonals
  std::vector<CubeTriangle> triangles;
};

// The triangulation of the part of a loop from one of its edges to another with the shortest diagonals, none
// of which lies in a face: there the cube beyond could have the same one.
Fan triangulate(const Loop& loop, std::size_t from, std::size_t to) {
  if (to - from < 2) return {0, {}};
  Fan best;
  for (std::size_t apex = from + 1; apex < to; ++apex) {
    double cost = 0;
    for (const auto& [a, b] : {std::pair(from, apex), std::pair(apex, to)}) {
      if (b - a < 2) continue;
      if (share_face(loop[a], loop[b])) cost = std::numeric_limits<double>::infinity();
      cost += (middle(loop[a]) - middle(loop[b])).squaredNorm();
    }
    const Fan before = triangulate(loop, from, apex), after = triangulate(loop, apex, to);
    cost += before.cost + after.cost;
    if (!(cost < best.cost)) continue;
    best = {cost, before.triangles};
    best.triangles.push_back({loop[from], loop[apex], loop[to]});
    best.triangles.insert(best.triangles.end(), after.triangles.begin(), after.triangles.end());
  }
  return best;
}

std::array<std::vector<CubeTriangle>, 256> make_table() {
  std::array<std::vector<CubeTriangle>, 256> table;
  for (int inside = 0; inside < 256; ++inside)
    for (const Loop& loop : loops_of(inside)) {
      const Fan fan = triangulate(loop, 0, loop.size() - 1);
      if (fan.triangles.empty()) throw std::logic_error("a loop round a cube without a triangulation");
      table[inside].insert(table[inside].end(), fan.triangles.begin(), fan.triangles.end());
    }
  return table;
}

}  // namespace

const std::array<CubeEdge, 12>& cube_edges() {
  static const std::array<CubeEdge, 12> edges = make_edges();
  return edges;
}

const std::vector<CubeTriangle>& cube_triangles(std::uint8_t inside) {
  static const std::array<std::vector<CubeTriangle>, 256> table = make_table();
  return table[inside];
}

}  // namespace meshcomplete
