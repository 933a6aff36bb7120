// A mesh in a root cube at a random place, divided into atomic volumes, and what is known of inside and
// outside by other means.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch.h"
#include "common/core/patch_check.h"
#include "filter_atomicvolumes/decomposition.h"
#include "filter_atomicvolumes/labelling.h"
#include "filter_atomicvolumes/lattice_mesh.h"
#include "filter_atomicvolumes/square_triangulation.h"
#include "filter_atomicvolumes/volume_complex.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace test {

/// Uniform in [0, 1), the same on every platform.
inline double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// A mesh and all that questions about it on a lattice need. The root is a cube 1.5 to 2 times as large as
/// the mesh, which lies at a random place in it.
class PlacedMesh {
 public:
  PlacedMesh(TriangleMesh given, std::uint64_t seed)
      : mesh(std::move(given)),
        topology(build_topology(mesh)),
        neighbourhood(mesh),
        lattice_mesh{mesh, topology, neighbourhood, root(mesh, seed)} {}
  PlacedMesh(const PlacedMesh&) = delete;
  PlacedMesh& operator=(const PlacedMesh&) = delete;

  const TriangleMesh mesh;
  const MeshTopology topology;
  const InputNeighbourhood neighbourhood;
  const LatticeMesh lattice_mesh;

 private:
  static Lattice root(const TriangleMesh& mesh, std::uint64_t seed) {
    Vector3 low = mesh.vertices[mesh.triangles[0][0]], high = low;
    for (const Triangle& t : mesh.triangles)
      for (Index v : t) {
        low = low.cwiseMin(mesh.vertices[v]);
        high = high.cwiseMax(mesh.vertices[v]);
      }
    std::mt19937_64 random(seed);
    const double length = (high - low).maxCoeff(), side = (1.5 + 0.5 * uniform(random)) * length;
    Vector3 origin = low;
    for (int k = 0; k < 3; ++k) origin[k] -= 0.05 * side + uniform(random) * (0.9 * side - (high - low)[k]);
    return Lattice(origin, side);
  }
};

/// Space divided round a mesh.
struct Division {
  Decomposition decomposition;
  VolumeComplex complex;
};

/// Absent when two features coincide in this root. Crossed cubes that disagree are split until none are left.
inline std::optional<Division> divide(const PlacedMesh& placed, const DecompositionOptions& options = {}) {
  try {
    Division division{decompose(placed.lattice_mesh, options), {}};
    division.complex = build_complex(placed.lattice_mesh, division.decomposition);
    for (int round = 0; round < 8 && !division.complex.disagreeing.empty(); ++round) {
      split_further(division.decomposition, placed.lattice_mesh, options, division.complex.disagreeing);
      division.complex = build_complex(placed.lattice_mesh, division.decomposition);
    }
    return division;
  } catch (const Coincidence&) {
    return std::nullopt;
  }
}

/// How often a closed mesh winds round a point: 1 inside, 0 outside. By the solid angles of the faces.
inline double winding_number(const TriangleMesh& mesh, const Vector3& point) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vector3 a = mesh.vertices[t[0]] - point, b = mesh.vertices[t[1]] - point,
                  c = mesh.vertices[t[2]] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4 * 3.14159265358979323846);
}

// --- meshes to complete
// -------------------------------------------------------------------------------------------

/// A torus without what lies within `radius` of three points on it, one of them on its inner side.
inline TriangleMesh torus_with_missing_parts(double radius = 0.35) {
  TriangleMesh mesh = torus(24, 12);
  for (const Vector3& centre : {Vector3(1.4, 0, 0), Vector3(-0.5, 0.4, 0.1), Vector3(-0.6, -0.8, 0.4)})
    mesh = without_ball(mesh, centre, radius);
  return mesh;
}

/// A sphere without a band round its middle: two caps apart, one hole with two boundary loops.
inline TriangleMesh two_caps(int subdivisions = 2, double height = 0.3) {
  const TriangleMesh sphere = icosphere(subdivisions);
  return without_faces(sphere, [&](Index f) {
    double least = 2;
    for (Index v : sphere.triangles[f]) least = std::min(least, std::abs(sphere.vertices[v].z()));
    return least < height;
  });
}

/// A sphere with a hole in it and another one, closed or not, turned inside out within: a thick shell.
inline TriangleMesh shell_with_hole(bool hole_within) {
  const TriangleMesh outer = sphere_with_hole(2, 0.6);
  const TriangleMesh inner = hole_within ? sphere_with_hole(2, 0.7) : icosphere(2);
  return join(outer, flipped(scaled(inner, 0.5)));
}

/// A sphere with a hole, one of its vertices next to the rim pushed through a face not far from it, in many
/// ways for each of so many vertices.
inline std::vector<TriangleMesh> folded_meshes(std::size_t vertices) {
  const TriangleMesh sphere = sphere_with_hole(2, 0.6);
  std::vector<char> at_rim(sphere.vertices.size(), 0);
  for (Index h : build_topology(sphere).boundary_half_edges) at_rim[sphere.triangles[h / 3][h % 3]] = 1;
  std::set<Index> next_to_rim;
  for (const Triangle& t : sphere.triangles)
    if (at_rim[t[0]] || at_rim[t[1]] || at_rim[t[2]])
      for (Index v : t)
        if (!at_rim[v] && next_to_rim.size() < vertices) next_to_rim.insert(v);
  std::vector<TriangleMesh> meshes;
  for (Index vertex : next_to_rim)
    for (const Triangle& t : sphere.triangles) {
      const Vector3 middle = (sphere.vertices[t[0]] + sphere.vertices[t[1]] + sphere.vertices[t[2]]) / 3;
      if (std::count(t.begin(), t.end(), vertex) || (middle - sphere.vertices[vertex]).norm() > 0.6) continue;
      meshes.push_back(sphere);
      meshes.back().vertices[vertex] = as_stored(1.05 * middle);
    }
  return meshes;
}

/// A sphere whose upper pole is two vertices, each with five faces: between them two opposite faces are
/// missing, so that two holes touch there.
struct SplitPole {
  TriangleMesh mesh = uv_sphere(8, 12);
  Index original = 0, copy = static_cast<Index>(mesh.vertices.size());

  SplitPole() {
    while (mesh.vertices[original][2] < 0.999) ++original;
    mesh.vertices.push_back(mesh.vertices[original]);
    for (Triangle& t : mesh.triangles) {
      if (std::count(t.begin(), t.end(), original) == 0) continue;
      const Vector3 middle = mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]];
      const double angle = std::atan2(middle[1], middle[0]) * 180 / 3.14159265;
      if ((0 < angle && angle < 30) || angle < -150)
        t.fill(original);
      else if (angle > 0)
        std::replace(t.begin(), t.end(), original, copy);
    }
    const auto repeats = [](const Triangle& t) { return t[0] == t[1]; };
    mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), repeats),
                         mesh.triangles.end());
  }
};

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

/// Holes of all kinds: round, with islands, between pieces apart, ragged and touching themselves at vertices.
inline std::vector<NamedMesh> holed_meshes() {
  return {{"sphere", sphere_with_hole(2, 0.6)},
          {"six holes", sphere_with_holes(6, 2, 0.4)},
          {"island", sphere_with_island(3, 0.9, 0.4)},
          {"cylinder", open_cylinder(9, 3)},
          {"torus", torus_with_missing_parts()},
          {"two caps", two_caps()},
          {"touching holes", sphere_with_touching_holes()},
          {"ragged", rough_sphere_with_ragged_holes(2, 4, 3)},
          {"ragged and rough", rough_sphere_with_ragged_holes(3, 5, 5, 0.05)},
          {"shell", shell_with_hole(false)},
          {"shell open within", shell_with_hole(true)},
          {"sheet", rough_sheet(6, 5, 0.3, 1, 2)},
          {"two spheres apart",
           join(sphere_with_hole(1, 0.7), translated(sphere_with_hole(2, 0.5), Vector3(1.2, 2, -1.3)))}};
}

/// A mesh with holes, and the closed one that it is a part of: what is inside is known.
struct PuncturedMesh {
  std::string name;
  TriangleMesh closed, mesh;
};

inline std::vector<PuncturedMesh> punctured_meshes() {
  const TriangleMesh within = flipped(scaled(icosphere(2), 0.5));
  const TriangleMesh rough = rough_sphere(3, 0.15, 4);
  return {{"sphere", icosphere(2), sphere_with_hole(2, 0.6)},
          {"six holes", icosphere(2), sphere_with_holes(6, 2, 0.4)},
          {"torus", torus(24, 12), torus_with_missing_parts()},
          {"two caps", icosphere(2), two_caps()},
          {"shell", join(icosphere(2), within), shell_with_hole(false)},
          {"shell open within", join(icosphere(2), within), shell_with_hole(true)},
          {"rough", rough, without_ball(without_ball(rough, Vector3(0, 0, 1), 0.3), Vector3(1, 0, 0), 0.4)}};
}

// --- labellings
// ---------------------------------------------------------------------------------------------------

/// Every node inside with this probability.
inline Labelling random_labelling(const VolumeComplex& complex, std::uint64_t seed, double share) {
  std::mt19937_64 random(seed);
  Labelling labelling;
  for (std::size_t node = 0; node < complex.nodes; ++node)
    labelling.inside.push_back(uniform(random) < share);
  return labelling;
}

}  // namespace test
}  // namespace meshcomplete
