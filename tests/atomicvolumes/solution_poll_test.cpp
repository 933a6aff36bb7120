// Which division is taken, against the definition in its header.
#include "filter_atomicvolumes/solution_poll.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

class Poll : public ::testing::Test {
 protected:
  /// Told apart by a figure.
  VolumeSolution solution(std::size_t number) const {
    VolumeSolution one{
        {mesh_, topology_, neighbourhood_, Lattice(Vector3::Zero(), 1)}, {}, {}, {}, {}, {}, {}, {}};
    one.figures.nodes = number;
    return one;
  }

 private:
  const TriangleMesh mesh_ = test::icosphere(0);
  const MeshTopology topology_ = build_topology(mesh_);
  const InputNeighbourhood neighbourhood_{mesh_};
};

std::size_t winner_by_definition(const std::vector<SolutionVote>& votes) {
  const auto rank = [&](const SolutionVote& one) {
    std::size_t alike = 0;
    for (const SolutionVote& other : votes) alike += other.partition == one.partition;
    return std::make_tuple(one.flawed_edges, votes.size() - alike, one.cost, one.number);
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < votes.size(); ++i)
    if (rank(votes[i]) < rank(votes[best])) best = i;
  return votes[best].number;
}

TEST_F(Poll, WhatMostJoinBeatsTheLeastCost) {
  const LoopPartition apart = {{0, 1}, {1, 1}}, joined = {{0, 1, 1}};
  SolutionPoll poll;
  poll.hear({0, 0, apart, 1.0}, solution(0));
  poll.hear({1, 0, joined, 3.0}, solution(1));
  EXPECT_EQ(poll.winner(), 0u);
  poll.hear({2, 0, joined, 2.0}, solution(2));
  EXPECT_EQ(poll.winner(), 2u);
  poll.hear({3, 5, joined, 0.5}, solution(3));
  EXPECT_EQ(poll.winner(), 2u) << "its patch cannot be used for five edges";
  const auto taken = poll.take();
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->figures.nodes, 2u);
}

TEST_F(Poll, TheOrderDoesNotMatter) {
  const std::vector<LoopPartition> partitions = {
      {{0, 1}, {1, 1}}, {{0, 1, 1}}, {{0, 1, 2}}, {{0, 1}}, {{1, 1}}};
  std::mt19937 random(5);
  std::size_t kept = 0, lost = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<SolutionVote> votes;
    const std::size_t count = 1 + random() % 8;
    for (std::size_t i = 0; i < count; ++i)
      votes.push_back({i, random() % 4 == 0 ? random() % 3 : 0, partitions[random() % partitions.size()],
                       static_cast<double>(random() % 4)});
    const std::size_t expected = winner_by_definition(votes);
    std::shuffle(votes.begin(), votes.end(), random);
    SolutionPoll poll;
    std::set<LoopPartition> heard;
    for (const SolutionVote& vote : votes) {
      poll.hear(vote, solution(vote.number));
      heard.insert(vote.partition);
    }
    ASSERT_EQ(poll.winner(), expected) << "round " << round;
    const auto taken = poll.take();
    if (taken) {
      EXPECT_EQ(taken->figures.nodes, expected);
    } else {
      EXPECT_GT(heard.size(), 3u) << "round " << round;
    }
    ++(taken ? kept : lost);
  }
  EXPECT_GT(kept, 200u);
  EXPECT_GT(lost, 0u) << "some have to be made again";
}

}  // namespace
}  // namespace meshcomplete
