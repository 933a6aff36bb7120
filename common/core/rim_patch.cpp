#include "common/core/rim_patch.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "common/core/patch_rounding.h"

namespace meshcomplete {
namespace {

constexpr Index none = PatchMesh::none;

// Passes over the Steiner points that are left: removing some makes room for others.
constexpr int most_passes = 16;

// How far from a Steiner point vertices are relaxed to make room.
constexpr int relaxed_rings = 2;

// Edges shorter than so many times the resolution of what is stored are too short.
constexpr double least_stored_edge = 16;

// The smallest part of the way into the patch by which a Steiner point is taken off its edge.
constexpr double smallest_lift = 1e-4;

// Where on the way from a Steiner point to its neighbours their edges are split.
constexpr double shrinking = 0.3;

// A sheet's boundary, walked as its triangles walk it: vertices of the sheet.
std::vector<std::vector<Index>> boundary_walks(const Sheet& sheet) {
  std::unordered_map<std::uint64_t, char> sides;
  const auto key = [](Index a, Index b) { return static_cast<std::uint64_t>(a) << 32 | b; };
  for (const Triangle& t : sheet.triangles)
    for (int k = 0; k < 3; ++k) sides[key(t[k], t[(k + 1) % 3])] = 1;
  std::vector<Index> next(sheet.vertices.size(), none);
  for (const Triangle& t : sheet.triangles)
    for (int k = 0; k < 3; ++k)
      if (!sides.count(key(t[(k + 1) % 3], t[k]))) next[t[k]] = t[(k + 1) % 3];
  std::vector<std::vector<Index>> walks;
  std::vector<char> seen(sheet.vertices.size(), 0);
  for (Index start = 0; start < sheet.vertices.size(); ++start) {
    // Begin at a vertex of the mesh: the Steiner points between two are left out of the loops.
    if (next[start] == none || seen[start] || sheet.vertices[start].input == SheetVertex::none) continue;
    walks.emplace_back();
    for (Index v = start; !seen[v]; v = next[v]) {
      seen[v] = 1;
      walks.back().push_back(v);
    }
  }
  return walks;
}

// The mesh's boundary half-edges by the vertex at their end: patches walk them the other way.
std::unordered_map<std::uint64_t, Index> faces_at_boundary(const TriangleMesh& mesh,
                                                           const std::vector<Index>& closes) {
  std::unordered_map<std::uint64_t, Index> faces;
  for (Index h : closes) {
    const Triangle& t = mesh.triangles[h / 3];
    faces[static_cast<std::uint64_t>(t[(h % 3 + 1) % 3]) << 32 | t[h % 3]] = h / 3;
  }
  return faces;
}

// The length below which edges may turn over when their ends are rounded to what will be stored.
double least_stored_length(const Vector3& a, const Vector3& b) {
  return least_stored_edge * std::max(stored_resolution(a), stored_resolution(b));
}

// Which boundary edge of the mesh each Steiner point of a patch lies on. Edges are known by the place in the
// rim where they begin.
class RimEdges {
 public:
  RimEdges(const PatchMesh& mesh, const Rim& rim)
      : mesh_(mesh), rim_(rim), edge_of_(mesh.vertex_count(), none) {
    for (Index place = 0; place < mesh.rim_size(); ++place)
      for (Index v = mesh.target(mesh.leaving_along_boundary(place)); !mesh.on_rim(v);
           v = mesh.target(mesh.leaving_along_boundary(v))) {
        edge_of_[v] = place;
        steiner_points_.push_back(v);
      }
  }

  const std::vector<Index>& steiner_points() const { return steiner_points_; }  // edge by edge, along the rim
  // Of a vertex at the boundary; of one on the rim the edge that begins there.
  Index edge_of(Index vertex) const { return mesh_.on_rim(vertex) ? vertex : edge_of_[vertex]; }
  bool on_edge(Index vertex, Index edge) const {
    return edge_of(vertex) == edge || (mesh_.on_rim(vertex) && vertex == rim_.next[edge]);
  }

 private:
  const PatchMesh& mesh_;
  const Rim& rim_;
  std::vector<Index> edge_of_;  // of Steiner points
  std::vector<Index> steiner_points_;
};

// Pockets: what an edge between two points of one boundary edge cuts off the patch, on the side of that edge.
// It lies over a stretch of a straight line, so that the patch does without it.
class PocketRemover {
 public:
  PocketRemover(PatchMesh& mesh, const Rim& rim) : mesh_(mesh), edges_(mesh, rim) {}

  // Returns whether there were any.
  bool run() {
    std::vector<char> gone(mesh_.triangle_count(), 0);
    bool any = false;
    for (Index h = 0; h < 3 * mesh_.triangle_count(); ++h)
      if (mesh_.alive(h / 3) && !mesh_.is_boundary(h) && !gone[h / 3]) any |= cut_off(h, gone);
    if (!any) return false;
    std::vector<Triangle> triangles;
    for (Index t = 0; t < mesh_.triangle_count(); ++t)
      if (mesh_.alive(t) && !gone[t]) triangles.push_back(mesh_.triangles()[t]);
    mesh_ = PatchMesh(mesh_.positions(), mesh_.rim_size(), std::move(triangles));
    mesh_.compact();
    return true;
  }

 private:
  // Takes out what the half-edge cuts off if it goes from a point of a boundary edge to an earlier one.
  bool cut_off(Index h, std::vector<char>& gone) const {
    const Index from = mesh_.target(h), to = mesh_.origin(h);
    if (!mesh_.at_boundary(from) || !mesh_.at_boundary(to)) return false;
    const Index edge = edges_.edge_of(from);
    if (!edges_.on_edge(to, edge) || to == edge) return false;
    std::size_t path = 0;
    for (Index v = from; v != to; ++path) {
      if (v != from && mesh_.on_rim(v)) return false;
      v = mesh_.target(mesh_.leaving_along_boundary(v));
    }
    // The half-edge closes the path to a loop round the pocket.
    std::vector<Index> pocket = {h / 3};
    std::unordered_set<Index> seen = {h / 3};
    std::size_t boundary = 0;
    for (std::size_t i = 0; i < pocket.size() && boundary <= path; ++i)
      for (Index side = 3 * pocket[i]; side < 3 * pocket[i] + 3; ++side) {
        const Index other = mesh_.opposite(side);
        if (other == none)
          ++boundary;
        else if (side != h && seen.insert(other / 3).second)
          pocket.push_back(other / 3);
      }
    if (boundary != path) return false;
    for (Index t : pocket) gone[t] = 1;
    return true;
  }

  PatchMesh& mesh_;
  const RimEdges edges_;
};

// Collapses the edges that are too short to be stored, as far as the patch stays a manifold: towards the rim,
// then towards Steiner points. What that tangles is so small that hardly anything is, and it is mended later.
void remove_short_edges(PatchMesh& mesh) {
  bool any = true;
  while (any) {
    any = false;
    for (Index h = 0; h < 3 * mesh.triangle_count(); ++h) {
      if (!mesh.alive(h / 3)) continue;
      const Index a = mesh.origin(h), b = mesh.target(h);
      if (mesh.can_remove_ear(a)) {
        mesh.remove_ear(a);
        any = true;
        continue;
      }
      if (mesh.length(h) >= least_stored_length(mesh.position(a), mesh.position(b))) continue;
      if (mesh.is_boundary(h)) {
        for (const bool onto_target : {true, false})
          if (mesh.alive(h / 3) && mesh.can_collapse_at_boundary(h, onto_target)) {
            mesh.collapse_at_boundary(h, onto_target);
            any = true;
          }
      } else if (!mesh.at_boundary(a) && mesh.can_collapse(h)) {
        mesh.collapse(h);
        any = true;
      }
    }
  }
  mesh.compact();
}

class SteinerRemover {
 public:
  SteinerRemover(RimPatch& patch, const InputNeighbourhood& input,
                 const std::vector<std::array<Vector3, 3>>& obstacles)
      : mesh_(patch.mesh),
        obstacles_(obstacles),
        guarded_(patch.mesh, input, patch.rim.forbidden, obstacles),
        edges_(patch.mesh, patch.rim),
        steiner_(edges_.steiner_points()),
        previous_(patch.mesh.rim_size()) {
    for (Index steiner : steiner_) guarded_.rest(steiner, patch.rim_faces[edges_.edge_of(steiner)]);
    for (Index place = 0; place < mesh_.rim_size(); ++place) previous_[patch.rim.next[place]] = place;
  }

  std::size_t run(const Progress& progress);

 private:
  bool makes_chord(Index gone, Index kept) const;
  bool collapse(Index steiner);
  bool flip_one(Index steiner);
  void shrink_fan(Index steiner);
  void relax_around(Index steiner);
  bool lift(Index steiner);
  bool force(Index steiner);

  PatchMesh& mesh_;
  const std::vector<std::array<Vector3, 3>>& obstacles_;
  GuardedPatch guarded_;
  const RimEdges edges_;
  std::vector<Index> steiner_;   // that are left
  std::vector<Index> previous_;  // along the rim
};

// Whether an edge would join two points of one boundary edge of the mesh without being part of it. The
// point's two neighbours along the boundary go on being such.
bool SteinerRemover::makes_chord(Index gone, Index kept) const {
  bool chord = false;
  mesh_.for_outgoing(gone, [&](Index out) {
    const Index v = mesh_.target(out);
    if (v == kept || mesh_.is_boundary(out) || !mesh_.at_boundary(v)) return;
    if (mesh_.on_rim(kept))
      chord |= edges_.on_edge(v, kept) || edges_.on_edge(v, previous_[kept]);
    else
      chord |= edges_.on_edge(v, edges_.edge_of(kept));
  });
  return chord;
}

// A point with a single triangle, whose corners are all on one edge of the rim, goes with that triangle.
bool SteinerRemover::collapse(Index steiner) {
  if (guarded_.remove_ear(steiner)) return true;
  const Index out = mesh_.leaving_along_boundary(steiner), in = mesh_.arriving_along_boundary(steiner);
  const bool forward_first = mesh_.length(out) < mesh_.length(in);
  for (bool forward : {forward_first, !forward_first}) {
    const Index kept = forward ? mesh_.target(out) : mesh_.origin(in);
    if (!makes_chord(steiner, kept) && guarded_.collapse_at_boundary(forward ? out : in, forward))
      return true;
  }
  return false;
}

// Takes an inner edge away from the point: with a single one left its two triangles are one but for rounding.
bool SteinerRemover::flip_one(Index steiner) {
  std::vector<Index> edges;
  mesh_.for_outgoing(steiner, [&](Index out) {
    if (!mesh_.is_boundary(out)) edges.push_back(out);
  });
  if (edges.size() < 2) return false;
  for (Index h : edges) {
    const Index c = mesh_.apex(h), d = mesh_.apex(mesh_.opposite(h));
    if (mesh_.at_boundary(c) && mesh_.at_boundary(d)) {
      const Index e = edges_.edge_of(c), f = edges_.edge_of(d);
      if (edges_.on_edge(c, f) || edges_.on_edge(d, e) ||
          (mesh_.on_rim(c) && edges_.on_edge(d, previous_[c])))
        continue;
    }
    if (guarded_.flip(h)) return true;
  }
  return false;
}

// Splits the inner edges near the point: small triangles sweep over less when it moves along the rim, and a
// neighbour that it shares with the end of its edge is none any more.
void SteinerRemover::shrink_fan(Index steiner) {
  std::vector<Index> neighbours;
  mesh_.for_outgoing(steiner, [&](Index out) {
    if (!mesh_.is_boundary(out)) neighbours.push_back(mesh_.target(out));
  });
  for (Index v : neighbours) {
    Index h = none;
    mesh_.for_outgoing(steiner, [&](Index out) {
      if (mesh_.target(out) == v) h = out;
    });
    if (h == none) continue;
    const Vector3& here = mesh_.position(steiner);
    guarded_.split(h, here + shrinking * (mesh_.position(v) - here));
  }
}

// Moves the inner vertices near the point towards the middle of their neighbours, off the stairs that are in
// the way.
void SteinerRemover::relax_around(Index steiner) {
  std::vector<Index> near = {steiner};
  std::size_t first = 0;
  for (int ring = 0; ring < relaxed_rings; ++ring) {
    const std::size_t last = near.size();
    for (; first < last; ++first)
      mesh_.for_neighbours(near[first], [&](Index v) {
        if (std::find(near.begin(), near.end(), v) == near.end()) near.push_back(v);
      });
  }
  for (Index v : near) {
    if (mesh_.at_boundary(v)) continue;
    Vector3 sum = Vector3::Zero();
    double count = 0;
    mesh_.for_neighbours(v, [&](Index w) {
      sum += mesh_.position(w);
      ++count;
    });
    const Vector3 here = mesh_.position(v), goal = sum / count;
    if (!guarded_.move(v, goal)) guarded_.move(v, 0.5 * (here + goal));
  }
}

// Takes the point off its edge, a little towards the middle of the patch or one of the point's neighbours,
// and puts a thin triangle between it and the edge: a small change, which hardly anything can be in the way
// of.
bool SteinerRemover::lift(Index steiner) {
  const Vector3 here = mesh_.position(steiner);
  std::vector<Vector3> ways = {Vector3::Zero()};
  mesh_.for_outgoing(steiner, [&](Index out) {
    const Index t = out / 3;
    const auto& [a, b, c] = mesh_.triangles()[t];
    const Vector3 way = (mesh_.position(a) + mesh_.position(b) + mesh_.position(c)) / 3 - here;
    ways.push_back(way);
    ways.front() += way;
    if (!mesh_.is_boundary(out)) ways.push_back(mesh_.position(mesh_.target(out)) - here);
  });
  for (double part = 0.5; part > smallest_lift; part *= 0.25)
    for (const Vector3& way : ways)
      if (guarded_.fill_at_boundary(steiner, here + part * way)) return true;
  return false;
}

// Takes the point off the boundary in any way that leaves a manifold. The guard does not know of it.
bool SteinerRemover::force(Index steiner) {
  if (mesh_.can_remove_ear(steiner)) {
    mesh_.remove_ear(steiner);
    return true;
  }
  const Index out = mesh_.leaving_along_boundary(steiner), in = mesh_.arriving_along_boundary(steiner);
  for (const bool forward : {true, false}) {
    const Index h = forward ? out : in, kept = forward ? mesh_.target(out) : mesh_.origin(in);
    if (makes_chord(steiner, kept) || !mesh_.can_collapse_at_boundary(h, forward)) continue;
    mesh_.collapse_at_boundary(h, forward);
    return true;
  }
  if (!mesh_.can_fill_at_boundary(steiner)) return false;
  const Triangle& t = mesh_.triangles()[out / 3];
  const Vector3 middle = (mesh_.position(t[0]) + mesh_.position(t[1]) + mesh_.position(t[2])) / 3;
  mesh_.move(steiner, as_stored(0.5 * (mesh_.position(steiner) + middle)));
  mesh_.fill_at_boundary(steiner);
  return true;
}

std::size_t SteinerRemover::run(const Progress& progress) {
  std::vector<Index> unrounded;
  for (Index v = static_cast<Index>(mesh_.rim_size()); v < mesh_.vertex_count(); ++v)
    if (edges_.edge_of(v) == none && mesh_.vertex_alive(v) &&
        as_stored(mesh_.position(v)) != mesh_.position(v))
      unrounded.push_back(v);
  round_vertices(mesh_, guarded_, unrounded, progress);
  for (int pass = 0; pass < most_passes && !steiner_.empty(); ++pass) {
    std::vector<Index> left;
    for (Index steiner : steiner_) {
      bool gone = collapse(steiner);
      // Flips only when collapses alone have come to an end, and new vertices only when flips have.
      for (bool flipped = pass > 0; !gone && flipped;) {
        flipped = flip_one(steiner);
        gone = flipped && collapse(steiner);
      }
      if (!gone && pass > 1) {
        if (pass > 2) relax_around(steiner);
        if (pass % 2 == 0) shrink_fan(steiner);
        gone = collapse(steiner) || (pass > 2 && lift(steiner));
      }
      if (!gone) left.push_back(steiner);
      progress.check();
    }
    steiner_ = std::move(left);
  }
  // Where the patch meets something at the rim already no guarded step is left. What follows may meet more;
  // it is for those who finish the patch to mend.
  steiner_.erase(
      std::remove_if(steiner_.begin(), steiner_.end(), [&](Index steiner) { return force(steiner); }),
      steiner_.end());
  return steiner_.size();
}

}  // namespace

RimPatch make_rim_patch(const TriangleMesh& mesh, const MeshTopology& topology, const Sheet& sheet) {
  const auto faces = faces_at_boundary(mesh, sheet.closes);
  std::vector<BoundaryLoop> loops;
  std::vector<Index> rim_vertices, rim_faces, order, local(sheet.vertices.size(), none);
  for (const std::vector<Index>& walk : boundary_walks(sheet)) {
    BoundaryLoop loop;
    for (Index v : walk) {
      if (sheet.vertices[v].input == SheetVertex::none) continue;
      local[v] = static_cast<Index>(order.size());
      order.push_back(v);
      loop.vertices.push_back(sheet.vertices[v].input);
    }
    for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
      const Index from = loop.vertices[i], to = loop.vertices[(i + 1) % loop.vertices.size()];
      loop.faces.push_back(faces.at(static_cast<std::uint64_t>(from) << 32 | to));
    }
    rim_vertices.insert(rim_vertices.end(), loop.vertices.begin(), loop.vertices.end());
    rim_faces.insert(rim_faces.end(), loop.faces.begin(), loop.faces.end());
    loops.push_back(std::move(loop));
  }
  for (Index v = 0; v < local.size(); ++v)
    if (local[v] == none) {
      local[v] = static_cast<Index>(order.size());
      order.push_back(v);
    }
  // What will stay is rounded to what will be stored; Steiner points are as exact as they can be, and where
  // planes cut convex cells so is all.
  const bool cut = std::any_of(sheet.vertices.begin(), sheet.vertices.end(),
                               [](const SheetVertex& one) { return one.cut; });
  std::vector<Vector3> positions;
  for (Index v : order) positions.push_back(sheet.vertices[v].position);
  std::vector<Triangle> triangles = sheet.triangles;
  for (Triangle& t : triangles)
    for (Index& corner : t) corner = local[corner];
  Rim rim = collect_rim(mesh, topology, loops);
  PatchMesh patch(std::move(positions), rim_vertices.size(), std::move(triangles));
  if (!cut) {
    do remove_short_edges(patch);
    while (PocketRemover(patch, rim).run());
    for (Index v = static_cast<Index>(patch.rim_size()); v < patch.vertex_count(); ++v)
      if (!patch.at_boundary(v)) patch.move(v, as_stored(patch.position(v)));
  }
  return {std::move(loops), std::move(rim_vertices), std::move(rim_faces),
          std::move(rim),   std::move(patch),        0};
}

std::size_t remove_steiner_points(RimPatch& patch, const InputNeighbourhood& input,
                                  const std::vector<std::array<Vector3, 3>>& obstacles,
                                  const Progress& progress) {
  patch.steiner_points = SteinerRemover(patch, input, obstacles).run(progress);
  return patch.steiner_points;
}

Patch as_patch(const PatchMesh& patch, const std::vector<Index>& rim_vertices, const TriangleMesh& mesh) {
  Patch result;
  result.input_vertices = static_cast<Index>(mesh.vertices.size());
  std::vector<Index> number = rim_vertices;
  number.resize(patch.vertex_count(), none);
  for (Index v = static_cast<Index>(patch.rim_size()); v < patch.vertex_count(); ++v) {
    if (!patch.vertex_alive(v)) continue;
    number[v] = result.input_vertices + static_cast<Index>(result.vertices.size());
    result.vertices.push_back(as_stored(patch.position(v)));
  }
  for (Index t = 0; t < patch.triangle_count(); ++t) {
    if (!patch.alive(t)) continue;
    const Triangle& corners = patch.triangles()[t];
    result.triangles.push_back({number[corners[0]], number[corners[1]], number[corners[2]]});
  }
  return result;
}

}  // namespace meshcomplete
