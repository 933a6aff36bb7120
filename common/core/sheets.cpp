#include "common/core/sheets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "common/core/disjoint_sets.h"
#include "common/core/pair_key.h"
#include "common/core/touching_fans.h"

namespace meshcomplete {
namespace {

constexpr Index none = SheetVertex::none;

// One side of a triangle, from `low` to `high` when `forward`.
struct FaceSide {
  Index low, high, half_edge;  // `half_edge` is 3 * triangle + k; `none` for the mesh's own triangle at a rim
  bool forward;
  double angle = 0;
  bool operator<(const FaceSide& o) const {
    return std::tie(low, high, half_edge) < std::tie(o.low, o.high, o.half_edge);
  }
};

class Splitter {
 public:
  Splitter(const TriangleMesh& mesh, const MeshTopology& topology, const SeparatingSurface& surface,
           const TriangleMesh& input)
      : mesh_(mesh),
        input_(input),
        topology_(topology),
        surface_(surface),
        fans_(3 * surface.triangles.size()),
        partner_(fans_.size(), none),
        rim_(fans_.size(), none) {}

  std::vector<Sheet> run();

 private:
  void index_rim_edges();
  void pair_sides();
  void pair_at_edge(std::vector<FaceSide>& sides);
  Index rim_edge(Index from, Index to) const;
  void sort_by_angle(std::vector<FaceSide>& sides, Index rim) const;
  void join(const FaceSide& a, const FaceSide& b);
  Index vertex(Index half_edge) const { return surface_.triangles[half_edge / 3][half_edge % 3]; }
  static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  void number_fans();
  void name_corners();
  void add_midpoints();
  void divide(Index triangle, const Index* middle);
  void separate_doubles();
  std::vector<Sheet> pieces() const;

  const TriangleMesh &mesh_, &input_;
  const MeshTopology& topology_;
  const SeparatingSurface& surface_;
  DisjointSets fans_;           // of corners
  std::vector<Index> partner_;  // the half-edge at the other side of an edge
  std::vector<Index> rim_;      // the mesh's boundary half-edge at a half-edge of the patch
  std::unordered_map<std::uint64_t, Index> boundary_;  // by its two vertices
  // The surface taken apart.
  std::vector<SheetVertex> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Index> origin_;  // of each vertex, in the surface; `none` for middles
  std::vector<char> doubled_;
  std::vector<char> joined_;  // vertices that would have to be two of the input's at once
};

void Splitter::index_rim_edges() {
  for (Index h : topology_.boundary_half_edges) {
    const Triangle& t = mesh_.triangles[h / 3];
    boundary_.emplace(pair_key(t[h % 3], t[(h % 3 + 1) % 3]), h);
  }
}

// The mesh's boundary half-edge on which the edge lies.
Index Splitter::rim_edge(Index from, Index to) const {
  const SheetVertex &a = surface_.vertices[from], &b = surface_.vertices[to];
  const auto on_rim = [](const SheetVertex& v) { return v.input != none || v.rim_edge != none; };
  if (!on_rim(a) || !on_rim(b)) return none;
  if (a.input != none && b.input != none) {
    const auto found = boundary_.find(pair_key(a.input, b.input));
    return found == boundary_.end() ? none : found->second;
  }
  const Index edge = a.rim_edge != none ? a.rim_edge : b.rim_edge;
  const Triangle& t = mesh_.triangles[edge / 3];
  const auto belongs = [&](const SheetVertex& v) {
    return v.rim_edge == edge || v.input == t[edge % 3] || v.input == t[(edge % 3 + 1) % 3];
  };
  return belongs(a) && belongs(b) ? edge : none;
}

// By the angle round the edge, from its lower vertex to its higher.
void Splitter::sort_by_angle(std::vector<FaceSide>& sides, Index rim) const {
  const Vector3& low = surface_.vertices[sides.front().low].position;
  const Vector3 axis = (surface_.vertices[sides.front().high].position - low).normalized();
  Vector3 zero = axis.unitOrthogonal();
  const Vector3 quarter = axis.cross(zero);
  for (FaceSide& side : sides) {
    const Vector3 apex = side.half_edge == none
                             ? mesh_.vertices[mesh_.triangles[rim / 3][(rim % 3 + 2) % 3]]
                             : surface_.vertices[vertex(next(next(side.half_edge)))].position;
    side.angle = std::atan2((apex - low).dot(quarter), (apex - low).dot(zero));
  }
  std::sort(sides.begin(), sides.end(), [](const FaceSide& a, const FaceSide& b) {
    return std::tie(a.angle, a.half_edge) < std::tie(b.angle, b.half_edge);
  });
}

void Splitter::join(const FaceSide& a, const FaceSide& b) {
  if (a.half_edge == none || b.half_edge == none) return;
  partner_[a.half_edge] = b.half_edge;
  partner_[b.half_edge] = a.half_edge;
  fans_.unite(a.half_edge, next(b.half_edge));
  fans_.unite(next(a.half_edge), b.half_edge);
}

// The inside lies behind a face, which is before it, turning about the edge, when the face goes along the
// edge forward. So an inside sector begins at a face that goes backward and ends at the next one.
void Splitter::pair_at_edge(std::vector<FaceSide>& sides) {
  const Index rim = rim_edge(sides.front().low, sides.front().high);
  std::size_t forward = 0;
  for (const FaceSide& side : sides) forward += side.forward;
  if (rim != none && 2 * forward != sides.size()) {
    FaceSide own{sides.front().low, sides.front().high, none, 2 * forward < sides.size(), 0};
    for (const FaceSide& side : sides) rim_[side.half_edge] = rim;
    sides.push_back(own);
  }
  if (sides.size() > 2) sort_by_angle(sides, rim);
  std::vector<char> taken(sides.size(), 0);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (sides[i].forward || taken[i]) continue;
    for (std::size_t step = 1; step < sides.size(); ++step) {
      const std::size_t j = (i + step) % sides.size();
      if (!sides[j].forward || taken[j]) continue;
      taken[i] = taken[j] = 1;
      join(sides[i], sides[j]);
      break;
    }
  }
  for (const FaceSide& side : sides)
    if (side.half_edge != none && partner_[side.half_edge] != none) rim_[side.half_edge] = none;
}

void Splitter::pair_sides() {
  std::vector<FaceSide> all;
  for (Index h = 0; h < partner_.size(); ++h) {
    const Index a = vertex(h), b = vertex(next(h));
    all.push_back({std::min(a, b), std::max(a, b), h, a < b, 0});
  }
  std::sort(all.begin(), all.end());
  std::vector<FaceSide> sides;
  for (std::size_t i = 0; i < all.size();) {
    sides.clear();
    for (const std::size_t first = i;
         i < all.size() && all[i].low == all[first].low && all[i].high == all[first].high; ++i)
      sides.push_back(all[i]);
    pair_at_edge(sides);
  }
}

// A vertex for every fan. On the rim the fans that end there keep what the vertex is.
void Splitter::number_fans() {
  std::vector<char> at_rim(fans_.size(), 0);
  for (Index h = 0; h < fans_.size(); ++h)
    if (partner_[h] == none) at_rim[fans_.root(h)] = at_rim[fans_.root(next(h))] = 1;
  std::vector<Index> number(fans_.size(), none);
  std::vector<char> seen(surface_.vertices.size(), 0);
  triangles_.resize(surface_.triangles.size());
  for (Index corner = 0; corner < fans_.size(); ++corner) {
    const Index fan = fans_.root(corner), v = vertex(corner);
    if (number[fan] == none) {
      number[fan] = static_cast<Index>(vertices_.size());
      const SheetVertex& original = surface_.vertices[v];
      const bool on_rim = original.input != none || original.rim_edge != none;
      SheetVertex one{original.position, none, none, original.cut};
      if (at_rim[fan]) {
        one.input = original.input;
        one.rim_edge = original.rim_edge;
      }
      vertices_.push_back(one);
      origin_.push_back(v);
      doubled_.push_back(!at_rim[fan] && (on_rim || seen[v]));
      seen[v] = 1;
    }
    triangles_[corner / 3][corner % 3] = number[fan];
  }
}

// Which vertex of the input a fan's corner is: the one at the end of its rim edges.
void Splitter::name_corners() {
  std::vector<char> named(vertices_.size(), 0);
  joined_.assign(vertices_.size(), 0);
  for (Index h = 0; h < partner_.size(); ++h) {
    if (partner_[h] != none || rim_[h] == none) continue;
    const Index face = rim_[h] / 3;
    for (const Index corner : {h, next(h)}) {
      const Index v = triangles_[corner / 3][corner % 3], same = vertices_[v].input;
      if (same == none) continue;
      const Index place = surface_.vertices[vertex(corner)].input == mesh_.triangles[face][rim_[h] % 3]
                              ? rim_[h] % 3
                              : (rim_[h] % 3 + 1) % 3;
      const Index name = input_.triangles[face][place];
      if (named[v] && name != same) joined_[v] = 1;
      vertices_[v].input = name;
      named[v] = 1;
    }
  }
}

// Two pairs of faces that share both ends of an edge, because neither end is doubled, get different middles.
// The faces at a rim keep theirs, which the mesh has too.
void Splitter::add_midpoints() {
  const auto key = [&](Index h) {
    return pair_key(triangles_[h / 3][h % 3], triangles_[h / 3][next(h) % 3]);
  };
  std::unordered_set<std::uint64_t> taken;
  for (Index h = 0; h < partner_.size(); ++h)
    if (partner_[h] == none) taken.insert(key(h));
  std::vector<Index> middle(partner_.size(), none);
  for (Index h = 0; h < partner_.size(); ++h) {
    if (partner_[h] == none || partner_[h] < h || taken.insert(key(h)).second) continue;
    middle[h] = middle[partner_[h]] = static_cast<Index>(vertices_.size());
    const Vector3 &a = vertices_[triangles_[h / 3][h % 3]].position,
                  &b = vertices_[triangles_[h / 3][next(h) % 3]].position;
    vertices_.push_back({0.5 * (a + b), none, none, false});
    origin_.push_back(none);
    doubled_.push_back(1);
  }
  for (Index t = 0; 3 * t < middle.size(); ++t) divide(t, &middle[3 * t]);
}

// A fan from one of the middles of the triangle's sides: every new edge ends at a middle, so that there is no
// other like it.
void Splitter::divide(Index triangle, const Index* middle) {
  std::vector<Index> outline;
  std::size_t first = 0;
  for (int k = 0; k < 3; ++k) {
    outline.push_back(triangles_[triangle][k]);
    if (middle[k] == none) continue;
    first = outline.size();
    outline.push_back(middle[k]);
  }
  if (outline.size() == 3) return;
  std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(first), outline.end());
  triangles_[triangle] = {outline[0], outline[1], outline[2]};
  for (std::size_t i = 2; i + 1 < outline.size(); ++i)
    triangles_.push_back({outline[0], outline[i], outline[i + 1]});
}

void Splitter::separate_doubles() {
  std::vector<TouchingFan> fans;
  for (Index v = 0; v < vertices_.size(); ++v) {
    if (!doubled_[v]) continue;
    const SheetVertex* original = origin_[v] == none ? nullptr : &surface_.vertices[origin_[v]];
    fans.push_back({v, original ? original->input : none, original ? original->rim_edge : none});
  }
  retreat(mesh_, fans, triangles_, vertices_);
}

std::vector<Sheet> Splitter::pieces() const {
  DisjointSets connected(vertices_.size());
  for (const Triangle& t : triangles_)
    for (int k = 1; k < 3; ++k) connected.unite(t[k], t[0]);
  std::vector<Sheet> sheets;
  std::vector<Index> sheet_of(vertices_.size(), none), local(vertices_.size(), none);
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Index top = connected.root(triangles_[i][0]);
    if (sheet_of[top] == none) {
      sheet_of[top] = static_cast<Index>(sheets.size());
      sheets.emplace_back();
    }
    Sheet& sheet = sheets[sheet_of[top]];
    Triangle t;
    for (int k = 0; k < 3; ++k) {
      Index& number = local[triangles_[i][k]];
      if (number == none) {
        number = static_cast<Index>(sheet.vertices.size());
        sheet.vertices.push_back(vertices_[triangles_[i][k]]);
      }
      t[k] = number;
    }
    sheet.triangles.push_back(t);
  }
  for (Index h = 0; h < partner_.size(); ++h) {
    if (partner_[h] != none) continue;
    Sheet& sheet = sheets[sheet_of[connected.root(triangles_[h / 3][h % 3])]];
    if (rim_[h] == none)
      sheet.flaw = Sheet::Flaw::open;
    else
      sheet.closes.push_back(rim_[h]);
  }
  for (Index v = 0; v < joined_.size(); ++v) {
    if (!joined_[v] || sheet_of[connected.root(v)] == none) continue;
    Sheet::Flaw& flaw = sheets[sheet_of[connected.root(v)]].flaw;
    if (flaw == Sheet::Flaw::none) flaw = Sheet::Flaw::joins_vertices;
  }
  for (Sheet& sheet : sheets) {
    std::sort(sheet.closes.begin(), sheet.closes.end());
    sheet.closes.erase(std::unique(sheet.closes.begin(), sheet.closes.end()), sheet.closes.end());
  }
  return sheets;
}

std::vector<Sheet> Splitter::run() {
  index_rim_edges();
  pair_sides();
  number_fans();
  name_corners();
  add_midpoints();
  separate_doubles();
  return pieces();
}

}  // namespace

std::vector<Sheet> split_into_sheets(const TriangleMesh& mesh, const MeshTopology& topology,
                                     const SeparatingSurface& surface, const TriangleMesh& input) {
  return Splitter(mesh, topology, surface, input).run();
}

}  // namespace meshcomplete
