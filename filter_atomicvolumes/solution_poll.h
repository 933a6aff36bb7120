// Which of several divisions of space is taken.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "filter_atomicvolumes/volume_solution.h"

namespace meshcomplete {

/// Which loops have a patch in common: per patch its loops, ascending, and the number of its pieces at the
/// end.
using LoopPartition = std::vector<std::vector<std::size_t>>;

/// What is held against a solution, and what it says.
struct SolutionVote {
  std::size_t number = 0;        ///< of the solution
  std::size_t flawed_edges = 0;  ///< of rims whose patch cannot be used
  LoopPartition partition;
  double cost = 0;
};

/// Hears all solutions and keeps a few. The one taken has the fewest flawed edges; of those, the partition
/// that most solutions have: near ties between two surfaces fall at random; and of these the least cost. The
/// order in which they are heard does not matter.
class SolutionPoll {
 public:
  /// Keeps the solution if it may be the one.
  void hear(SolutionVote vote, VolumeSolution solution);
  /// The number of the winner. There must be one.
  std::size_t winner() const;
  /// The winner, if it was kept: else it has to be made again.
  std::optional<VolumeSolution> take();

 private:
  bool better(const SolutionVote& a, const SolutionVote& b) const;

  std::vector<SolutionVote> votes_;
  struct Kept {
    std::size_t vote;  // in `votes_`
    VolumeSolution solution;
  };
  std::vector<Kept> kept_;  // the best of each of the most frequent partitions
};

}  // namespace meshcomplete
