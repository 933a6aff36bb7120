#include "common/core/rim_strip.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_set>
#include <utility>

#include "common/core/pair_key.h"
#include "common/core/patch_geodesic.h"
#include "common/core/patch_graph.h"

namespace meshcomplete {
namespace {

// Up to how many edges an end of a stretch is moved along its rim.
constexpr std::size_t most_moved = 16;

// How much longer a path has to be for that, in parts of the way along the rim.
constexpr double moving_price = 4;

// How much longer a path from one stretch to another may be than one from its end to its own beginning.
constexpr double bay_price = 8;

// The triangles that a geodesic is looked for in: as far as so many times the length of a path along edges.
constexpr double around_path = 1.3;

// A vertex of a rim where a path may begin or end.
struct End {
  Index vertex = 0;
  double price = 0;
  std::ptrdiff_t moved = 0;  // edges along the loop from where the stretch has its own end
};

double distance(const Vector3& p, const std::vector<Vector3>& way) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    const Vector3 along = way[i + 1] - way[i];
    const double length = along.squaredNorm();
    const double t = length > 0 ? std::clamp((p - way[i]).dot(along) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, (p - way[i] - t * along).norm());
  }
  return least;
}

// Which start each end is to be joined to so that all paths together are as short as can be. Joined to
// itself a stretch is closed as a bay; with two that face each other a strip across is meant.
std::vector<std::size_t> shortest_pairs(const std::vector<std::vector<double>>& lengths) {
  std::vector<std::size_t> order(lengths.size()), best;
  std::iota(order.begin(), order.end(), std::size_t(0));
  double least = PatchPaths::unreached;
  do {
    double total = 0;
    for (std::size_t i = 0; i < order.size(); ++i)
      total += (order[i] == i && order.size() > 1 ? bay_price : 1) * lengths[i][order[i]];
    if (total >= least) continue;
    least = total;
    best = order;
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

class StripCutter {
 public:
  StripCutter(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops,
              const std::vector<std::size_t>& rims, const std::vector<RimStretch>& stretches,
              const Patch& patch);

  Strip run(const Progress& progress);

 private:
  std::size_t size(std::size_t loop) const { return loops_[loop].vertices.size(); }
  Index vertex(std::size_t loop, std::size_t position) const {
    return loops_[loop].vertices[position % size(loop)];
  }
  bool is_whole(const RimStretch& stretch) const { return stretch.edges == size(stretch.loop); }
  std::size_t open_edges_beside(const RimStretch& stretch, bool after) const;
  std::vector<End> ends_of(const RimStretch& stretch, bool last) const;
  PatchPaths paths_from(const std::vector<End>& ends, const Progress& progress) const;
  static const End* nearest(const PatchPaths& paths, const std::vector<End>& ends, double& length);
  std::vector<Index> path(Index from, Index to, const PatchPaths& roughly, const Progress& progress) const;
  bool join_ends(const Progress& progress);
  void flood();
  bool reached(std::size_t loop, std::size_t edge) const {
    return inside_[graph_.face(vertex(loop, edge), vertex(loop, edge + 1))] != 0;
  }
  bool separated() const;
  Strip result() const;

  const TriangleMesh& mesh_;
  const std::vector<BoundaryLoop>& loops_;
  const std::vector<std::size_t>& rims_;
  const Patch& patch_;
  const PatchGraph graph_;
  std::vector<RimStretch> whole_, open_;
  std::unordered_set<Index> used_;         // vertices of paths
  std::unordered_set<std::uint64_t> cut_;  // edges of paths
  std::vector<char> inside_;
};

StripCutter::StripCutter(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops,
                         const std::vector<std::size_t>& rims, const std::vector<RimStretch>& stretches,
                         const Patch& patch)
    : mesh_(mesh), loops_(loops), rims_(rims), patch_(patch), graph_(mesh, patch) {
  for (const RimStretch& stretch : stretches)
    if (std::count(rims_.begin(), rims_.end(), stretch.loop))
      (is_whole(stretch) ? whole_ : open_).push_back(stretch);
}

// How many edges lie between a stretch and the next or the previous one of its loop.
std::size_t StripCutter::open_edges_beside(const RimStretch& stretch, bool after) const {
  const std::size_t count = size(stretch.loop);
  std::size_t least = count - stretch.edges;
  for (const RimStretch& other : open_) {
    if (other.loop != stretch.loop || other.first == stretch.first) continue;
    const RimStretch& before = after ? stretch : other;
    const RimStretch& behind = after ? other : stretch;
    least = std::min(least, (behind.first + 2 * count - before.first - before.edges) % count);
  }
  return least;
}

// At least one edge remains of the stretch, and of what is open beside it.
std::vector<End> StripCutter::ends_of(const RimStretch& stretch, bool last) const {
  const std::size_t count = size(stretch.loop);
  const std::size_t own = stretch.first + (last ? stretch.edges : 0);
  const auto step = [&](std::size_t k, bool outward) { return own + (last == outward ? k : count - k); };
  std::vector<End> ends = {{vertex(stretch.loop, own), 0, 0}};
  for (const bool outward : {false, true}) {
    const std::size_t room = outward ? open_edges_beside(stretch, last) : stretch.edges;
    double price = 0;
    for (std::size_t k = 1; k <= std::min(most_moved, (room - 1) / 2); ++k) {
      const Index next = vertex(stretch.loop, step(k, outward));
      price += moving_price * graph_.length(vertex(stretch.loop, step(k - 1, outward)), next);
      ends.push_back({next, price, (last == outward ? 1 : -1) * static_cast<std::ptrdiff_t>(k)});
    }
  }
  return ends;
}

PatchPaths StripCutter::paths_from(const std::vector<End>& ends, const Progress& progress) const {
  std::vector<std::pair<Index, double>> starts;
  for (const End& end : ends) starts.emplace_back(end.vertex, end.price);
  return graph_.paths_from(
      starts, [this](Index a, Index b) { return graph_.length(a, b); }, used_, progress);
}

const End* StripCutter::nearest(const PatchPaths& paths, const std::vector<End>& ends, double& length) {
  const End* best = nullptr;
  length = PatchPaths::unreached;
  for (const End& end : ends)
    if (paths.to(end.vertex) + end.price < length) {
      length = paths.to(end.vertex) + end.price;
      best = &end;
    }
  return best;
}

// Along the geodesic: of the many paths that are nearly as short some go far to one side.
std::vector<Index> StripCutter::path(Index from, Index to, const PatchPaths& roughly,
                                     const Progress& progress) const {
  const double far = around_path * roughly.to(to);
  std::vector<Index> around;
  for (Index t = 0; t < patch_.triangles.size(); ++t) {
    const Triangle& corners = patch_.triangles[t];
    if (std::any_of(corners.begin(), corners.end(), [&](Index v) { return roughly.to(v) <= far; }))
      around.push_back(t);
  }
  const std::vector<Vector3> way = geodesic(mesh_, patch_, around, from, to);
  const auto price = [&](Index a, Index b) {
    const double length = graph_.length(a, b);
    const double beside = way.empty() ? 0 : distance((graph_.position(a) + graph_.position(b)) / 2, way);
    return length + beside;
  };
  return graph_.paths_from({{from, 0.0}}, price, used_, progress).back_from(to);
}

// One after the other: no two paths share a vertex.
bool StripCutter::join_ends(const Progress& progress) {
  std::vector<std::vector<End>> firsts, lasts;
  for (const RimStretch& stretch : open_) {
    firsts.push_back(ends_of(stretch, false));
    lasts.push_back(ends_of(stretch, true));
  }
  std::vector<std::vector<double>> lengths;
  for (const std::vector<End>& last : lasts) {
    progress.update(static_cast<double>(lengths.size()) / static_cast<double>(2 * lasts.size()));
    const PatchPaths paths = paths_from(last, progress);
    std::vector<double>& to = lengths.emplace_back(firsts.size());
    for (std::size_t j = 0; j < firsts.size(); ++j) nearest(paths, firsts[j], to[j]);
  }
  const std::vector<std::size_t> pairs = shortest_pairs(lengths);
  if (pairs.size() < open_.size()) return false;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const PatchPaths paths = paths_from(lasts[i], progress);
    double length = 0;
    const End* first = nearest(paths, firsts[pairs[i]], length);
    if (first == nullptr) return false;
    const Index start = paths.back_from(first->vertex).back();
    const std::vector<Index> vertices = path(start, first->vertex, paths, progress);
    used_.insert(vertices.begin(), vertices.end());
    for (std::size_t k = 0; k + 1 < vertices.size(); ++k) cut_.insert(pair_key(vertices[k], vertices[k + 1]));
    const auto last =
        std::find_if(lasts[i].begin(), lasts[i].end(), [&](const End& end) { return end.vertex == start; });
    RimStretch &ending = open_[i], &beginning = open_[pairs[i]];
    ending.edges += static_cast<std::size_t>(last->moved);
    const std::size_t count = size(beginning.loop);
    beginning.first = (beginning.first + count + static_cast<std::size_t>(first->moved)) % count;
    beginning.edges -= static_cast<std::size_t>(first->moved);
  }
  return true;
}

void StripCutter::flood() {
  inside_.assign(patch_.triangles.size(), 0);
  std::vector<Index> open;
  const auto take = [&](Index triangle) {
    if (triangle == inside_.size() || inside_[triangle]) return;
    inside_[triangle] = 1;
    open.push_back(triangle);
  };
  for (const std::vector<RimStretch>* stretches : {&whole_, &open_})
    for (const RimStretch& s : *stretches)
      for (std::size_t k = s.first; k < s.first + s.edges; ++k)
        take(graph_.face(vertex(s.loop, k), vertex(s.loop, k + 1)));
  while (!open.empty()) {
    const Index triangle = open.back();
    open.pop_back();
    const Triangle& t = patch_.triangles[triangle];
    for (int k = 0; k < 3; ++k)
      if (!cut_.count(pair_key(t[k], t[(k + 1) % 3]))) take(graph_.beyond(triangle, k));
  }
}

// Whether of the loops with an open stretch nothing but the stretches was reached.
bool StripCutter::separated() const {
  for (std::size_t loop : rims_) {
    std::size_t selected = 0, met = 0;
    for (const RimStretch& stretch : open_) selected += stretch.loop == loop ? stretch.edges : 0;
    for (std::size_t k = 0; k < size(loop); ++k) met += reached(loop, k);
    if (selected > 0 && met != selected) return false;
  }
  return true;
}

Strip StripCutter::result() const {
  Strip strip;
  strip.patch.input_vertices = patch_.input_vertices;
  std::vector<Index> number(patch_.vertices.size(), std::numeric_limits<Index>::max());
  for (Index t = 0; t < inside_.size(); ++t) {
    if (!inside_[t]) continue;
    Triangle corners = patch_.triangles[t];
    for (Index& v : corners) {
      if (v < patch_.input_vertices) continue;
      Index& own = number[v - patch_.input_vertices];
      if (own == std::numeric_limits<Index>::max()) {
        own = patch_.input_vertices + static_cast<Index>(strip.patch.vertices.size());
        strip.patch.vertices.push_back(patch_.vertices[v - patch_.input_vertices]);
      }
      v = own;
    }
    strip.patch.triangles.push_back(corners);
  }
  for (std::size_t loop : rims_)
    for (std::size_t k = 0; k < size(loop); ++k, ++strip.of) strip.edges += reached(loop, k);
  return strip;
}

Strip StripCutter::run(const Progress& progress) {
  Strip strip;
  if (open_.size() > most_stretches) {
    strip.reason = "the selection has " + std::to_string(open_.size()) +
                   " stretches on the rims of this hole; select at most " + std::to_string(most_stretches);
    return strip;
  }
  if (!join_ends(progress)) {
    strip.reason =
        "no path over the new surface joins the ends of the selected stretches of the rim without touching "
        "it";
    return strip;
  }
  flood();
  if (separated()) return result();
  strip.reason =
      "the paths between the ends of the selected stretches of the rim do not separate a part of the new "
      "surface from the rest; select more of the rim, or on both sides of the hole";
  return strip;
}

}  // namespace

Strip cut_strip(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops,
                const std::vector<std::size_t>& rims, const std::vector<RimStretch>& stretches,
                const Patch& patch, const Progress& progress) {
  return StripCutter(mesh, loops, rims, stretches, patch).run(progress);
}

}  // namespace meshcomplete
