#include "common/core/patch_check.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/core/box_tree.h"
#include "common/core/patch_half_edges.h"
#include "common/core/threads.h"
#include "common/core/triangle_blocks.h"
#include "common/core/triangle_intersection.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;

constexpr std::size_t worth_threads = 4096;  // patch triangles

void sort_unique(std::vector<Index>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

bool has_repeated_corner(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Where a patch comes near the input: which pairs of triangles meet, and which share a position that they
/// should not.
struct InputContacts {
  std::vector<Index> patch_meeting, input_met;
  std::vector<Index> patch_coincident, input_coincident;

  void append(const InputContacts& other) {
    const auto add = [](std::vector<Index>& to, const std::vector<Index>& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    add(patch_meeting, other.patch_meeting);
    add(input_met, other.input_met);
    add(patch_coincident, other.patch_coincident);
    add(input_coincident, other.input_coincident);
  }
};

class Checker {
 public:
  Checker(const InputNeighbourhood& input, const Patch& patch, const std::vector<const BoundaryLoop*>& rim,
          const Progress& progress)
      : blocks_(input.blocks()), mesh_(input.mesh()), patch_(patch), rim_(rim), progress_(progress) {}

  PatchCheck run();

 private:
  bool is_new(Index vertex) const { return vertex >= patch_.input_vertices; }
  const Vector3& position(Index vertex) const {
    return is_new(vertex) ? patch_.vertices[vertex - patch_.input_vertices] : mesh_.vertices[vertex];
  }

  void find_bad_indices();
  void find_unused_vertices();
  void find_bad_coordinates();
  void find_open_rim();
  void find_bad_edges();
  void find_bad_vertices();
  void find_detached_pieces();
  void find_degenerate_faces();
  void find_coincident_vertices();
  void find_self_intersections();
  void find_input_contacts();

  std::vector<Index> input_triangles_at_edge(Index a, Index b) const;
  void test_block(std::size_t block, const BoxTree& tree, const std::vector<Index>& order,
                  InputContacts& found) const;
  bool holds_position_wanted(const Triangle& input_triangle, Index patch_triangle) const;

  void report(PatchDefect defect) {
    if (result_.passed()) result_.defect = defect;
  }

  const TriangleBlocks& blocks_;
  const TriangleMesh& mesh_;
  const Patch& patch_;
  const std::vector<const BoundaryLoop*>& rim_;
  const Progress& progress_;
  PatchHalfEdges half_edges_;
  std::vector<Corners> corners_;
  PatchCheck result_;
};

PatchCheck Checker::run() {
  using Step = void (Checker::*)();
  // Each step may rely on those before it having found nothing, but for the last one, which follows
  // intersections too.
  const std::array<std::pair<Step, double>, 11> steps = {{{&Checker::find_bad_indices, 0.01},
                                                          {&Checker::find_unused_vertices, 0.02},
                                                          {&Checker::find_bad_coordinates, 0.03},
                                                          {&Checker::find_open_rim, 0.1},
                                                          {&Checker::find_bad_edges, 0.12},
                                                          {&Checker::find_bad_vertices, 0.14},
                                                          {&Checker::find_detached_pieces, 0.16},
                                                          {&Checker::find_degenerate_faces, 0.18},
                                                          {&Checker::find_coincident_vertices, 0.2},
                                                          {&Checker::find_self_intersections, 0.5},
                                                          {&Checker::find_input_contacts, 1}}};
  for (const auto& [step, done] : steps) {
    (this->*step)();
    // A patch that meets itself is searched for contacts with the input too, so that a caller can mend both.
    if (!result_.passed() && result_.defect != PatchDefect::meets_itself) break;
    progress_.update(done);
  }
  sort_unique(result_.patch_triangles);
  sort_unique(result_.input_triangles);
  return std::move(result_);
}

void Checker::find_bad_indices() {
  const bool other_mesh = patch_.input_vertices != mesh_.vertices.size();
  const std::size_t vertices = patch_.input_vertices + patch_.vertices.size();
  for (Index t = 0; t < patch_.triangles.size(); ++t) {
    const Triangle& triangle = patch_.triangles[t];
    const bool outside =
        std::any_of(triangle.begin(), triangle.end(), [&](Index v) { return v >= vertices; });
    if (other_mesh || outside || has_repeated_corner(triangle)) result_.patch_triangles.push_back(t);
  }
  if (other_mesh || !result_.patch_triangles.empty()) report(PatchDefect::bad_index);
}

void Checker::find_unused_vertices() {
  std::vector<char> used(patch_.vertices.size(), 0);
  for (const Triangle& triangle : patch_.triangles)
    for (Index v : triangle)
      if (is_new(v)) used[v - patch_.input_vertices] = 1;
  if (std::find(used.begin(), used.end(), 0) != used.end()) report(PatchDefect::unused_vertex);
}

void Checker::find_bad_coordinates() {
  for (Index t = 0; t < patch_.triangles.size(); ++t)
    for (Index v : patch_.triangles[t]) {
      const Vector3& p = position(v);
      if (!p.allFinite() || (is_new(v) && as_stored(p) != p)) result_.patch_triangles.push_back(t);
    }
  if (!result_.patch_triangles.empty()) report(PatchDefect::not_finite);
}

void Checker::find_open_rim() {
  half_edges_ = PatchHalfEdges(patch_);
  bool open = false;
  for (const BoundaryLoop* loop : rim_)
    for (std::size_t i = 0; i < loop->vertices.size(); ++i) {
      const Index from = loop->vertices[i], to = loop->vertices[(i + 1) % loop->vertices.size()];
      const auto forward = half_edges_.between(from, to), backward = half_edges_.between(to, from);
      if (forward.size() == 1 && backward.empty()) continue;
      open = true;
      for (const auto& range : {forward, backward})
        for (const PatchHalfEdges::HalfEdge& h : range) result_.patch_triangles.push_back(h.triangle);
    }
  if (open)
    report(PatchDefect::rim_not_closed);
  else
    for (const BoundaryLoop* loop : rim_) half_edges_.add_rim(loop->vertices);
}

void Checker::find_bad_edges() {
  half_edges_.for_each_edge_inside([&](Index a, Index b) {
    const auto forward = half_edges_.between(a, b), backward = half_edges_.between(b, a);
    bool bad = forward.size() != 1 || backward.size() != 1;
    if (!bad && !is_new(a) && !is_new(b)) {
      const std::vector<Index> old = input_triangles_at_edge(a, b);
      result_.input_triangles.insert(result_.input_triangles.end(), old.begin(), old.end());
      bad = !old.empty();
    }
    if (!bad) return;
    report(PatchDefect::edge_not_manifold);
    for (const auto& range : {forward, backward})
      for (const PatchHalfEdges::HalfEdge& h : range) result_.patch_triangles.push_back(h.triangle);
  });
}

std::vector<Index> Checker::input_triangles_at_edge(Index a, Index b) const {
  std::vector<Index> found;
  const Vector3& p = mesh_.vertices[a];
  blocks_.visit(bounding_box(p, p, p), [&](Index t) {
    const Triangle& triangle = mesh_.triangles[t];
    const auto has = [&](Index v) {
      return std::find(triangle.begin(), triangle.end(), v) != triangle.end();
    };
    if (has(a) && has(b) && !has_repeated_corner(triangle)) found.push_back(t);
    return true;
  });
  return found;
}

void Checker::find_bad_vertices() {
  half_edges_.for_each_vertex([&](Index vertex) {
    if (half_edges_.fans_match_rim(vertex, is_new(vertex))) return;
    report(PatchDefect::vertex_not_manifold);
    for (const PatchHalfEdges::HalfEdge& h : half_edges_.leaving(vertex))
      result_.patch_triangles.push_back(h.triangle);
  });
}

void Checker::find_detached_pieces() {
  // Edges are manifold here: flooding from the triangles at the rim reaches every piece that has one.
  std::vector<char> reached(patch_.triangles.size(), 0);
  std::vector<Index> flood;
  const auto reach = [&](Index t) {
    if (!reached[t]) flood.push_back(t);
    reached[t] = 1;
  };
  for (Index t = 0; t < patch_.triangles.size(); ++t)
    if (std::any_of(patch_.triangles[t].begin(), patch_.triangles[t].end(),
                    [&](Index v) { return !is_new(v); }))
      reach(t);
  while (!flood.empty()) {
    const Triangle triangle = patch_.triangles[flood.back()];
    flood.pop_back();
    for (int k = 0; k < 3; ++k)
      for (const PatchHalfEdges::HalfEdge& h : half_edges_.between(triangle[(k + 1) % 3], triangle[k]))
        reach(h.triangle);
  }
  for (Index t = 0; t < reached.size(); ++t)
    if (!reached[t]) result_.patch_triangles.push_back(t);
  if (!result_.patch_triangles.empty()) report(PatchDefect::detached_piece);
}

void Checker::find_degenerate_faces() {
  corners_.reserve(patch_.triangles.size());
  for (const auto& [a, b, c] : patch_.triangles) corners_.push_back({position(a), position(b), position(c)});
  for (Index t = 0; t < corners_.size(); ++t)
    if (collinear(corners_[t][0], corners_[t][1], corners_[t][2])) result_.patch_triangles.push_back(t);
  if (!result_.patch_triangles.empty()) report(PatchDefect::degenerate_face);
}

void Checker::find_coincident_vertices() {
  struct Place {
    Vector3 at;
    Index vertex;
    bool operator<(const Place& other) const {
      return std::lexicographical_compare(at.data(), at.data() + 3, other.at.data(), other.at.data() + 3);
    }
  };
  std::vector<Place> places;
  half_edges_.for_each_vertex([&](Index vertex) { places.push_back({position(vertex), vertex}); });
  std::sort(places.begin(), places.end());
  for (std::size_t i = 0; i < places.size();) {
    std::size_t j = i;
    bool any_new = false;
    for (; j < places.size() && places[j].at == places[i].at; ++j) any_new |= is_new(places[j].vertex);
    if (any_new && j - i > 1) {
      report(PatchDefect::coincident_vertices);
      for (std::size_t k = i; k < j; ++k)
        for (const PatchHalfEdges::HalfEdge& h : half_edges_.leaving(places[k].vertex))
          result_.patch_triangles.push_back(h.triangle);
    }
    i = j;
  }
}

void Checker::find_self_intersections() {
  for (const auto& [i, j] : improper_pairs(corners_, static_cast<std::size_t>(-1), progress_)) {
    report(PatchDefect::meets_itself);
    result_.patch_triangles.push_back(i);
    result_.patch_triangles.push_back(j);
  }
}

/// Whether a new corner of the patch triangle lies where a corner of the input triangle is.
bool Checker::holds_position_wanted(const Triangle& input_triangle, Index patch_triangle) const {
  for (Index v : patch_.triangles[patch_triangle])
    for (Index w : input_triangle)
      if (is_new(v) && position(v) == mesh_.vertices[w]) return true;
  return false;
}

void Checker::test_block(std::size_t block, const BoxTree& tree, const std::vector<Index>& order,
                         InputContacts& found) const {
  blocks_.visit_block(block, [&](Index t) {
    const Triangle& triangle = mesh_.triangles[t];
    const Corners corners = {mesh_.vertices[triangle[0]], mesh_.vertices[triangle[1]],
                             mesh_.vertices[triangle[2]]};
    int degenerate = -1;  // decided when something is near
    tree.visit(blocks_.triangle_box(t), [&](std::size_t leaf) {
      const Index patch_triangle = order[leaf];
      if (holds_position_wanted(triangle, patch_triangle)) {
        found.patch_coincident.push_back(patch_triangle);
        found.input_coincident.push_back(t);
      }
      if (degenerate < 0) degenerate = collinear(corners[0], corners[1], corners[2]);
      if (!degenerate && meet_improperly(corners_[patch_triangle], corners)) {
        found.patch_meeting.push_back(patch_triangle);
        found.input_met.push_back(t);
      }
      return true;
    });
    return true;
  });
}

void Checker::find_input_contacts() {
  std::vector<Box> boxes(corners_.size());
  for (std::size_t t = 0; t < corners_.size(); ++t)
    boxes[t] = bounding_box(corners_[t][0], corners_[t][1], corners_[t][2]);
  const std::vector<Index> order = spatial_order(boxes);
  std::vector<Box> ordered(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) ordered[i] = boxes[order[i]];
  const BoxTree tree(std::move(ordered));

  std::vector<std::size_t> near;
  blocks_.tree().descend([&](const Box& box) { return !tree.visit(box, [](std::size_t) { return false; }); },
                         [&](std::size_t block) {
                           near.push_back(block);
                           return true;
                         });
  InputContacts contacts;
  if (corners_.size() < worth_threads) {
    for (std::size_t block : near) {
      progress_.check();
      test_block(block, tree, order, contacts);
    }
  } else {
    tbb::enumerable_thread_specific<InputContacts> found;
    for_each(near.size(), 4, progress_,
             [&](std::size_t i) { test_block(near[i], tree, order, found.local()); });
    for (const InputContacts& part : found) contacts.append(part);
  }
  const auto add = [&](PatchDefect defect, const std::vector<Index>& patch, const std::vector<Index>& input) {
    report(defect);
    result_.patch_triangles.insert(result_.patch_triangles.end(), patch.begin(), patch.end());
    result_.input_triangles.insert(result_.input_triangles.end(), input.begin(), input.end());
  };
  if (!contacts.patch_coincident.empty())
    add(PatchDefect::coincident_vertices, contacts.patch_coincident, contacts.input_coincident);
  else if (!contacts.patch_meeting.empty())
    add(PatchDefect::meets_input, contacts.patch_meeting, contacts.input_met);
}

}  // namespace

std::string describe(PatchDefect defect) {
  switch (defect) {
    case PatchDefect::none:
      return "nothing is wrong with the patch";
    case PatchDefect::bad_index:
      return "a face of the patch names a vertex that does not exist, or one vertex twice";
    case PatchDefect::unused_vertex:
      return "a vertex of the patch belongs to no face";
    case PatchDefect::not_finite:
      return "a coordinate is infinite, not a number, or cannot be stored exactly";
    case PatchDefect::rim_not_closed:
      return "the patch leaves part of the rim open";
    case PatchDefect::edge_not_manifold:
      return "more or fewer than two faces would meet at an edge";
    case PatchDefect::vertex_not_manifold:
      return "the faces round a vertex would not form a single fan";
    case PatchDefect::detached_piece:
      return "a piece of the patch is not connected to the rim";
    case PatchDefect::degenerate_face:
      return "a face of the patch has no area";
    case PatchDefect::coincident_vertices:
      return "a new vertex lies exactly where there is one already";
    case PatchDefect::meets_itself:
      return "the patch intersects itself";
    case PatchDefect::meets_input:
      return "the patch intersects the mesh";
  }
  return "";
}

InputNeighbourhood::InputNeighbourhood(const TriangleMesh& mesh)
    : blocks_(std::make_unique<TriangleBlocks>(mesh)) {}
InputNeighbourhood::~InputNeighbourhood() = default;
InputNeighbourhood::InputNeighbourhood(InputNeighbourhood&&) noexcept = default;

const TriangleMesh& InputNeighbourhood::mesh() const { return blocks_->mesh(); }

std::vector<Index> InputNeighbourhood::triangles_in_box(const Vector3& low, const Vector3& high) const {
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.low[k] = low[k];
    box.high[k] = high[k];
  }
  std::vector<Index> found;
  blocks_->visit(box, [&](Index t) {
    found.push_back(t);
    return true;
  });
  std::sort(found.begin(), found.end());
  return found;
}

PatchCheck check_patch(const InputNeighbourhood& input, const Patch& patch,
                       const std::vector<const BoundaryLoop*>& rim, const Progress& progress) {
  return Checker(input, patch, rim, progress).run();
}

std::vector<Index> input_triangles_met(const InputNeighbourhood& input,
                                       const std::array<Vector3, 3>& triangle, std::size_t limit) {
  std::vector<Index> met;
  const Box box = bounding_box(triangle[0], triangle[1], triangle[2]);
  if (limit == 0 || box.low[0] > box.high[0] || collinear(triangle[0], triangle[1], triangle[2])) return met;
  const TriangleMesh& mesh = input.mesh();
  input.blocks().visit(box, [&](Index t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Corners corners = {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
    if (!collinear(corners[0], corners[1], corners[2]) && meet_improperly(triangle, corners))
      met.push_back(t);
    return met.size() < limit;
  });
  std::sort(met.begin(), met.end());
  return met;
}

}  // namespace meshcomplete
