#include "common/core/patch_untangling.h"

#include <algorithm>

#include "common/core/patch.h"
#include "common/core/patch_surroundings.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;

// Distances of the places that are tried, in mean edge lengths at the vertex: near ones first, so that a
// small disturbance wins over a large one.
constexpr std::array<double, 7> distances = {0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0};

// Places on the way from the middle of a side of the star to the vertex.
constexpr std::array<double, 3> shares_of_the_way = {0.5, 0.25, 0.1};

// The 26 directions from the centre of a cube to its faces, edges and corners.
std::vector<Vector3> directions() {
  std::vector<Vector3> list;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x || y || z) list.push_back(Vector3(x, y, z).normalized());
  return list;
}

class Untangler {
 public:
  Untangler(PatchMesh& patch, const InputNeighbourhood& input, const std::vector<Corners>& obstacles,
            const ForbiddenEdges& forbidden)
      : patch_(patch),
        forbidden_(forbidden),
        surroundings_(patch, input, obstacles),
        directions_(directions()) {
    for (Index v = static_cast<Index>(patch.rim_size()); v < patch.vertex_count(); ++v)
      patch.move(v, as_stored(patch.position(v)));
  }

  std::vector<Index> movable_vertices(const std::vector<Index>& tangled, int rings);
  bool improve(Index vertex);
  bool improve_by_flips(Index triangle);

 private:
  double mean_edge(Index vertex) const;
  std::vector<Vector3> places(Index vertex, double edge) const;

  PatchMesh& patch_;
  const ForbiddenEdges& forbidden_;
  PatchSurroundings surroundings_;
  const std::vector<Vector3> directions_;
  std::vector<Index> star_;  // the triangles at hand: round a vertex, or at the two sides of an edge
};

// The inner vertices of the tangled triangles; a triangle of rim vertices only gets one.
std::vector<Index> Untangler::movable_vertices(const std::vector<Index>& tangled, int rings) {
  std::vector<Index> vertices;
  for (Index t : tangled) {
    bool any = false;
    for (Index v : patch_.triangles()[t])
      if (!patch_.on_rim(v)) {
        vertices.push_back(v);
        any = true;
      }
    for (Index h = 3 * t; h < 3 * t + 3 && !any; ++h) {
      if (patch_.is_boundary(h)) continue;
      const Vector3 middle = 0.5 * (patch_.position(patch_.origin(h)) + patch_.position(patch_.target(h)));
      vertices.push_back(patch_.split(h, as_stored(middle)));
      any = true;
    }
    // A vertex of its own lets a triangle bulge round what it meets: the last resort, when moving its corners
    // was no help.
    if (!any || rings > 0) {
      const Corners c = surroundings_.corners(t);
      vertices.push_back(patch_.insert(t, as_stored((c[0] + c[1] + c[2]) / 3.0)));
    }
  }
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<Index> reached = vertices;
    for (Index v : reached)
      patch_.for_neighbours(v, [&](Index neighbour) {
        if (!patch_.on_rim(neighbour)) vertices.push_back(neighbour);
      });
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::vector<Index> triangles = tangled;
  for (Index v : vertices) patch_.for_outgoing(v, [&](Index h) { triangles.push_back(h / 3); });
  surroundings_.focus(triangles);
  return vertices;
}

double Untangler::mean_edge(Index vertex) const {
  double sum = 0;
  int count = 0;
  patch_.for_neighbours(vertex, [&](Index v) {
    sum += (patch_.position(v) - patch_.position(vertex)).norm();
    ++count;
  });
  return sum / count;
}

// Where a vertex may go: all round it, and close to the sides of its star, for stars that wrap a curl of the
// rim.
std::vector<Vector3> Untangler::places(Index vertex, double edge) const {
  std::vector<Vector3> list;
  const Vector3& here = patch_.position(vertex);
  for (double distance : distances)
    for (const Vector3& direction : directions_)
      list.push_back(as_stored(here + distance * edge * direction));
  for (double share : shares_of_the_way)
    for (Index t : star_) {
      const Corners c = surroundings_.corners(t);
      const Vector3 side = 0.5 * (c[0] + c[1] + c[2] - here);
      list.push_back(as_stored(side + share * (here - side)));
    }
  return list;
}

// Tries places round the vertex and keeps the best; false when the vertex stays.
bool Untangler::improve(Index vertex) {
  const double edge = mean_edge(vertex);
  if (!(edge > 0)) return false;
  star_.clear();
  patch_.for_outgoing(vertex, [&](Index h) { star_.push_back(h / 3); });
  surroundings_.collect_round(star_, edge * distances.back());
  const Vector3 start = patch_.position(vertex);
  Vector3 best = start;
  std::size_t least = surroundings_.met_by_star(star_);
  for (const Vector3& place : places(vertex, edge)) {
    if (least == 0) break;
    patch_.move(vertex, place);
    const std::size_t now = surroundings_.met_by_star(star_, least);
    if (now < least) {
      least = now;
      best = place;
    }
  }
  patch_.move(vertex, best);
  return best != start;
}

// Flips an edge of the triangle when that makes it and its neighbour meet fewer triangles.
bool Untangler::improve_by_flips(Index triangle) {
  for (Index h = 3 * triangle; h < 3 * triangle + 3; ++h) {
    if (!can_flip(patch_, h, forbidden_)) continue;
    star_ = {triangle, patch_.opposite(h) / 3};
    surroundings_.collect_round(star_, 0.0);
    const std::size_t before = surroundings_.met_by_star(star_);
    if (before == 0) continue;
    patch_.flip(h);
    if (surroundings_.met_by_star(star_, before) < before) return true;
    // The new diagonal is the first half-edge of both triangles; flipping it brings the old one back.
    patch_.flip(3 * triangle);
  }
  return false;
}

}  // namespace

std::size_t untangle(PatchMesh& patch, const std::vector<Index>& tangled, const InputNeighbourhood& input,
                     const std::vector<Corners>& obstacles, const ForbiddenEdges& forbidden, int rings,
                     int rounds, const Progress& progress) {
  Untangler untangler(patch, input, obstacles, forbidden);
  const std::vector<Index> vertices = untangler.movable_vertices(tangled, rings);
  std::size_t moved = 0;
  for (int round = 0; round < rounds; ++round) {
    std::size_t now = 0;
    for (Index v : vertices) {
      now += untangler.improve(v);
      progress.check();
    }
    for (Index t : tangled) now += untangler.improve_by_flips(t);
    moved += now;
    if (now == 0) break;
  }
  return moved;
}

}  // namespace meshcomplete
