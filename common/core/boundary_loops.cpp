#include "common/core/boundary_loops.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>
#include <unordered_map>

#include "common/core/triangle_intersection.h"

namespace meshcomplete {
namespace {

constexpr Index none = 0xffffffffu;

// A sheet whose area is at most this many times the area that its outer rim encloses, seen from the direction
// in which that is greatest, is flat enough for a patch to lie on it. (A hemisphere has 2, a cap of 48
// degrees 1.2.)
constexpr double open_sheet_area_ratio = 1.2;

// An end of a boundary half-edge: 2 * i for the origin and 2 * i + 1 for the target of boundary half-edge
// number i. A patch walks the half-edge from its target to its origin.
using EdgeEnd = Index;

class Tracer {
 public:
  Tracer(const TriangleMesh& mesh, const MeshTopology& topology)
      : mesh_(mesh), topology_(topology), half_edges_(topology.boundary_half_edges) {}

  std::vector<BoundaryLoop> trace(const Progress& progress);

 private:
  Index corner(Index half_edge, int step) const {
    return mesh_.triangles[half_edge / 3][(half_edge % 3 + static_cast<Index>(step)) % 3];
  }
  Index vertex(EdgeEnd end) const { return corner(half_edges_[end / 2], static_cast<int>(end % 2)); }
  Index boundary_number(Index half_edge) const {
    return static_cast<Index>(std::lower_bound(half_edges_.begin(), half_edges_.end(), half_edge) -
                              half_edges_.begin());
  }
  EdgeEnd end_of_fan(EdgeEnd end) const;
  void link_fans();
  void link_loose_ends();
  std::vector<EdgeEnd> walk(EdgeEnd start) const;
  void cut_at_revisits(const std::vector<EdgeEnd>& walked, std::vector<BoundaryLoop>& loops) const;
  BoundaryLoop chain(const std::vector<EdgeEnd>& walked, LoopDefect defect) const;

  const TriangleMesh& mesh_;
  const MeshTopology& topology_;
  const std::vector<Index>& half_edges_;
  std::vector<EdgeEnd> link_;  // the end on the other side of the fan, or `none`
};

// Turns round the vertex at `end`, from face to face, until the fan's other boundary edge.
EdgeEnd Tracer::end_of_fan(EdgeEnd end) const {
  const Index pivot = vertex(end);
  Index half_edge = half_edges_[end / 2];
  for (;;) {
    const Index face = half_edge - half_edge % 3;
    const Index side = half_edge % 3;
    const bool leaves_pivot = corner(half_edge, 0) == pivot;
    const Index other = face + (leaves_pivot ? (side + 2) % 3 : (side + 1) % 3);
    const Index opposite = topology_.opposite[other];
    if (opposite == MeshTopology::boundary)
      return 2 * boundary_number(other) + (corner(other, 0) == pivot ? 0 : 1);
    if (opposite == MeshTopology::non_manifold) return none;
    half_edge = opposite;
  }
}

void Tracer::link_fans() {
  link_.assign(2 * half_edges_.size(), none);
  for (EdgeEnd end = 0; end < link_.size(); ++end)
    if (link_[end] == none) {
      const EdgeEnd other = end_of_fan(end);
      link_[end] = other;
      if (other != none) link_[other] = end;
    }
}

// Where fans end at a non-manifold edge, two loose ends at one vertex can only belong together.
void Tracer::link_loose_ends() {
  std::vector<std::pair<Index, EdgeEnd>> loose;
  for (EdgeEnd end = 0; end < link_.size(); ++end)
    if (link_[end] == none) loose.emplace_back(vertex(end), end);
  std::sort(loose.begin(), loose.end());
  for (std::size_t i = 0; i < loose.size();) {
    std::size_t j = i;
    while (j < loose.size() && loose[j].first == loose[i].first) ++j;
    if (j - i == 2) {
      link_[loose[i].second] = loose[i + 1].second;
      link_[loose[i + 1].second] = loose[i].second;
    }
    i = j;
  }
}

// The ends through which a walk from `start` leaves each edge; closed when it comes back to `start`.
std::vector<EdgeEnd> Tracer::walk(EdgeEnd start) const {
  std::vector<EdgeEnd> walked;
  EdgeEnd leaving = start;
  do {
    walked.push_back(leaving);
    const EdgeEnd entering = link_[leaving];
    if (entering == none) break;
    leaving = entering ^ 1u;
  } while (leaving != start);
  return walked;
}

BoundaryLoop Tracer::chain(const std::vector<EdgeEnd>& walked, LoopDefect defect) const {
  BoundaryLoop loop;
  loop.defect = defect;
  for (EdgeEnd leaving : walked) {
    loop.vertices.push_back(vertex(leaving ^ 1u));
    loop.faces.push_back(half_edges_[leaving / 2] / 3);
  }
  return loop;
}

// Splits a closed walk wherever it comes back to a vertex, so that every loop passes a vertex once.
void Tracer::cut_at_revisits(const std::vector<EdgeEnd>& walked, std::vector<BoundaryLoop>& loops) const {
  std::unordered_map<Index, std::size_t> position;  // of a vertex in `open`
  std::vector<EdgeEnd> open;
  for (EdgeEnd leaving : walked) {
    const Index from = vertex(leaving ^ 1u);
    const auto seen = position.find(from);
    if (seen != position.end()) {
      const auto first = open.begin() + static_cast<std::ptrdiff_t>(seen->second);
      const std::vector<EdgeEnd> closed(first, open.end());
      loops.push_back(chain(closed, LoopDefect::none));
      for (EdgeEnd end : closed) position.erase(vertex(end ^ 1u));
      open.erase(first, open.end());
    }
    position[from] = open.size();
    open.push_back(leaving);
  }
  loops.push_back(chain(open, LoopDefect::none));
}

std::vector<BoundaryLoop> Tracer::trace(const Progress& progress) {
  link_fans();
  link_loose_ends();
  std::vector<BoundaryLoop> loops;
  std::vector<char> done(half_edges_.size(), 0);
  const auto trace_from = [&](EdgeEnd start) {
    const std::vector<EdgeEnd> walked = walk(start);
    bool consistent = true;
    for (EdgeEnd end : walked) {
      done[end / 2] = 1;
      consistent &= end % 2 == start % 2;
    }
    if (link_[walked.back()] == none)
      loops.push_back(chain(walked, LoopDefect::non_manifold_edge));
    else if (!consistent)
      loops.push_back(chain(walked, LoopDefect::inconsistent_normals));
    else
      cut_at_revisits(walked, loops);
    progress.check();
  };
  // Open chains first, from their loose ends, so that none is met in its middle; then the closed ones.
  for (EdgeEnd end = 0; end < link_.size(); ++end)
    if (link_[end] == none && !done[end / 2]) trace_from(end ^ 1u);
  for (Index i = 0; i < half_edges_.size(); ++i)
    if (!done[i]) trace_from(2 * i);
  return loops;
}

Vector3 vector_area(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  const Vector3 base = mesh.vertices[loop.vertices.front()];
  Vector3 area = Vector3::Zero();
  for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
    const Vector3& a = mesh.vertices[loop.vertices[i]];
    const Vector3& b = mesh.vertices[loop.vertices[(i + 1) % loop.vertices.size()]];
    area += 0.5 * (a - base).cross(b - base);
  }
  return area;
}

bool has_edge_without_length(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  for (std::size_t i = 0; i < loop.vertices.size(); ++i)
    if (mesh.vertices[loop.vertices[i]] == mesh.vertices[loop.vertices[(i + 1) % loop.vertices.size()]])
      return true;
  return false;
}

bool on_one_line(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  const auto& p = mesh.vertices;
  const auto& v = loop.vertices;
  for (std::size_t i = 2; i < v.size(); ++i)
    if (!collinear(p[v[0]], p[v[1]], p[v[i]])) return false;
  return true;
}

// Finds sheets that a patch would cover a second time, by flooding the surface from the rim until it is
// clearly larger than what the rim encloses: the flood ends early at every true hole.
class SheetTest {
 public:
  SheetTest(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<BoundaryLoop>& loops)
      : mesh_(mesh), topology_(topology), loops_(loops), stamp_(mesh.triangles.size(), none) {
    for (std::size_t i = 0; i < loops.size(); ++i) {
      perimeters_.push_back(perimeter(mesh, loops[i]));
      areas_.push_back(loops[i].defect == LoopDefect::none ? vector_area(mesh, loops[i])
                                                           : Vector3(Vector3::Zero()));
      for (Index face : loops[i].faces) loops_at_face_.emplace(face, i);
    }
  }

  LoopDefect test(std::size_t loop) {
    const double limit = open_sheet_area_ratio * areas_[loop].norm();
    std::vector<Index> flood;
    std::vector<std::size_t> rims;
    double area = 0;
    const auto reach = [&](Index face) {
      if (stamp_[face] == loop) return;
      stamp_[face] = static_cast<Index>(loop);
      flood.push_back(face);
      const Triangle& t = mesh_.triangles[face];
      const auto& p = mesh_.vertices;
      area += 0.5 * (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).norm();
      const auto range = loops_at_face_.equal_range(face);
      for (auto it = range.first; it != range.second; ++it) rims.push_back(it->second);
    };
    for (Index face : loops_[loop].faces) reach(face);
    for (std::size_t i = 0; i < flood.size() && area <= limit; ++i)
      for (Index h = 3 * flood[i]; h < 3 * flood[i] + 3; ++h)
        if (topology_.opposite[h] < MeshTopology::non_manifold) reach(topology_.opposite[h] / 3);
    if (flood.size() == 1) return LoopDefect::isolated_triangle;
    if (area > limit) return LoopDefect::none;
    std::sort(rims.begin(), rims.end());
    rims.erase(std::unique(rims.begin(), rims.end()), rims.end());
    // What the sheet's faces add up to as vectors is what all its rims enclose; that of a band or a short
    // tube is nothing.
    Vector3 enclosed = areas_[loop];
    for (std::size_t rim : rims)
      if (rim != loop) {
        enclosed += areas_[rim];
        if (perimeters_[rim] > perimeters_[loop]) return LoopDefect::none;
      }
    return area <= open_sheet_area_ratio * enclosed.norm() ? LoopDefect::open_sheet : LoopDefect::none;
  }

 private:
  const TriangleMesh& mesh_;
  const MeshTopology& topology_;
  const std::vector<BoundaryLoop>& loops_;
  std::vector<Index> stamp_;  // the last loop whose flood reached a face
  std::vector<double> perimeters_;
  std::vector<Vector3> areas_;  // as vectors
  std::unordered_multimap<Index, std::size_t> loops_at_face_;
};

}  // namespace

std::string describe(LoopDefect defect) {
  switch (defect) {
    case LoopDefect::none:
      return "";
    case LoopDefect::non_manifold_edge:
      return "edges shared by three or more faces end at this rim, so it is not clear where the hole goes "
             "on; apply "
             "'Select non Manifold Edges' and 'Delete Selected Faces' or 'Repair non Manifold Edges by "
             "removing faces' first";
    case LoopDefect::inconsistent_normals:
      return "the faces round this rim do not agree which side is the front; apply 'Re-Orient all faces "
             "coherentely' "
             "first (a one-sided surface such as a Moebius strip cannot be closed)";
    case LoopDefect::isolated_triangle:
      return "this is the rim of a single triangle, not a hole; a patch would cover the triangle a second "
             "time";
    case LoopDefect::open_sheet:
      return "this is the outer rim of an open, nearly flat sheet, not a hole; a patch would cover the sheet "
             "a second time";
    case LoopDefect::edge_without_length:
      return "two neighbouring vertices of this rim lie at the same position; apply 'Merge Close Vertices' "
             "first";
    case LoopDefect::degenerate_rim:
      return "all vertices of this rim lie on one straight line";
  }
  return "";
}

Index half_edge_at(const TriangleMesh& mesh, const BoundaryLoop& loop, std::size_t edge) {
  const Triangle& t = mesh.triangles[loop.faces[edge]];
  const auto target = std::find(t.begin(), t.end(), loop.vertices[edge]) - t.begin();
  return 3 * loop.faces[edge] + static_cast<Index>(target + 2) % 3;
}

double perimeter(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.vertices.size(); ++i)
    sum += (mesh.vertices[loop.vertices[i]] - mesh.vertices[loop.vertices[(i + 1) % loop.vertices.size()]])
               .norm();
  return sum;
}

std::vector<BoundaryLoop> trace_boundary_loops(const TriangleMesh& mesh, const MeshTopology& topology,
                                               const Progress& progress) {
  std::vector<BoundaryLoop> loops = Tracer(mesh, topology).trace(progress.part(0, 0.5, ""));
  for (BoundaryLoop& loop : loops) {
    const auto least = std::min_element(loop.vertices.begin(), loop.vertices.end()) - loop.vertices.begin();
    if (loop.defect != LoopDefect::non_manifold_edge) {  // those are open chains
      std::rotate(loop.vertices.begin(), loop.vertices.begin() + least, loop.vertices.end());
      std::rotate(loop.faces.begin(), loop.faces.begin() + least, loop.faces.end());
    }
  }
  std::sort(loops.begin(), loops.end(), [](const BoundaryLoop& a, const BoundaryLoop& b) {
    return std::tie(a.vertices, a.faces) < std::tie(b.vertices, b.faces);
  });
  SheetTest sheets(mesh, topology, loops);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    BoundaryLoop& loop = loops[i];
    if (loop.defect != LoopDefect::none) continue;
    if (has_edge_without_length(mesh, loop))
      loop.defect = LoopDefect::edge_without_length;
    else if (on_one_line(mesh, loop))
      loop.defect = LoopDefect::degenerate_rim;
    else
      loop.defect = sheets.test(i);
    progress.part(0.5, 1, "").update(static_cast<double>(i + 1) / static_cast<double>(loops.size()));
  }
  return loops;
}

}  // namespace meshcomplete
