// Boxes that come and go, and which of them meet a given one: for patches that are being edited.
#pragma once

#include <vector>

#include "common/core/box_tree.h"

namespace meshcomplete {

/// A binary tree of boxes, kept balanced by rotations, whatever the boxes' sizes. Cost: O(log n) to change a
/// box, and to ask O(log n) and the boxes found, as long as not too many overlap.
class DynamicBoxTree {
 public:
  /// Adds a box or replaces the one with this number. Numbers should be small: they index a vector.
  void set(Index number, const Box& box);
  void remove(Index number);
  bool holds(Index number) const { return number < leaf_of_.size() && leaf_of_[number] != none; }

  /// Calls `visit(number)`, in no particular order, for every box that meets `box`, until it returns false.
  /// Returns whether it never did.
  template <class Visit>
  bool visit(const Box& box, Visit&& visit) const {
    return root_ == none || walk(root_, box, visit);
  }

 private:
  static constexpr Index none = 0xffffffffu;
  struct Node {
    Box box;
    Index parent = none;
    Index left = none, right = none;  // of a leaf: none, and its number
    int height = 0;
    bool is_leaf() const { return left == none; }
  };

  template <class Visit>
  bool walk(Index at, const Box& box, Visit& visit) const {
    const Node& node = nodes_[at];
    if (!node.box.meets(box)) return true;
    if (node.is_leaf()) return visit(node.right);
    return walk(node.left, box, visit) && walk(node.right, box, visit);
  }

  Index new_node();
  Index best_sibling(const Box& box) const;
  void update(Index node);
  void refit_upwards(Index node);
  Index rotate(Index node);
  void replace_child(Index parent, Index before, Index after);

  std::vector<Node> nodes_;
  std::vector<Index> unused_, leaf_of_;
  Index root_ = none;
};

}  // namespace meshcomplete
