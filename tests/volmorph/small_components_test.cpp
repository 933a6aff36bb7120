#include "filter_volmorph/small_components.h"

#include <gtest/gtest.h>

#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

/// A flat grid of that many unit squares, shifted.
TriangleMesh strip(int columns, int rows, double aside) {
  return test::translated(test::flat_grid(columns, rows), Vector3(0, aside, 0));
}

TEST(SmallComponents, are_narrow_when_short_or_when_long_with_little_area) {
  const TriangleMesh large = strip(60, 60, 0), object = strip(12, 12, 100), crumb = strip(5, 5, 200),
                     sliver = strip(60, 4, 300);
  const TriangleMesh kept =
      without_narrow_components(test::join(test::join(large, crumb), test::join(object, sliver)), 8);
  const TriangleMesh should = test::join(large, object);
  EXPECT_EQ(kept.vertices, should.vertices);
  EXPECT_EQ(kept.triangles, should.triangles);
}

TEST(SmallComponents, leave_the_largest_one_however_narrow) {
  const TriangleMesh large = strip(4, 3, 0), crumb = strip(2, 2, 10);
  const TriangleMesh kept = without_narrow_components(test::join(crumb, large), 1000);
  EXPECT_EQ(kept.vertices, large.vertices);
  EXPECT_EQ(kept.triangles, large.triangles);
  EXPECT_TRUE(without_narrow_components(TriangleMesh(), 1).triangles.empty());
}

}  // namespace
}  // namespace meshcomplete
