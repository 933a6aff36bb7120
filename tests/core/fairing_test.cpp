#include "common/core/fairing.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "common/core/error.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

constexpr double pi = 3.14159265358979323846;

constexpr SurfaceEnergy energies[] = {SurfaceEnergy::membrane, SurfaceEnergy::thin_plate,
                                      SurfaceEnergy::normal_variation};
constexpr LaplacianWeights weightings[] = {LaplacianWeights::uniform, LaplacianWeights::cotangent};

struct Case {
  TriangleMesh surface;
  std::vector<char> fixed;
};

/// The top of the unit sphere within `outer` radians of the pole, as faces; vertices within `inner` of it are
/// free, and pressed flat to begin with.
Case cap(double inner, double outer, int subdivisions = 3) {
  const TriangleMesh sphere = test::icosphere(subdivisions);
  const auto polar = [&](const Vector3& p) { return std::atan2(std::hypot(p.x(), p.y()), p.z()); };
  Case c;
  c.surface = test::without_faces(sphere, [&](Index f) {
    const Triangle& t = sphere.triangles[f];
    return std::any_of(t.begin(), t.end(), [&](Index v) { return polar(sphere.vertices[v]) > outer; });
  });
  for (Vector3& p : c.surface.vertices) {
    c.fixed.push_back(polar(p) > inner);
    if (!c.fixed.back()) p.z() = std::cos(inner);
  }
  return c;
}

/// A flat square of `n` * `n` cells with the vertices jittered; the outer `rings` + 1 rows of vertices are
/// fixed.
Case sheet(int n, int rings, unsigned seed) {
  Case c;
  c.surface = test::flat_grid(n, n);
  std::mt19937 random(seed);
  const auto jitter = [&] { return 0.5 * (random() * (1.0 / 4294967296.0) - 0.5); };
  for (Vector3& p : c.surface.vertices) {
    const bool fixed = std::min({p.x(), p.y(), n - p.x(), n - p.y()}) <= rings;
    c.fixed.push_back(fixed);
    p += Vector3(jitter(), jitter(), 0);
  }
  return c;
}

std::size_t free_count(const Case& c) {
  return static_cast<std::size_t>(std::count(c.fixed.begin(), c.fixed.end(), 0));
}

/// Sum over the inner edges of length times squared jump of the unit normal.
double normal_jumps(const TriangleMesh& mesh) {
  std::map<std::pair<Index, Index>, std::vector<Vector3>> normals;
  for (const Triangle& t : mesh.triangles) {
    const Vector3 n = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                          .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                          .normalized();
    for (int k = 0; k < 3; ++k) normals[std::minmax(t[k], t[(k + 1) % 3])].push_back(n);
  }
  double sum = 0;
  for (const auto& [edge, pair] : normals)
    if (pair.size() == 2)
      sum +=
          (mesh.vertices[edge.first] - mesh.vertices[edge.second]).norm() * (pair[0] - pair[1]).squaredNorm();
  return sum;
}

double worst_radius_error(const Case& c) {
  double worst = 0;
  for (std::size_t v = 0; v < c.fixed.size(); ++v)
    if (!c.fixed[v]) worst = std::max(worst, std::abs(c.surface.vertices[v].norm() - 1));
  return worst;
}

double total_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum +=
        0.5 *
        (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm();
  return sum;
}

TEST(Fairing, FixedVerticesAreKeptToTheBit) {
  for (SurfaceEnergy energy : energies)
    for (LaplacianWeights weights : weightings) {
      Case c = cap(0.6, 1.0);
      ASSERT_GT(free_count(c), 20u);
      for (Vector3& p : c.surface.vertices) p = p * 0.1 + Vector3(1000.1, -0.3, 1e-7);
      const std::vector<Vector3> before = c.surface.vertices;
      const std::vector<Triangle> triangles = c.surface.triangles;
      minimize_energy(c.surface, c.fixed, energy, weights);
      EXPECT_EQ(c.surface.triangles, triangles);
      bool moved = false;
      for (std::size_t v = 0; v < before.size(); ++v) {
        if (c.fixed[v]) {
          EXPECT_EQ(c.surface.vertices[v], before[v]);
        }
        moved |= c.surface.vertices[v] != before[v];
      }
      EXPECT_TRUE(moved);
    }
}

TEST(Fairing, NothingFreeNothingDone) {
  Case c = cap(0.6, 1.0);
  const std::vector<Vector3> before = c.surface.vertices;
  minimize_energy(c.surface, std::vector<char>(before.size(), 1), SurfaceEnergy::thin_plate,
                  LaplacianWeights::cotangent);
  EXPECT_EQ(c.surface.vertices, before);
}

// --- planes
// --------------------------------------------------------------------------------------------------

TEST(Fairing, APlaneStaysAPlane) {
  const Vector3 normal = Vector3(1, -2, 3).normalized();
  for (SurfaceEnergy energy : energies)
    for (LaplacianWeights weights : weightings) {
      Case c = sheet(12, 1, 3);
      // Tilted, and the free vertices moved off the plane.
      for (std::size_t v = 0; v < c.fixed.size(); ++v) {
        Vector3& p = c.surface.vertices[v];
        p.z() = -(normal.x() * p.x() + normal.y() * p.y()) / normal.z();
        if (!c.fixed[v]) p += 0.2 * std::sin(static_cast<double>(v)) * normal;
      }
      minimize_energy(c.surface, c.fixed, energy, weights);
      for (const Vector3& p : c.surface.vertices)
        EXPECT_NEAR(p.dot(normal), 0, 1e-9) << name(energy) << " " << static_cast<int>(weights);
    }
}

// With cotangent weights a flat triangulation is a minimum as it is.
TEST(Fairing, CotangentWeightsLeaveAFlatTriangulationAlone) {
  for (SurfaceEnergy energy : energies)
    for (unsigned seed = 1; seed <= 5; ++seed) {
      Case c = sheet(10, 1, seed);
      // All edges inside Delaunay, or the bound on the weights would rightly come in.
      const auto cotangent_sum_positive = [&] {
        std::map<std::pair<Index, Index>, double> sum;
        for (const Triangle& t : c.surface.triangles)
          for (int k = 0; k < 3; ++k) {
            const Vector3 o = c.surface.vertices[t[(k + 2) % 3]];
            const Vector3 a = c.surface.vertices[t[k]] - o, b = c.surface.vertices[t[(k + 1) % 3]] - o;
            sum[std::minmax(t[k], t[(k + 1) % 3])] += a.dot(b) / a.cross(b).norm();
          }
        return std::all_of(sum.begin(), sum.end(), [](const auto& entry) { return entry.second > 0.05; });
      };
      for (int halving = 0; halving < 10 && !cotangent_sum_positive(); ++halving) {
        const TriangleMesh grid = test::flat_grid(10, 10);
        for (std::size_t v = 0; v < grid.vertices.size(); ++v) {
          // Sheared, so that the grid's right angles do not give weights of zero.
          const Vector3 sheared(grid.vertices[v].x() - 0.4 * grid.vertices[v].y(), grid.vertices[v].y(), 0);
          const Vector3 offset = c.surface.vertices[v] - grid.vertices[v];
          c.surface.vertices[v] =
              sheared + 0.2 * offset.normalized() * std::min(offset.norm(), 1.0) / (1 + halving);
        }
      }
      if (!cotangent_sum_positive()) continue;
      const std::vector<Vector3> before = c.surface.vertices;
      minimize_energy(c.surface, c.fixed, energy, LaplacianWeights::cotangent);
      for (std::size_t v = 0; v < before.size(); ++v)
        EXPECT_LT((c.surface.vertices[v] - before[v]).norm(), 1e-9) << name(energy);
    }
}

TEST(Fairing, TheMembraneOfAPlanarRimIsPlanar) {
  for (LaplacianWeights weights : weightings) {
    Case c = sheet(10, 0, 2);
    for (std::size_t v = 0; v < c.fixed.size(); ++v)
      if (!c.fixed[v]) c.surface.vertices[v].z() = 1 + std::cos(static_cast<double>(v));
    minimize_energy(c.surface, c.fixed, SurfaceEnergy::membrane, weights);
    for (const Vector3& p : c.surface.vertices) EXPECT_NEAR(p.z(), 0, 1e-12);
  }
}

// The least-squares mesh: every free vertex at the mean of its neighbours.
TEST(Fairing, TheUniformMembraneIsTheMeanOfItsNeighbours) {
  Case c = cap(0.8, 1.1);
  minimize_energy(c.surface, c.fixed, SurfaceEnergy::membrane, LaplacianWeights::uniform);
  std::vector<std::map<Index, int>> neighbours(c.fixed.size());
  for (const Triangle& t : c.surface.triangles)
    for (int k = 0; k < 3; ++k) {
      neighbours[t[k]][t[(k + 1) % 3]] = 1;
      neighbours[t[(k + 1) % 3]][t[k]] = 1;
    }
  for (std::size_t v = 0; v < c.fixed.size(); ++v) {
    if (c.fixed[v]) continue;
    Vector3 mean = Vector3::Zero();
    for (const auto& [u, one] : neighbours[v]) mean += c.surface.vertices[u];
    EXPECT_LT((mean / static_cast<double>(neighbours[v].size()) - c.surface.vertices[v]).norm(), 1e-12);
  }
}

// --- spheres
// --------------------------------------------------------------------------------------------------

TEST(Fairing, TheThinPlateContinuesASphere) {
  for (LaplacianWeights weights : weightings)
    for (double inner : {0.3, 0.5, 0.8}) {
      Case plate = cap(inner, inner + 0.3), membrane = plate;
      minimize_energy(plate.surface, plate.fixed, SurfaceEnergy::thin_plate, weights);
      minimize_energy(membrane.surface, membrane.fixed, SurfaceEnergy::membrane, weights);
      const double sagitta = 1 - std::cos(inner);  // what a flat lid would be off by
      EXPECT_LT(worst_radius_error(plate), (inner < 0.6 ? 0.15 : 0.3) * sagitta) << inner;
      EXPECT_GT(worst_radius_error(membrane), 0.5 * sagitta) << "a membrane is nearly flat";
    }
}

TEST(Fairing, TheMembraneHasTheSmallestArea) {
  for (LaplacianWeights weights : weightings) {
    double area[3];
    for (SurfaceEnergy energy : energies) {
      Case c = cap(0.8, 1.1);
      minimize_energy(c.surface, c.fixed, energy, weights);
      area[static_cast<int>(energy)] = total_area(c.surface);
    }
    EXPECT_LT(area[0], area[1]);
    EXPECT_LT(area[0], area[2]);
  }
}

TEST(Fairing, NormalVariationLowersTheJumpsOfTheNormals) {
  for (LaplacianWeights weights : weightings)
    for (double inner : {0.4, 0.8, 1.2}) {
      double jumps[3];
      for (SurfaceEnergy energy : energies) {
        Case c = cap(inner, inner + 0.3);
        minimize_energy(c.surface, c.fixed, energy, weights);
        jumps[static_cast<int>(energy)] = normal_jumps(c.surface);
      }
      EXPECT_LT(jumps[2], 0.7 * jumps[0]) << "membrane, " << inner;
      EXPECT_LT(jumps[2], 1.001 * jumps[1]) << "thin plate, which it starts from, " << inner;
    }
}

// --- invariance
// --------------------------------------------------------------------------------------------------

TEST(Fairing, ScalingByPowersOfTwoCommutesToTheBit) {
  for (SurfaceEnergy energy : energies)
    for (LaplacianWeights weights : weightings)
      for (double factor : {0x1p-20, 0x1p30}) {
        Case c = cap(0.6, 0.9), scaled = c;
        for (Vector3& p : scaled.surface.vertices) p *= factor;
        minimize_energy(c.surface, c.fixed, energy, weights);
        minimize_energy(scaled.surface, scaled.fixed, energy, weights);
        for (std::size_t v = 0; v < c.fixed.size(); ++v)
          EXPECT_EQ(scaled.surface.vertices[v], Vector3(factor * c.surface.vertices[v]));
      }
}

TEST(Fairing, RigidMotionsCommute) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3(1, 2, -1).normalized()).toRotationMatrix();
  const Vector3 offset(10, -20, 5);
  for (SurfaceEnergy energy : energies)
    for (LaplacianWeights weights : weightings) {
      Case c = cap(0.6, 0.9), moved = c;
      for (Vector3& p : moved.surface.vertices) p = turn * p + offset;
      minimize_energy(c.surface, c.fixed, energy, weights);
      minimize_energy(moved.surface, moved.fixed, energy, weights);
      // The normal variation is descended in steps, which may end one earlier or later.
      const double tolerance = energy == SurfaceEnergy::normal_variation ? 1e-3 : 1e-9;
      for (std::size_t v = 0; v < c.fixed.size(); ++v)
        EXPECT_LT((moved.surface.vertices[v] - (turn * c.surface.vertices[v] + offset)).norm(), tolerance);
    }
}

// The grid's diagonals all run one way: a half turn maps it to itself, vertex i to vertex n - 1 - i.
TEST(Fairing, ASymmetricProblemHasASymmetricSolution) {
  for (SurfaceEnergy energy : energies)
    for (LaplacianWeights weights : weightings) {
      Case c;
      c.surface = test::flat_grid(10, 10);
      for (Vector3& p : c.surface.vertices) {
        c.fixed.push_back(std::min({p.x(), p.y(), 10 - p.x(), 10 - p.y()}) <= 1);
        p -= Vector3(5, 5, 0);
        p.z() = c.fixed.back() ? 0.05 * (p.x() * p.x() - p.x() * p.y()) : 0;
      }
      minimize_energy(c.surface, c.fixed, energy, weights);
      const std::size_t n = c.fixed.size();
      for (std::size_t v = 0; v < n; ++v) {
        const Vector3 &p = c.surface.vertices[v], &q = c.surface.vertices[n - 1 - v];
        EXPECT_LT((Vector3(-p.x(), -p.y(), p.z()) - q).norm(), 1e-9) << name(energy);
      }
    }
}

TEST(Fairing, TheSameTwice) {
  for (SurfaceEnergy energy : energies) {
    Case c = cap(0.6, 0.9), again = c;
    minimize_energy(c.surface, c.fixed, energy, LaplacianWeights::cotangent);
    minimize_energy(again.surface, again.fixed, energy, LaplacianWeights::cotangent);
    EXPECT_EQ(c.surface.vertices, again.surface.vertices);
  }
}

// --- bad input
// --------------------------------------------------------------------------------------------------

TEST(Fairing, NeedlesInTheRingDoNoHarm) {
  for (SurfaceEnergy energy : energies)
    for (LaplacianWeights weights : weightings) {
      Case c = cap(0.6, 0.9);
      // A needle and a face without area on fixed vertices.
      const Index v = static_cast<Index>(std::find(c.fixed.begin(), c.fixed.end(), 1) - c.fixed.begin());
      const Index needle = static_cast<Index>(c.surface.vertices.size());
      c.surface.vertices.push_back(c.surface.vertices[v] + Vector3(1e-7, 0, 0));
      c.surface.vertices.push_back(c.surface.vertices[v] + Vector3(0.5, 1e-9, 0));
      c.surface.vertices.push_back(c.surface.vertices[v] + Vector3(1, 0, 0));
      c.surface.vertices.push_back(c.surface.vertices[v] + Vector3(2, 0, 0));
      c.fixed.resize(c.surface.vertices.size(), 1);
      c.surface.triangles.push_back({v, needle, needle + 1});
      c.surface.triangles.push_back({v, needle + 2, needle + 3});
      minimize_energy(c.surface, c.fixed, energy, weights);
      for (const Vector3& p : c.surface.vertices) {
        ASSERT_TRUE(p.allFinite());
        EXPECT_LT(p.norm(), 4);
      }
    }
}

TEST(Fairing, AFreeVertexWithoutFacesIsAnError) {
  for (SurfaceEnergy energy : energies)
    for (LaplacianWeights weights : weightings) {
      Case c = cap(0.6, 0.9);
      c.surface.vertices.emplace_back(0.1, 0.2, 0.3);
      c.fixed.push_back(0);
      EXPECT_THROW(minimize_energy(c.surface, c.fixed, energy, weights), CompletionError)
          << name(energy) << " " << static_cast<int>(weights);
    }
}

TEST(Fairing, AFreePieceThatTouchesNothingFixedIsAnError) {
  for (SurfaceEnergy energy : energies)
    for (LaplacianWeights weights : weightings) {
      Case c = cap(0.6, 0.9);
      c.surface = test::join(c.surface, test::rough_sphere(1, 0.1, 5));
      c.fixed.resize(c.surface.vertices.size(), 0);
      EXPECT_THROW(minimize_energy(c.surface, c.fixed, energy, weights), CompletionError)
          << name(energy) << " " << static_cast<int>(weights);
    }
}

TEST(Fairing, EverythingAtOnePointIsAnError) {
  Case c = cap(0.6, 0.9);
  std::fill(c.surface.vertices.begin(), c.surface.vertices.end(), Vector3(1, 2, 3));
  EXPECT_THROW(minimize_energy(c.surface, c.fixed, SurfaceEnergy::thin_plate, LaplacianWeights::cotangent),
               CompletionError);
}

TEST(Fairing, CanBeCancelled) {
  Case c = cap(0.6, 0.9);
  EXPECT_THROW(
      minimize_energy(c.surface, c.fixed, SurfaceEnergy::normal_variation, LaplacianWeights::cotangent,
                      Progress([](double, const std::string&) { return false; })),
      Cancelled);
}

/// A square, flat at its border, with a hump of its free vertices.
Case hump(double height) {
  Case c = sheet(20, 3, 7);
  for (Index v = 0; v < c.surface.vertices.size(); ++v) {
    Vector3& p = c.surface.vertices[v];
    if (!c.fixed[v])
      p.z() = height * std::pow(std::cos(pi * (p.x() / 20 - 0.5)) * std::cos(pi * (p.y() / 20 - 0.5)), 2);
  }
  return c;
}

double highest(const TriangleMesh& surface) {
  double z = 0;
  for (const Vector3& p : surface.vertices) z = std::max(z, p.z());
  return z;
}

double variation_of_normals(const TriangleMesh& surface) {
  std::map<std::pair<Index, Index>, Vector3> first;
  double sum = 0;
  for (const Triangle& t : surface.triangles) {
    const Vector3 &a = surface.vertices[t[0]], &b = surface.vertices[t[1]], &c = surface.vertices[t[2]];
    const Vector3 normal = (b - a).cross(c - a).normalized();
    for (int k = 0; k < 3; ++k) {
      const Index v = t[k], w = t[(k + 1) % 3];
      const auto [found, added] = first.emplace(std::minmax(v, w), normal);
      if (!added) sum += (surface.vertices[v] - surface.vertices[w]).norm() * (1 - found->second.dot(normal));
    }
  }
  return sum;
}

TEST(Fairing, LoweringStartsFromTheShapeThatIsThere) {
  const Case before = hump(6);
  Case from_rim = before, from_shape = before;
  minimize_energy(from_rim.surface, before.fixed, SurfaceEnergy::normal_variation,
                  LaplacianWeights::cotangent);
  EXPECT_LT(highest(from_rim.surface), 0.1);
  const double diagonal = Vector3(20, 20, 6).norm();
  lower_normal_variation(from_shape.surface, before.fixed, 0.06);
  EXPECT_GT(highest(from_shape.surface), 6 - 0.07 * diagonal);
  EXPECT_LT(variation_of_normals(from_shape.surface), 0.9 * variation_of_normals(before.surface));
}

TEST(Fairing, LoweringMovesNoVertexFartherThanAllowed) {
  const Case before = hump(6);
  Eigen::AlignedBox3d box;
  for (const Vector3& p : before.surface.vertices) box.extend(p);
  double last = 0;
  for (double share : {0.005, 0.02, 0.06}) {
    Case c = before;
    lower_normal_variation(c.surface, c.fixed, share);
    double longest = 0;
    for (Index v = 0; v < c.surface.vertices.size(); ++v) {
      const double move = (c.surface.vertices[v] - before.surface.vertices[v]).norm();
      if (c.fixed[v]) {
        EXPECT_EQ(move, 0);
      }
      longest = std::max(longest, move);
    }
    EXPECT_LE(longest, share * box.diagonal().norm() * (1 + 1e-9));
    EXPECT_GT(longest, last);
    last = longest;
  }
}

TEST(Fairing, EnergiesHaveNames) {
  EXPECT_STREQ(name(SurfaceEnergy::membrane), "membrane");
  EXPECT_STREQ(name(SurfaceEnergy::thin_plate), "thin plate");
  EXPECT_STREQ(name(SurfaceEnergy::normal_variation), "normal variation");
}

}  // namespace
}  // namespace meshcomplete
