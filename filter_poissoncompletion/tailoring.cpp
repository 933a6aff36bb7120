#include "filter_poissoncompletion/tailoring.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <unordered_map>

#include "common/core/graph_cut.h"

namespace meshcomplete {
namespace {

constexpr Index none = DelaunayComplex::none;

// The price of having a cell on the other side than the function has it on, in parts of its surface: below 1,
// or no cell would ever change sides; above 1/3, or a cell with one facet of four on the right side would
// have been better off with its neighbours although the surface goes through it.
const double unlikeness = std::getenv("UNLIKE") ? std::atof(std::getenv("UNLIKE")) : 0.5;

// The sum of all prices in the graph's units: far from its limit, and fine enough for every facet.
constexpr double total_price = 1e12;

enum class Place : char { elsewhere, ring, rim, on_rim_edge, fresh };

enum Side : char { free = 0, inside = 1, outside = 2, both = 3 };

class Tailor {
 public:
  Tailor(const TailoringInput& input, TailoringFigures& figures)
      : in_(input), complex_(input.complex), figures_(figures) {}

  SeparatingSurface run(const Progress& progress);

 private:
  void place_vertices();
  void index_ring_faces();
  void match_facets();
  Index face_at(const Triangle& facet) const;
  Index face_with_steiner_points(const Triangle& facet) const;
  void match(Index cell, int k, Index face);
  void flood_stars();
  bool flood(Index vertex, const std::vector<Index>& star);
  void cut(const Progress& progress);
  double area(Index cell, int k) const;
  bool is_input(Index cell, int k) const {
    return matched_.count(4 * std::uint64_t{cell} + static_cast<std::uint64_t>(k)) != 0;
  }
  SeparatingSurface extract() const;

  const TailoringInput& in_;
  const DelaunayComplex& complex_;
  TailoringFigures& figures_;
  std::vector<Place> place_;
  std::vector<Index> input_of_;                                  // the mesh's vertex
  std::unordered_map<std::uint64_t, std::vector<Index>> faces_;  // ring faces by two of their corners
  std::unordered_map<std::uint64_t, Index> matched_;  // facets (4 * cell + k) that are parts of ring faces
  std::vector<char> side_;                            // that the ring has a cell on
  std::vector<char> label_;                           // inside
};

std::uint64_t pair_key(Index a, Index b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
}

void Tailor::place_vertices() {
  place_.assign(complex_.vertices.size(), Place::elsewhere);
  input_of_.assign(complex_.vertices.size(), none);
  std::vector<char> on_rim(in_.mesh.vertices.size(), 0), on_ring(in_.mesh.vertices.size(), 0);
  for (Index face : in_.ring_faces)
    for (Index v : in_.mesh.triangles[face]) on_ring[v] = 1;
  for (Index h : in_.half_edges) {
    const Triangle& t = in_.mesh.triangles[h / 3];
    on_rim[t[h % 3]] = on_rim[t[(h % 3 + 1) % 3]] = 1;
  }
  for (Index v = 0; v < in_.initial.size(); ++v) {
    input_of_[v] = in_.initial[v];
    place_[v] = on_rim[input_of_[v]] ? Place::rim : on_ring[input_of_[v]] ? Place::ring : Place::elsewhere;
  }
  for (Index v = complex_.initial_points + DelaunayComplex::far_corners; v < place_.size(); ++v)
    place_[v] = complex_.on_edge[v] != none ? Place::on_rim_edge : Place::fresh;
}

void Tailor::index_ring_faces() {
  for (Index face : in_.ring_faces) {
    const Triangle& t = in_.mesh.triangles[face];
    for (int k = 0; k < 3; ++k) faces_[pair_key(t[k], t[(k + 1) % 3])].push_back(face);
  }
}

// The ring face of which a facet is a part.
Index Tailor::face_at(const Triangle& facet) const {
  bool any_steiner = false;
  for (Index v : facet) {
    if (place_[v] == Place::on_rim_edge)
      any_steiner = true;
    else if (place_[v] != Place::rim && place_[v] != Place::ring)
      return none;
  }
  if (any_steiner) return face_with_steiner_points(facet);
  const auto found = faces_.find(pair_key(input_of_[facet[0]], input_of_[facet[1]]));
  if (found == faces_.end()) return none;
  for (Index face : found->second) {
    const Triangle& t = in_.mesh.triangles[face];
    if (std::count(t.begin(), t.end(), input_of_[facet[2]])) return face;
  }
  return none;
}

Index Tailor::face_with_steiner_points(const Triangle& facet) const {
  Index face = none;
  for (Index v : facet)
    if (place_[v] == Place::on_rim_edge) face = in_.half_edges[complex_.on_edge[v]] / 3;
  const Triangle& t = in_.mesh.triangles[face];
  // Bit k: on the side from corner k to the next. Three points of one side are no part of the face.
  int common = 7;
  for (Index v : facet) {
    int sides = 0;
    if (place_[v] == Place::on_rim_edge) {
      const Index h = in_.half_edges[complex_.on_edge[v]];
      if (h / 3 != face) return none;
      sides = 1 << h % 3;
    } else {
      const auto k = std::find(t.begin(), t.end(), input_of_[v]) - t.begin();
      if (k == 3) return none;
      sides = 1 << k | 1 << (k + 2) % 3;
    }
    common &= sides;
  }
  return common == 0 ? face : none;
}

// The cells at a part of a ring face are on the sides of it that they are on.
void Tailor::match(Index cell, int k, Index face) {
  const Triangle facet = facet_towards_corner(complex_.cells[cell], k);
  const Triangle& t = in_.mesh.triangles[face];
  const auto normal = [](const std::vector<Vector3>& positions, const Triangle& corners) -> Vector3 {
    const Vector3& p = positions[corners[0]];
    return (positions[corners[1]] - p).cross(positions[corners[2]] - p);
  };
  const bool before = normal(complex_.vertices, facet).dot(normal(in_.mesh.vertices, t)) > 0;
  side_[cell] |= before ? outside : inside;
  matched_.emplace(4 * std::uint64_t{cell} + static_cast<std::uint64_t>(k), face);
}

void Tailor::match_facets() {
  side_.assign(complex_.cells.size(), free);
  std::vector<char> met(in_.mesh.triangles.size(), 0);
  for (Index cell = 0; cell < complex_.cells.size(); ++cell)
    for (int k = 0; k < 4; ++k) {
      const Index face = face_at(facet_towards_corner(complex_.cells[cell], k));
      if (face == none) continue;
      match(cell, k, face);
      figures_.ring_faces_met += !met[face];
      met[face] = 1;
    }
}

// Where all faces round a vertex of the ring are there, every cell at it is on one side of them.
void Tailor::flood_stars() {
  std::vector<Index> first(complex_.vertices.size() + 1, 0), cells;
  const auto counts = [&](Index v) { return place_[v] == Place::ring; };
  for (const auto& cell : complex_.cells)
    for (Index v : cell) first[v + 1] += counts(v);
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  cells.resize(first.back());
  std::vector<Index> filled(first.begin(), first.end() - 1);
  for (Index c = 0; c < complex_.cells.size(); ++c)
    for (Index v : complex_.cells[c])
      if (counts(v)) cells[filled[v]++] = c;
  for (Index v = 0; v < complex_.vertices.size(); ++v)
    if (first[v + 1] > first[v])
      flood(v, std::vector<Index>(cells.begin() + first[v], cells.begin() + first[v + 1]));
}

// Only when it leads to no contradiction: there is one when faces are missing.
bool Tailor::flood(Index vertex, const std::vector<Index>& star) {
  std::unordered_map<Index, char> found;
  std::vector<Index> open;
  for (Index cell : star)
    for (int k = 0; k < 4; ++k)
      if (complex_.cells[cell][k] != vertex && is_input(cell, k)) {
        // What other faces say of the cell does not matter here.
        found[cell] = side_[cell];
        open.push_back(cell);
      }
  for (std::size_t i = 0; i < open.size(); ++i) {
    const Index cell = open[i];
    const char side = found[cell];
    if (side == both) return false;
    for (int k = 0; k < 4; ++k) {
      const Index next = complex_.neighbours[cell][k];
      if (complex_.cells[cell][k] == vertex || next == none || is_input(cell, k)) continue;
      const auto [at, fresh] = found.emplace(next, side);
      if (fresh)
        open.push_back(next);
      else if (at->second != side)
        return false;
    }
  }
  for (const auto& [cell, side] : found) side_[cell] |= side;
  return true;
}

double Tailor::area(Index cell, int k) const {
  const Triangle t = facet_towards_corner(complex_.cells[cell], k);
  const Vector3& p = complex_.vertices[t[0]];
  return 0.5 * (complex_.vertices[t[1]] - p).cross(complex_.vertices[t[2]] - p).norm();
}

// A minimum cut over the cells at the rims and at new points; what is further away is where the function has
// it.
void Tailor::cut(const Progress& progress) {
  label_ = complex_.inside;
  std::vector<Index> node(complex_.cells.size(), none), cells;
  double total = 0;
  for (Index c = 0; c < complex_.cells.size(); ++c) {
    if (side_[c] == inside || side_[c] == outside) label_[c] = side_[c] == inside;
    if (side_[c] == both) ++figures_.contradictions;
    const bool near = std::any_of(complex_.cells[c].begin(), complex_.cells[c].end(),
                                  [&](Index v) { return place_[v] != Place::elsewhere; });
    if (!near || (side_[c] != free && side_[c] != both)) continue;
    node[c] = static_cast<Index>(cells.size());
    cells.push_back(c);
    for (int k = 0; k < 4; ++k) total += area(c, k);
  }
  progress.check();
  const double scale = total > 0 ? total_price / total : 0;
  GraphCut graph(cells.size(), 2 * cells.size());
  for (Index i = 0; i < cells.size(); ++i) {
    const Index c = cells[i];
    double surface = 0;
    for (int k = 0; k < 4; ++k) {
      const double facet = area(c, k);
      surface += facet;
      const auto price = static_cast<GraphCut::Capacity>(is_input(c, k) ? 0 : scale * facet);
      const Index other = complex_.neighbours[c][k];
      if (other == none)
        graph.tie(i, 0, price);
      else if (node[other] == none)
        graph.tie(i, label_[other] ? price : 0, label_[other] ? 0 : price);
      else if (other > c)
        graph.join(i, node[other], price);
    }
    const auto price = static_cast<GraphCut::Capacity>(scale * unlikeness * surface);
    graph.tie(i, complex_.inside[c] ? price : 0, complex_.inside[c] ? 0 : price);
  }
  graph.cut();
  for (Index i = 0; i < cells.size(); ++i) label_[cells[i]] = graph.with_source(i);
  for (Index c = 0; c < label_.size(); ++c) figures_.relabelled += label_[c] != complex_.inside[c];
}

SeparatingSurface Tailor::extract() const {
  SeparatingSurface surface;
  std::vector<Index> number(complex_.vertices.size(), none);
  for (Index c = 0; c < complex_.cells.size(); ++c) {
    if (!label_[c]) continue;
    for (int k = 0; k < 4; ++k) {
      const Index other = complex_.neighbours[c][k];
      if ((other != none && label_[other]) || is_input(c, k)) continue;
      const Triangle facet = facet_towards_corner(complex_.cells[c], k);
      if (std::any_of(facet.begin(), facet.end(), [&](Index v) { return place_[v] < Place::rim; })) continue;
      Triangle t{facet[0], facet[2], facet[1]};
      for (Index& v : t) {
        if (number[v] == none) {
          number[v] = static_cast<Index>(surface.vertices.size());
          const Index edge = complex_.on_edge[v];
          surface.vertices.push_back({complex_.vertices[v], place_[v] == Place::rim ? input_of_[v] : none,
                                      edge == none ? none : in_.half_edges[edge], false});
        }
        v = number[v];
      }
      surface.triangles.push_back(t);
    }
  }
  return surface;
}

SeparatingSurface Tailor::run(const Progress& progress) {
  place_vertices();
  index_ring_faces();
  match_facets();
  progress.check();
  flood_stars();
  progress.check();
  cut(progress);
  return extract();
}

}  // namespace

SeparatingSurface tailor(const TailoringInput& input, TailoringFigures& figures, const Progress& progress) {
  return Tailor(input, figures).run(progress);
}

}  // namespace meshcomplete
