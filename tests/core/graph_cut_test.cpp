#include "common/core/graph_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

using Capacity = GraphCut::Capacity;

struct Edge {
  std::size_t a = 0, b = 0;
  Capacity capacity = 0;
};

struct Tie {
  std::size_t node = 0;
  Capacity to_source = 0, to_sink = 0;
};

struct Problem {
  std::size_t nodes = 0;
  std::vector<Edge> edges;
  std::vector<Tie> ties;
};

GraphCut graph_of(const Problem& problem) {
  GraphCut graph(problem.nodes, problem.edges.size());
  for (const Edge& edge : problem.edges) graph.join(edge.a, edge.b, edge.capacity);
  for (const Tie& tie : problem.ties) graph.tie(tie.node, tie.to_source, tie.to_sink);
  return graph;
}

struct Answer {
  Capacity weight = 0;
  std::uint32_t with_source = 0;  ///< a bit for each node
};

bool operator==(const Answer& a, const Answer& b) {
  return a.weight == b.weight && a.with_source == b.with_source;
}

Answer answer_of(GraphCut graph, std::size_t nodes) {
  Answer answer;
  answer.weight = graph.cut();
  for (std::size_t node = 0; node < nodes; ++node)
    if (graph.with_source(node)) answer.with_source |= std::uint32_t{1} << node;
  return answer;
}

/// The least weight among all labellings, and the nodes that are with the source in every one of that weight.
/// (Minimum cuts are closed under intersection, so that this is the labelling in which as much as possible is
/// with the sink.) Visits the labellings in the order of a Gray code: one node changes sides at each step.
Answer by_brute_force(const Problem& problem) {
  std::vector<std::vector<Capacity>> joined(problem.nodes, std::vector<Capacity>(problem.nodes, 0));
  std::vector<Capacity> to_source(problem.nodes, 0), to_sink(problem.nodes, 0);
  for (const Edge& edge : problem.edges)
    if (edge.a != edge.b) {
      joined[edge.a][edge.b] += edge.capacity;
      joined[edge.b][edge.a] += edge.capacity;
    }
  Capacity weight = 0;  // of the labelling in which all are with the sink
  for (const Tie& tie : problem.ties) {
    to_source[tie.node] += tie.to_source;
    to_sink[tie.node] += tie.to_sink;
    weight += tie.to_source;
  }
  Answer best{weight, 0};
  std::uint32_t labels = 0;
  for (std::uint32_t step = 1; step < std::uint32_t{1} << problem.nodes; ++step) {
    std::size_t node = 0;
    while ((step >> node & 1) == 0) ++node;
    const bool leaves_source = (labels >> node & 1) != 0;
    labels ^= std::uint32_t{1} << node;
    // What it costs that the node is with the source, and not with the sink, the others being as they are.
    Capacity price = to_sink[node] - to_source[node];
    for (std::size_t other = 0; other < problem.nodes; ++other)
      price += (labels >> other & 1) != 0 ? -joined[node][other] : joined[node][other];
    weight += leaves_source ? -price : price;
    if (weight < best.weight)
      best = {weight, labels};
    else if (weight == best.weight)
      best.with_source &= labels;
  }
  return best;
}

Problem random_problem(std::mt19937_64& random, std::size_t nodes, Capacity highest) {
  std::uniform_int_distribution<Capacity> capacity(0, highest);
  std::uniform_int_distribution<std::size_t> node(0, nodes - 1);
  Problem problem;
  problem.nodes = nodes;
  for (std::size_t i = 0; i < 3 * nodes; ++i)
    problem.edges.push_back({node(random), node(random), capacity(random)});
  for (std::size_t i = 0; i < nodes; ++i)
    problem.ties.push_back({node(random), capacity(random), capacity(random)});
  return problem;
}

TEST(GraphCut, WeightAndLabellingAreThoseOfBruteForce) {
  std::mt19937_64 random(1);
  // Small capacities make many cuts of the same weight.
  for (const Capacity highest : {Capacity{1}, Capacity{2}, Capacity{5}, Capacity{1000000}})
    for (int trial = 0; trial < 100; ++trial) {
      const Problem problem = random_problem(random, 2 + static_cast<std::size_t>(trial) % 10, highest);
      const Answer answer = answer_of(graph_of(problem), problem.nodes);
      const Answer expected = by_brute_force(problem);
      EXPECT_EQ(answer.weight, expected.weight);
      EXPECT_EQ(answer.with_source, expected.with_source);
    }
}

TEST(GraphCut, TwentyNodes) {
  std::mt19937_64 random(2);
  for (const Capacity highest : {Capacity{1}, Capacity{3}, Capacity{1} << 40}) {
    const Problem problem = random_problem(random, 20, highest);
    EXPECT_TRUE(answer_of(graph_of(problem), problem.nodes) == by_brute_force(problem)) << highest;
  }
}

TEST(GraphCut, InfiniteTiesAreObeyed) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 50; ++trial) {
    Problem problem = random_problem(random, 10, Capacity{1} << 40);
    problem.ties.push_back({0, GraphCut::infinite, 0});
    problem.ties.push_back({1, GraphCut::infinite, 0});
    problem.ties.push_back({2, 0, GraphCut::infinite});
    const Answer answer = answer_of(graph_of(problem), problem.nodes);
    EXPECT_EQ(answer.with_source & 7u, 3u);
    EXPECT_LT(answer.weight, GraphCut::infinite);
    EXPECT_TRUE(answer == by_brute_force(problem));
  }
}

TEST(GraphCut, InfiniteEdgesHoldTogether) {
  // A strong tie to the source at one end of a chain, weaker ones to the sink all along it.
  GraphCut graph(4, 3);
  for (std::size_t node = 0; node < 3; ++node) {
    graph.join(node, node + 1, GraphCut::infinite);
    graph.tie(node + 1, 0, 10);
  }
  graph.tie(0, 31, 0);
  EXPECT_EQ(graph.cut(), 30);
  for (std::size_t node = 0; node < 4; ++node) EXPECT_TRUE(graph.with_source(node));
}

TEST(GraphCut, InfinityAddedToInfinityIsInfinity) {
  GraphCut graph(3);
  for (int i = 0; i < 20000; ++i) {
    graph.tie(0, GraphCut::infinite, 0);
    graph.tie(1, 0, std::numeric_limits<Capacity>::max());
  }
  graph.join(0, 1, 5);
  graph.join(1, 2, std::numeric_limits<Capacity>::max());
  EXPECT_EQ(graph.cut(), 5);
  EXPECT_TRUE(graph.with_source(0));
  EXPECT_FALSE(graph.with_source(1));
  EXPECT_FALSE(graph.with_source(2));
}

TEST(GraphCut, ContradictionsHaveAnInfiniteWeight) {
  // As many as would overflow 64 bits if their capacities were added up.
  constexpr std::size_t pairs = 20000;
  GraphCut graph(2 * pairs, pairs);
  for (std::size_t i = 0; i < pairs; ++i) {
    graph.tie(2 * i, GraphCut::infinite, 0);
    graph.tie(2 * i + 1, 0, GraphCut::infinite);
    graph.join(2 * i, 2 * i + 1, GraphCut::infinite);
  }
  EXPECT_EQ(graph.cut(), GraphCut::infinite);
}

TEST(GraphCut, NodesWithoutTiesGoWithTheSink) {
  GraphCut graph(5, 2);
  graph.join(1, 2, 7);
  graph.tie(3, 2, 2);
  graph.tie(4, 3, 0);
  EXPECT_EQ(graph.cut(), 2);
  for (std::size_t node = 0; node < 4; ++node) EXPECT_FALSE(graph.with_source(node)) << node;
  EXPECT_TRUE(graph.with_source(4));
}

TEST(GraphCut, AGraphWithoutNodes) { EXPECT_EQ(GraphCut(0).cut(), 0); }

TEST(GraphCut, LargeCapacities) {
  // One apart, near the greatest sum that is allowed: neither doubles nor 32 bits tell them apart.
  const Capacity large = (Capacity{1} << 49) - 2;
  for (const Capacity more : {-1, 0, 1}) {
    GraphCut graph(2, 1);
    graph.tie(0, GraphCut::infinite, 0);
    graph.join(0, 1, large);
    graph.tie(1, 0, large + more);
    EXPECT_EQ(graph.cut(), large + std::min(more, Capacity{0}));
    EXPECT_EQ(graph.with_source(1), more < 0);
  }
}

TEST(GraphCut, RepeatedEdgesAndTiesAddUp) {
  GraphCut graph(2, 1);
  for (int i = 0; i < 4; ++i) graph.join(i % 2 == 0 ? 0 : 1, i % 2 == 0 ? 1 : 0, 5);
  for (int i = 0; i < 3; ++i) {
    graph.tie(0, 10, 1);
    graph.tie(1, 2, 7);
  }
  // Both with the source 3 + 21, both with the sink 30 + 6, apart 20 + 3 + 6 the right way round.
  EXPECT_EQ(graph.cut(), 24);
  EXPECT_TRUE(graph.with_source(0) && graph.with_source(1));
}

TEST(GraphCut, MoreEdgesThanAnnounced) {
  std::mt19937_64 random(4);
  const Problem problem = random_problem(random, 15, 9);
  GraphCut graph(problem.nodes);
  for (const Edge& edge : problem.edges) graph.join(edge.a, edge.b, edge.capacity);
  for (const Tie& tie : problem.ties) graph.tie(tie.node, tie.to_source, tie.to_sink);
  EXPECT_TRUE(answer_of(std::move(graph), problem.nodes) == by_brute_force(problem));
}

TEST(GraphCut, TiesAndEdgesCanBeAddedAfterACut) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 30; ++trial) {
    Problem problem = random_problem(random, 9, 4);
    GraphCut graph = graph_of(problem);
    graph.cut();
    const Problem more = random_problem(random, 9, 4);
    for (const Edge& edge : more.edges) {
      graph.join(edge.a, edge.b, edge.capacity);
      problem.edges.push_back(edge);
    }
    for (const Tie& tie : more.ties) {
      graph.tie(tie.node, tie.to_source, tie.to_sink);
      problem.ties.push_back(tie);
    }
    EXPECT_TRUE(answer_of(std::move(graph), problem.nodes) == by_brute_force(problem));
  }
}

TEST(GraphCut, NegativeCapacitiesAndForeignNodesAreRefused) {
  GraphCut graph(2, 1);
  EXPECT_THROW(graph.join(0, 1, -1), CompletionError);
  EXPECT_THROW(graph.tie(0, -1, 0), CompletionError);
  EXPECT_THROW(graph.tie(0, 0, -1), CompletionError);
  EXPECT_THROW(graph.join(0, 2, 1), std::out_of_range);
  EXPECT_THROW(graph.tie(2, 1, 0), std::out_of_range);
  EXPECT_THROW(graph.with_source(2), std::out_of_range);
  EXPECT_EQ(graph.cut(), 0);
}

TEST(GraphCut, TooManyNodesAreRefused) {
  EXPECT_THROW(GraphCut(std::size_t{1} << 31), CompletionError);
  EXPECT_THROW(GraphCut(1, std::size_t{1} << 31), CompletionError);
}

/// A slab of a grid: many shortest cuts, as in a decomposition of empty space.
TEST(GraphCut, AGridIsCutAtItsWaist) {
  constexpr std::size_t n = 30;
  const auto at = [](std::size_t x, std::size_t y, std::size_t z) { return (z * n + y) * n + x; };
  GraphCut graph(n * n * n, 3 * n * n * n);
  for (std::size_t z = 0; z < n; ++z)
    for (std::size_t y = 0; y < n; ++y)
      for (std::size_t x = 0; x < n; ++x) {
        const Capacity price = x == 20 ? 2 : 3;
        if (x + 1 < n) graph.join(at(x, y, z), at(x + 1, y, z), price);
        if (y + 1 < n) graph.join(at(x, y, z), at(x, y + 1, z), 3);
        if (z + 1 < n) graph.join(at(x, y, z), at(x, y, z + 1), 3);
        if (x == 0) graph.tie(at(x, y, z), GraphCut::infinite, 0);
        if (x == n - 1) graph.tie(at(x, y, z), 0, GraphCut::infinite);
      }
  EXPECT_EQ(graph.cut(), Capacity{2 * n * n});
  for (std::size_t i = 0; i < n * n * n; ++i) EXPECT_EQ(graph.with_source(i), i % n <= 20) << i;
}

}  // namespace
}  // namespace meshcomplete
