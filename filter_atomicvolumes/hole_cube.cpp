#include "filter_atomicvolumes/hole_cube.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

class SurfaceBuilder {
 public:
  explicit SurfaceBuilder(const std::vector<CubeSquare>& squares) : squares_(squares) {}

  HoleCubeSurface build() {
    collect();
    connect();
    label_at_segments();
    flood_stars();
    return std::move(surface_);
  }

 private:
  void collect();
  void connect();
  void label_at_segments();
  void flood_stars();
  void label(Index base, Side side) {
    Side& known = surface_.sides[base];
    if (known == Side::free) {
      known = side;
      flood_.push_back(base);
    } else if (known != side) {
      surface_.contradicting = true;
    }
  }
  bool inner(Index vertex) const { return std::binary_search(inner_.begin(), inner_.end(), vertex); }

  const std::vector<CubeSquare>& squares_;
  HoleCubeSurface surface_;
  std::vector<std::pair<Index, Index>> segments_;  // outside the cube looking in, the front is on the left
  std::vector<Index> inner_;                       // vertices where the mesh goes on to both sides
  std::vector<Index> flood_;
};

void SurfaceBuilder::collect() {
  std::vector<Index> ends;
  for (const CubeSquare& s : squares_) {
    const auto& vertex = *s.vertex;
    for (Index t = 0; t < s.triangulation->triangles.size(); ++t) {
      auto [a, b, c] = s.triangulation->triangles[t];
      if (!s.outward_is_up) std::swap(b, c);
      surface_.bases.push_back({{vertex[a], vertex[b], vertex[c]}, s.square, t});
    }
    for (const SquareTriangulation::Segment& segment : s.triangulation->segments) {
      std::pair<Index, Index> directed(vertex[segment.from], vertex[segment.to]);
      if (!s.outward_is_up) std::swap(directed.first, directed.second);
      segments_.push_back(directed);
      ends.push_back(directed.first);
      ends.push_back(directed.second);
    }
  }
  surface_.sides.assign(surface_.bases.size(), Side::free);
  std::sort(segments_.begin(), segments_.end());
  std::sort(ends.begin(), ends.end());
  for (std::size_t i = 0, past; i < ends.size(); i = past) {
    for (past = i; past < ends.size() && ends[past] == ends[i]; ++past) {
    }
    (past - i > 1 ? inner_ : surface_.rim_ends).push_back(ends[i]);
  }
}

void SurfaceBuilder::connect() {
  struct HalfEdge {
    Index from, to, number;
    bool operator<(const HalfEdge& o) const { return std::tie(from, to) < std::tie(o.from, o.to); }
  };
  std::vector<HalfEdge> sorted;
  for (Index b = 0; b < surface_.bases.size(); ++b)
    for (Index k = 0; k < 3; ++k)
      sorted.push_back({surface_.bases[b].corners[k], surface_.bases[b].corners[(k + 1) % 3], 3 * b + k});
  std::sort(sorted.begin(), sorted.end());
  surface_.across.resize(sorted.size());
  surface_.walled.assign(sorted.size(), 0);
  for (const HalfEdge& h : sorted) {
    const auto opposite = std::lower_bound(sorted.begin(), sorted.end(), HalfEdge{h.to, h.from, 0});
    if (opposite == sorted.end() || opposite->from != h.to || opposite->to != h.from)
      throw CompletionError("dividing space",
                            "The surface of a cube is not closed; this is a defect of the program.");
    surface_.across[h.number] = opposite->number / 3;
    surface_.walled[h.number] =
        std::binary_search(segments_.begin(), segments_.end(), std::make_pair(h.from, h.to)) ||
        std::binary_search(segments_.begin(), segments_.end(), std::make_pair(h.to, h.from));
  }
}

void SurfaceBuilder::label_at_segments() {
  for (Index h = 0; h < surface_.walled.size(); ++h) {
    if (!surface_.walled[h]) continue;
    const auto& corners = surface_.bases[h / 3].corners;
    const std::pair<Index, Index> directed(corners[h % 3], corners[(h % 3 + 1) % 3]);
    const bool on_left = std::binary_search(segments_.begin(), segments_.end(), directed);
    label(h / 3, on_left ? Side::outside : Side::inside);
  }
}

// Round a vertex where the mesh goes on to both sides, what lies between its two segments is all on one side.
void SurfaceBuilder::flood_stars() {
  while (!flood_.empty()) {
    const Index base = flood_.back();
    flood_.pop_back();
    for (Index k = 0; k < 3; ++k) {
      const Index h = 3 * base + k;
      const auto& corners = surface_.bases[base].corners;
      if (surface_.walled[h] || !(inner(corners[k]) || inner(corners[(k + 1) % 3]))) continue;
      label(surface_.across[h], surface_.sides[base]);
    }
  }
}

}  // namespace

HoleCubeSurface hole_cube_surface(const std::vector<CubeSquare>& squares) {
  return SurfaceBuilder(squares).build();
}

}  // namespace meshcomplete
