#include "common/core/patch_retriangulation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "common/core/patch.h"
#include "common/core/patch_remeshing.h"
#include "common/core/patch_surroundings.h"
#include "common/core/triangle_intersection.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;

constexpr Index none = PatchMesh::none;

// Gaps with more corners take too long.
constexpr std::size_t most_corners = 60;

// A crease is measured as one minus the cosine of the angle between two normals. Up to 60 degrees it is
// slight: short edges matter more then.
constexpr double slight_crease = 0.5;

// How often triangles of one triangulation that meet each other are forbidden, one of each pair, before
// giving up.
constexpr int most_forbiddings = 12;

// Of a triangulation of part of the gap: its worst crease unless slight, and the sum of its triangles'
// squared sides.
struct Cost {
  double crease = 0;
  double squares = 0;
  bool operator<(const Cost& other) const {
    return crease != other.crease ? crease < other.crease : squares < other.squares;
  }
};

struct Gap {
  std::vector<Index> triangles;  // that are taken out
  std::vector<Index> corners;    // vertices of the patch, in the sense of the triangles
  // Unit, beyond the side from each corner to the next; zero where there is nothing.
  std::vector<Vector3> normals;
};

class GapFinder {
 public:
  GapFinder(const PatchMesh& patch, const Rim& rim) : patch_(patch) {
    const Index n = static_cast<Index>(rim.positions.size());
    for (const Triangle& t : rim.ring.triangles)
      for (int k = 0; k < 3; ++k) {
        const Index a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
        if (a >= n || b >= n || a != rim.next[b]) continue;
        const auto& p = rim.ring.vertices;
        rim_normals_[b] = (p[b] - p[a]).cross(p[c] - p[a]).stableNormalized();
      }
  }

  std::vector<Gap> gaps(const std::vector<Index>& tangled, int rings) const;

 private:
  std::optional<Gap> gap(const std::vector<Index>& triangles, const std::vector<char>& inside) const;

  const PatchMesh& patch_;
  // Of the input's triangles at the rim edges, by the edge's first vertex.
  std::map<Index, Vector3> rim_normals_;
};

std::vector<Gap> GapFinder::gaps(const std::vector<Index>& tangled, int rings) const {
  std::vector<char> inside(patch_.triangle_count(), 0);
  std::vector<Index> triangles;
  const auto take = [&](Index t) {
    if (inside[t]) return;
    inside[t] = 1;
    triangles.push_back(t);
  };
  for (Index t : tangled) take(t);
  std::size_t first = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t last = triangles.size();
    for (; first < last; ++first)
      for (Index v : Triangle(patch_.triangles()[triangles[first]]))
        patch_.for_outgoing(v, [&](Index h) { take(h / 3); });
  }
  // Parts that hang together by edges.
  std::vector<Gap> found;
  std::vector<char> seen(patch_.triangle_count(), 0);
  for (Index start : triangles) {
    if (seen[start]) continue;
    std::vector<Index> part = {start};
    seen[start] = 1;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (Index h = 3 * part[i]; h < 3 * part[i] + 3; ++h) {
        const Index other = patch_.opposite(h);
        if (other == none || !inside[other / 3] || seen[other / 3]) continue;
        seen[other / 3] = 1;
        part.push_back(other / 3);
      }
    if (std::optional<Gap> one = gap(part, inside)) found.push_back(std::move(*one));
  }
  return found;
}

std::optional<Gap> GapFinder::gap(const std::vector<Index>& triangles,
                                  const std::vector<char>& inside) const {
  std::map<Index, Index> side_from;  // half-edges round the part
  for (Index t : triangles)
    for (Index h = 3 * t; h < 3 * t + 3; ++h) {
      const Index other = patch_.opposite(h);
      if (other != none && inside[other / 3]) continue;
      if (!side_from.emplace(patch_.origin(h), h).second) return std::nullopt;
    }
  if (side_from.size() < 3 || side_from.size() > most_corners) return std::nullopt;
  Gap gap;
  gap.triangles = triangles;
  Index corner = side_from.begin()->first;
  do {
    const Index h = side_from.at(corner), other = patch_.opposite(h);
    gap.corners.push_back(corner);
    if (other != none) {
      gap.normals.push_back(patch_.area_normal(other / 3).stableNormalized());
    } else {
      const auto at = rim_normals_.find(corner);
      gap.normals.push_back(at == rim_normals_.end() ? Vector3(Vector3::Zero()) : at->second);
    }
    corner = patch_.target(h);
  } while (corner != gap.corners.front());
  if (gap.corners.size() != side_from.size()) return std::nullopt;
  return gap;
}

// What closing some gaps has changed already: the triangles taken out, and those in their place.
struct Fillings {
  std::vector<char> gone;  // per triangle of the patch
  std::vector<Triangle> triangles;
  std::set<std::pair<Index, Index>> edges;  // of `triangles`, the smaller vertex first
};

std::pair<Index, Index> edge(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

// Triangulations of a gap, by dynamic programming over its corners i < j < k.
class GapFiller {
 public:
  GapFiller(const PatchMesh& patch, const Gap& gap, const Fillings& before, const ForbiddenEdges& forbidden,
            PatchSurroundings& surroundings)
      : patch_(patch),
        gap_(gap),
        surroundings_(surroundings),
        n_(gap.corners.size()),
        allowed_(n_ * n_, 1),
        state_(n_ * n_ * n_, unknown) {
    std::vector<char> out = before.gone;
    for (Index t : gap.triangles) out[t] = 1;
    surroundings.focus(gap.triangles);
    surroundings.collect(surroundings.box_of(gap.triangles), [&](Index t) { return out[t] != 0; });
    for (const Triangle& t : before.triangles)
      surroundings.add({patch.position(t[0]), patch.position(t[1]), patch.position(t[2])});
    find_allowed_edges(out, before, forbidden);
  }

  /// The triangles, corners being vertices of the patch; empty when there are none.
  std::vector<Triangle> fill(const Progress& progress);

 private:
  enum State : char { unknown, free, taken };
  struct Part {
    Cost cost;
    std::size_t apex = 0;
    bool possible = false;
    Vector3 normal = Vector3::Zero();
  };

  const Vector3& corner(std::size_t i) const { return patch_.position(gap_.corners[i]); }
  Part& part(std::size_t i, std::size_t k) { return parts_[i * n_ + k]; }
  char& state(std::size_t i, std::size_t j, std::size_t k) { return state_[(i * n_ + j) * n_ + k]; }
  void find_allowed_edges(const std::vector<char>& out, const Fillings& before,
                          const ForbiddenEdges& forbidden);
  bool is_free(std::size_t i, std::size_t j, std::size_t k);
  bool optimise(const Progress& progress);
  std::vector<std::array<std::size_t, 3>> chosen();
  static double crease(const Vector3& a, const Vector3& b) {
    const double crease = 1 - a.dot(b);
    return a.isZero() || b.isZero() || crease < slight_crease ? 0.0 : crease;
  }

  const PatchMesh& patch_;
  const Gap& gap_;
  PatchSurroundings& surroundings_;
  const std::size_t n_;
  std::vector<char> allowed_;  // per pair of corners: whether an edge may join them
  std::vector<char> state_;    // per triangle
  std::vector<Part> parts_;
};

void GapFiller::find_allowed_edges(const std::vector<char>& out, const Fillings& before,
                                   const ForbiddenEdges& forbidden) {
  std::map<Index, std::size_t> place;
  for (std::size_t i = 0; i < n_; ++i) place[gap_.corners[i]] = i;
  const auto forbid = [&](Index a, Index b) {
    const auto at_a = place.find(a), at_b = place.find(b);
    if (at_a == place.end() || at_b == place.end()) return;
    allowed_[at_a->second * n_ + at_b->second] = allowed_[at_b->second * n_ + at_a->second] = 0;
  };
  // Edges that are there already, apart from the sides of the gap.
  for (Index corner : gap_.corners)
    patch_.for_outgoing(corner, [&](Index h) {
      if (out[h / 3]) return;
      forbid(corner, patch_.target(h));
      forbid(corner, patch_.apex(h));
    });
  for (const auto& [a, b] : before.edges) forbid(a, b);
  for (const auto& [a, b] : forbidden) forbid(a, b);
  for (std::size_t i = 0; i < n_; ++i) {
    const std::size_t k = (i + 1) % n_;
    allowed_[i * n_ + k] = allowed_[k * n_ + i] = 1;
  }
}

bool GapFiller::is_free(std::size_t i, std::size_t j, std::size_t k) {
  char& known = state(i, j, k);
  if (known == unknown) {
    const Corners c = {corner(i), corner(j), corner(k)};
    known = !collinear(c[0], c[1], c[2]) && surroundings_.met_by(c, 1) == 0 ? free : taken;
  }
  return known == free;
}

bool GapFiller::optimise(const Progress& progress) {
  parts_.assign(n_ * n_, Part());
  for (std::size_t i = 0; i < n_; ++i) {
    Part& side = part(i, (i + 1) % n_);
    side.possible = true;
    side.normal = gap_.normals[i];
  }
  for (std::size_t span = 2; span < n_; ++span) {
    progress.check();
    for (std::size_t i = 0; i + span < n_; ++i) {
      const std::size_t k = i + span;
      const bool whole = i == 0 && k == n_ - 1;
      if (!allowed_[i * n_ + k]) continue;
      Part best;
      for (std::size_t j = i + 1; j < k; ++j) {
        const Part &left = part(i, j), &right = part(j, k);
        if (!left.possible || !right.possible) continue;
        const Vector3 normal = (corner(j) - corner(i)).cross(corner(k) - corner(i)).stableNormalized();
        Cost cost;
        cost.crease = std::max(
            {left.cost.crease, right.cost.crease, crease(left.normal, normal), crease(right.normal, normal)});
        if (whole) cost.crease = std::max(cost.crease, crease(gap_.normals[k], normal));
        cost.squares = left.cost.squares + right.cost.squares + (corner(j) - corner(i)).squaredNorm() +
                       (corner(k) - corner(j)).squaredNorm() + (corner(i) - corner(k)).squaredNorm();
        if ((best.possible && !(cost < best.cost)) || !is_free(i, j, k)) continue;
        best = {cost, j, true, normal};
      }
      part(i, k) = best;
    }
  }
  return part(0, n_ - 1).possible;
}

std::vector<std::array<std::size_t, 3>> GapFiller::chosen() {
  std::vector<std::array<std::size_t, 3>> triangles;
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, n_ - 1}};
  while (!open.empty()) {
    const auto [i, k] = open.back();
    open.pop_back();
    if (k == i + 1) continue;
    const std::size_t j = part(i, k).apex;
    triangles.push_back({i, j, k});
    open.emplace_back(i, j);
    open.emplace_back(j, k);
  }
  return triangles;
}

std::vector<Triangle> GapFiller::fill(const Progress& progress) {
  for (int round = 0; round < most_forbiddings; ++round) {
    if (!optimise(progress)) return {};
    const auto triangles = chosen();
    std::vector<Corners> soup;
    for (const auto& t : triangles) soup.push_back({corner(t[0]), corner(t[1]), corner(t[2])});
    const auto size = [&](Index t) {
      return (soup[t][0] - soup[t][1]).squaredNorm() + (soup[t][1] - soup[t][2]).squaredNorm() +
             (soup[t][2] - soup[t][0]).squaredNorm();
    };
    const auto pairs = improper_pairs(soup);
    if (pairs.empty()) {
      std::vector<Triangle> result;
      for (const auto& t : triangles)
        result.push_back({gap_.corners[t[0]], gap_.corners[t[1]], gap_.corners[t[2]]});
      return result;
    }
    for (const auto& [a, b] : pairs) {
      const auto& t = triangles[size(a) > size(b) ? a : b];
      state(t[0], t[1], t[2]) = taken;
    }
  }
  return {};
}

// Gives a closed gap the resolution of what is round it, by steps that meet nothing.
class GapRefiner {
 public:
  /// The gap's triangles are those from `first` to before `last`.
  GapRefiner(PatchMesh& patch, Index first, Index last, const ForbiddenEdges& forbidden,
             const std::vector<double>& wanted, PatchSurroundings& surroundings)
      : patch_(patch),
        forbidden_(forbidden),
        wanted_(wanted),
        surroundings_(surroundings),
        most_triangles_(most_pieces * (last - first)) {
    for (Index t = first; t < last; ++t) triangles_.push_back(t);
    surroundings.focus(triangles_);
  }

  void refine(const Progress& progress) {
    for (int pass = 0; pass < most_passes && split_long_edges(); ++pass) flip_edges(progress);
    for (int sweep = 0; sweep < smoothing_sweeps; ++sweep) {
      for (Index v : vertices_) smooth(v);
      flip_edges(progress);
    }
  }

 private:
  static constexpr int most_passes = 6;
  static constexpr int smoothing_sweeps = 4;
  static constexpr std::size_t most_pieces = 50;  // per triangle of the filling, on average
  static constexpr double longest = 4.0 / 3.0;    // wanted lengths, as in remeshing
  static constexpr double better = 1.01;          // rounder by this factor is worth a flip

  bool inside(Index triangle) const {
    return std::binary_search(triangles_.begin(), triangles_.end(), triangle);
  }
  bool split_long_edges();
  bool can_split(Index half_edge, const Vector3& middle);
  void flip_edges(const Progress& progress);
  bool flip(Index half_edge);
  void smooth(Index vertex);
  double wanted_length(Index vertex);

  PatchMesh& patch_;
  const ForbiddenEdges& forbidden_;
  const std::vector<double>& wanted_;
  PatchSurroundings& surroundings_;
  const std::size_t most_triangles_;
  std::vector<Index> triangles_;  // in the gap, ascending: new ones have the highest numbers
  std::vector<Index> vertices_;   // new ones
  std::map<Index, double> lengths_;
};

// Of a corner of the gap inside the patch: the mean length of the edges outside the gap.
double GapRefiner::wanted_length(Index vertex) {
  if (patch_.on_rim(vertex)) return wanted_[vertex];
  const auto known = lengths_.find(vertex);
  if (known != lengths_.end()) return known->second;
  double outside = 0, all = 0;
  int count_outside = 0, count = 0;
  patch_.for_outgoing(vertex, [&](Index h) {
    all += patch_.length(h);
    ++count;
    if (inside(h / 3)) return;
    outside += patch_.length(h);
    ++count_outside;
  });
  return lengths_[vertex] = count_outside > 0 ? outside / count_outside : all / count;
}

// Whether the four pieces of the edge's two triangles meet nothing; the middle is not quite on the edge once
// rounded.
bool GapRefiner::can_split(Index h, const Vector3& middle) {
  const Index g = patch_.opposite(h);
  const Vector3 &a = patch_.position(patch_.origin(h)), &b = patch_.position(patch_.target(h));
  const Vector3 &c = patch_.position(patch_.apex(h)), &d = patch_.position(patch_.apex(g));
  surroundings_.collect_round({h / 3, g / 3}, (middle - 0.5 * (a + b)).norm());
  const std::array<Corners, 4> pieces = {{{a, middle, c}, {middle, b, c}, {b, middle, d}, {middle, a, d}}};
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (collinear(pieces[i][0], pieces[i][1], pieces[i][2]) || surroundings_.met_by(pieces[i], 1) > 0)
      return false;
    for (std::size_t k = 0; k < i; ++k)
      if (meet_improperly(pieces[i], pieces[k])) return false;
  }
  return true;
}

bool GapRefiner::split_long_edges() {
  std::vector<std::pair<double, Index>> edges;
  for (Index t : triangles_)
    for (Index h = 3 * t; h < 3 * t + 3; ++h) {
      if (patch_.is_boundary(h) || patch_.opposite(h) < h || !inside(patch_.opposite(h) / 3)) continue;
      const double wanted = 0.5 * (wanted_length(patch_.origin(h)) + wanted_length(patch_.target(h)));
      if (patch_.length(h) > longest * wanted) edges.emplace_back(-patch_.length(h), h);
    }
  std::sort(edges.begin(), edges.end());
  bool any = false;
  for (const auto& [length, h] : edges) {
    const Index a = patch_.origin(h), b = patch_.target(h);
    // Shortened by a split before.
    if (patch_.length(h) < -length || triangles_.size() > most_triangles_) continue;
    const Vector3 middle = as_stored(0.5 * (patch_.position(a) + patch_.position(b)));
    if (!can_split(h, middle)) continue;
    const double wanted = 0.5 * (wanted_length(a) + wanted_length(b));
    const Index m = patch_.split(h, middle);
    lengths_[m] = wanted;
    vertices_.push_back(m);
    const Index count = static_cast<Index>(patch_.triangle_count());
    triangles_.push_back(count - 2);
    triangles_.push_back(count - 1);
    any = true;
  }
  return any;
}

// Of a triangle: the larger the rounder, 0 for a degenerate one.
double roundness(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double squares = (a - b).squaredNorm() + (b - c).squaredNorm() + (c - a).squaredNorm();
  return squares > 0 ? (b - a).cross(c - a).norm() / squares : 0.0;
}

// Flips when the less round triangle becomes rounder and the surface is not creased for it.
bool GapRefiner::flip(Index h) {
  if (patch_.is_boundary(h) || !inside(patch_.opposite(h) / 3) || !can_flip(patch_, h, forbidden_))
    return false;
  const Index a = patch_.origin(h), b = patch_.target(h), c = patch_.apex(h),
              d = patch_.apex(patch_.opposite(h));
  const Vector3 &pa = patch_.position(a), &pb = patch_.position(b), &pc = patch_.position(c),
                &pd = patch_.position(d);
  const double before = std::min(roundness(pa, pb, pc), roundness(pb, pa, pd));
  const double after = std::min(roundness(pc, pd, pb), roundness(pd, pc, pa));
  if (!(after > better * before)) return false;
  const Vector3 n1 = (pd - pc).cross(pb - pc), n2 = (pc - pd).cross(pa - pd);
  if (n1.dot(n2) < (1 - slight_crease) * n1.norm() * n2.norm()) return false;
  const std::vector<Index> star = {h / 3, patch_.opposite(h) / 3};
  surroundings_.collect_round(star, 0.0);
  patch_.flip(h);
  if (surroundings_.met_by_star(star, 1) == 0) return true;
  patch_.flip(3 * (h / 3));  // the diagonal is the first half-edge of both triangles now
  return false;
}

void GapRefiner::flip_edges(const Progress& progress) {
  constexpr int most_rounds = 5;
  for (int round = 0; round < most_rounds; ++round) {
    progress.check();
    bool any = false;
    for (Index t : triangles_)
      for (Index h = 3 * t; h < 3 * t + 3; ++h) any |= flip(h);
    if (!any) break;
  }
}

// Towards the mean of its neighbours, as far as the star stays clean.
void GapRefiner::smooth(Index vertex) {
  Vector3 sum = Vector3::Zero();
  double count = 0;
  patch_.for_neighbours(vertex, [&](Index v) {
    sum += patch_.position(v);
    ++count;
  });
  const Vector3 start = patch_.position(vertex), goal = sum / count;
  std::vector<Index> star;
  patch_.for_outgoing(vertex, [&](Index h) { star.push_back(h / 3); });
  surroundings_.collect_round(star, (goal - start).norm());
  for (double step : {1.0, 0.5, 0.25}) {
    patch_.move(vertex, as_stored(start + step * (goal - start)));
    if (surroundings_.met_by_star(star, 1) == 0) return;
  }
  patch_.move(vertex, start);
}

}  // namespace

std::size_t retriangulate(PatchMesh& patch, const std::vector<Index>& tangled, const Rim& rim,
                          const std::vector<double>& wanted, const InputNeighbourhood& input,
                          const std::vector<Corners>& obstacles, int rings, const Progress& progress) {
  for (Index v = static_cast<Index>(patch.rim_size()); v < patch.vertex_count(); ++v)
    patch.move(v, as_stored(patch.position(v)));
  PatchSurroundings surroundings(patch, input, obstacles);
  Fillings fillings;
  fillings.gone.assign(patch.triangle_count(), 0);
  std::vector<Index> gap_ends;  // in the list of new triangles
  for (const Gap& gap : GapFinder(patch, rim).gaps(tangled, rings)) {
    const std::vector<Triangle> filling =
        GapFiller(patch, gap, fillings, rim.forbidden, surroundings).fill(progress);
    if (filling.empty()) continue;
    for (Index t : gap.triangles) fillings.gone[t] = 1;
    for (const Triangle& t : filling) {
      fillings.triangles.push_back(t);
      for (int k = 0; k < 3; ++k) fillings.edges.insert(edge(t[k], t[(k + 1) % 3]));
    }
    gap_ends.push_back(static_cast<Index>(fillings.triangles.size()));
  }
  if (gap_ends.empty()) return 0;
  std::vector<Triangle> triangles = std::move(fillings.triangles);
  for (Index t = 0; t < patch.triangle_count(); ++t)
    if (patch.alive(t) && !fillings.gone[t]) triangles.push_back(patch.triangles()[t]);
  patch = PatchMesh(patch.positions(), patch.rim_size(), std::move(triangles));
  patch.compact();
  Index first = 0;
  for (Index last : gap_ends) {
    GapRefiner(patch, first, last, rim.forbidden, wanted, surroundings).refine(progress);
    first = last;
  }
  return gap_ends.size();
}

}  // namespace meshcomplete
