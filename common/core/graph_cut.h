// Minimum cuts: which of many nodes go with the source and which with the sink.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace meshcomplete {

/// A graph with integer capacities, so that the cut is exact. Boykov and Kolmogorov's algorithm (libmaxflow).
/// At most 2^31 nodes and 2^30 edges; while cutting, about 80 bytes for each node and for each edge. Numbers
/// of nodes that are not there throw std::out_of_range, lack of memory throws CompletionError.
class GraphCut {
 public:
  using Capacity = std::int64_t;
  /// Stronger than every finite capacity together; the caller's finite ones must add up to less than this.
  /// Greater capacities, and sums of infinite ones, count as infinite.
  static constexpr Capacity infinite = Capacity{1} << 50;

  /// `nodes` and `edges` are what memory is reserved for.
  explicit GraphCut(std::size_t nodes, std::size_t edges = 0);
  ~GraphCut();
  GraphCut(GraphCut&&) noexcept;

  /// The price of separating two nodes, either way; adds up. Negative capacities throw CompletionError. An
  /// edge from a node to itself counts for nothing.
  void join(std::size_t a, std::size_t b, Capacity capacity);
  /// The price of putting the node with the sink (`to_source`) or with the source (`to_sink`); add up.
  void tie(std::size_t node, Capacity to_source, Capacity to_sink);

  /// Computes a minimum cut; returns its weight, `infinite` when infinite prices contradict one another. A
  /// node that could be on either side is with the sink, so that the labels do not depend on the order of the
  /// calls. More may be joined and tied afterwards, and the graph be cut again. Cost: near-linear in practice
  /// for the graphs of octrees; many edges between the same two nodes make it quadratic in their number.
  Capacity cut();
  /// After `cut`: whether the node is with the source.
  bool with_source(std::size_t node) const;

 private:
  struct Graph;
  std::unique_ptr<Graph> graph_;
};

}  // namespace meshcomplete
