#include "common/core/guarded_remeshing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meshcomplete {
namespace {

constexpr Index none = PatchMesh::none;

// A move that is not free is tried again at half its length, so often.
constexpr int halvings = 3;

// Sum of the cotangents of a triangle's angles, times four; infinite for a flat triangle.
double harmonic_index(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double squares = (a - b).squaredNorm() + (b - c).squaredNorm() + (c - a).squaredNorm();
  const double area = (b - a).cross(c - a).norm();
  return area > 0 ? squares / area : std::numeric_limits<double>::infinity();
}

class GuardedRemesher {
 public:
  GuardedRemesher(GuardedPatch& guarded, std::vector<double>& target, const GuardedRemeshOptions& options)
      : guarded_(guarded), patch_(guarded.patch()), target_(target), options_(options) {}

  void split_long_edges();
  void collapse_short_edges();
  void flip_edges();
  void smooth();

 private:
  double relative_length(Index h) const {
    return patch_.length(h) / (0.5 * (target_[patch_.origin(h)] + target_[patch_.target(h)]));
  }
  bool collapse(Index h);

  GuardedPatch& guarded_;
  const PatchMesh& patch_;
  std::vector<double>& target_;
  const GuardedRemeshOptions& options_;
};

void GuardedRemesher::split_long_edges() {
  struct LongEdge {
    double ratio;
    Index half_edge, from, to;
  };
  std::vector<LongEdge> edges;
  for (Index h = 0; h < 3 * patch_.triangle_count(); ++h) {
    if (!patch_.alive(h / 3) || patch_.is_boundary(h) || patch_.opposite(h) < h) continue;
    const double ratio = relative_length(h);
    if (ratio > options_.longest) edges.push_back({ratio, h, patch_.origin(h), patch_.target(h)});
  }
  std::sort(edges.begin(), edges.end(), [](const LongEdge& a, const LongEdge& b) {
    return a.ratio != b.ratio ? a.ratio > b.ratio : a.half_edge < b.half_edge;
  });
  for (const LongEdge& e : edges) {
    if (patch_.origin(e.half_edge) != e.from || patch_.target(e.half_edge) != e.to) continue;
    const Vector3 middle = 0.5 * (patch_.position(e.from) + patch_.position(e.to));
    if (guarded_.split(e.half_edge, middle) != none)
      target_.push_back(0.5 * (target_[e.from] + target_[e.to]));
  }
}

// An inner vertex moves onto its neighbour, the other end where that is the rim.
bool GuardedRemesher::collapse(Index h) {
  const Index a = patch_.origin(h), b = patch_.target(h);
  if (patch_.at_boundary(a)) return false;
  bool good = true;
  patch_.for_outgoing(a, [&](Index out) {
    const Index v = patch_.target(out);
    if (v == b) return;
    good &= (patch_.position(v) - patch_.position(b)).norm() <=
            options_.longest * 0.5 * (target_[v] + target_[b]);
    // A chord of the rim cannot be smoothed.
    good &= !(patch_.at_boundary(b) && patch_.at_boundary(v)) || patch_.joined(v, b);
  });
  return good && guarded_.collapse(h);
}

void GuardedRemesher::collapse_short_edges() {
  const Index half_edges = static_cast<Index>(3 * patch_.triangle_count());
  for (Index h = 0; h < half_edges; ++h)
    if (patch_.alive(h / 3) && !patch_.is_boundary(h) && relative_length(h) < options_.shortest) collapse(h);
}

void GuardedRemesher::flip_edges() {
  // The margin keeps rounding from flipping back and forth.
  constexpr double margin = 1.0 - 1e-9;
  for (Index h = 0; h < 3 * patch_.triangle_count(); ++h) {
    if (!patch_.alive(h / 3) || patch_.is_boundary(h) || patch_.opposite(h) < h) continue;
    const Index g = patch_.opposite(h);
    const Vector3 &a = patch_.position(patch_.origin(h)), &b = patch_.position(patch_.target(h)),
                  &c = patch_.position(patch_.apex(h)), &d = patch_.position(patch_.apex(g));
    if (harmonic_index(c, d, b) + harmonic_index(d, c, a) <
        margin * (harmonic_index(a, b, c) + harmonic_index(b, a, d)))
      guarded_.flip(h);
  }
}

void GuardedRemesher::smooth() {
  std::vector<Vector3> goal = patch_.positions();
  for (Index v = static_cast<Index>(patch_.rim_size()); v < patch_.vertex_count(); ++v) {
    if (!patch_.vertex_alive(v) || patch_.at_boundary(v)) continue;
    Vector3 sum = Vector3::Zero();
    double count = 0, size = 0;
    patch_.for_neighbours(v, [&](Index w) {
      sum += patch_.position(w);
      size += target_[w];
      ++count;
    });
    goal[v] = sum / count;
    target_[v] = size / count;
  }
  guarded_approach(guarded_, goal, 1);
}

}  // namespace

void guarded_remesh(GuardedPatch& guarded, std::vector<double>& target, const GuardedRemeshOptions& options,
                    const Progress& progress) {
  GuardedRemesher remesher(guarded, target, options);
  for (int round = 0; round < options.rounds; ++round) {
    // Collapses first: every step after them has fewer triangles to guard.
    remesher.collapse_short_edges();
    progress.check();
    remesher.split_long_edges();
    remesher.flip_edges();
    progress.check();
    remesher.smooth();
    progress.update((round + 1.0) / options.rounds);
  }
}

double guarded_approach(GuardedPatch& guarded, const std::vector<Vector3>& goal, int sweeps,
                        const Progress& progress) {
  const PatchMesh& patch = guarded.patch();
  double first = 0, left = 0;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    left = 0;
    for (Index v = static_cast<Index>(patch.rim_size()); v < patch.vertex_count(); ++v) {
      if (!patch.vertex_alive(v) || patch.at_boundary(v)) continue;
      const Vector3 here = patch.position(v);
      const double distance = (goal[v] - here).norm();
      if (sweep == 0) first = std::max(first, distance);
      double share = 1;
      int tried = 0;
      while (tried <= halvings && !guarded.move(v, here + share * (goal[v] - here))) {
        share *= 0.5;
        ++tried;
      }
      left = std::max(left, (goal[v] - patch.position(v)).norm());
    }
    progress.update((sweep + 1.0) / sweeps);
  }
  return first > 0 ? left / first : 0;
}

}  // namespace meshcomplete
