#include "common/core/patch_rounding.h"

#include <algorithm>
#include <utility>

#include "common/core/patch.h"

namespace meshcomplete {
namespace {

// Passes over the vertices that are left: merging some makes room for others.
constexpr int most_passes = 8;

class Rounder {
 public:
  Rounder(PatchMesh& patch, GuardedPatch& guarded) : patch_(patch), guarded_(guarded) {}

  // Whether the vertex is gone, or is where it can be stored.
  bool settle(Index vertex, int pass) {
    if (!patch_.vertex_alive(vertex)) return true;
    return guarded_.move(vertex, patch_.position(vertex)) || merge(vertex) || (pass > 0 && flip(vertex)) ||
           (pass > 1 && move_inward(vertex));
  }

 private:
  std::vector<Index> edges_by_length(Index vertex) const {
    std::vector<std::pair<double, Index>> edges;
    patch_.for_outgoing(vertex, [&](Index h) { edges.emplace_back(patch_.length(h), h); });
    std::sort(edges.begin(), edges.end());
    std::vector<Index> sorted;
    for (const auto& [length, h] : edges) sorted.push_back(h);
    return sorted;
  }
  bool merge(Index vertex) {
    const std::vector<Index> edges = edges_by_length(vertex);
    return std::any_of(edges.begin(), edges.end(), [&](Index h) { return guarded_.collapse(h); });
  }
  // Takes an edge away, which may make room.
  bool flip(Index vertex) {
    std::vector<Index> edges = edges_by_length(vertex);
    std::reverse(edges.begin(), edges.end());
    for (Index h : edges)
      if (!patch_.is_boundary(h) && guarded_.flip(h))
        return guarded_.move(vertex, patch_.position(vertex)) || merge(vertex);
    return false;
  }
  bool move_inward(Index vertex) {
    Vector3 sum = Vector3::Zero();
    double count = 0;
    patch_.for_neighbours(vertex, [&](Index v) {
      sum += patch_.position(v);
      ++count;
    });
    const Vector3 here = patch_.position(vertex), middle = sum / count;
    return guarded_.move(vertex, middle) || guarded_.move(vertex, 0.5 * (here + middle)) ||
           guarded_.move(vertex, 0.9 * here + 0.1 * middle);
  }

  PatchMesh& patch_;
  GuardedPatch& guarded_;
};

}  // namespace

std::size_t round_vertices(PatchMesh& patch, GuardedPatch& guarded, const std::vector<Index>& vertices,
                           const Progress& progress) {
  Rounder rounder(patch, guarded);
  std::vector<Index> left = vertices;
  for (int pass = 0; pass < most_passes && !left.empty(); ++pass) {
    std::vector<Index> still;
    for (Index v : left) {
      if (!rounder.settle(v, pass)) still.push_back(v);
      progress.check();
    }
    left.swap(still);
  }
  for (Index v : left) patch.move(v, as_stored(patch.position(v)));
  return left.size();
}

}  // namespace meshcomplete
