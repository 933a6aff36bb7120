#include "common/core/triangle_blocks.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <utility>

namespace meshcomplete {
namespace {

constexpr std::size_t grain = 64;  // blocks per task: a few thousand triangles

// An order is coherent when the surfaces of the blocks' boxes add up to at most this many times those of the
// triangles' own boxes. Blocks in spatial order have less than 1, strips in an oblique direction up to 8; a
// shuffled mesh has about as many as it has blocks.
constexpr double coherent_surface_ratio = 16;

double surface(const Box& box) {
  const double x = box.high[0] - box.low[0], y = box.high[1] - box.low[1], z = box.high[2] - box.low[2];
  return x >= 0 ? x * y + y * z + z * x : 0;
}

}  // namespace

TriangleBlocks::TriangleBlocks(const TriangleMesh& mesh) : mesh_(mesh) {
  const std::size_t triangles = mesh.triangles.size();
  std::vector<Box> blocks((triangles + block_size - 1) / block_size);
  std::vector<double> triangle_surface(blocks.size(), 0.0);
  const auto over_blocks = [&](const auto& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.size(), grain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t block = range.begin(); block != range.end(); ++block) body(block);
                      });
  };
  over_blocks([&](std::size_t block) {
    visit_block(block, [&](Index triangle) {
      const Box box = triangle_box(triangle);
      blocks[block].include(box);
      triangle_surface[block] += surface(box);
      return true;
    });
  });
  double block_sum = 0, triangle_sum = 0;
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    block_sum += surface(blocks[block]);
    triangle_sum += triangle_surface[block];
  }
  if (block_sum > coherent_surface_ratio * triangle_sum) {
    std::vector<Box> boxes(triangles);
    over_blocks([&](std::size_t block) {
      visit_block(block, [&](Index triangle) {
        boxes[triangle] = triangle_box(triangle);
        return true;
      });
    });
    order_ = spatial_order(boxes);
    over_blocks([&](std::size_t block) {
      blocks[block] = Box();
      visit_block(block, [&](Index triangle) {
        blocks[block].include(boxes[triangle]);
        return true;
      });
    });
  }
  tree_ = BoxTree(std::move(blocks));
}

}  // namespace meshcomplete
