#include "tests/support/atomic_solids.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <utility>

#include "common/core/mesh_topology.h"
#include "common/core/patch_check.h"
#include "filter_atomicvolumes/extraction.h"
#include "filter_atomicvolumes/volume_locator.h"

namespace meshcomplete {
namespace test {
namespace {

Lattice random_root(const TriangleMesh& mesh, std::uint64_t seed) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : mesh.triangles)
    for (Index v : t) box.extend(mesh.vertices[v]);
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const double side = box.sizes().maxCoeff() * (1.5 + 0.5 * uniform());
  Vector3 origin = box.min();
  for (int k = 0; k < 3; ++k) origin[k] -= 0.05 * side + uniform() * (0.9 * side - box.sizes()[k]);
  return Lattice(origin, side);
}

int euler_characteristic(const std::vector<Triangle>& triangles) {
  std::set<Index> vertices;
  std::set<std::pair<Index, Index>> edges;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      vertices.insert(t[k]);
      edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
    }
  return static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) +
         static_cast<int>(triangles.size());
}

class Gluing {
 public:
  explicit Gluing(const TriangleMesh& mesh) : parent_(mesh.vertices.size()) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
    for (const Triangle& t : mesh.triangles) {
      join(t[0], t[1]);
      join(t[1], t[2]);
    }
  }
  void join(Index a, Index b) { parent_[root(a)] = root(b); }
  int pieces(const TriangleMesh& mesh) {
    std::set<Index> roots;
    for (const Triangle& t : mesh.triangles) roots.insert(root(t[0]));
    return static_cast<int>(roots.size());
  }

 private:
  Index root(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  std::vector<Index> parent_;
};

// Every rim is a circle, which counts nothing in either part, so that Euler characteristics add up.
void glue(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<Sheet>& sheets,
          AtomicSolid& solid) {
  Gluing gluing(mesh);
  int euler = euler_characteristic(mesh.triangles);
  std::set<Index> closed;
  for (const Sheet& sheet : sheets) {
    if (sheet.flaw != Sheet::Flaw::none || sheet.closes.empty()) continue;
    euler += euler_characteristic(sheet.triangles);
    const auto origin = [&](Index h) { return mesh.triangles[h / 3][h % 3]; };
    for (Index h : sheet.closes) {
      closed.insert(h);
      gluing.join(origin(sheet.closes.front()), origin(h));
    }
    const Index first = static_cast<Index>(solid.vertices.size());
    for (const SheetVertex& v : sheet.vertices) solid.vertices.push_back(v.position);
    for (const Triangle& t : sheet.triangles)
      solid.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  solid.closed = closed.size() == topology.boundary_half_edges.size();
  solid.components = gluing.pieces(mesh);
  solid.genus = solid.components - euler / 2;
}

}  // namespace

double AtomicSolid::area() const { return mean(nullptr); }

double AtomicSolid::mean(const std::function<double(const Vector3&)>& distance) const {
  double area = 0, sum = 0;
  for (const auto& [a, b, c] : triangles) {
    const Vector3 &p = vertices[a], &q = vertices[b], &r = vertices[c];
    const double part = 0.5 * (q - p).cross(r - p).norm();
    area += part;
    if (distance) sum += part * (distance(p) + distance(q) + distance(r)) / 3;
  }
  return distance ? sum / area : area;
}

AtomicSolid complete_by_cut(const TriangleMesh& mesh, const VolumeConstraints& constraints,
                            std::uint64_t seed, const std::vector<Vector3>& asked, CutWeight weight,
                            const DecompositionOptions& options) {
  const MeshTopology topology = build_topology(mesh);
  const InputNeighbourhood neighbourhood(mesh);
  const PreparedConstraints prepared(mesh, topology, neighbourhood, constraints);
  const LatticeMesh placed{mesh, topology, neighbourhood, random_root(mesh, seed)};
  Decomposition decomposition = decompose(placed, options);
  refine_for_constraints(decomposition, placed, options, prepared);
  VolumeComplex complex = build_complex(placed, decomposition);
  TiedConstraints tied = tie_constraints(placed, decomposition, complex, weight, prepared);
  for (int round = 0; round < 8 && !(complex.disagreeing.empty() && tied.split.empty()); ++round) {
    split_further(decomposition, placed, options, complex.disagreeing);
    refine_for_constraints(decomposition, placed, options, prepared, tied.split);
    complex = build_complex(placed, decomposition);
    tied = tie_constraints(placed, decomposition, complex, weight, prepared);
  }
  const Labelling labelling = cut_complex(placed, complex, weight, tied.ties);
  AtomicSolid solid;
  const SeparatingSurface surface = separating(extract(placed, decomposition.octree, complex, labelling));
  glue(mesh, topology, split_into_sheets(mesh, topology, surface, mesh), solid);
  solid.leaves = decomposition.octree.size();
  solid.notes = prepared.notes();
  solid.notes.insert(solid.notes.end(), tied.notes.begin(), tied.notes.end());
  const SideFinder sides(mesh, topology);
  const VolumeLocator locator(placed, decomposition, complex, sides);
  for (const Vector3& point : asked) {
    const VolumePlace place = locator.locate(point);
    char label = place.kind == VolumePlace::inside ? 1 : place.kind == VolumePlace::unknown ? -1 : 0;
    if (place.kind == VolumePlace::free) label = labelling.is_inside(place.node) ? 1 : 0;
    solid.labels.push_back(label);
  }
  return solid;
}

}  // namespace test
}  // namespace meshcomplete
