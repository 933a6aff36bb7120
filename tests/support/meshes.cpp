#include "tests/support/meshes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <utility>

namespace meshcomplete {
namespace test {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr Index none = 0xffffffffu;

Vector3 rounded(const Vector3& p) { return p.cast<float>().cast<double>(); }

void round_to_floats(TriangleMesh& mesh) {
  for (Vector3& p : mesh.vertices) p = rounded(p);
}

/// Uniform in [0, 1), the same on every platform (the standard's distributions are not).
double uniform(std::mt19937& random) { return random() * (1.0 / 4294967296.0); }

/// Pushes two triangles for the quad a, b, c, d (counter-clockwise).
void add_quad(TriangleMesh& mesh, Index a, Index b, Index c, Index d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

TriangleMesh icosahedron() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Vector3& p : mesh.vertices) p.normalize();
  return mesh;
}

/// Every face into four; new vertices at the middles of the edges.
TriangleMesh subdivided(const TriangleMesh& mesh) {
  TriangleMesh fine;
  fine.vertices = mesh.vertices;
  std::map<std::pair<Index, Index>, Index> middles;
  auto middle = [&](Index a, Index b) {
    const auto [place, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<Index>(fine.vertices.size()));
    if (is_new) fine.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
    return place->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Triangle& t :
         {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}})
      fine.triangles.push_back(t);
  }
  return fine;
}

/// Points on the unit sphere in double precision.
TriangleMesh unit_icosphere(int subdivisions) {
  TriangleMesh mesh = icosahedron();
  for (int i = 0; i < subdivisions; ++i) {
    mesh = subdivided(mesh);
    for (Vector3& p : mesh.vertices) p.normalize();
  }
  return mesh;
}

double angle_between(const Vector3& a, const Vector3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// The faces with a corner within `angle` of `axis`, seen from the origin.
std::vector<char> faces_in_cone(const TriangleMesh& mesh, const Vector3& axis, double angle) {
  std::vector<char> inside(mesh.triangles.size(), 0);
  for (std::size_t f = 0; f < inside.size(); ++f)
    for (Index v : mesh.triangles[f]) inside[f] |= angle_between(mesh.vertices[v], axis) < angle;
  return inside;
}

/// Faces that share an edge with face f, in manifold parts of the mesh.
std::vector<std::vector<Index>> face_neighbours(const TriangleMesh& mesh) {
  std::map<std::pair<Index, Index>, std::vector<Index>> at_edge;
  for (Index f = 0; f < mesh.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k)
      at_edge[std::minmax(mesh.triangles[f][k], mesh.triangles[f][(k + 1) % 3])].push_back(f);
  std::vector<std::vector<Index>> neighbours(mesh.triangles.size());
  for (const auto& [edge, faces] : at_edge)
    for (Index f : faces)
      for (Index g : faces)
        if (f != g) neighbours[f].push_back(g);
  return neighbours;
}

/// Removes `holes` sets of 10 to 40 faces (fewer on small meshes), each grown at random from a random face.
TriangleMesh with_ragged_holes(const TriangleMesh& mesh, int holes, std::mt19937& random) {
  const auto neighbours = face_neighbours(mesh);
  const std::size_t most =
      std::max<std::size_t>(4, mesh.triangles.size() / (4 * static_cast<std::size_t>(holes + 1)));
  std::vector<char> removed(mesh.triangles.size(), 0);
  for (int hole = 0; hole < holes; ++hole) {
    std::vector<Index> grown = {static_cast<Index>(random() % mesh.triangles.size())};
    removed[grown[0]] = 1;
    const std::size_t size = std::min<std::size_t>(most, 10 + random() % 31);
    for (std::size_t tries = 0; grown.size() < size && tries < 100 * size; ++tries) {
      const std::vector<Index>& around = neighbours[grown[random() % grown.size()]];
      if (around.empty()) continue;
      const Index f = around[random() % around.size()];
      if (removed[f]) continue;
      removed[f] = 1;
      grown.push_back(f);
    }
  }
  return without_faces(mesh, [&](Index f) { return removed[f] != 0; });
}

}  // namespace

TriangleMesh icosphere(int subdivisions, double radius, const Vector3& centre) {
  TriangleMesh mesh = unit_icosphere(subdivisions);
  for (Vector3& p : mesh.vertices) p = centre + radius * p;
  round_to_floats(mesh);
  return mesh;
}

TriangleMesh uv_sphere(int rings, int segments, double radius) {
  TriangleMesh mesh;
  const auto at = [&](int ring, int segment) {
    return static_cast<Index>(1 + (ring - 1) * segments + segment % segments);
  };
  mesh.vertices.push_back({0, 0, radius});
  for (int ring = 1; ring < rings; ++ring)
    for (int segment = 0; segment < segments; ++segment) {
      const double polar = pi * ring / rings, around = 2 * pi * segment / segments;
      mesh.vertices.push_back(radius * Vector3(std::sin(polar) * std::cos(around),
                                               std::sin(polar) * std::sin(around), std::cos(polar)));
    }
  const Index south = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.push_back({0, 0, -radius});
  for (int segment = 0; segment < segments; ++segment) {
    mesh.triangles.push_back({0, at(1, segment), at(1, segment + 1)});
    for (int ring = 1; ring + 1 < rings; ++ring)
      add_quad(mesh, at(ring, segment), at(ring + 1, segment), at(ring + 1, segment + 1),
               at(ring, segment + 1));
    mesh.triangles.push_back({at(rings - 1, segment), south, at(rings - 1, segment + 1)});
  }
  round_to_floats(mesh);
  return mesh;
}

TriangleMesh torus(int major_segments, int minor_segments, double major_radius, double minor_radius) {
  TriangleMesh mesh;
  const auto at = [&](int i, int j) {
    return static_cast<Index>((i % major_segments) * minor_segments + j % minor_segments);
  };
  for (int i = 0; i < major_segments; ++i)
    for (int j = 0; j < minor_segments; ++j) {
      const double u = 2 * pi * i / major_segments, v = 2 * pi * j / minor_segments;
      const double r = major_radius + minor_radius * std::cos(v);
      mesh.vertices.push_back({r * std::cos(u), r * std::sin(u), minor_radius * std::sin(v)});
    }
  for (int i = 0; i < major_segments; ++i)
    for (int j = 0; j < minor_segments; ++j)
      add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  round_to_floats(mesh);
  return mesh;
}

TriangleMesh cube(double side, const Vector3& corner) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.push_back(corner + side * Vector3(i & 1, (i >> 1) & 1, i >> 2));
  add_quad(mesh, 0, 2, 3, 1);
  add_quad(mesh, 4, 5, 7, 6);
  add_quad(mesh, 0, 1, 5, 4);
  add_quad(mesh, 2, 6, 7, 3);
  add_quad(mesh, 0, 4, 6, 2);
  add_quad(mesh, 1, 3, 7, 5);
  round_to_floats(mesh);
  return mesh;
}

TriangleMesh tetrahedron(double side) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {side, 0, 0}, {0, side, 0}, {0, 0, side}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  round_to_floats(mesh);
  return mesh;
}

TriangleMesh plate_with_tunnels(int tunnels) {
  const int columns = 2 * tunnels + 1;
  const auto solid = [&](int x, int y, int z) {
    const bool inside = x >= 0 && x < columns && y >= 0 && y < 3 && z == 0;
    return inside && !(y == 1 && x % 2 == 1);
  };
  TriangleMesh mesh;
  std::map<std::array<int, 3>, Index> numbers;
  const auto vertex = [&](const std::array<int, 3>& p) {
    const auto [place, is_new] = numbers.try_emplace(p, static_cast<Index>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(Vector3(p[0], p[1], p[2]));
    return place->second;
  };
  for (int x = 0; x < columns; ++x)
    for (int y = 0; y < 3; ++y)
      for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
          std::array<int, 3> beyond = {x, y, 0};
          beyond[axis] += side ? 1 : -1;
          if (!solid(x, y, 0) || solid(beyond[0], beyond[1], beyond[2])) continue;
          const int u = (axis + 1) % 3, v = (axis + 2) % 3;
          std::array<int, 3> corner = {x, y, 0};
          corner[axis] += side;
          std::array<Index, 4> quad;
          for (int k = 0; k < 4; ++k) {
            std::array<int, 3> p = corner;
            p[u] += k == 1 || k == 2;
            p[v] += k >= 2;
            quad[side ? k : 3 - k] = vertex(p);
          }
          add_quad(mesh, quad[0], quad[1], quad[2], quad[3]);
        }
  return mesh;
}

TriangleMesh rough_sphere(int subdivisions, double roughness, std::uint32_t seed) {
  std::mt19937 random(seed);
  TriangleMesh mesh = unit_icosphere(subdivisions);
  for (Vector3& p : mesh.vertices) p *= 1 + roughness * (2 * uniform(random) - 1);
  round_to_floats(mesh);
  return mesh;
}

TriangleMesh sphere_with_hole(int subdivisions, double angle) {
  const TriangleMesh sphere = icosphere(subdivisions);
  const std::vector<char> hole = faces_in_cone(sphere, Vector3::UnitZ(), angle);
  return without_faces(sphere, [&](Index f) { return hole[f] != 0; });
}

TriangleMesh sphere_with_holes(int holes, int subdivisions, double angle) {
  const TriangleMesh sphere = icosphere(subdivisions);
  std::vector<char> removed(sphere.triangles.size(), 0);
  for (int hole = 0; hole < holes; ++hole) {
    const std::vector<char> inside =
        faces_in_cone(sphere, (hole % 2 ? -1 : 1) * Vector3::Unit(hole / 2), angle);
    for (std::size_t f = 0; f < removed.size(); ++f) removed[f] |= inside[f];
  }
  return without_faces(sphere, [&](Index f) { return removed[f] != 0; });
}

TriangleMesh sphere_with_island(int subdivisions, double outer_angle, double inner_angle) {
  const TriangleMesh sphere = icosphere(subdivisions);
  const std::vector<char> hole = faces_in_cone(sphere, Vector3::UnitZ(), outer_angle);
  const std::vector<char> island = faces_in_cone(sphere, Vector3::UnitZ(), inner_angle);
  return without_faces(sphere, [&](Index f) { return hole[f] && !island[f]; });
}

TriangleMesh open_cylinder(int segments, int rings, double radius, double height) {
  TriangleMesh mesh;
  const auto at = [&](int ring, int segment) {
    return static_cast<Index>(ring * segments + segment % segments);
  };
  for (int ring = 0; ring <= rings; ++ring)
    for (int segment = 0; segment < segments; ++segment) {
      const double around = 2 * pi * segment / segments;
      mesh.vertices.push_back({radius * std::cos(around), radius * std::sin(around), height * ring / rings});
    }
  for (int ring = 0; ring < rings; ++ring)
    for (int segment = 0; segment < segments; ++segment)
      add_quad(mesh, at(ring, segment), at(ring, segment + 1), at(ring + 1, segment + 1),
               at(ring + 1, segment));
  round_to_floats(mesh);
  return mesh;
}

TriangleMesh rough_sphere_with_ragged_holes(int subdivisions, int holes, std::uint32_t seed,
                                            double roughness) {
  std::mt19937 random(seed + 1);
  return with_ragged_holes(rough_sphere(subdivisions, roughness, seed), holes, random);
}

TriangleMesh sphere_with_touching_holes(int subdivisions) {
  const TriangleMesh sphere = icosphere(subdivisions);
  // Two vertices with one common neighbour only: their one-rings touch in that vertex.
  std::vector<std::vector<Index>> ring(sphere.vertices.size());
  for (const Triangle& t : sphere.triangles)
    for (int k = 0; k < 3; ++k) ring[t[k]].push_back(t[(k + 1) % 3]);
  for (auto& r : ring) std::sort(r.begin(), r.end());
  Index other = none;
  for (Index v = 1; v < ring.size() && other == none; ++v) {
    std::vector<Index> common;
    std::set_intersection(ring[0].begin(), ring[0].end(), ring[v].begin(), ring[v].end(),
                          std::back_inserter(common));
    if (common.size() == 1) other = v;
  }
  return without_faces(sphere, [&](Index f) {
    const Triangle& t = sphere.triangles[f];
    return std::any_of(t.begin(), t.end(), [&](Index v) { return v == 0 || v == other; });
  });
}

TriangleMesh collar(const std::vector<Vector3>& rim, const std::vector<Vector3>& outer) {
  TriangleMesh mesh;
  mesh.vertices = rim;
  mesh.vertices.insert(mesh.vertices.end(), outer.begin(), outer.end());
  const Index n = static_cast<Index>(rim.size());
  for (Index i = 0; i < n; ++i) add_quad(mesh, (i + 1) % n, i, n + i, n + (i + 1) % n);
  round_to_floats(mesh);
  return mesh;
}

TriangleMesh flat_grid(int columns, int rows) {
  TriangleMesh mesh;
  const auto at = [&](int x, int y) { return static_cast<Index>(y * (columns + 1) + x); };
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x) mesh.vertices.push_back(Vector3(x, y, 0));
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) add_quad(mesh, at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
  return mesh;
}

TriangleMesh rough_sheet(int columns, int rows, double roughness, int holes, std::uint32_t seed) {
  std::mt19937 random(seed);
  TriangleMesh mesh = flat_grid(columns, rows);
  for (Vector3& p : mesh.vertices) p.z() = roughness * (2 * uniform(random) - 1);
  round_to_floats(mesh);
  return with_ragged_holes(mesh, holes, random);
}

TriangleMesh moebius_strip(int segments) {
  TriangleMesh mesh;
  for (int i = 0; i < segments; ++i)
    for (int side = 0; side < 2; ++side) {
      const double around = 2 * pi * i / segments, across = side ? 0.3 : -0.3;
      const double r = 1 + across * std::cos(around / 2);
      mesh.vertices.push_back({r * std::cos(around), r * std::sin(around), across * std::sin(around / 2)});
    }
  const auto at = [&](int i, int side) {
    return static_cast<Index>(2 * (i % segments) + (i < segments ? side : 1 - side));
  };
  for (int i = 0; i < segments; ++i) add_quad(mesh, at(i, 0), at(i, 1), at(i + 1, 1), at(i + 1, 0));
  round_to_floats(mesh);
  return mesh;
}

TriangleMesh isolated_triangle() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

TriangleMesh pinched_tetrahedra() {
  const TriangleMesh one = tetrahedron();
  TriangleMesh mesh = one;
  for (int v = 1; v < 4; ++v) mesh.vertices.push_back(-one.vertices[v]);
  for (const auto& [a, b, c] : one.triangles) {
    const auto number = [](Index v) { return v ? v + 3 : 0; };
    mesh.triangles.push_back({number(b), number(a), number(c)});  // a point reflection turns faces over
  }
  return mesh;
}

TriangleMesh book(int pages) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 0, 1}};
  for (int page = 0; page < pages; ++page) {
    const double around = 2 * pi * page / pages;
    mesh.triangles.push_back({0, 1, static_cast<Index>(mesh.vertices.size())});
    mesh.vertices.push_back({std::cos(around), std::sin(around), 0.5});
  }
  round_to_floats(mesh);
  return mesh;
}

TriangleMesh sphere_with_hole_and_fin(int subdivisions, double angle) {
  TriangleMesh mesh = sphere_with_hole(subdivisions, angle);
  const auto lowest = std::min_element(mesh.triangles.begin(), mesh.triangles.end(),
                                       [&](const Triangle& s, const Triangle& t) {
                                         return mesh.vertices[s[0]].z() < mesh.vertices[t[0]].z();
                                       });
  const Index a = (*lowest)[0], b = (*lowest)[1];
  mesh.triangles.push_back({a, b, static_cast<Index>(mesh.vertices.size())});
  mesh.vertices.push_back(rounded(0.8 * (mesh.vertices[a] + mesh.vertices[b])));
  return mesh;
}

TriangleMesh cube_with_zero_area_face() {
  TriangleMesh mesh = cube(2);
  const Triangle split = mesh.triangles[0];
  const auto [a, b, c] = split;
  const Index middle = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
  mesh.triangles[0] = {a, middle, c};
  mesh.triangles.push_back({middle, b, c});
  mesh.triangles.push_back({a, b, middle});
  return mesh;
}

TriangleMesh join(const TriangleMesh& first, const TriangleMesh& second) {
  TriangleMesh mesh = first;
  const Index shift = static_cast<Index>(first.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), second.vertices.begin(), second.vertices.end());
  for (const auto& [a, b, c] : second.triangles) mesh.triangles.push_back({a + shift, b + shift, c + shift});
  return mesh;
}

TriangleMesh translated(TriangleMesh mesh, const Vector3& offset) {
  for (Vector3& p : mesh.vertices) p += offset;
  round_to_floats(mesh);
  return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vector3& p : mesh.vertices) p *= factor;
  round_to_floats(mesh);
  return mesh;
}

TriangleMesh flipped(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh without_faces(const TriangleMesh& mesh, const std::function<bool(Index face)>& remove) {
  TriangleMesh rest;
  std::vector<Index> number(mesh.vertices.size(), none);
  for (Index f = 0; f < mesh.triangles.size(); ++f)
    if (!remove(f)) {
      rest.triangles.push_back(mesh.triangles[f]);
      for (Index v : mesh.triangles[f]) number[v] = 0;
    }
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] != none) {
      number[v] = static_cast<Index>(rest.vertices.size());
      rest.vertices.push_back(mesh.vertices[v]);
    }
  for (Triangle& t : rest.triangles)
    for (Index& v : t) v = number[v];
  return rest;
}

TriangleMesh without_ball(const TriangleMesh& mesh, const Vector3& centre, double radius) {
  return without_faces(mesh, [&](Index f) {
    const Triangle& t = mesh.triangles[f];
    return std::any_of(t.begin(), t.end(),
                       [&](Index v) { return (mesh.vertices[v] - centre).norm() < radius; });
  });
}

TriangleMesh unwelded(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const Index first = static_cast<Index>(soup.vertices.size());
    for (Index v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TriangleMesh shuffled(const TriangleMesh& mesh, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto shuffle = [&](auto& list) {
    for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[random() % i]);
  };
  std::vector<Index> number(mesh.vertices.size());
  std::iota(number.begin(), number.end(), Index{0});
  shuffle(number);
  TriangleMesh other;
  other.vertices.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < number.size(); ++v) other.vertices[number[v]] = mesh.vertices[v];
  for (const auto& [a, b, c] : mesh.triangles) {
    Triangle t = {number[a], number[b], number[c]};
    std::rotate(t.begin(), t.begin() + random() % 3, t.end());
    other.triangles.push_back(t);
  }
  shuffle(other.triangles);
  return other;
}

std::vector<std::array<Vector3, 3>> corners_of(const TriangleMesh& mesh) {
  std::vector<std::array<Vector3, 3>> corners;
  for (const auto& [a, b, c] : mesh.triangles)
    corners.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  return corners;
}

}  // namespace test
}  // namespace meshcomplete
