#include "common/core/disjoint_sets.h"

#include <gtest/gtest.h>

namespace meshcomplete {
namespace {

TEST(DisjointSets, TheLeastMemberStandsForASet) {
  DisjointSets sets(6);
  EXPECT_EQ(sets.size(), 6u);
  EXPECT_TRUE(sets.unite(5, 3));
  EXPECT_TRUE(sets.unite(4, 5));
  EXPECT_FALSE(sets.unite(3, 4));
  EXPECT_EQ(sets.root(5), 3u);
  EXPECT_TRUE(sets.unite(4, 1));
  for (Index i : {1u, 3u, 4u, 5u}) EXPECT_EQ(sets.root(i), 1u);
  EXPECT_EQ(sets.root(0), 0u);
  EXPECT_EQ(sets.root(2), 2u);
}

}  // namespace
}  // namespace meshcomplete
