// The shortest loop near a given one that cannot be drawn together either.
#pragma once

#include <vector>

#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "filter_volmorph/capped_surface.h"
#include "filter_volmorph/loop_basis.h"

namespace meshcomplete {

/// Shortens loops of one surface. Keeps 40 bytes for each vertex. For one thread.
class LoopShortener {
 public:
  /// Refers to both; `lengths`: `edge_lengths`.
  LoopShortener(const CappedSurface& surface, const std::vector<double>& lengths);

  /// A loop that crosses the edges of `crossed` an odd number of times and goes through one of
  /// some vertices of `loop`, which does so itself: the shortest one if that has no more than about a hundred
  /// edges, and none that is longer than `loop`; and so on from that loop, while it gets shorter. `crossed`:
  /// the edges that a closed curve crosses, each by any of its half-edges; those named twice count as not
  /// crossed. Cost: O(m log m) for the m vertices that are no farther than half the loop's length, a few
  /// times.
  SurfaceLoop shortened(SurfaceLoop loop, const std::vector<Index>& crossed,
                        const Progress& progress = Progress());

 private:
  // A vertex, reached by a path that crosses an even or an odd number of times.
  using Node = std::uint32_t;
  struct Meeting {
    double length;
    Node from = 0;
    Index half_edge = 0;
    Node to = 0;
  };

  bool shorten_through(Index vertex, SurfaceLoop& loop, const Progress& progress);
  void toggle(const std::vector<Index>& crossed);
  void begin(Node root);
  bool reached(Node node) const { return stamp_[node] == round_; }
  SurfaceLoop loop_at(const Meeting& meeting) const;
  std::vector<Index> path_to(Node node) const;

  const CappedSurface& surface_;
  const std::vector<double>& lengths_;
  std::vector<char> odd_;  // of half-edges: crossed
  std::vector<std::uint32_t> stamp_;
  std::vector<double> distance_;
  std::vector<Index> entering_;
  std::uint32_t round_ = 0;
};

}  // namespace meshcomplete
