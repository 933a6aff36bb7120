// A mesh's triangles in blocks of 64 with a tree over them: what is near, without a box for every triangle.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/core/box_tree.h"
#include "common/core/mesh.h"

namespace meshcomplete {

/// Refers to the mesh, which must outlive it. Immutable, safe to ask from many threads.
class TriangleBlocks {
 public:
  static constexpr std::size_t block_size = 64;

  /// Blocks are runs of consecutive triangles when the mesh is stored in a coherent order, as nearly all are,
  /// and of triangles in spatial order when it is not. Cost: O(faces), O(faces log faces) for an incoherent
  /// order; threaded.
  explicit TriangleBlocks(const TriangleMesh& mesh);

  const TriangleMesh& mesh() const { return mesh_; }
  const BoxTree& tree() const { return tree_; }  ///< its leaves are the blocks
  Box triangle_box(Index triangle) const {
    const Triangle& t = mesh_.triangles[triangle];
    return bounding_box(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
  }

  /// Calls `visit(triangle)` for the triangles of a block until it returns false; returns whether it never
  /// did.
  template <class Visit>
  bool visit_block(std::size_t block, Visit&& visit) const {
    const std::size_t past = std::min((block + 1) * block_size, mesh_.triangles.size());
    for (std::size_t i = block * block_size; i < past; ++i)
      if (!visit(order_.empty() ? static_cast<Index>(i) : order_[i])) return false;
    return true;
  }

  /// Calls `visit(triangle)`, in no particular order, for every triangle whose box meets `box`, until it
  /// returns false.
  template <class Visit>
  void visit(const Box& box, Visit&& visit) const {
    tree_.visit(box, [&](std::size_t block) {
      return visit_block(
          block, [&](Index triangle) { return !triangle_box(triangle).meets(box) || visit(triangle); });
    });
  }

 private:
  const TriangleMesh& mesh_;
  std::vector<Index> order_;  ///< empty when the mesh's own order is kept
  BoxTree tree_;
};

}  // namespace meshcomplete
