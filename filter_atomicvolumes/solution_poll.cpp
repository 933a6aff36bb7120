#include "filter_atomicvolumes/solution_poll.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace meshcomplete {
namespace {

// Solutions of large meshes take a gigabyte.
constexpr std::size_t most_kept = 3;

}  // namespace

bool SolutionPoll::better(const SolutionVote& a, const SolutionVote& b) const {
  const auto others = [&](const SolutionVote& one) {
    return std::count_if(votes_.begin(), votes_.end(),
                         [&](const SolutionVote& other) { return other.partition != one.partition; });
  };
  return std::make_tuple(a.flawed_edges, others(a), a.cost, a.number) <
         std::make_tuple(b.flawed_edges, others(b), b.cost, b.number);
}

void SolutionPoll::hear(SolutionVote vote, VolumeSolution solution) {
  votes_.push_back(std::move(vote));
  std::vector<Kept> kept;
  kept.push_back({votes_.size() - 1, std::move(solution)});
  for (Kept& one : kept_) kept.push_back({one.vote, std::move(one.solution)});
  // Of two with one partition the worse cannot win any more.
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const SolutionVote& here = votes_[kept[i].vote];
    if (std::none_of(kept.begin(), kept.end(), [&](const Kept& other) {
          const SolutionVote& there = votes_[other.vote];
          return there.partition == here.partition && better(there, here);
        }))
      order.push_back(i);
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return better(votes_[kept[a].vote], votes_[kept[b].vote]); });
  order.resize(std::min(order.size(), most_kept));
  kept_.clear();
  for (std::size_t i : order) kept_.push_back({kept[i].vote, std::move(kept[i].solution)});
}

std::size_t SolutionPoll::winner() const {
  return std::min_element(votes_.begin(), votes_.end(),
                          [&](const SolutionVote& a, const SolutionVote& b) { return better(a, b); })
      ->number;
}

std::optional<VolumeSolution> SolutionPoll::take() {
  const std::size_t number = winner();
  for (Kept& one : kept_)
    if (votes_[one.vote].number == number) return std::move(one.solution);
  return std::nullopt;
}

}  // namespace meshcomplete
