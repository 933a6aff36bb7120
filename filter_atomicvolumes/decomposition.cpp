#include "filter_atomicvolumes/decomposition.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "common/core/error.h"
#include "common/core/threads.h"
#include "filter_atomicvolumes/crossed_cube.h"

namespace meshcomplete {
namespace {

// So many triangles are handed on from a cube to its parts, so that these need not look for them in the whole
// mesh.
constexpr std::size_t most_handed_on = 512;

using Triangles = std::shared_ptr<const std::vector<Index>>;

// A cube to be looked at, with the part of the boundary that meets it.
struct Pending {
  Index cube;
  std::vector<Index> vertices, edges;  // boundary vertices in it, boundary half-edges that meet it
  bool split = false;                  // whatever it holds
  Triangles near = nullptr;            // all triangles that meet it, and others; null when not known
};

struct Verdict {
  bool split = false;
  Volume volume;
  Triangles near = nullptr;  // of a cube that is split
};

class Decomposer {
 public:
  Decomposer(const LatticeMesh& mesh, const DecompositionOptions& options, Decomposition& result)
      : mesh_(mesh), options_(options), result_(result) {}

  void run(std::vector<Pending> level, const Progress& progress);
  Pending whole() const;
  Pending at(Index leaf) const;

 private:
  template <class Visit>
  void triangles_in(const Pending& pending, const LatticeBox& box, Visit&& visit) const;
  Triangles near(const Pending& pending) const;
  Verdict judge(const Pending& pending) const;
  Verdict judge_hole(const Pending& pending, const LatticeBox& box) const;
  std::array<Pending, 8> divide(const Pending& parent, const Triangles& near, Index first_child) const;

  const LatticeMesh& mesh_;
  const DecompositionOptions& options_;
  Decomposition& result_;
};

Pending Decomposer::whole() const {
  Pending root;
  root.cube = 0;
  root.edges = mesh_.topology.boundary_half_edges;
  for (Index h : root.edges) {
    root.vertices.push_back(mesh_.origin(h));
    root.vertices.push_back(mesh_.target(h));
  }
  std::sort(root.vertices.begin(), root.vertices.end());
  root.vertices.erase(std::unique(root.vertices.begin(), root.vertices.end()), root.vertices.end());
  return root;
}

// Of a leaf that exists already.
Pending Decomposer::at(Index leaf) const {
  Pending pending;
  pending.cube = leaf;
  const LatticeBox box = result_.octree.box(leaf);
  for (Index t : result_.volumes[leaf].triangles)
    for (Index h = 3 * t; h < 3 * t + 3; ++h) {
      if (mesh_.topology.opposite[h] != MeshTopology::boundary) continue;
      const Index a = mesh_.origin(h), b = mesh_.target(h);
      const LatticePoint pa = mesh_.vertex(a), pb = mesh_.vertex(b);
      if (meets(pa, pb, box)) pending.edges.push_back(h);
      if (box.contains(pa)) pending.vertices.push_back(a);
      if (box.contains(pb)) pending.vertices.push_back(b);
    }
  std::sort(pending.vertices.begin(), pending.vertices.end());
  pending.vertices.erase(std::unique(pending.vertices.begin(), pending.vertices.end()),
                         pending.vertices.end());
  pending.split = true;
  return pending;
}

// Calls `visit` for every triangle that meets the cube until it returns false.
template <class Visit>
void Decomposer::triangles_in(const Pending& pending, const LatticeBox& box, Visit&& visit) const {
  if (!pending.near) {
    mesh_.triangles_in(box, [&](Index t, const LatticeTriangle&) { return visit(t); });
    return;
  }
  for (Index t : *pending.near)
    if (meets(mesh_.triangle(t), box) && !visit(t)) return;
}

// The triangles of a cube for its parts; null when they are too many.
Triangles Decomposer::near(const Pending& pending) const {
  auto list = std::make_shared<std::vector<Index>>();
  triangles_in(pending, result_.octree.box(pending.cube), [&](Index t) {
    list->push_back(t);
    return list->size() <= most_handed_on;
  });
  return list->size() <= most_handed_on ? list : nullptr;
}

Verdict Decomposer::judge_hole(const Pending& pending, const LatticeBox& box) const {
  Verdict verdict;
  Volume& volume = verdict.volume;
  const bool at_vertex = pending.vertices.size() == 1;
  volume.kind = at_vertex ? VolumeKind::vertex : VolumeKind::edge;
  volume.apex = at_vertex ? pending.vertices.front() : pending.edges.front();
  bool trivial = pending.vertices.size() <= 1 && (at_vertex || pending.edges.size() == 1);
  if (at_vertex)
    for (Index h : pending.edges) trivial &= mesh_.origin(h) == volume.apex || mesh_.target(h) == volume.apex;
  const bool last = result_.octree[pending.cube].depth >= options_.max_depth;
  if (!trivial && !last) {
    verdict.split = true;
    return verdict;
  }
  triangles_in(pending, box, [&](Index t) {
    volume.triangles.push_back(t);
    const Triangle& corners = mesh_.mesh.triangles[t];
    trivial &= at_vertex ? std::find(corners.begin(), corners.end(), volume.apex) != corners.end()
                         : t == volume.apex / 3;
    return trivial || last;
  });
  std::sort(volume.triangles.begin(), volume.triangles.end());
  if (trivial) return verdict;
  verdict.split = !last;
  volume.kind = VolumeKind::unresolved;
  return verdict;
}

Verdict Decomposer::judge(const Pending& pending) const {
  const LatticeBox box = result_.octree.box(pending.cube);
  const bool last = result_.octree[pending.cube].depth >= options_.max_depth;
  Verdict verdict;
  if (!last && pending.split) {
    verdict.split = true;
    return verdict;
  }
  if (!pending.edges.empty()) return judge_hole(pending, box);
  triangles_in(pending, box, [&](Index t) {
    verdict.volume.triangles.push_back(t);
    return true;
  });
  if (verdict.volume.triangles.empty()) return verdict;
  std::sort(verdict.volume.triangles.begin(), verdict.volume.triangles.end());
  verdict.volume.kind = VolumeKind::crossed;
  if (box.high[0] - box.low[0] <= options_.least_contradiction) return verdict;
  if (sides_agree(mesh_, verdict.volume.triangles, box)) return verdict;
  verdict.split = !last;
  if (last) verdict.volume.kind = VolumeKind::unresolved;
  return verdict;
}

std::array<Pending, 8> Decomposer::divide(const Pending& parent, const Triangles& near,
                                          Index first_child) const {
  std::array<Pending, 8> children;
  for (Index place = 0; place < 8; ++place) {
    Pending& child = children[place];
    child.cube = first_child + place;
    child.near = near;
    const LatticeBox box = result_.octree.box(child.cube);
    for (Index v : parent.vertices)
      if (box.contains(mesh_.vertex(v))) child.vertices.push_back(v);
    for (Index h : parent.edges)
      if (meets(mesh_.vertex(mesh_.origin(h)), mesh_.vertex(mesh_.target(h)), box)) child.edges.push_back(h);
  }
  return children;
}

// Level by level: a level's cubes are judged in threads, and split one after the other, so that their numbers
// do not depend on the threads.
void Decomposer::run(std::vector<Pending> level, const Progress& progress) {
  double done = 0;
  while (!level.empty()) {
    std::vector<Verdict> verdicts(level.size());
    for_each(level.size(), 1, progress, [&](std::size_t i) {
      verdicts[i] = judge(level[i]);
      if (verdicts[i].split) verdicts[i].near = near(level[i]);
    });
    std::vector<Pending> next;
    for (std::size_t i = 0; i < level.size(); ++i) {
      const Index cube = level[i].cube;
      if (!verdicts[i].split) {
        result_.volumes[cube] = std::move(verdicts[i].volume);
        continue;
      }
      if (result_.octree.size() + 8 > options_.cube_budget)
        throw CompletionError(
            "dividing space",
            "The octree would need more than " + std::to_string(options_.cube_budget) +
                " cubes. Raise NodeBudget, set MaxDepth, or remove faces that touch or intersect each "
                "other near the holes.");
      result_.volumes[cube] = Volume();
      const Index first = result_.octree.split(cube);
      result_.volumes.resize(result_.octree.size());
      for (Pending& child : divide(level[i], verdicts[i].near, first)) next.push_back(std::move(child));
    }
    level = std::move(next);
    done += 0.5 * (1 - done);
    progress.update(done);
  }
}

}  // namespace

Decomposition decompose(const LatticeMesh& mesh, const DecompositionOptions& options,
                        const Progress& progress) {
  Decomposition result;
  result.volumes.resize(1);
  Decomposer decomposer(mesh, options, result);
  decomposer.run({decomposer.whole()}, progress);
  return result;
}

bool split_further(Decomposition& decomposition, const LatticeMesh& mesh, const DecompositionOptions& options,
                   const std::vector<Index>& leaves, const Progress& progress) {
  Decomposer decomposer(mesh, options, decomposition);
  std::vector<Pending> level;
  for (Index leaf : leaves)
    if (decomposition.octree[leaf].depth < options.max_depth) level.push_back(decomposer.at(leaf));
  const bool any = !level.empty();
  decomposer.run(std::move(level), progress);
  return any;
}

}  // namespace meshcomplete
