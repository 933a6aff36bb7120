#include "filter_volmorph/triangle_fan.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/box_tree.h"
#include "common/core/counted.h"
#include "common/core/hole_targets.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch_check.h"
#include "common/core/rim.h"
#include "common/core/stage_clock.h"
#include "common/core/threads.h"
#include "common/core/triangle_intersection.h"
#include "filter_volmorph/rim_fan.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;

// What closes one hole, or why nothing does.
struct Filling {
  Patch patch;
  std::string route, reason;
};

Patch one_triangle(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  Patch patch;
  patch.input_vertices = static_cast<Index>(mesh.vertices.size());
  patch.triangles.push_back({loop.vertices[0], loop.vertices[1], loop.vertices[2]});
  return patch;
}

std::string reason_for(PatchDefect defect, const InputNeighbourhood& input, const BoundaryLoop& loop) {
  if (defect != PatchDefect::meets_input) return describe(defect);
  const std::size_t edges = obstructed_edges(input, loop).size();
  if (edges == 0) return describe(defect);
  return "other faces of the mesh pass through " + counted(edges, "edge", "edges") +
         " of this rim, so that every patch would meet them; apply 'Select Self Intersecting Faces' and "
         "delete "
         "them first";
}

Filling fill(const InputNeighbourhood& input, const BoundaryLoop& loop, const Progress& progress) {
  Filling filling{rim_fan(input.mesh(), loop), "fan", {}};
  const PatchDefect defect = check_patch(input, filling.patch, {&loop}, progress).defect;
  if (defect == PatchDefect::none) return filling;
  if (loop.vertices.size() == 3) {
    filling = {one_triangle(input.mesh(), loop), "single triangle", {}};
    if (check_patch(input, filling.patch, {&loop}, progress).passed()) return filling;
  }
  return {Patch(), {}, reason_for(defect, input, loop)};
}

std::vector<Box> reordered(const std::vector<Box>& boxes, const std::vector<Index>& order) {
  std::vector<Box> result;
  result.reserve(order.size());
  for (const Index i : order) result.push_back(boxes[i]);
  return result;
}

// Triangles, none of them degenerate, that others are held against.
class TriangleTree {
 public:
  explicit TriangleTree(const std::vector<Corners>& triangles) {
    std::vector<Box> boxes;
    for (const Corners& t : triangles) boxes.push_back(bounding_box(t[0], t[1], t[2]));
    const std::vector<Index> order = spatial_order(boxes);
    for (const Index i : order) triangles_.push_back(triangles[i]);
    tree_ = BoxTree(reordered(boxes, order));
  }

  bool meets(const std::vector<Corners>& others, const Progress& progress) const {
    for (const Corners& t : others) {
      progress.check();
      const Box box = bounding_box(t[0], t[1], t[2]);
      if (!tree_.visit(box, [&](std::size_t i) { return !meet_improperly(t, triangles_[i]); })) return true;
    }
    return false;
  }

 private:
  std::vector<Corners> triangles_;
  BoxTree tree_;
};

// The fans of one run, each sound by itself, and which of them can be together.
class Fans {
 public:
  Fans(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops, std::vector<HoleReport>& holes)
      : mesh_(mesh), loops_(loops), holes_(holes), fillings_(loops.size()) {}

  void fill_all(const Progress& progress);
  void separate(const Progress& progress);
  Patch finish();

 private:
  std::vector<std::size_t> by_preference() const;
  std::vector<Corners> triangles(std::size_t hole) const;

  const TriangleMesh& mesh_;
  const std::vector<BoundaryLoop>& loops_;
  std::vector<HoleReport>& holes_;
  std::vector<Filling> fillings_;
};

void Fans::fill_all(const Progress& progress) {
  std::vector<std::size_t> todo;
  double edges = 0;
  for (std::size_t i = 0; i < loops_.size(); ++i)
    if (is_targeted(holes_[i])) {
      todo.push_back(i);
      edges += static_cast<double>(loops_[i].vertices.size());
    }
  if (todo.empty()) return;
  // Long rims first, so that no thread is left alone with the longest.
  std::stable_sort(todo.begin(), todo.end(), [&](std::size_t a, std::size_t b) {
    return loops_[a].vertices.size() > loops_[b].vertices.size();
  });
  const InputNeighbourhood input(mesh_);
  const Progress within = progress.part(0, 0, "closing holes");
  for_each(todo.size(), 1, progress, [&](std::size_t i) {
    const BoundaryLoop& loop = loops_[todo[i]];
    fillings_[todo[i]] = fill(input, loop, within);
    progress.advance(static_cast<double>(loop.vertices.size()) / edges);
  });
}

std::vector<std::size_t> Fans::by_preference() const {
  std::vector<std::size_t> filled;
  for (std::size_t i = 0; i < fillings_.size(); ++i)
    if (!fillings_[i].patch.empty()) filled.push_back(i);
  std::stable_sort(filled.begin(), filled.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(holes_[a].edges, holes_[a].perimeter) < std::tie(holes_[b].edges, holes_[b].perimeter);
  });
  return filled;
}

std::vector<Corners> Fans::triangles(std::size_t hole) const {
  std::vector<Corners> list;
  for (const Triangle& t : fillings_[hole].patch.triangles)
    list.push_back(corners(mesh_, fillings_[hole].patch, t));
  return list;
}

// Of fans that meet, the one that comes first in the order of preference stays. (Each is held against all
// before it, which have fewer edges: what is built for it is built once, however many these are.)
void Fans::separate(const Progress& progress) {
  const std::vector<std::size_t> filled = by_preference();
  std::vector<Box> boxes;
  for (const std::size_t hole : filled) {
    progress.check();
    Box box;
    for (const Corners& t : triangles(hole)) box.include(bounding_box(t[0], t[1], t[2]));
    boxes.push_back(box);
  }
  const std::vector<Index> order = spatial_order(boxes);
  const BoxTree tree(reordered(boxes, order));
  for (std::size_t i = 0; i < filled.size(); ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(filled.size()));
    const Patch& patch = fillings_[filled[i]].patch;
    std::optional<TriangleTree> fan;
    bool free = true;
    tree.visit(boxes[i], [&](std::size_t leaf) {
      const std::size_t other = order[leaf];
      if (other >= i) return true;
      const Patch& before = fillings_[filled[other]].patch;
      if (before.empty()) return true;  // it was dropped
      if (!fan) fan.emplace(triangles(filled[i]));
      const bool same_apex = !patch.vertices.empty() && patch.vertices == before.vertices;
      free = !same_apex && !fan->meets(triangles(filled[other]), progress);
      return free;
    });
    if (!free) fillings_[filled[i]] = {Patch(), {}, "the patch meets the patch of another hole"};
  }
}

Patch Fans::finish() {
  Patch patch;
  patch.input_vertices = static_cast<Index>(mesh_.vertices.size());
  std::size_t faces = 0;
  for (const Filling& filling : fillings_) faces += filling.patch.triangles.size();
  patch.triangles.reserve(faces);  // or `append` would move them for every hole
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    HoleReport& hole = holes_[i];
    if (!is_targeted(hole)) continue;
    const Filling& filling = fillings_[i];
    hole.route = filling.route;
    hole.reason = filling.reason;
    if (filling.patch.empty()) continue;
    hole.outcome = HoleOutcome::closed;
    hole.vertices_added = filling.patch.vertices.size();
    hole.faces_added = filling.patch.triangles.size();
    append(patch, filling.patch);
  }
  return patch;
}

}  // namespace

Completion close_by_fans(const TriangleMesh& mesh, const MeshSelection& selection,
                         const TriangleFanOptions& options, const Progress& progress) {
  Completion completion;
  CompletionReport& report = completion.report;
  StageClock clock(report);
  const MeshTopology topology = build_topology(mesh, progress.part(0, 0.2, "finding the boundary"));
  const std::vector<BoundaryLoop> loops =
      trace_boundary_loops(mesh, topology, progress.part(0.2, 0.3, "tracing boundary loops"));
  report.holes = select_holes(mesh, loops, selection, options.holes);
  clock.end_of("finding the holes");
  Fans fans(mesh, loops, report.holes);
  fans.fill_all(progress.part(0.3, 0.95, "closing holes"));
  clock.end_of("closing the holes");
  fans.separate(progress.part(0.95, 1, "comparing the fans"));
  completion.patch = fans.finish();
  clock.end_of("comparing the fans");
  progress.update(1);
  return completion;
}

}  // namespace meshcomplete
