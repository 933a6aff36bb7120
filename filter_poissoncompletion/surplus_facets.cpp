#include "filter_poissoncompletion/surplus_facets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/core/pair_key.h"

namespace meshcomplete {
namespace {

constexpr Index none = SheetVertex::none;

// A facet goes when so many of its sides have a wrong number of facets: then fewer have afterwards.
constexpr int enough_sides = 2;

class Dropper {
 public:
  Dropper(SeparatingSurface& surface, const TriangleMesh& mesh, const MeshTopology& topology)
      : surface_(surface), mesh_(mesh), gone_(surface.triangles.size(), 0) {
    boundary_.reserve(topology.boundary_half_edges.size());
    for (Index h : topology.boundary_half_edges) boundary_.emplace(pair_key(end(h, 0), end(h, 1)), h);
    list_facets();
  }

  std::size_t run();

 private:
  // More wrong sides first, then the smaller angle, then the lower number.
  using Entry = std::tuple<int, double, Index>;

  Index end(Index half_edge, Index k) const {
    return mesh_.triangles[half_edge / 3][(half_edge % 3 + k) % 3];
  }
  std::uint64_t side(Index t, int k) const {
    return pair_key(surface_.triangles[t][k], surface_.triangles[t][(k + 1) % 3]);
  }
  void list_facets();
  Index rim_at(Index a, Index b) const;
  bool is_wrong(Index t, int k) const;
  Entry entry(Index t) const;
  double angle_to_mesh(Index t, int k, Index half_edge) const;

  SeparatingSurface& surface_;
  const TriangleMesh& mesh_;
  std::vector<char> gone_;
  std::unordered_map<std::uint64_t, Index> boundary_;  // half-edges of the mesh
  std::vector<Index> edge_;                            // of each side of each facet
  std::vector<Index> first_;                           // of each edge, in `facets_`
  std::vector<Index> left_;                            // how many facets an edge has left
  std::vector<Index> facets_;                          // by edge, those that are left first
};

// By sides sorted along their edges: much faster than a table of lists.
void Dropper::list_facets() {
  std::vector<std::pair<std::uint64_t, Index>> sides(3 * surface_.triangles.size());
  for (Index i = 0; i < sides.size(); ++i) sides[i] = {side(i / 3, static_cast<int>(i % 3)), i};
  std::sort(sides.begin(), sides.end());
  edge_.resize(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i == 0 || sides[i].first != sides[i - 1].first) {
      first_.push_back(static_cast<Index>(i));
      left_.push_back(0);
    }
    edge_[sides[i].second] = static_cast<Index>(left_.size() - 1);
    ++left_.back();
    facets_.push_back(sides[i].second / 3);
  }
}

// The boundary half-edge of the mesh on which a side lies.
Index Dropper::rim_at(Index a, Index b) const {
  const SheetVertex &p = surface_.vertices[a], &q = surface_.vertices[b];
  if (p.input != none && q.input != none) {
    const auto found = boundary_.find(pair_key(p.input, q.input));
    return found == boundary_.end() ? none : found->second;
  }
  const Index h = p.rim_edge != none ? p.rim_edge : q.rim_edge;
  if (h == none) return none;
  const auto on = [&](const SheetVertex& v) {
    return v.rim_edge == h || (v.input != none && (v.input == end(h, 0) || v.input == end(h, 1)));
  };
  return on(p) && on(q) ? h : none;
}

bool Dropper::is_wrong(Index t, int k) const {
  const Index rim = rim_at(surface_.triangles[t][k], surface_.triangles[t][(k + 1) % 3]);
  return left_[edge_[3 * t + static_cast<Index>(k)]] % 2 != (rim == none ? 0 : 1);
}

double Dropper::angle_to_mesh(Index t, int k, Index half_edge) const {
  const Vector3 &a = mesh_.vertices[end(half_edge, 0)], &b = mesh_.vertices[end(half_edge, 1)];
  const Vector3 along = (b - a).normalized();
  const auto across = [&](const Vector3& apex) -> Vector3 {
    return (apex - a) - along.dot(apex - a) * along;
  };
  const Vector3 own = across(mesh_.vertices[end(half_edge, 2)]),
                other = across(surface_.vertices[surface_.triangles[t][(k + 2) % 3]].position);
  return std::atan2(own.cross(other).norm(), own.dot(other));
}

Dropper::Entry Dropper::entry(Index t) const {
  int wrong = 0;
  double angle = 4;  // above every angle: no wrong side on a rim
  for (int k = 0; k < 3; ++k) {
    if (!is_wrong(t, k)) continue;
    ++wrong;
    const Index rim = rim_at(surface_.triangles[t][k], surface_.triangles[t][(k + 1) % 3]);
    if (rim != none) angle = std::min(angle, angle_to_mesh(t, k, rim));
  }
  return {-wrong, angle, t};
}

std::size_t Dropper::run() {
  std::set<Entry> queue;
  std::vector<Entry> entry_of(surface_.triangles.size());
  for (Index t = 0; t < entry_of.size(); ++t) {
    entry_of[t] = entry(t);
    if (-std::get<0>(entry_of[t]) >= enough_sides) queue.insert(entry_of[t]);
  }
  std::size_t dropped = 0;
  while (!queue.empty()) {
    const Index worst = std::get<2>(*queue.begin());
    queue.erase(queue.begin());
    gone_[worst] = 1;
    ++dropped;
    std::vector<Index> touched;
    for (int k = 0; k < 3; ++k) {
      const Index edge = edge_[3 * worst + static_cast<Index>(k)];
      const auto there = facets_.begin() + first_[edge], end = there + left_[edge];
      const auto place = std::find(there, end, worst);
      std::copy(place + 1, end, place);
      --left_[edge];
      touched.insert(touched.end(), there, end - 1);
    }
    for (Index t : touched) {
      queue.erase(entry_of[t]);
      entry_of[t] = entry(t);
      if (-std::get<0>(entry_of[t]) >= enough_sides) queue.insert(entry_of[t]);
    }
  }
  std::vector<Triangle> left;
  for (Index t = 0; t < gone_.size(); ++t)
    if (!gone_[t]) left.push_back(surface_.triangles[t]);
  surface_.triangles = std::move(left);
  return dropped;
}

}  // namespace

std::size_t drop_surplus_facets(SeparatingSurface& surface, const TriangleMesh& mesh,
                                const MeshTopology& topology) {
  return Dropper(surface, mesh, topology).run();
}

}  // namespace meshcomplete
