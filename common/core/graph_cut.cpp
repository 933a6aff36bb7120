#include "common/core/graph_cut.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "common/core/error.h"

// libmaxflow's documented way to compile its templates for other types than those in its library. Where it
// outgrows what was reserved it computes with pointers that realloc has freed, so everything is reserved in
// advance here.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuse-after-free"
#define MAXFLOW_INCLUDE_TEMPLATE_IMPLEMENTATION
#include <maxflow.h>
#pragma GCC diagnostic pop

namespace meshcomplete {
namespace {

const char* const stage = "cutting the graph";

/// The flow may be the sum of many infinite capacities, where the infinite prices contradict one another.
__extension__ using Flow = __int128;
using Solver = maxflow::Graph<GraphCut::Capacity, GraphCut::Capacity, Flow>;

/// libmaxflow counts nodes, and arcs, two to an edge, with an int.
constexpr std::size_t most_nodes = std::numeric_limits<int>::max();
constexpr std::size_t most_edges = std::numeric_limits<int>::max() / 2;

/// libmaxflow ends the program when its error function returns; this one does not return.
void fail(const char* message) {
  if (std::string(message).find("memory") != std::string::npos)
    throw CompletionError(stage, "There is not enough memory for a graph of this size.");
  throw CompletionError(stage, std::string("The minimum cut could not be computed: ") + message);
}

void refuse_more(std::size_t count, std::size_t most, const char* what) {
  if (count > most)
    throw CompletionError(
        stage, "The graph is too large: at most " + std::to_string(most) + " " + what + " can be handled.");
}

void refuse_negative(GraphCut::Capacity capacity) {
  if (capacity < 0)
    throw CompletionError(stage, "A capacity of the graph is negative: " + std::to_string(capacity) + ".");
}

/// Sums stay within what 64 bits hold, however often something infinite is added.
GraphCut::Capacity clamped(GraphCut::Capacity capacity) { return std::min(capacity, GraphCut::infinite); }

}  // namespace

struct GraphCut::Graph {
  struct Edge {
    int a = 0, b = 0;
    Capacity capacity = 0;
  };
  struct Node {
    Capacity to_source = 0, to_sink = 0;
  };

  void check_node(std::size_t node) const {
    if (node >= nodes.size()) throw std::out_of_range("the graph has no such node");
  }

  std::vector<Node> nodes;
  std::vector<Edge> edges;
  std::vector<bool> with_source;  ///< of the last cut
};

GraphCut::GraphCut(std::size_t nodes, std::size_t edges) : graph_(std::make_unique<Graph>()) {
  refuse_more(nodes, most_nodes, "nodes");
  refuse_more(edges, most_edges, "edges");
  graph_->nodes.resize(nodes);
  graph_->with_source.resize(nodes, false);
  graph_->edges.reserve(edges);
}

GraphCut::~GraphCut() = default;

GraphCut::GraphCut(GraphCut&&) noexcept = default;

void GraphCut::join(std::size_t a, std::size_t b, Capacity capacity) {
  refuse_negative(capacity);
  graph_->check_node(a);
  graph_->check_node(b);
  if (a == b || capacity == 0) return;
  refuse_more(graph_->edges.size() + 1, most_edges, "edges");
  graph_->edges.push_back({static_cast<int>(a), static_cast<int>(b), clamped(capacity)});
}

void GraphCut::tie(std::size_t node, Capacity to_source, Capacity to_sink) {
  refuse_negative(to_source);
  refuse_negative(to_sink);
  graph_->check_node(node);
  Graph::Node& tied = graph_->nodes[node];
  tied.to_source = clamped(tied.to_source + clamped(to_source));
  tied.to_sink = clamped(tied.to_sink + clamped(to_sink));
}

GraphCut::Capacity GraphCut::cut() {
  Graph& graph = *graph_;
  const int nodes = static_cast<int>(graph.nodes.size());
  Solver solver(nodes, static_cast<int>(graph.edges.size()), &fail);
  if (nodes > 0) solver.add_node(nodes);
  for (int node = 0; node < nodes; ++node)
    solver.add_tweights(node, graph.nodes[node].to_source, graph.nodes[node].to_sink);
  for (const Graph::Edge& edge : graph.edges) solver.add_edge(edge.a, edge.b, edge.capacity, edge.capacity);
  const Flow flow = solver.maxflow();
  for (int node = 0; node < nodes; ++node)
    graph.with_source[node] = solver.what_segment(node, Solver::SINK) == Solver::SOURCE;
  return flow < infinite ? static_cast<Capacity>(flow) : infinite;
}

bool GraphCut::with_source(std::size_t node) const {
  graph_->check_node(node);
  return graph_->with_source[node];
}

}  // namespace meshcomplete
