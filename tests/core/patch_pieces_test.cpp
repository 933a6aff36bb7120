#include "common/core/patch_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

using Flaw = Sheet::Flaw;
using Numbers = std::vector<std::size_t>;

Sheet sheet_of(std::vector<Index> closes, Flaw flaw = Flaw::none) {
  Sheet sheet;
  sheet.closes = std::move(closes);
  sheet.flaw = flaw;
  return sheet;
}

PatchPiece piece_of(Numbers loops, std::size_t edges = 0, Flaw flaw = Flaw::none) {
  PatchPiece piece;
  piece.loops = std::move(loops);
  piece.sheet = sheet_of(std::vector<Index>(edges, 0), flaw);
  return piece;
}

BoundaryLoop loop_of(std::size_t edges) {
  BoundaryLoop loop;
  loop.vertices.resize(edges);
  loop.faces.resize(edges);
  return loop;
}

TEST(LoopNumbers, EveryBoundaryHalfEdgeHasTheLoopThatWalksItTheOtherWay) {
  // In the narrow tubes faces have edges on one loop and corners on another one.
  for (const TriangleMesh& mesh :
       {test::sphere_with_holes(6, 2, 0.4), test::open_cylinder(5, 1), test::flat_grid(1, 1),
        test::sphere_with_touching_holes(), test::shuffled(test::sphere_with_island(3, 0.9, 0.4), 3)}) {
    const std::vector<BoundaryLoop> loops = test::loops_of(mesh);
    const LoopNumbers numbers(mesh, loops);
    const MeshTopology topology = build_topology(mesh);
    std::vector<std::size_t> edges(loops.size(), 0);
    for (Index h = 0; h < 3 * mesh.triangles.size(); ++h) {
      const auto loop = numbers.of(h);
      ASSERT_EQ(loop.has_value(), topology.opposite[h] == MeshTopology::boundary);
      if (!loop) continue;
      const std::vector<Index>& walk = loops.at(*loop).vertices;
      const Triangle& t = mesh.triangles[h / 3];
      bool walked = false;
      for (std::size_t k = 0; k < walk.size(); ++k)
        walked |= walk[k] == t[(h % 3 + 1) % 3] && walk[(k + 1) % walk.size()] == t[h % 3];
      EXPECT_TRUE(walked);
      ++edges[*loop];
    }
    for (std::size_t i = 0; i < loops.size(); ++i) EXPECT_EQ(edges[i], loops[i].faces.size());
  }
}

TEST(PatchPieces, AreTheSheetsAtRims) {
  const TriangleMesh mesh = test::sphere_with_holes(3, 2, 0.4);
  const MeshTopology topology = build_topology(mesh);
  const std::vector<BoundaryLoop> loops = test::loops_of(mesh);
  const LoopNumbers numbers(mesh, loops);
  std::vector<std::vector<Index>> edges(3);
  Index inner = 0;
  for (Index h = 0; h < 3 * mesh.triangles.size(); ++h) {
    if (const auto loop = numbers.of(h))
      edges[*loop].push_back(h);
    else
      inner = h;
  }
  std::vector<Index> two = edges[2];
  two.insert(two.end(), edges[0].begin(), edges[0].end());
  const auto pieces = make_pieces({sheet_of({}), sheet_of(two), sheet_of({edges[1][0], inner}),
                                   sheet_of(edges[1], Flaw::joins_vertices), sheet_of({inner})},
                                  topology, numbers);
  ASSERT_EQ(pieces.size(), 3u) << "those without a loop are none";
  EXPECT_EQ(pieces[0].loops, (Numbers{0, 2}));
  EXPECT_EQ(pieces[0].sheet.flaw, Flaw::none);
  EXPECT_EQ(pieces[0].sheet.closes, two);
  EXPECT_EQ(pieces[1].loops, Numbers{1});
  EXPECT_EQ(pieces[1].sheet.flaw, Flaw::open) << "an edge where the mesh goes on";
  EXPECT_EQ(pieces[2].sheet.flaw, Flaw::joins_vertices);
  for (const PatchPiece& piece : pieces) EXPECT_FALSE(piece.wanted);
}

TEST(PatchPieces, ThatShareALoopAreAGroup) {
  std::vector<PatchPiece> pieces;
  for (const Numbers& loops :
       {Numbers{4, 5}, Numbers{2}, Numbers{1, 3}, Numbers{6}, Numbers{3, 5}, Numbers{2}})
    pieces.push_back(piece_of(loops));
  const auto groups = group_by_loops(pieces);
  EXPECT_EQ(groups, (std::vector<Numbers>{{0, 2, 4}, {1, 5}, {3}}));
  EXPECT_EQ(loops_of(pieces, groups[0]), (Numbers{1, 3, 4, 5}));
  EXPECT_EQ(loops_of(pieces, groups[1]), Numbers{2});
  EXPECT_TRUE(group_by_loops({}).empty());
}

TEST(PatchPieces, TheWorstFlawOfAGroupCounts) {
  const std::vector<BoundaryLoop> loops = {loop_of(4), loop_of(3)};
  const auto flaw = [&](const std::vector<PatchPiece>& pieces) {
    Numbers all;
    for (std::size_t i = 0; i < pieces.size(); ++i) all.push_back(i);
    return flaw_of(pieces, all, loops);
  };
  EXPECT_EQ(flaw({piece_of({0}, 4)}), Flaw::none);
  EXPECT_EQ(flaw({piece_of({0}, 3)}), Flaw::open) << "an edge without a sheet";
  EXPECT_EQ(flaw({piece_of({0, 1}, 7)}), Flaw::none);
  EXPECT_EQ(flaw({piece_of({0, 1}, 4)}), Flaw::open);
  EXPECT_EQ(flaw({piece_of({0}, 1), piece_of({0, 1}, 6)}), Flaw::none);
  EXPECT_EQ(flaw({piece_of({0}, 1), piece_of({0, 1}, 6, Flaw::open)}), Flaw::open);
  EXPECT_EQ(flaw({piece_of({0}, 1, Flaw::joins_vertices), piece_of({0, 1}, 6, Flaw::open)}),
            Flaw::joins_vertices);
  EXPECT_EQ(flaw({piece_of({0}, 1, Flaw::joins_vertices), piece_of({0, 1}, 5)}), Flaw::joins_vertices);
}

}  // namespace
}  // namespace meshcomplete
