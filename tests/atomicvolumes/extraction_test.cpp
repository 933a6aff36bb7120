#include "filter_atomicvolumes/extraction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
#include <vector>

#include "tests/support/complexes.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::Division;
using test::Edge;
using test::PlacedMesh;

LabelledSurface surface_of(const PlacedMesh& placed, const Division& division, const Labelling& labelling) {
  return extract(placed.lattice_mesh, division.decomposition.octree, division.complex, labelling);
}

using Numbers = std::unordered_map<VertexKey, Index, VertexKeyHash>;

Numbers numbers_of(const LabelledSurface& surface) {
  Numbers numbers;
  for (Index v = 0; v < surface.vertices.size(); ++v)
    EXPECT_TRUE(numbers.emplace(surface.vertices[v].key, v).second) << "a vertex twice";
  return numbers;
}

/// Every boundary edge of the mesh once, against its face, through all Steiner points on it in their order. A
/// point that the surface does not have gets a number of its own.
std::map<Edge, int> rims_of(const PlacedMesh& placed, const Division& division, Numbers numbers) {
  const auto number = [&](const VertexKey& key) {
    return numbers.emplace(key, static_cast<Index>(numbers.size())).first->second;
  };
  std::map<Index, std::vector<const VolumeVertex*>> steiner;
  for (const VolumeVertex& v : division.complex.vertices)
    if (v.rim_edge != VolumeVertex::none) steiner[v.rim_edge].push_back(&v);
  std::map<Edge, int> rims;
  for (Index h : placed.topology.boundary_half_edges) {
    const Index from = placed.lattice_mesh.target(h), to = placed.lattice_mesh.origin(h);
    const Vector3 along = placed.mesh.vertices[to] - placed.mesh.vertices[from];
    std::vector<const VolumeVertex*>& points = steiner[h];
    std::sort(points.begin(), points.end(), [&](const VolumeVertex* a, const VolumeVertex* b) {
      return along.dot(a->position) < along.dot(b->position);
    });
    std::vector<Index> chain = {number(VertexKey::vertex(from))};
    for (const VolumeVertex* p : points) chain.push_back(number(p->key));
    chain.push_back(number(VertexKey::vertex(to)));
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const Index a = chain[i], b = chain[i + 1];
      rims[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return rims;
}

/// All labels, from everything outside to everything inside, and the two cuts.
std::vector<Labelling> labellings_of(const PlacedMesh& placed, const Division& division, unsigned seed) {
  std::vector<Labelling> all;
  for (double share : {0.0, 0.2, 0.5, 0.8, 1.0})
    all.push_back(test::random_labelling(division.complex, seed, share));
  all.push_back(cut_complex(placed.lattice_mesh, division.complex, CutWeight::area, {}));
  all.push_back(cut_complex(placed.lattice_mesh, division.complex, CutWeight::unit, {}));
  return all;
}

// The property on which everything rests: whatever the labels, as long as what is known of the volumes is
// kept, the faces between inside and outside close the mesh. No T-junction, no missing face, no wrong side.
TEST(Extraction, AnyLabellingClosesAllHoles) {
  int coincidences = 0;
  for (const test::NamedMesh& named : test::holed_meshes())
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const PlacedMesh placed(named.mesh, seed);
      const auto division = test::divide(placed);
      if (!division) {
        ++coincidences;
        continue;
      }
      for (const Labelling& labelling : labellings_of(placed, *division, seed)) {
        const LabelledSurface surface = surface_of(placed, *division, labelling);
        const std::map<Edge, int> rims = rims_of(placed, *division, numbers_of(surface));
        ASSERT_EQ(test::boundary_of(surface.triangles), rims) << named.name << ", seed " << seed;
      }
    }
  EXPECT_LE(coincidences, 1);
}

/// Whether the volume holds a point: a blank cube or a free tetrahedron, in doubles.
bool holds(const PlacedMesh& placed, const Division& division, Cell cell, const Vector3& point) {
  const VolumeComplex& complex = division.complex;
  const std::size_t node = static_cast<std::size_t>(cell);
  if (node < complex.blank_nodes) {
    const auto at = std::find(complex.cube_cells.begin(), complex.cube_cells.end(), cell);
    const LatticeBox box =
        division.decomposition.octree.box(static_cast<Index>(at - complex.cube_cells.begin()));
    const Vector3 low = placed.lattice_mesh.lattice.position(box.low),
                  high = placed.lattice_mesh.lattice.position(box.high);
    return (point.array() > low.array()).all() && (point.array() < high.array()).all();
  }
  const VolumeComplex::Tetrahedron& t = complex.free_tetrahedra[node - complex.blank_nodes];
  const auto at = [&](Index v) { return complex.vertices[v].position; };
  const std::array<Vector3, 4> c = {at(t.base[0]), at(t.base[1]), at(t.base[2]), at(t.apex)};
  const auto volume = [](const Vector3& a, const Vector3& b, const Vector3& d, const Vector3& p) {
    return (b - a).cross(d - a).dot(p - a);
  };
  return volume(c[0], c[2], c[1], point) > 0 && volume(c[0], c[1], c[3], point) > 0 &&
         volume(c[1], c[2], c[3], point) > 0 && volume(c[2], c[0], c[3], point) > 0;
}

// A step from the middle of a triangle against its normal leads into the volume that it says is inside, a
// step along it into the other.
TEST(Extraction, TrianglesLieBetweenTheVolumesTheyName) {
  for (const test::NamedMesh& named : test::holed_meshes()) {
    const PlacedMesh placed(named.mesh, 7);
    const auto division = test::divide(placed);
    if (!division) continue;
    const Labelling labelling = test::random_labelling(division->complex, 7, 0.5);
    const LabelledSurface surface = surface_of(placed, *division, labelling);
    ASSERT_EQ(surface.volumes.size(), surface.triangles.size());
    std::size_t looked_at = 0;
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      const LabelledSurface::Between& between = surface.volumes[i];
      ASSERT_TRUE(labelling.is_inside(between.inside));
      ASSERT_FALSE(labelling.is_inside(between.outside));
      if (i % 7 != 0) continue;
      const auto& [a, b, c] = surface.triangles[i];
      const Vector3 &pa = surface.vertices[a].position, &pb = surface.vertices[b].position,
                    &pc = surface.vertices[c].position;
      const Vector3 area = (pb - pa).cross(pc - pa), middle = (pa + pb + pc) / 3;
      const double longest = std::max({(pb - pa).norm(), (pc - pb).norm(), (pa - pc).norm()});
      if (area.norm() < 1e-4 * longest * longest) continue;  // needles: a step would lead too far
      const Vector3 step = 1e-6 * area / longest;
      for (bool inside : {true, false}) {
        const Cell cell = inside ? between.inside : between.outside;
        if (cell < 0) continue;
        ++looked_at;
        EXPECT_TRUE(holds(placed, *division, cell, inside ? Vector3(middle - step) : Vector3(middle + step)))
            << named.name;
      }
    }
    EXPECT_GT(looked_at, 50u);
  }
}

// Rim points are known as such: boundary vertices where they are in the mesh, Steiner points on their edge.
TEST(Extraction, RimPointsLieOnTheRim) {
  for (const test::NamedMesh& named : test::holed_meshes()) {
    const PlacedMesh placed(named.mesh, 2);
    const auto division = test::divide(placed);
    if (!division) continue;
    const LabelledSurface surface =
        surface_of(placed, *division, test::random_labelling(division->complex, 1, 0.4));
    std::set<Index> inputs;
    std::size_t steiner = 0;
    for (const VolumeVertex& v : surface.vertices) {
      if (v.input != VolumeVertex::none) {
        EXPECT_EQ(v.position, placed.mesh.vertices[v.input]);
        EXPECT_EQ(v.rim_edge, VolumeVertex::none);
        inputs.insert(v.input);
      } else if (v.rim_edge != VolumeVertex::none) {
        ++steiner;
        const Vector3 &a = placed.mesh.vertices[placed.lattice_mesh.origin(v.rim_edge)],
                      &b = placed.mesh.vertices[placed.lattice_mesh.target(v.rim_edge)];
        const double share = (v.position - a).dot(b - a) / (b - a).squaredNorm();
        EXPECT_GT(share, 0);
        EXPECT_LT(share, 1);
        EXPECT_LT((a + share * (b - a) - v.position).norm(), 10 * placed.lattice_mesh.lattice.step());
      }
    }
    EXPECT_GE(steiner, placed.topology.boundary_half_edges.size());
    std::set<Index> boundary;
    for (Index h : placed.topology.boundary_half_edges) boundary.insert(placed.lattice_mesh.origin(h));
    EXPECT_EQ(inputs, boundary) << named.name;
  }
}

}  // namespace
}  // namespace meshcomplete
