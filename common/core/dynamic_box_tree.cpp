#include "common/core/dynamic_box_tree.h"

#include <algorithm>

namespace meshcomplete {
namespace {

// Half the surface area of a box: the chance that something meets it.
double half_area(const Box& box) {
  const double x = box.high[0] - box.low[0], y = box.high[1] - box.low[1], z = box.high[2] - box.low[2];
  return x * y + y * z + z * x;
}

Box together(const Box& a, const Box& b) {
  Box both = a;
  both.include(b);
  return both;
}

}  // namespace

Index DynamicBoxTree::new_node() {
  if (unused_.empty()) {
    nodes_.emplace_back();
    return static_cast<Index>(nodes_.size() - 1);
  }
  const Index node = unused_.back();
  unused_.pop_back();
  nodes_[node] = Node();
  return node;
}

// Descends to where the box adds least area.
Index DynamicBoxTree::best_sibling(const Box& box) const {
  Index at = root_;
  while (!nodes_[at].is_leaf()) {
    const Node& node = nodes_[at];
    const double grown = half_area(together(node.box, box));
    const double here = 2 * grown, inherited = 2 * (grown - half_area(node.box));
    const auto descent = [&](Index child) {
      const Node& c = nodes_[child];
      const double area = half_area(together(c.box, box));
      return inherited + (c.is_leaf() ? area : area - half_area(c.box));
    };
    const double left = descent(node.left), right = descent(node.right);
    if (here < left && here < right) break;
    at = left < right ? node.left : node.right;
  }
  return at;
}

void DynamicBoxTree::update(Index at) {
  Node& node = nodes_[at];
  node.box = together(nodes_[node.left].box, nodes_[node.right].box);
  node.height = 1 + std::max(nodes_[node.left].height, nodes_[node.right].height);
}

void DynamicBoxTree::replace_child(Index parent, Index before, Index after) {
  if (after != none) nodes_[after].parent = parent;
  if (parent == none)
    root_ = after;
  else
    (nodes_[parent].left == before ? nodes_[parent].left : nodes_[parent].right) = after;
}

// Where one child is higher than the other by more than one, it takes its parent's place and gives it its
// lower child.
Index DynamicBoxTree::rotate(Index at) {
  const Index left = nodes_[at].left, right = nodes_[at].right;
  const int lean = nodes_[right].height - nodes_[left].height;
  if (lean >= -1 && lean <= 1) return at;
  const Index high = lean > 0 ? right : left;
  const Index a = nodes_[high].left, b = nodes_[high].right;
  const Index higher = nodes_[a].height > nodes_[b].height ? a : b, lower = higher == a ? b : a;
  replace_child(nodes_[at].parent, at, high);
  (lean > 0 ? nodes_[at].right : nodes_[at].left) = lower;
  nodes_[lower].parent = at;
  nodes_[high].left = at;
  nodes_[high].right = higher;
  nodes_[at].parent = high;
  nodes_[higher].parent = high;
  update(at);
  update(high);
  return high;
}

void DynamicBoxTree::refit_upwards(Index at) {
  while (at != none) {
    at = rotate(at);
    update(at);
    at = nodes_[at].parent;
  }
}

void DynamicBoxTree::set(Index number, const Box& box) {
  if (number >= leaf_of_.size()) leaf_of_.resize(number + 1, none);
  remove(number);
  const Index leaf = new_node();
  leaf_of_[number] = leaf;
  nodes_[leaf].box = box;
  nodes_[leaf].right = number;
  if (root_ == none) {
    root_ = leaf;
    return;
  }
  const Index sibling = best_sibling(box), above = nodes_[sibling].parent;
  const Index joint = new_node();
  replace_child(above, sibling, joint);
  nodes_[joint].left = sibling;
  nodes_[joint].right = leaf;
  nodes_[sibling].parent = joint;
  nodes_[leaf].parent = joint;
  refit_upwards(joint);
}

void DynamicBoxTree::remove(Index number) {
  if (!holds(number)) return;
  const Index leaf = leaf_of_[number], joint = nodes_[leaf].parent;
  leaf_of_[number] = none;
  unused_.push_back(leaf);
  if (joint == none) {
    root_ = none;
    return;
  }
  const Index sibling = nodes_[joint].left == leaf ? nodes_[joint].right : nodes_[joint].left;
  const Index above = nodes_[joint].parent;
  replace_child(above, joint, sibling);
  unused_.push_back(joint);
  refit_upwards(above);
}

}  // namespace meshcomplete
