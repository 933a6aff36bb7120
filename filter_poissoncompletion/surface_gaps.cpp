#include "filter_poissoncompletion/surface_gaps.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "common/core/pair_key.h"

namespace meshcomplete {
namespace {

constexpr Index none = SheetVertex::none;

// Gaps with more edges are missing surface: on real scans none of more than nine was seen.
constexpr std::size_t most_edges = 24;

constexpr int lowest = std::numeric_limits<int>::min();
constexpr double infinity = std::numeric_limits<double>::infinity();

class GapCloser {
 public:
  GapCloser(SeparatingSurface& surface, const TriangleMesh& mesh) : surface_(surface), mesh_(mesh) {
    for (Index v = 0; v < surface.vertices.size(); ++v)
      if (surface.vertices[v].input != none) vertex_of_.emplace(surface.vertices[v].input, v);
  }

  SurfaceGapFigures run(const std::vector<Index>& rim_half_edges);

 private:
  using Loop = std::vector<Index>;

  Index vertex_of(Index input);
  void count(Index from, Index to) { balance_.emplace_back(pair_key(from, to), from < to ? 1 : -1); }
  void sum_up();
  void count_rims(const std::vector<Index>& rim_half_edges);
  std::vector<Loop> loops() const;
  void find_mesh_edges(const std::vector<Loop>& loops);
  bool has_edge(Index a, Index b) const;
  double squared(Index a, Index b) const {
    return (surface_.vertices[a].position - surface_.vertices[b].position).squaredNorm();
  }
  bool close(const Loop& loop);

  SeparatingSurface& surface_;
  const TriangleMesh& mesh_;
  std::unordered_map<Index, Index> vertex_of_;  // by the mesh's vertex
  // Edges, ascending once they are summed up: facets that walk one upwards, minus the others.
  std::vector<std::pair<std::uint64_t, int>> balance_;
  std::unordered_set<std::uint64_t> new_edges_;   // of the facets that close gaps
  std::unordered_set<std::uint64_t> mesh_edges_;  // between the mesh's vertices at gaps
};

Index GapCloser::vertex_of(Index input) {
  const auto [it, fresh] = vertex_of_.emplace(input, static_cast<Index>(surface_.vertices.size()));
  if (fresh) surface_.vertices.push_back({mesh_.vertices[input], input, none, false});
  return it->second;
}

// The mesh's faces at the rims, in the pieces into which Steiner points divide their edges.
void GapCloser::count_rims(const std::vector<Index>& rim_half_edges) {
  std::unordered_map<Index, std::vector<Index>> between;
  for (Index v = 0; v < surface_.vertices.size(); ++v)
    if (surface_.vertices[v].rim_edge != none) between[surface_.vertices[v].rim_edge].push_back(v);
  for (Index h : rim_half_edges) {
    const Triangle& t = mesh_.triangles[h / 3];
    Loop chain = {vertex_of(t[h % 3])};
    const auto found = between.find(h);
    if (found != between.end()) {
      std::vector<Index>& points = found->second;
      std::sort(points.begin(), points.end(),
                [&](Index a, Index b) { return squared(chain[0], a) < squared(chain[0], b); });
      chain.insert(chain.end(), points.begin(), points.end());
    }
    chain.push_back(vertex_of(t[(h % 3 + 1) % 3]));
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) count(chain[i], chain[i + 1]);
  }
}

// One entry for each edge, also where facets on both sides cancel out.
void GapCloser::sum_up() {
  std::sort(balance_.begin(), balance_.end());
  std::size_t last = 0;
  for (std::size_t i = 1; i < balance_.size(); ++i)
    if (balance_[i].first == balance_[last].first)
      balance_[last].second += balance_[i].second;
    else
      balance_[++last] = balance_[i];
  if (!balance_.empty()) balance_.resize(last + 1);
}

// Simple loops of the edges that lack facets, in the sense in which these have to walk them.
std::vector<GapCloser::Loop> GapCloser::loops() const {
  std::map<Index, std::vector<Index>> leaving;
  for (const auto& [key, balance] : balance_) {
    const Index low = static_cast<Index>(key >> 32), high = static_cast<Index>(key);
    for (int i = 0; i < std::abs(balance); ++i)
      balance > 0 ? leaving[high].push_back(low) : leaving[low].push_back(high);
  }
  std::vector<Loop> result;
  for (auto& [start, targets] : leaving) {
    Loop path = {start};
    std::unordered_map<Index, std::size_t> place = {{start, 0}};
    while (!path.empty()) {
      std::vector<Index>& next = leaving[path.back()];
      if (next.empty()) break;  // only at the start, when all its edges are used
      const Index v = next.back();
      next.pop_back();
      const auto [it, fresh] = place.emplace(v, path.size());
      path.push_back(v);
      if (fresh) continue;
      result.emplace_back(path.begin() + static_cast<std::ptrdiff_t>(it->second), path.end() - 1);
      for (std::size_t i = it->second + 1; i + 1 < path.size(); ++i) place.erase(path[i]);
      path.resize(it->second + 1);
    }
  }
  return result;
}

void GapCloser::find_mesh_edges(const std::vector<Loop>& loops) {
  std::vector<char> concerned(mesh_.vertices.size(), 0);
  for (const Loop& loop : loops)
    for (Index v : loop)
      if (surface_.vertices[v].input != none) concerned[surface_.vertices[v].input] = 1;
  for (const Triangle& t : mesh_.triangles)
    for (int k = 0; k < 3; ++k)
      if (concerned[t[k]] && concerned[t[(k + 1) % 3]]) mesh_edges_.insert(pair_key(t[k], t[(k + 1) % 3]));
}

bool GapCloser::has_edge(Index a, Index b) const {
  const Index p = surface_.vertices[a].input, q = surface_.vertices[b].input;
  const auto at = std::lower_bound(balance_.begin(), balance_.end(), std::make_pair(pair_key(a, b), lowest));
  return (at != balance_.end() && at->first == pair_key(a, b)) || new_edges_.count(pair_key(a, b)) ||
         (p != none && q != none && mesh_edges_.count(pair_key(p, q)));
}

// Dynamic programming over the parts of the loop from corner i to corner j.
bool GapCloser::close(const Loop& loop) {
  const std::size_t n = loop.size();
  if (n < 3 || n > most_edges) return false;
  std::vector<double> cost(n * n, 0);
  std::vector<std::size_t> apex(n * n, 0);
  for (std::size_t length = 2; length < n; ++length)
    for (std::size_t i = 0; i + length < n; ++i) {
      const std::size_t j = i + length;
      double& best = cost[i * n + j];
      best = infinity;
      const bool side = i == 0 && j == n - 1;
      if (!side && has_edge(loop[i], loop[j])) continue;
      const double own = squared(loop[i], loop[j]);
      for (std::size_t k = i + 1; k < j; ++k) {
        const double sum =
            cost[i * n + k] + cost[k * n + j] + own + squared(loop[i], loop[k]) + squared(loop[k], loop[j]);
        if (sum < best) {
          best = sum;
          apex[i * n + j] = k;
        }
      }
    }
  if (cost[n - 1] == infinity) return false;
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, n - 1}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j - i < 2) continue;
    const std::size_t k = apex[i * n + j];
    surface_.triangles.push_back({loop[i], loop[k], loop[j]});
    for (const auto& [a, b] : {std::make_pair(i, k), std::make_pair(k, j), std::make_pair(i, j)})
      new_edges_.insert(pair_key(loop[a], loop[b]));
    open.emplace_back(i, k);
    open.emplace_back(k, j);
  }
  return true;
}

SurfaceGapFigures GapCloser::run(const std::vector<Index>& rim_half_edges) {
  for (const Triangle& t : surface_.triangles)
    for (int k = 0; k < 3; ++k) count(t[k], t[(k + 1) % 3]);
  count_rims(rim_half_edges);
  sum_up();
  SurfaceGapFigures figures;
  const std::vector<Loop> gaps = loops();
  if (gaps.empty()) return figures;
  find_mesh_edges(gaps);
  for (const Loop& gap : gaps) {
    ++(close(gap) ? figures.closed : figures.left);
    figures.largest = std::max(figures.largest, gap.size());
  }
  return figures;
}

}  // namespace

SurfaceGapFigures close_gaps(SeparatingSurface& surface, const TriangleMesh& mesh,
                             const std::vector<Index>& rim_half_edges) {
  return GapCloser(surface, mesh).run(rim_half_edges);
}

}  // namespace meshcomplete
