#include "filter_atomicvolumes/sheets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "filter_atomicvolumes/rim_patch.h"
#include "tests/support/complexes.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::PlacedMesh;

/// A sheet's boundary without its Steiner points: the mesh's boundary half-edges along it, and whether the
/// walk is right: from one boundary vertex over points of one boundary edge, in their order, to the next.
std::vector<Index> closed_edges(const PlacedMesh& placed, const Sheet& sheet) {
  std::map<Index, Index> next;
  for (const auto& [edge, times] : test::boundary_of(sheet.triangles)) {
    EXPECT_EQ(std::abs(times), 1);
    next[times > 0 ? edge.first : edge.second] = times > 0 ? edge.second : edge.first;
  }
  std::map<test::Edge, Index> half_edges;  // by target and origin: a patch walks the other way
  for (Index h : placed.topology.boundary_half_edges)
    half_edges[{placed.lattice_mesh.target(h), placed.lattice_mesh.origin(h)}] = h;
  std::vector<Index> closed;
  for (const auto& [start, second] : next) {
    const Index from = sheet.vertices[start].input;
    if (from == SheetVertex::none) continue;
    std::vector<Index> between;
    Index at = second;
    while (sheet.vertices[at].input == SheetVertex::none && between.size() < next.size()) {
      between.push_back(at);
      at = next.at(at);
    }
    const auto found = half_edges.find({from, sheet.vertices[at].input});
    if (found == half_edges.end()) {
      ADD_FAILURE() << "no boundary edge from " << from;
      continue;
    }
    closed.push_back(found->second);
    double share = 0;
    const Vector3 along = placed.mesh.vertices[found->first.second] - placed.mesh.vertices[from];
    for (Index v : between) {
      EXPECT_EQ(sheet.vertices[v].rim_edge, found->second);
      const double here = along.dot(sheet.vertices[v].position - placed.mesh.vertices[from]);
      EXPECT_GT(here, share) << "Steiner points go forward";
      share = here;
    }
  }
  std::sort(closed.begin(), closed.end());
  return closed;
}

/// All that a sheet must be.
void expect_sheets(const PlacedMesh& placed, const std::vector<Sheet>& sheets) {
  std::vector<Index> all;
  for (const Sheet& sheet : sheets) {
    ASSERT_EQ(sheet.flaw, Sheet::Flaw::none);
    ASSERT_EQ(sheet.volumes.size(), sheet.triangles.size());
    const test::Shape shape = test::shape_of(sheet.triangles);
    ASSERT_TRUE(shape.manifold);
    ASSERT_EQ(shape.components, 1u);
    ASSERT_EQ(sheet.closes, closed_edges(placed, sheet));
    all.insert(all.end(), sheet.closes.begin(), sheet.closes.end());
    std::set<Index> used;
    for (const Triangle& t : sheet.triangles) used.insert(t.begin(), t.end());
    ASSERT_EQ(used.size(), sheet.vertices.size());
  }
  std::sort(all.begin(), all.end());
  ASSERT_EQ(all, placed.topology.boundary_half_edges) << "every boundary edge in just one sheet";
}

LabelledSurface surface_of(const PlacedMesh& placed, const test::Division& division,
                           const Labelling& labelling) {
  return extract(placed.lattice_mesh, division.decomposition.octree, division.complex, labelling);
}

// Random labels make volumes touch in every way there is.
TEST(Sheets, AnyLabellingComesApartIntoManifolds) {
  std::size_t pieces = 0;
  for (const test::NamedMesh& named : test::holed_meshes())
    for (unsigned seed = 1; seed <= 2; ++seed) {
      const PlacedMesh placed(named.mesh, seed);
      const auto division = test::divide(placed);
      if (!division) continue;
      for (double share : {0.0, 0.2, 0.5, 0.7}) {
        const Labelling labelling = test::random_labelling(division->complex, seed, share);
        const auto sheets = split_into_sheets(placed.mesh, placed.topology,
                                              surface_of(placed, *division, labelling), placed.mesh);
        ASSERT_NO_FATAL_FAILURE(expect_sheets(placed, sheets))
            << named.name << ", seed " << seed << ", share " << share;
        pieces += sheets.size();
      }
    }
  EXPECT_GT(pieces, 1000u);
}

}  // namespace
}  // namespace meshcomplete
