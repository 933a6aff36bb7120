#include "common/core/patch_remeshing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

constexpr Index none = PatchMesh::none;

// A flip may bend the surface by at most this angle unless it was bent more before: cosine of 60 degrees.
constexpr double flat_enough = 0.5;

// A vertex moves at most this far towards the centre of its neighbours in one smoothing step.
constexpr double smoothing_step = 0.7;

class Remesher {
 public:
  Remesher(PatchMesh& patch, std::vector<double>& target, const RemeshOptions& options)
      : patch_(patch), target_(target), options_(options) {}

  void check_size() const;
  void split_long_edges(const Progress& progress);
  void collapse_short_edges();
  void flip_all();
  void smooth_along_surface();
  void split_forbidden();
  void compact();

 private:
  struct LongEdge {
    double ratio;
    Index from, to, half_edge;
    bool operator<(const LongEdge& other) const {
      return ratio != other.ratio ? ratio > other.ratio : half_edge < other.half_edge;
    }
  };

  std::vector<LongEdge> long_edges() const;
  double relative_length(Index h) const {
    return patch_.length(h) / (0.5 * (target_[patch_.origin(h)] + target_[patch_.target(h)]));
  }
  bool forbidden(Index a, Index b) const {
    if (!patch_.on_rim(a) || !patch_.on_rim(b)) return false;
    const std::pair<Index, Index> pair(std::min(a, b), std::max(a, b));
    return std::binary_search(options_.forbidden.begin(), options_.forbidden.end(), pair);
  }
  [[noreturn]] void too_many_vertices() const;
  bool wants_flip(Index h) const;
  void flip_around(Index vertex);
  void flip_stack();
  Index split(Index h);
  bool collapse_is_good(Index h) const;

  PatchMesh& patch_;
  std::vector<double>& target_;
  const RemeshOptions& options_;
  std::vector<Index> stack_;  // half-edges that may have to be flipped
  bool splitting_ = false;
};

// Sum of the cotangents of a triangle's angles, times four: squared sides over area, infinite for a flat
// triangle.
double harmonic_index(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double squares = (a - b).squaredNorm() + (b - c).squaredNorm() + (c - a).squaredNorm();
  const double area = (b - a).cross(c - a).norm();
  return area > 0 ? squares / area : std::numeric_limits<double>::infinity();
}

// In the plane the Delaunay triangulation has the least sum of harmonic indices (Musin 1997), and every flip
// towards it lowers the sum. Asking for just that also makes flips end on a bent patch, where the angle
// criterion may cycle.
bool Remesher::wants_flip(Index h) const {
  const Index g = patch_.opposite(h);
  if (g == none) return false;
  const Index a = patch_.origin(h), b = patch_.target(h), c = patch_.apex(h), d = patch_.apex(g);
  const Vector3 &pa = patch_.position(a), &pb = patch_.position(b), &pc = patch_.position(c),
                &pd = patch_.position(d);
  // The margin is far above the rounding of the sums and far below any change worth a flip.
  constexpr double margin = 1.0 - 1e-9;
  const double before = harmonic_index(pa, pb, pc) + harmonic_index(pb, pa, pd);
  const double after = harmonic_index(pc, pd, pb) + harmonic_index(pd, pc, pa);
  if (!(after < margin * before)) return false;
  // While long edges are split no flip may make one: the split would undo the flip, and never end.
  if (splitting_ && (pc - pd).norm() > 0.5 * options_.longest * (target_[c] + target_[d])) return false;
  if (!can_flip(patch_, h, options_.forbidden)) return false;
  const Vector3 before1 = (pb - pa).cross(pc - pa), before2 = (pa - pb).cross(pd - pb);
  const Vector3 after1 = (pd - pc).cross(pb - pc), after2 = (pc - pd).cross(pa - pd);
  const double bend_after = after1.dot(after2) / (after1.norm() * after2.norm());
  const double norms_before = before1.norm() * before2.norm();
  const double bend_before = norms_before > 0 ? before1.dot(before2) / norms_before : -1.0;
  return bend_after >= std::min(flat_enough, bend_before);
}

void Remesher::flip_stack() {
  while (!stack_.empty()) {
    const Index h = stack_.back();
    stack_.pop_back();
    if (!patch_.alive(h / 3) || patch_.is_boundary(h) || !wants_flip(h)) continue;
    const Index h0 = h - h % 3, g0 = patch_.opposite(h) - patch_.opposite(h) % 3;
    patch_.flip(h);
    for (Index around : {h0 + 1, h0 + 2, g0 + 1, g0 + 2}) stack_.push_back(around);
  }
}

void Remesher::flip_all() {
  for (Index h = 0; h < 3 * patch_.triangle_count(); ++h)
    if (patch_.alive(h / 3) && !patch_.is_boundary(h) && h < patch_.opposite(h)) stack_.push_back(h);
  std::reverse(stack_.begin(), stack_.end());
  flip_stack();
}

void Remesher::flip_around(Index vertex) {
  patch_.for_outgoing(vertex, [&](Index h) {
    stack_.push_back(PatchMesh::next(h));
    stack_.push_back(h);
  });
  flip_stack();
}

Index Remesher::split(Index h) {
  const Index a = patch_.origin(h), b = patch_.target(h);
  const Index m = patch_.split(h, 0.5 * (patch_.position(a) + patch_.position(b)));
  target_.push_back(0.5 * (target_[a] + target_[b]));
  return m;
}

// The inner edges that are too long now, longest first.
std::vector<Remesher::LongEdge> Remesher::long_edges() const {
  std::vector<LongEdge> edges;
  for (Index h = 0; h < 3 * patch_.triangle_count(); ++h) {
    if (!patch_.alive(h / 3) || patch_.is_boundary(h) || patch_.opposite(h) < h) continue;
    const double ratio = relative_length(h);
    if (ratio > options_.longest) edges.push_back({ratio, patch_.origin(h), patch_.target(h), h});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

void Remesher::too_many_vertices() const {
  throw CompletionError("refining the patch", "The patch would need more than " +
                                                  std::to_string(options_.max_vertices) +
                                                  " vertices at this edge length; ask for longer edges.");
}

// Triangles whose sides are all short enough have at most a known area, and there are two of them per vertex:
// this many vertices are needed at least, and it is better to know before they have been made.
void Remesher::check_size() const {
  double triangles = 0;
  for (Index t = 0; t < patch_.triangle_count(); ++t) {
    if (!patch_.alive(t)) continue;
    const Triangle& corners = patch_.triangles()[t];
    const double side =
        options_.longest * std::max({target_[corners[0]], target_[corners[1]], target_[corners[2]]});
    triangles += 0.5 * patch_.area_normal(t).norm() / (0.25 * std::sqrt(3.0) * side * side);
  }
  if (0.5 * triangles > static_cast<double>(options_.max_vertices)) too_many_vertices();
}

// In passes, each over the edges that are too long at its start: splitting needles makes new long edges for
// ever, and the passes are as many as halving the longest edge takes, and as many again for the edges that
// splits add.
void Remesher::split_long_edges(const Progress& progress) {
  std::vector<LongEdge> edges = long_edges();
  if (edges.empty()) return;
  const int passes = 2 * static_cast<int>(std::ceil(std::log2(edges.front().ratio / options_.longest))) + 2;
  splitting_ = true;
  for (int pass = 0; pass < passes && !edges.empty(); ++pass) {
    for (const LongEdge& edge : edges) {
      const Index h = edge.half_edge;
      // Stale when flips or splits have changed what the half-edge joins.
      if (patch_.origin(h) != edge.from || patch_.target(h) != edge.to) continue;
      if (patch_.vertex_count() >= options_.max_vertices) too_many_vertices();
      flip_around(split(h));
    }
    progress.check();
    edges = long_edges();
  }
  splitting_ = false;
}

bool Remesher::collapse_is_good(Index h) const {
  if (!patch_.can_collapse(h)) return false;
  const Index a = patch_.origin(h), b = patch_.target(h);
  const Vector3 goal = patch_.position(b);
  bool good = true;
  patch_.for_outgoing(a, [&](Index out) {
    const Index from = patch_.target(out), to = patch_.apex(out);
    const bool dies = from == b || to == b;
    if (from != b) {
      const double wanted = 0.5 * (target_[from] + target_[b]);
      good &= (patch_.position(from) - goal).norm() <= options_.longest * wanted;
      // A chord of the rim is a long-lived nuisance: it may double an input edge and cannot be smoothed.
      good &= !(patch_.on_rim(b) && patch_.on_rim(from)) || patch_.joined(from, b);
    }
    if (dies) return;
    const Vector3 before = patch_.area_normal(out / 3);
    const Vector3 after = (patch_.position(from) - goal).cross(patch_.position(to) - goal);
    good &= after.dot(before) > flat_enough * after.norm() * before.norm();
  });
  return good;
}

void Remesher::collapse_short_edges() {
  const Index half_edges = static_cast<Index>(3 * patch_.triangle_count());
  for (Index h = 0; h < half_edges; ++h) {
    if (!patch_.alive(h / 3) || patch_.is_boundary(h) || relative_length(h) >= options_.shortest) continue;
    Index doomed = h;
    if (patch_.on_rim(patch_.origin(doomed))) doomed = patch_.opposite(h);
    if (patch_.on_rim(patch_.origin(doomed)) || !collapse_is_good(doomed)) continue;
    patch_.collapse(doomed);
  }
}

void Remesher::smooth_along_surface() {
  std::vector<Vector3> moved(patch_.positions());
  std::vector<double> sizes(target_);
  for (Index v = static_cast<Index>(patch_.rim_size()); v < patch_.vertex_count(); ++v) {
    if (!patch_.vertex_alive(v)) continue;
    Vector3 normal = Vector3::Zero(), centre = Vector3::Zero();
    double weight = 0, size = 0;
    int neighbours = 0;
    patch_.for_outgoing(v, [&](Index out) {
      const Vector3 area = patch_.area_normal(out / 3);
      const double relative = area.norm() / std::max(target_[v] * target_[v], 1e-300);
      normal += area;
      const Vector3 middle =
          (patch_.position(v) + patch_.position(patch_.target(out)) + patch_.position(patch_.apex(out))) /
          3.0;
      centre += relative * middle;
      weight += relative;
      size += target_[patch_.target(out)];
      ++neighbours;
    });
    sizes[v] = size / neighbours;
    if (!(weight > 0) || !(normal.norm() > 0)) continue;
    normal.normalize();
    const Vector3 step = centre / weight - patch_.position(v);
    moved[v] += smoothing_step * (step - normal * normal.dot(step));
  }
  for (Index v = static_cast<Index>(patch_.rim_size()); v < patch_.vertex_count(); ++v)
    if (patch_.vertex_alive(v)) patch_.move(v, moved[v]);
  target_ = sizes;
}

void Remesher::split_forbidden() {
  const Index half_edges = static_cast<Index>(3 * patch_.triangle_count());
  for (Index h = 0; h < half_edges; ++h)
    if (patch_.alive(h / 3) && !patch_.is_boundary(h) && forbidden(patch_.origin(h), patch_.target(h)))
      split(h);
}

void Remesher::compact() {
  std::size_t kept = 0;
  for (Index v = 0; v < patch_.vertex_count(); ++v)
    if (patch_.vertex_alive(v) || patch_.on_rim(v)) target_[kept++] = target_[v];
  target_.resize(kept);
  patch_.compact();
}

}  // namespace

bool can_flip(const PatchMesh& patch, Index h, const ForbiddenEdges& forbidden) {
  if (patch.is_boundary(h)) return false;
  const Index c = patch.apex(h), d = patch.apex(patch.opposite(h));
  const std::pair<Index, Index> pair(std::min(c, d), std::max(c, d));
  return c != d && !patch.joined(c, d) && !std::binary_search(forbidden.begin(), forbidden.end(), pair);
}

void refine(PatchMesh& patch, std::vector<double>& target, const RemeshOptions& options,
            const Progress& progress) {
  Remesher remesher(patch, target, options);
  remesher.flip_all();
  remesher.check_size();
  remesher.split_long_edges(progress);
  remesher.split_forbidden();
}

void remesh(PatchMesh& patch, std::vector<double>& target, const RemeshOptions& options,
            const Progress& progress) {
  Remesher remesher(patch, target, options);
  remesher.check_size();
  for (int round = 0; round < options.rounds; ++round) {
    remesher.split_long_edges(progress);
    remesher.collapse_short_edges();
    remesher.flip_all();
    remesher.smooth_along_surface();
    remesher.flip_all();
    progress.update((round + 1.0) / options.rounds);
  }
  remesher.split_forbidden();
  remesher.compact();
}

}  // namespace meshcomplete
