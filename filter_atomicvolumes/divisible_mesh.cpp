#include "filter_atomicvolumes/divisible_mesh.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "common/core/triangle_intersection.h"

namespace meshcomplete {
namespace {

// Leaving a face out makes new rims, where other faces may be in the way in turn. Meshes in which that goes
// on intersect themselves all over.
constexpr int most_rounds = 16;

class Preparation {
 public:
  Preparation(const TriangleMesh& mesh, const MeshTopology& topology, const InputNeighbourhood& neighbourhood)
      : mesh_(mesh),
        topology_(topology),
        neighbourhood_(neighbourhood),
        at_rim_(mesh.vertices.size(), 0),
        rim_edges_(mesh.triangles.size(), 0) {
    for (Index h : topology.boundary_half_edges) {
      rim_edges_[h / 3] = static_cast<char>(rim_edges_[h / 3] | 1 << h % 3);
      for (Index v : {mesh.triangles[h / 3][h % 3], mesh.triangles[h / 3][(h % 3 + 1) % 3]}) at_rim_[v] = 1;
    }
  }

  std::unique_ptr<DivisibleMesh> run(const Progress& progress);

 private:
  std::array<Vector3, 3> corners(Index t) const {
    const Triangle& c = mesh_.triangles[t];
    return {mesh_.vertices[c[0]], mesh_.vertices[c[1]], mesh_.vertices[c[2]]};
  }
  static bool repeats(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }
  Index same(Index v) const;
  bool meet_at_rim(Index a, Index b) const;
  bool is_flat_at_rim(Index face) const;
  bool is_expendable(Index a, Index b) const;
  std::vector<Index> faces_at_rims() const;
  bool is_left_out(Index face) const { return std::binary_search(left_out_.begin(), left_out_.end(), face); }
  void leave_out(const std::vector<Index>& faces);
  std::vector<Index> folded(const std::vector<Index>& faces) const;
  std::vector<Index> in_the_way() const;
  void list_coincident_vertices();

  const TriangleMesh& mesh_;
  const MeshTopology& topology_;
  const InputNeighbourhood& neighbourhood_;
  std::vector<char> at_rim_;                   // per vertex
  std::vector<char> rim_edges_;                // per face: which of its edges are on a rim, a bit each
  std::vector<Index> left_out_;                // ascending
  std::vector<std::pair<Index, Index>> same_;  // rim vertices, and the first one at their position; ascending
};

// The faces with a corner on a rim.
std::vector<Index> Preparation::faces_at_rims() const {
  std::vector<Index> faces;
  for (Index t = 0; t < mesh_.triangles.size(); ++t) {
    const Triangle& c = mesh_.triangles[t];
    if ((at_rim_[c[0]] || at_rim_[c[1]] || at_rim_[c[2]]) && !repeats(c) && !is_left_out(t))
      faces.push_back(t);
  }
  return faces;
}

Index Preparation::same(Index v) const {
  const auto found = std::lower_bound(same_.begin(), same_.end(), std::make_pair(v, Index{0}));
  return found != same_.end() && found->first == v ? found->second : v;
}

bool Preparation::meet_at_rim(Index a, Index b) const {
  for (Index v : mesh_.triangles[a])
    for (Index w : mesh_.triangles[b])
      if (at_rim_[v] && same(v) == same(w)) return true;
  return false;
}

// Whether a face without area has its longest side on a rim: without the face the rim is at the same place.
bool Preparation::is_flat_at_rim(Index face) const {
  if (!rim_edges_[face]) return false;
  const std::array<Vector3, 3> p = corners(face);
  if (!p[0].allFinite() || !p[1].allFinite() || !p[2].allFinite() || !collinear(p[0], p[1], p[2]))
    return false;
  int longest = 0;
  for (int k = 1; k < 3; ++k)
    if ((p[(k + 1) % 3] - p[k]).norm() > (p[(longest + 1) % 3] - p[longest]).norm()) longest = k;
  return rim_edges_[face] == 1 << longest;
}

// Whether the first one is to go: that without an edge on a rim, which the patch has to meet; else the one
// with fewer corners on rims, which leaves the rims as they are.
bool Preparation::is_expendable(Index a, Index b) const {
  if (rim_edges_[a] || rim_edges_[b]) return !rim_edges_[a];
  const auto on_rims = [&](Index t) {
    const Triangle& c = mesh_.triangles[t];
    return at_rim_[c[0]] + at_rim_[c[1]] + at_rim_[c[2]];
  };
  return on_rims(a) < on_rims(b);
}

// Faces to leave out because they meet another one at a rim vertex, or have no area at a rim; ascending.
std::vector<Index> Preparation::folded(const std::vector<Index>& faces) const {
  std::vector<char> gone(faces.size(), 0);
  std::vector<std::array<Vector3, 3>> triangles;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    triangles.push_back(corners(faces[i]));
    gone[i] = is_flat_at_rim(faces[i]);
  }
  for (const auto& [i, j] : improper_pairs(triangles)) {
    const Index a = faces[i], b = faces[j];
    if (gone[i] || gone[j] || !meet_at_rim(a, b) || (rim_edges_[a] && rim_edges_[b])) continue;
    gone[is_expendable(a, b) ? i : j] = 1;
  }
  std::vector<Index> list;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (gone[i]) list.push_back(faces[i]);
  return list;
}

// Faces to leave out because they border on ones that are, and meet others there; ascending. So the gap grows
// along the line in which the mesh meets itself, to its end.
std::vector<Index> Preparation::in_the_way() const {
  std::vector<Index> list;
  for (Index face : left_out_)
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      const Index opposite = topology_.opposite[h], beside = opposite / 3;
      if (opposite >= MeshTopology::non_manifold || is_left_out(beside)) continue;
      for (Index met : input_triangles_met(neighbourhood_, corners(beside))) {
        if (met == beside || is_left_out(met) || repeats(mesh_.triangles[met])) continue;
        if (!rim_edges_[beside])
          list.push_back(beside);
        else if (!rim_edges_[met])
          list.push_back(met);
      }
    }
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

void Preparation::leave_out(const std::vector<Index>& faces) {
  left_out_.insert(left_out_.end(), faces.begin(), faces.end());
  std::sort(left_out_.begin(), left_out_.end());
}

void Preparation::list_coincident_vertices() {
  std::vector<Index> rim;
  for (Index h : topology_.boundary_half_edges)
    for (int end = 0; end < 2; ++end) {
      const Index v = mesh_.triangles[h / 3][(h % 3 + static_cast<Index>(end)) % 3];
      if (mesh_.vertices[v].allFinite()) rim.push_back(v);
    }
  std::sort(rim.begin(), rim.end(), [&](Index a, Index b) {
    const Vector3 &p = mesh_.vertices[a], &q = mesh_.vertices[b];
    return std::tie(p[0], p[1], p[2], a) < std::tie(q[0], q[1], q[2], b);
  });
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  for (std::size_t i = 1, first = 0; i < rim.size(); ++i) {
    if (mesh_.vertices[rim[i]] != mesh_.vertices[rim[first]])
      first = i;
    else
      same_.emplace_back(rim[i], rim[first]);
  }
  std::sort(same_.begin(), same_.end());
}

std::unique_ptr<DivisibleMesh> Preparation::run(const Progress& progress) {
  list_coincident_vertices();
  leave_out(folded(faces_at_rims()));
  for (int round = 0; round < most_rounds; ++round) {
    progress.check();
    const std::vector<Index> more = in_the_way();
    if (more.empty()) break;
    leave_out(more);
  }
  if (left_out_.empty() && same_.empty()) return nullptr;
  TriangleMesh changed = mesh_;
  for (Index t : left_out_) changed.triangles[t].fill(changed.triangles[t][0]);
  if (!same_.empty())
    for (Triangle& t : changed.triangles)
      for (Index& v : t)
        if (at_rim_[v]) v = same(v);
  progress.check();
  auto result = std::make_unique<DivisibleMesh>(std::move(changed));
  result->left_out = std::move(left_out_);
  result->merged = !same_.empty();
  return result;
}

}  // namespace

std::unique_ptr<DivisibleMesh> make_divisible(const TriangleMesh& mesh, const MeshTopology& topology,
                                              const InputNeighbourhood& neighbourhood,
                                              const Progress& progress) {
  return Preparation(mesh, topology, neighbourhood).run(progress);
}

}  // namespace meshcomplete
