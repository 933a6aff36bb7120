#include "common/core/hole_targets.h"

#include <algorithm>

namespace meshcomplete {

bool is_targeted(const HoleReport& hole) {
  return hole.outcome == HoleOutcome::failed && hole.reason.empty();
}

void target_islands(const std::vector<BoundaryLoop>& loops, std::vector<HoleReport>& holes) {
  if (std::none_of(holes.begin(), holes.end(), is_targeted)) return;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (loops[i].defect != LoopDefect::open_sheet || holes[i].reason != describe(LoopDefect::open_sheet))
      continue;
    holes[i].outcome = HoleOutcome::failed;
    holes[i].reason.clear();
  }
}

}  // namespace meshcomplete
