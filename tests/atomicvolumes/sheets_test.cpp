#include "common/core/sheets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "common/core/rim_patch.h"
#include "filter_atomicvolumes/extraction.h"
#include "tests/support/complexes.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::PlacedMesh;

/// A sheet's boundary without its Steiner points: the mesh's boundary half-edges along it, and whether the
/// walk is right: from one boundary vertex over points of one boundary edge, in their order, to the next.
std::vector<Index> closed_edges(const PlacedMesh& placed, const TriangleMesh& input, const Sheet& sheet) {
  std::map<Index, Index> next;
  for (const auto& [edge, times] : test::boundary_of(sheet.triangles)) {
    EXPECT_EQ(std::abs(times), 1);
    next[times > 0 ? edge.first : edge.second] = times > 0 ? edge.second : edge.first;
  }
  std::map<test::Edge, Index> half_edges;  // by target and origin: a patch walks the other way
  for (Index h : placed.topology.boundary_half_edges)
    half_edges[{input.triangles[h / 3][(h % 3 + 1) % 3], input.triangles[h / 3][h % 3]}] = h;
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
    const Vector3 along = input.vertices[found->first.second] - input.vertices[from];
    for (Index v : between) {
      EXPECT_EQ(sheet.vertices[v].rim_edge, found->second);
      const double here = along.dot(sheet.vertices[v].position - input.vertices[from]);
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
    const test::Shape shape = test::shape_of(sheet.triangles);
    ASSERT_TRUE(shape.manifold);
    ASSERT_EQ(shape.components, 1u);
    ASSERT_EQ(sheet.closes, closed_edges(placed, placed.mesh, sheet));
    all.insert(all.end(), sheet.closes.begin(), sheet.closes.end());
    std::set<Index> used;
    for (const Triangle& t : sheet.triangles) used.insert(t.begin(), t.end());
    ASSERT_EQ(used.size(), sheet.vertices.size());
  }
  std::sort(all.begin(), all.end());
  ASSERT_EQ(all, placed.topology.boundary_half_edges) << "every boundary edge in just one sheet";
}

SeparatingSurface surface_of(const PlacedMesh& placed, const test::Division& division,
                             const Labelling& labelling) {
  return separating(extract(placed.lattice_mesh, division.decomposition.octree, division.complex, labelling));
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

/// The fourth face of a tetrahedron as a surface, for the three others without it.
SeparatingSurface fourth_face(const TriangleMesh& whole) {
  SeparatingSurface surface;
  for (Index v : whole.triangles[0]) surface.vertices.push_back({whole.vertices[v], v});
  surface.triangles = {{0, 1, 2}};
  return surface;
}

TEST(Sheets, CornersAreTheInputsVertices) {
  const TriangleMesh whole = test::tetrahedron();
  TriangleMesh mesh = whole;
  mesh.triangles.erase(mesh.triangles.begin());
  mesh.vertices.push_back(mesh.vertices[whole.triangles[0][0]]);
  const Index rim = whole.triangles[0][0], copy = 4;
  const MeshTopology topology = build_topology(mesh);
  std::vector<Index> at_rim;  // the two faces with an edge of the rim at the vertex
  for (Index t = 0; t < 3; ++t)
    if (std::count(mesh.triangles[t].begin(), mesh.triangles[t].end(), rim)) at_rim.push_back(t);
  ASSERT_EQ(at_rim.size(), 2u);
  for (const std::vector<Index>& renamed :
       {std::vector<Index>{}, {at_rim[0]}, {at_rim[1]}, {at_rim[0], at_rim[1]}}) {
    TriangleMesh input = mesh;
    for (Index t : renamed) std::replace(input.triangles[t].begin(), input.triangles[t].end(), rim, copy);
    const auto sheets = split_into_sheets(mesh, topology, fourth_face(whole), input);
    ASSERT_EQ(sheets.size(), 1u);
    EXPECT_EQ(sheets[0].closes, topology.boundary_half_edges);
    EXPECT_EQ(sheets[0].flaw, renamed.size() == 1 ? Sheet::Flaw::joins_vertices : Sheet::Flaw::none)
        << "the corner cannot be two vertices at once";
    if (renamed.size() == 1) continue;
    std::vector<Index> names;
    for (Index v : sheets[0].triangles[0]) names.push_back(sheets[0].vertices[v].input);
    EXPECT_EQ(names, (std::vector<Index>{renamed.empty() ? rim : copy, whole.triangles[0][1],
                                         whole.triangles[0][2]}));
  }
}

// Space is divided by a mesh in which the two vertices at the pole are one.
TEST(Sheets, PiecesAtCoincidentVerticesAreJoinedToTheirOwn) {
  const test::SplitPole pole;
  TriangleMesh merged = pole.mesh;
  for (Triangle& t : merged.triangles) std::replace(t.begin(), t.end(), pole.copy, pole.original);
  const auto at = [&](const Sheet& sheet, Index vertex) {
    return std::any_of(sheet.closes.begin(), sheet.closes.end(), [&](Index h) {
      const Triangle& t = pole.mesh.triangles[h / 3];
      return t[h % 3] == vertex || t[(h % 3 + 1) % 3] == vertex;
    });
  };
  std::size_t whole = 0, joining = 0, renamed = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const PlacedMesh placed(merged, seed);
    const auto division = test::divide(placed);
    if (!division) continue;
    for (double share : {0.0, 0.3, 0.6, 1.0}) {
      const Labelling labelling = test::random_labelling(division->complex, seed, share);
      for (const Sheet& sheet : split_into_sheets(placed.mesh, placed.topology,
                                                  surface_of(placed, *division, labelling), pole.mesh)) {
        ASSERT_NE(sheet.flaw, Sheet::Flaw::open);
        if (sheet.flaw == Sheet::Flaw::joins_vertices) {
          EXPECT_TRUE(at(sheet, pole.original) && at(sheet, pole.copy));
          ++joining;
          continue;
        }
        EXPECT_EQ(sheet.closes, closed_edges(placed, pole.mesh, sheet));
        whole += !sheet.closes.empty();
        renamed += at(sheet, pole.copy);
      }
    }
  }
  EXPECT_GT(whole, 10u);
  EXPECT_GT(joining, 5u);
  EXPECT_GT(renamed, 5u);
}

}  // namespace
}  // namespace meshcomplete
