#include "common/core/edge_length_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

// Samples in a leaf of the tree: with fewer the boxes cost more than the samples.
constexpr std::size_t leaf_size = 8;

// How many vertices to either side a length is averaged over: single long edges are no change of density.
constexpr std::size_t most_neighbours = 16;

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

EdgeLengthField::EdgeLengthField(std::vector<RimSample> samples)
    : samples_(std::move(samples)), shortest_(infinity), longest_(0) {
  if (samples_.empty())
    throw CompletionError("measuring the rims", "There is no rim to take the edge length from.");
  for (const RimSample& s : samples_) {
    shortest_ = std::min(shortest_, s.edge_length);
    longest_ = std::max(longest_, s.edge_length);
  }
  build(0, samples_.size());
}

Index EdgeLengthField::build(std::size_t begin, std::size_t past) {
  const Index number = static_cast<Index>(nodes_.size());
  Node node{{}, infinity, 0, begin, past, 0};
  for (std::size_t i = begin; i < past; ++i) {
    node.box.extend(samples_[i].position);
    node.shortest = std::min(node.shortest, samples_[i].edge_length);
    node.longest = std::max(node.longest, samples_[i].edge_length);
  }
  nodes_.push_back(node);
  if (past - begin <= leaf_size) return number;
  int axis = 0;
  node.box.sizes().maxCoeff(&axis);
  const std::size_t middle = begin + (past - begin) / 2;
  const auto at = [&](std::size_t i) { return samples_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(past), [axis](const RimSample& a, const RimSample& b) {
    return a.position[axis] < b.position[axis];
  });
  build(begin, middle);
  const Index right = build(middle, past);
  nodes_[number].right = right;
  return number;
}

// The nearer child first: what it holds bounds what the other one can.
template <class Bound, class Offer>
void EdgeLengthField::descend(Index number, const Vector3& point, Bound& bound, Offer& offer) const {
  const Node& node = nodes_[number];
  if (node.right == 0) {
    for (std::size_t i = node.begin; i < node.past; ++i) offer(samples_[i]);
    return;
  }
  Index children[2] = {number + 1, node.right};
  double distances[2];
  for (int k = 0; k < 2; ++k) distances[k] = nodes_[children[k]].box.exteriorDistance(point);
  if (distances[1] < distances[0]) {
    std::swap(children[0], children[1]);
    std::swap(distances[0], distances[1]);
  }
  for (int k = 0; k < 2; ++k)
    if (bound(nodes_[children[k]], distances[k])) descend(children[k], point, bound, offer);
}

double EdgeLengthField::at(const Vector3& point) const {
  if (shortest_ == longest_) return shortest_;
  double upper = longest_, lower = shortest_;
  const auto bound = [&](const Node& node, double distance) {
    return node.shortest + gradation * distance < upper || node.longest - gradation * distance > lower;
  };
  const auto offer = [&](const RimSample& s) {
    const double slope = gradation * (s.position - point).norm();
    upper = std::min(upper, s.edge_length + slope);
    lower = std::max(lower, s.edge_length - slope);
  };
  descend(0, point, bound, offer);
  return 0.5 * (upper + lower);
}

double EdgeLengthField::distance(const Vector3& point) const {
  double best = infinity;
  const auto bound = [&](const Node&, double distance) { return distance < best; };
  const auto offer = [&](const RimSample& s) { best = std::min(best, (s.position - point).norm()); };
  descend(0, point, bound, offer);
  return best;
}

std::vector<RimSample> smoothed_samples(const std::vector<Vector3>& positions,
                                        const std::vector<double>& lengths) {
  const std::size_t n = positions.size(), reach = std::min(most_neighbours, (n - 1) / 2);
  std::vector<RimSample> samples;
  samples.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;  // each anew: beside a very long edge differences would leave nothing of short ones
    for (std::size_t k = 0; k < 2 * reach + 1; ++k) sum += lengths[(i + n - reach + k) % n];
    samples.push_back({positions[i], sum / static_cast<double>(2 * reach + 1)});
  }
  return samples;
}

}  // namespace meshcomplete
