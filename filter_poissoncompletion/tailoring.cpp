#include "filter_poissoncompletion/tailoring.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "common/core/graph_cut.h"
#include "common/core/threads.h"
#include "filter_poissoncompletion/surplus_facets.h"

namespace meshcomplete {
namespace {

constexpr Index none = DelaunayComplex::none;

// The price of having a cell on the other side than the function has it on, in parts of its surface. With
// this one a cell by itself changes sides when more than 65 % of its surface would be on the surface.
constexpr double unlikeness = 0.3;

// The sum of all prices in the graph's units: far from its limit, and fine enough for every facet.
constexpr double total_price = 1e12;

constexpr std::size_t grain = 4096;  // cells or vertices in one go of a thread

// Where a vertex is: far out, a vertex of the mesh, on an inner edge, a vertex of a rim, on a rim's edge, or
// on the surface alone. Patches have corners at the last three.
enum class Place : char { elsewhere, mesh, mesh_edge, rim, rim_edge, fresh };

enum Side : char { free = 0, inside = 1, outside = 2, both = 3, unknown = 4 };

// The cells round one vertex that lie on a known side of the mesh's faces there.
class StarFlood {
 public:
  StarFlood(const DelaunayComplex& complex, const std::vector<char>& input_facets,
            const std::vector<char>& side)
      : complex_(complex), input_facets_(input_facets), side_(side), found_(complex.cells.size(), unknown) {}

  /// Only when it leads to no contradiction: there is one when faces are missing. `visit(cell, side)` is
  /// called for every cell.
  template <class Visit>
  void run(Index vertex, const Index* star, const Index* star_end, const Visit& visit) {
    if (flood(vertex, star, star_end))
      for (Index cell : open_) visit(cell, found_[cell]);
    for (Index cell : open_) found_[cell] = unknown;
  }

 private:
  bool flood(Index vertex, const Index* star, const Index* star_end);
  bool is_input(Index cell, int k) const { return input_facets_[cell] >> k & 1; }

  const DelaunayComplex& complex_;
  const std::vector<char>& input_facets_;
  const std::vector<char>& side_;
  std::vector<char> found_;  // of each cell: its side in the star that is flooded, or `unknown`
  std::vector<Index> open_;  // the cells of that star whose side was found
};

class Tailor {
 public:
  Tailor(const TailoringInput& input, TailoringFigures& figures)
      : in_(input), complex_(input.complex), figures_(figures) {}

  SeparatingSurface run(const Progress& progress);

 private:
  void place_vertices();
  void index_faces();
  void match_facets(const Progress& progress);
  Index face_at(const Triangle& facet) const;
  Index divided_face_at(const Triangle& facet) const;
  int sides_of(Index vertex, Index face) const;
  bool is_part(const Triangle& facet, Index face) const;
  void match(Index cell, int k, Index face);
  void flood_stars(const Progress& progress);
  void cut(const Progress& progress);
  double area(Index cell, int k) const;
  bool is_near(Index cell) const;
  std::vector<std::array<double, 4>> areas(const std::vector<Index>& cells, const Progress& progress) const;
  bool is_input(Index cell, int k) const { return input_facets_[cell] >> k & 1; }
  SeparatingSurface extract() const;

  const TailoringInput& in_;
  const DelaunayComplex& complex_;
  TailoringFigures& figures_;
  std::vector<Place> place_;
  std::vector<Index> rank_;         // of each vertex of the mesh that is in the complex
  std::vector<Index> first_face_;   // of each rank, in `faces_`
  std::vector<Index> faces_;        // ring faces at each vertex, ascending
  std::vector<char> input_facets_;  // of each cell: bit k, that facet k is part of a ring face
  std::vector<char> side_;          // that the ring has a cell on
  std::vector<char> label_;         // inside
};

void Tailor::place_vertices() {
  place_.assign(complex_.vertices.size(), Place::elsewhere);
  std::vector<char> on_rim(in_.mesh.vertices.size(), 0);
  for (std::size_t edge = 0; edge < in_.rim_edges; ++edge) {
    const Index h = in_.half_edges[edge];
    const Triangle& t = in_.mesh.triangles[h / 3];
    on_rim[t[h % 3]] = on_rim[t[(h % 3 + 1) % 3]] = 1;
  }
  for (Index v = 0; v < place_.size(); ++v) {
    const Index own = complex_.mesh_vertex[v], edge = complex_.on_edge[v];
    if (own != none)
      place_[v] = on_rim[own] ? Place::rim : Place::mesh;
    else if (edge != none)
      place_[v] = edge < in_.rim_edges ? Place::rim_edge : Place::mesh_edge;
    else if (complex_.is_new(v))
      place_[v] = Place::fresh;
  }
}

// Those whose corners are all there.
void Tailor::index_faces() {
  rank_.assign(in_.mesh.vertices.size(), none);
  Index ranks = 0;
  for (Index v : complex_.mesh_vertex)
    if (v != none && rank_[v] == none) rank_[v] = ranks++;
  std::vector<Index> ring;
  first_face_.assign(ranks + 1, 0);
  for (Index face = 0; face < in_.mesh.triangles.size(); ++face) {
    const Triangle& t = in_.mesh.triangles[face];
    if (rank_[t[0]] == none || rank_[t[1]] == none || rank_[t[2]] == none) continue;
    ring.push_back(face);
    for (Index v : t) ++first_face_[rank_[v] + 1];
  }
  std::partial_sum(first_face_.begin(), first_face_.end(), first_face_.begin());
  faces_.resize(first_face_.back());
  std::vector<Index> filled(first_face_.begin(), first_face_.end() - 1);
  for (Index face : ring)
    for (Index v : in_.mesh.triangles[face]) faces_[filled[rank_[v]]++] = face;
}

// The face of the mesh of which a facet is a part.
Index Tailor::face_at(const Triangle& facet) const {
  bool divided = false;
  for (Index v : facet) {
    if (place_[v] == Place::rim_edge || place_[v] == Place::mesh_edge)
      divided = true;
    else if (place_[v] != Place::rim && place_[v] != Place::mesh)
      return none;
  }
  if (divided) return divided_face_at(facet);
  const Index a = complex_.mesh_vertex[facet[0]], b = complex_.mesh_vertex[facet[1]],
              c = complex_.mesh_vertex[facet[2]];
  for (Index i = first_face_[rank_[a]]; i < first_face_[rank_[a] + 1]; ++i) {
    const Triangle& t = in_.mesh.triangles[faces_[i]];
    if ((t[0] == b || t[1] == b || t[2] == b) && (t[0] == c || t[1] == c || t[2] == c)) return faces_[i];
  }
  return none;
}

Index Tailor::divided_face_at(const Triangle& facet) const {
  for (Index v : facet) {
    if (complex_.on_edge[v] == none) continue;
    const Index h = in_.half_edges[complex_.on_edge[v]], other = in_.topology.opposite[h];
    if (is_part(facet, h / 3)) return h / 3;
    if (other < in_.topology.opposite.size() && is_part(facet, other / 3)) return other / 3;
    return none;
  }
  return none;
}

// Bit k: on the side from corner k to the next.
int Tailor::sides_of(Index vertex, Index face) const {
  const Index edge = complex_.on_edge[vertex];
  if (edge != none) {
    const Index h = in_.half_edges[edge], other = in_.topology.opposite[h];
    return h / 3 == face ? 1 << h % 3 : other / 3 == face ? 1 << other % 3 : 0;
  }
  const Triangle& t = in_.mesh.triangles[face];
  const auto k = std::find(t.begin(), t.end(), complex_.mesh_vertex[vertex]) - t.begin();
  return k == 3 ? 0 : 1 << k | 1 << (k + 2) % 3;
}

// Three points on one side are no part of a face.
bool Tailor::is_part(const Triangle& facet, Index face) const {
  const int a = sides_of(facet[0], face), b = sides_of(facet[1], face), c = sides_of(facet[2], face);
  return a && b && c && !(a & b & c);
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
  input_facets_[cell] |= static_cast<char>(1 << k);
}

void Tailor::match_facets(const Progress& progress) {
  side_.assign(complex_.cells.size(), free);
  input_facets_.assign(complex_.cells.size(), 0);
  std::vector<std::vector<Index>> met(complex_.cells.size() / grain + 1);
  for_ranges(complex_.cells.size(), grain, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell)
      for (int k = 0; k < 4; ++k) {
        const Index face = face_at(facet_towards_corner(complex_.cells[cell], k));
        if (face == none) continue;
        match(static_cast<Index>(cell), k, face);
        met[begin / grain].push_back(face);
      }
  });
  std::vector<char> counted(in_.mesh.triangles.size(), 0);
  for (const std::vector<Index>& faces : met)
    for (Index face : faces) {
      figures_.faces_met += !counted[face];
      counted[face] = 1;
    }
}

// Where all faces round a vertex of the ring are there, every cell at it is on one side of them.
void Tailor::flood_stars(const Progress& progress) {
  std::vector<Index> first(complex_.vertices.size() + 1, 0), cells;
  const auto counts = [&](Index v) { return place_[v] == Place::mesh || place_[v] == Place::mesh_edge; };
  for (const auto& cell : complex_.cells)
    for (Index v : cell) first[v + 1] += counts(v);
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  cells.resize(first.back());
  std::vector<Index> filled(first.begin(), first.end() - 1);
  for (Index c = 0; c < complex_.cells.size(); ++c)
    for (Index v : complex_.cells[c])
      if (counts(v)) cells[filled[v]++] = c;
  const std::size_t vertices = complex_.vertices.size();
  std::vector<std::vector<std::pair<Index, char>>> sides(vertices / grain + 1);
  for_ranges(vertices, grain, progress, [&](std::size_t begin, std::size_t end) {
    if (first[begin] == first[end]) return;
    StarFlood flood(complex_, input_facets_, side_);
    for (std::size_t v = begin; v < end; ++v)
      flood.run(static_cast<Index>(v), cells.data() + first[v], cells.data() + first[v + 1],
                [&](Index cell, char side) { sides[begin / grain].emplace_back(cell, side); });
  });
  for (const auto& range : sides)
    for (const auto& [cell, side] : range) side_[cell] |= side;
}

bool StarFlood::flood(Index vertex, const Index* star, const Index* star_end) {
  open_.clear();
  for (; star != star_end; ++star)
    for (int k = 0; k < 4; ++k)
      if (complex_.cells[*star][k] != vertex && is_input(*star, k) && found_[*star] == unknown) {
        found_[*star] = side_[*star];
        open_.push_back(*star);
      }
  for (std::size_t i = 0; i < open_.size(); ++i) {
    const Index cell = open_[i];
    const char side = found_[cell];
    if (side == both) return false;
    for (int k = 0; k < 4; ++k) {
      const Index next = complex_.neighbours[cell][k];
      if (complex_.cells[cell][k] == vertex || next == none || is_input(cell, k)) continue;
      if (found_[next] == unknown) {
        found_[next] = side;
        open_.push_back(next);
      } else if (found_[next] != side) {
        return false;
      }
    }
  }
  return true;
}

double Tailor::area(Index cell, int k) const {
  const Triangle t = facet_towards_corner(complex_.cells[cell], k);
  const Vector3& p = complex_.vertices[t[0]];
  return 0.5 * (complex_.vertices[t[1]] - p).cross(complex_.vertices[t[2]] - p).norm();
}

bool Tailor::is_near(Index cell) const {
  const DelaunayComplex::Cell& corners = complex_.cells[cell];
  return std::any_of(corners.begin(), corners.end(), [&](Index v) { return place_[v] != Place::elsewhere; });
}

std::vector<std::array<double, 4>> Tailor::areas(const std::vector<Index>& cells,
                                                 const Progress& progress) const {
  std::vector<std::array<double, 4>> areas(cells.size());
  for_each(cells.size(), grain, progress, [&](std::size_t i) {
    for (int k = 0; k < 4; ++k) areas[i][k] = area(cells[i], k);
  });
  return areas;
}

// A minimum cut over the cells at the rims and at new points; what is further away is where the function has
// it.
void Tailor::cut(const Progress& progress) {
  label_ = complex_.inside;
  std::vector<Index> node(complex_.cells.size(), none), cells;
  for (Index c = 0; c < complex_.cells.size(); ++c) {
    if (side_[c] == inside || side_[c] == outside) label_[c] = side_[c] == inside;
    if (side_[c] == both) ++figures_.contradictions;
    if ((side_[c] != free && side_[c] != both) || !is_near(c)) continue;
    node[c] = static_cast<Index>(cells.size());
    cells.push_back(c);
  }
  const std::vector<std::array<double, 4>> areas = this->areas(cells, progress);
  double total = 0;
  for (const std::array<double, 4>& facets : areas)
    for (double facet : facets) total += facet;
  const double scale = total > 0 ? total_price / total : 0;
  GraphCut graph(cells.size(), 2 * cells.size());
  for (Index i = 0; i < cells.size(); ++i) {
    const Index c = cells[i];
    double surface = 0;
    GraphCut::Capacity to_source = 0, to_sink = 0;
    const auto add = [&](bool in, GraphCut::Capacity price) { (in ? to_source : to_sink) += price; };
    for (int k = 0; k < 4; ++k) {
      surface += areas[i][k];
      const auto price = static_cast<GraphCut::Capacity>(is_input(c, k) ? 0 : scale * areas[i][k]);
      const Index other = complex_.neighbours[c][k];
      if (other == none)
        add(false, price);
      else if (node[other] == none)
        add(label_[other], price);
      else if (other > c)
        graph.join(i, node[other], price);
    }
    add(complex_.inside[c], static_cast<GraphCut::Capacity>(scale * unlikeness * surface));
    graph.tie(i, to_source, to_sink);
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
          surface.vertices.push_back({complex_.vertices[v],
                                      place_[v] == Place::rim ? complex_.mesh_vertex[v] : none,
                                      place_[v] == Place::rim_edge ? in_.half_edges[edge] : none, false});
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
  index_faces();
  match_facets(progress);
  flood_stars(progress);
  cut(progress);
  SeparatingSurface surface = extract();
  figures_.surplus = drop_surplus_facets(surface, in_.mesh, in_.topology);
  return surface;
}

}  // namespace

SeparatingSurface tailor(const TailoringInput& input, TailoringFigures& figures, const Progress& progress) {
  return Tailor(input, figures).run(progress);
}

}  // namespace meshcomplete
