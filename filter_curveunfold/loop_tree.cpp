#include "filter_curveunfold/loop_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meshcomplete {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

LoopTree::Box empty_box() { return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}}; }

LoopTree::Box united(const LoopTree::Box& a, const LoopTree::Box& b) {
  LoopTree::Box box;
  for (int k = 0; k < 3; ++k) {
    box.low[k] = std::min(a.low[k], b.low[k]);
    box.high[k] = std::max(a.high[k], b.high[k]);
  }
  return box;
}

bool neighbours(std::size_t i, std::size_t j, std::size_t n) {
  const std::size_t gap = i < j ? j - i : i - j;
  return gap <= 1 || gap + 1 == n;
}

}  // namespace

bool LoopTree::Box::overlaps(const Box& other) const {
  return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] &&
         other.low[1] <= high[1] && low[2] <= other.high[2] && other.low[2] <= high[2];
}

double LoopTree::Box::squared_distance(const Box& other) const {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double gap = std::max({0.0, low[k] - other.high[k], other.low[k] - high[k]});
    sum += gap * gap;
  }
  return sum;
}

LoopTree::LoopTree(const Loop& loop) : segments_(loop.size()), leaves_(1) {
  while (leaves_ < segments_) leaves_ *= 2;
  boxes_.assign(2 * leaves_, empty_box());
  refit(loop);
}

void LoopTree::refit(const Loop& loop) {
  for (std::size_t i = 0; i < segments_; ++i) {
    boxes_[leaves_ + i] = box_of(loop[i], loop[i + 1 < segments_ ? i + 1 : 0]);
  }
  for (std::size_t node = leaves_; node-- > 1;) boxes_[node] = united(boxes_[2 * node], boxes_[2 * node + 1]);
}

void LoopTree::refit_upwards(std::size_t segment) {
  for (std::size_t node = (leaves_ + segment) / 2; node > 0; node /= 2) {
    boxes_[node] = united(boxes_[2 * node], boxes_[2 * node + 1]);
  }
}

void LoopTree::set_segment(std::size_t segment, const Vector3& from, const Vector3& to) {
  boxes_[leaves_ + segment] = box_of(from, to);
  refit_upwards(segment);
}

void LoopTree::remove_segment(std::size_t segment) {
  boxes_[leaves_ + segment] = empty_box();
  refit_upwards(segment);
}

LoopTree::Box LoopTree::box_of(const Vector3& a, const Vector3& b) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.low[k] = std::min(a[k], b[k]);
    box.high[k] = std::max(a[k], b[k]);
  }
  return box;
}

LoopTree::Box LoopTree::grown(Box box, double margin) {
  for (int k = 0; k < 3; ++k) {
    box.low[k] -= margin;
    box.high[k] += margin;
  }
  return box;
}

double LoopTree::least_distance(const Loop& loop, double upper) const {
  double best = upper * upper;
  const std::size_t n = segments_;
  // Depth first, nearer pair first, so that the bound falls early.
  std::vector<std::pair<std::size_t, std::size_t>> stack = {{1, 1}};
  while (!stack.empty()) {
    const auto [a, b] = stack.back();
    stack.pop_back();
    if (is_empty(a) || is_empty(b)) continue;
    if (a != b && boxes_[a].squared_distance(boxes_[b]) >= best) continue;
    if (a >= leaves_) {
      const std::size_t i = a - leaves_, j = b - leaves_;
      if (i == j || neighbours(i, j, n)) continue;
      best = std::min(best, squared_distance(loop[i], loop[(i + 1) % n], loop[j], loop[(j + 1) % n]));
    } else if (a == b) {
      stack.emplace_back(2 * a, 2 * a + 1);
      stack.emplace_back(2 * a, 2 * a);
      stack.emplace_back(2 * a + 1, 2 * a + 1);
    } else {
      for (std::size_t left = 2 * a; left <= 2 * a + 1; ++left) {
        for (std::size_t right = 2 * b; right <= 2 * b + 1; ++right) stack.emplace_back(left, right);
      }
    }
  }
  return std::sqrt(best);
}

}  // namespace meshcomplete
