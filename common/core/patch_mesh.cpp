#include "common/core/patch_mesh.h"

#include <algorithm>

#include "common/core/error.h"
#include "common/core/mesh_topology.h"

namespace meshcomplete {

PatchMesh::PatchMesh(std::vector<Vector3> positions, std::size_t rim_size, std::vector<Triangle> triangles)
    : rim_size_(rim_size), positions_(std::move(positions)), triangles_(std::move(triangles)) {
  connect();
}

void PatchMesh::connect() {
  const MeshTopology topology = build_topology({positions_, triangles_});
  const auto inconsistent = [&](Index h) {
    return topology.opposite[h] < MeshTopology::non_manifold && origin(topology.opposite[h]) == origin(h);
  };
  opposite_.resize(topology.opposite.size());
  half_edge_of_.assign(positions_.size(), none);
  for (Index h = 0; h < opposite_.size(); ++h) {
    if (topology.opposite[h] == MeshTopology::non_manifold || !topology.degenerate_faces.empty() ||
        inconsistent(h))
      throw CompletionError("triangulating the patch",
                            "The triangulation of the unfolded rim is not manifold.");
    opposite_[h] = topology.opposite[h] == MeshTopology::boundary ? none : topology.opposite[h];
  }
  // On the rim, the half-edge to start a fan at is the one that lies on the boundary: turning goes away from
  // it.
  for (Index h = 0; h < opposite_.size(); ++h)
    if (half_edge_of_[origin(h)] == none || opposite_[h] == none) half_edge_of_[origin(h)] = h;
}

Vector3 PatchMesh::area_normal(Index triangle) const {
  const Triangle& t = triangles_[triangle];
  return (positions_[t[1]] - positions_[t[0]]).cross(positions_[t[2]] - positions_[t[0]]);
}

bool PatchMesh::joined(Index a, Index b) const {
  bool found = false;
  for_neighbours(a, [&](Index v) { found |= v == b; });
  return found;
}

std::size_t PatchMesh::valence(Index vertex) const {
  std::size_t count = 0;
  for_neighbours(vertex, [&](Index) { ++count; });
  return count;
}

void PatchMesh::join(Index half_edge, Index other) {
  opposite_[half_edge] = other;
  if (other != none) opposite_[other] = half_edge;
}

//      c                c
//    / | \            / | \        h = a -> b, g = b -> a; m is inserted on a b.
//   a--h--b   to     a--m--b       Triangles of h and g keep the corner a, the two new ones get b.
//    \ | /            \ | /
//      d                d
Index PatchMesh::split(Index h, const Vector3& position) {
  const Index g = opposite_[h];
  const Index b = target(h), c = apex(h), d = apex(g);
  const Index h_next = next(h), g_previous = previous(g);
  const Index beyond_bc = opposite_[h_next], beyond_db = opposite_[g_previous];
  const Index m = static_cast<Index>(positions_.size());
  positions_.push_back(position);

  const Index upper = static_cast<Index>(3 * triangles_.size());  // m b c
  const Index lower = upper + 3;                                  // b m d
  triangles_.push_back({m, b, c});
  triangles_.push_back({b, m, d});
  opposite_.resize(opposite_.size() + 6, none);
  triangles_[h / 3][(h % 3 + 1) % 3] = m;  // a m c
  triangles_[g / 3][g % 3] = m;            // m a d
  join(upper + 1, beyond_bc);
  join(upper + 2, h_next);
  join(lower + 2, beyond_db);
  join(lower + 1, g_previous);
  join(upper, lower);
  half_edge_of_.push_back(upper);
  if (half_edge_of_[b] == h_next) half_edge_of_[b] = upper + 1;
  if (half_edge_of_[b] == g) half_edge_of_[b] = lower;
  if (half_edge_of_[d] == g_previous) half_edge_of_[d] = lower + 2;
  return m;
}

// a b c keeps its number and becomes a b m; b c m and c a m are new.
Index PatchMesh::insert(Index triangle, const Vector3& position) {
  const auto [a, b, c] = triangles_[triangle];
  const Index first = 3 * triangle;
  const Index second = static_cast<Index>(3 * triangles_.size()), third = second + 3;
  const Index m = static_cast<Index>(positions_.size());
  const Index beyond_bc = opposite_[first + 1], beyond_ca = opposite_[first + 2];
  positions_.push_back(position);
  triangles_[triangle] = {a, b, m};
  triangles_.push_back({b, c, m});
  triangles_.push_back({c, a, m});
  opposite_.resize(opposite_.size() + 6, none);
  join(second, beyond_bc);
  join(third, beyond_ca);
  join(first + 1, second + 2);
  join(second + 1, third + 2);
  join(third + 1, first + 2);
  half_edge_of_.push_back(first + 2);
  if (half_edge_of_[b] == first + 1) half_edge_of_[b] = second;
  if (half_edge_of_[c] == first + 2) half_edge_of_[c] = third;
  return m;
}

// a b c, b a d  become  c d b, d c a.
void PatchMesh::flip(Index h) {
  const Index g = opposite_[h];
  const Index a = origin(h), b = target(h), c = apex(h), d = apex(g);
  const Index beyond_bc = opposite_[next(h)], beyond_ca = opposite_[previous(h)];
  const Index beyond_ad = opposite_[next(g)], beyond_db = opposite_[previous(g)];
  const Index h0 = h - h % 3, g0 = g - g % 3;
  const auto starts_at = [&](Index vertex, Index half_edge) { return half_edge_of_[vertex] == half_edge; };
  // A fan of the rim starts at the same edge as before, wherever that edge has gone.
  const bool b_at_bc = starts_at(b, next(h)), c_at_ca = starts_at(c, previous(h));
  const bool a_at_ad = starts_at(a, next(g)), d_at_db = starts_at(d, previous(g));
  const bool b_at_g = starts_at(b, g), a_at_h = starts_at(a, h);
  triangles_[h / 3] = {c, d, b};
  triangles_[g / 3] = {d, c, a};
  opposite_[h0] = g0;
  opposite_[g0] = h0;
  opposite_[h0 + 1] = opposite_[h0 + 2] = opposite_[g0 + 1] = opposite_[g0 + 2] = none;
  join(h0 + 1, beyond_db);
  join(h0 + 2, beyond_bc);
  join(g0 + 1, beyond_ca);
  join(g0 + 2, beyond_ad);
  if (b_at_bc || b_at_g) half_edge_of_[b] = h0 + 2;
  if (a_at_ad || a_at_h) half_edge_of_[a] = g0 + 2;
  if (c_at_ca) half_edge_of_[c] = g0 + 1;
  if (d_at_db) half_edge_of_[d] = h0 + 1;
}

bool PatchMesh::can_collapse(Index h) const {
  const Index g = opposite_[h];
  if (g == none || on_rim(origin(h)) || at_boundary(origin(h))) return false;
  const Index a = origin(h), b = target(h), c = apex(h), d = apex(g);
  if (c == d) return false;
  // Link condition: a and b have no common neighbours but c and d; and no triangle is left without a
  // neighbour.
  bool clean = true;
  std::size_t valence_a = 0;
  for_neighbours(a, [&](Index v) {
    ++valence_a;
    if (v != b && v != c && v != d && joined(v, b)) clean = false;
  });
  if (!clean || valence_a < 4) return false;
  // c and d lose a neighbour: inside they need three left, on the rim an edge that is not the boundary is
  // enough.
  const auto can_lose_one = [&](Index v) { return valence(v) > (at_boundary(v) ? 2u : 3u); };
  const bool side_c_stays = !(is_boundary(next(h)) && is_boundary(previous(h)));
  const bool side_d_stays = !(is_boundary(next(g)) && is_boundary(previous(g)));
  return side_c_stays && side_d_stays && can_lose_one(c) && can_lose_one(d);
}

void PatchMesh::collapse(Index h) {
  const Index g = opposite_[h];
  const Index a = origin(h), b = target(h), c = apex(h), d = apex(g);
  const Index beyond_bc = opposite_[next(h)], beyond_ca = opposite_[previous(h)];
  const Index beyond_ad = opposite_[next(g)], beyond_db = opposite_[previous(g)];
  std::vector<Index> around;
  for_outgoing(a, [&](Index out) { around.push_back(out); });
  for (Index out : around) triangles_[out / 3][out % 3] = b;
  // The edges c a and a d survive and become c b and b d.
  opposite_[beyond_ca] = beyond_bc;
  if (beyond_bc != none) opposite_[beyond_bc] = beyond_ca;
  opposite_[beyond_ad] = beyond_db;
  if (beyond_db != none) opposite_[beyond_db] = beyond_ad;
  triangles_[h / 3] = triangles_[g / 3] = {none, none, none};
  half_edge_of_[a] = none;
  // beyond_ca runs a -> c, now b -> c; beyond_ad runs d -> a, now d -> b.
  const auto dead = [&](Index half_edge) { return half_edge / 3 == h / 3 || half_edge / 3 == g / 3; };
  start_fan(b, dead(half_edge_of_[b]) ? beyond_ca : half_edge_of_[b]);
  start_fan(c, dead(half_edge_of_[c]) ? next(beyond_ca) : half_edge_of_[c]);
  start_fan(d, dead(half_edge_of_[d]) ? beyond_ad : half_edge_of_[d]);
}

// At the boundary a fan starts at the boundary: turns back to it from a half-edge that leaves the vertex.
void PatchMesh::start_fan(Index vertex, Index half_edge) {
  const Index first = half_edge;
  while (opposite_[half_edge] != none) {
    half_edge = next(opposite_[half_edge]);
    if (half_edge == first) break;
  }
  half_edge_of_[vertex] = half_edge;
}

bool PatchMesh::can_collapse_at_boundary(Index h, bool onto_target) const {
  const Index gone = onto_target ? origin(h) : target(h), kept = onto_target ? target(h) : origin(h);
  if (!is_boundary(h) || on_rim(gone)) return false;
  // The other two sides of the triangle become one, which needs a triangle; and only its third corner may be
  // a neighbour of both ends.
  if (is_boundary(next(h)) || is_boundary(previous(h))) return false;
  bool clean = true;
  for_neighbours(gone, [&](Index v) { clean &= v == kept || v == apex(h) || !joined(v, kept); });
  return clean && valence(apex(h)) > (at_boundary(apex(h)) ? 2u : 3u);
}

void PatchMesh::collapse_at_boundary(Index h, bool onto_target) {
  const Index gone = onto_target ? origin(h) : target(h), kept = onto_target ? target(h) : origin(h);
  const Index c = apex(h), dead = h / 3;
  const Index beyond_bc = opposite_[next(h)], beyond_ca = opposite_[previous(h)];
  std::vector<Index> around;
  for_outgoing(gone, [&](Index out) { around.push_back(out); });
  for (Index out : around) triangles_[out / 3][out % 3] = kept;
  join(beyond_bc, beyond_ca);
  triangles_[dead] = {none, none, none};
  half_edge_of_[gone] = none;
  // beyond_bc runs from c to an end of h, beyond_ca to c.
  start_fan(kept, beyond_ca);
  start_fan(c, beyond_bc);
}

Index PatchMesh::arriving_along_boundary(Index vertex) const {
  Index arriving = previous(half_edge_of_[vertex]);
  while (opposite_[arriving] != none) arriving = previous(opposite_[arriving]);
  return arriving;
}

bool PatchMesh::can_fill_at_boundary(Index vertex) const {
  if (on_rim(vertex) || !at_boundary(vertex)) return false;
  return !joined(origin(arriving_along_boundary(vertex)), target(leaving_along_boundary(vertex)));
}

Index PatchMesh::fill_at_boundary(Index vertex) {
  const Index in = arriving_along_boundary(vertex), out = leaving_along_boundary(vertex);
  const Index a = origin(in), b = target(out);
  const Index added = static_cast<Index>(triangles_.size());
  triangles_.push_back({a, b, vertex});
  opposite_.resize(opposite_.size() + 3, none);
  join(3 * added + 1, out);
  join(3 * added + 2, in);
  half_edge_of_[a] = 3 * added;
  return added;
}

bool PatchMesh::can_remove_ear(Index vertex) const {
  if (on_rim(vertex) || !at_boundary(vertex)) return false;
  const Index out = half_edge_of_[vertex];
  return opposite_[previous(out)] == none && opposite_[next(out)] != none;
}

void PatchMesh::remove_ear(Index vertex) {
  const Index out = half_edge_of_[vertex], base = next(out), beyond = opposite_[base];
  opposite_[beyond] = none;
  half_edge_of_[origin(beyond)] = beyond;
  triangles_[out / 3] = {none, none, none};
  half_edge_of_[vertex] = none;
}

void PatchMesh::compact() {
  std::vector<Index> number(positions_.size(), none);
  std::size_t kept = 0;
  for (Index v = 0; v < positions_.size(); ++v)
    if (vertex_alive(v) || on_rim(v)) {
      number[v] = static_cast<Index>(kept);
      positions_[kept++] = positions_[v];
    }
  positions_.resize(kept);
  triangles_.erase(
      std::remove_if(triangles_.begin(), triangles_.end(), [](const Triangle& t) { return t[0] == none; }),
      triangles_.end());
  for (Triangle& t : triangles_)
    for (Index& corner : t) corner = number[corner];
  connect();
}

}  // namespace meshcomplete
