#include "filter_curveunfold/divided_rim.h"

#include "common/core/error.h"
#include "common/core/patch.h"
#include "common/core/triangle_intersection.h"
#include "filter_curveunfold/polygon_triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace meshcomplete {
namespace {

constexpr const char* stage = "dividing the rim";

// Of longer rims only so many vertices, evenly spread, are ends of chords.
constexpr std::size_t most_ends = 400;

// Each part of the rim keeps at least this share of its length.
constexpr double least_share = 0.2;

// A chord of more edges costs too much: all pairs of its points are kept from being joined.
constexpr double most_pieces = 1000;

// Two chords are close to each other when both pairs of ends are, by this share of the rim's vertices.
constexpr double closeness = 0.1;

// Whether faces of the input, those at the ends left out, are in the way.
bool is_obstructed(const InputNeighbourhood& input, const Vector3& a, const Vector3& b) {
  const TriangleMesh& mesh = input.mesh();
  const std::vector<Index> near = input.triangles_in_box(a.cwiseMin(b), a.cwiseMax(b));
  return std::any_of(near.begin(), near.end(), [&](Index t) {
    std::array<Vector3, 3> corners;
    for (int k = 0; k < 3; ++k) corners[k] = mesh.vertices[mesh.triangles[t][k]];
    for (const Vector3& corner : corners)
      if (corner == a || corner == b) return false;
    return !collinear(corners[0], corners[1], corners[2]) && segment_meets_triangle(a, b, corners);
  });
}

// One side of a chord as a rim of its own: part of the old one, then the points of the chord.
struct Side {
  Rim rim;
  std::vector<Index> vertex;  // per vertex of `rim`: in the old rim, or from its size on a point of the chord
};

// The part of the rim from position `from` to position `to`, both included, and the chord's points on the way back. They are
// numbered from one end of the chord to the other; `backwards` says that this side meets them in the other order.
Side side_of(const Rim& rim, Index from, Index to, const std::vector<Vector3>& points,
             const std::vector<double>& lengths, bool backwards) {
  const Index n = static_cast<Index>(rim.positions.size());
  Side side;
  for (Index v = from;; v = (v + 1) % n) {
    side.vertex.push_back(v);
    if (v == to) break;
  }
  const Index count = static_cast<Index>(points.size());
  for (Index i = 0; i < count; ++i) side.vertex.push_back(n + (backwards ? count - 1 - i : i));
  for (Index v : side.vertex) {
    side.rim.positions.push_back(v < n ? rim.positions[v] : points[v - n]);
    side.rim.edge_length.push_back(v < n ? rim.edge_length[v] : lengths[v - n]);
  }
  const Index size = static_cast<Index>(side.vertex.size()), along = size - count;

  // The ring, numbered anew: this side's vertices, then all others.
  std::vector<Index> number(rim.ring.vertices.size(), PatchMesh::none);
  for (Index i = 0; i < along; ++i)
    if (side.vertex[i] < number.size()) number[side.vertex[i]] = i;
  side.rim.ring.vertices = side.rim.positions;
  for (Index v = 0; v < number.size(); ++v) {
    if (number[v] != PatchMesh::none) continue;
    number[v] = static_cast<Index>(side.rim.ring.vertices.size());
    side.rim.ring.vertices.push_back(rim.ring.vertices[v]);
  }
  for (const Triangle& t : rim.ring.triangles)
    side.rim.ring.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});

  const auto forbid = [&](Index a, Index b) { side.rim.forbidden.emplace_back(std::min(a, b), std::max(a, b)); };
  for (const auto& [a, b] : rim.forbidden)
    if (number[a] < along && number[b] < along) forbid(number[a], number[b]);
  // Both sides could join the same two vertices of the chord.
  std::vector<Index> line = {along - 1};
  for (Index i = along; i < size; ++i) line.push_back(i);
  line.push_back(0);
  for (std::size_t i = 0; i < line.size(); ++i)
    for (std::size_t k = i + 2; k < line.size(); ++k) forbid(line[i], line[k]);
  std::sort(side.rim.forbidden.begin(), side.rim.forbidden.end());
  return side;
}

PatchMesh fill_side(const Rim& rim, const InputNeighbourhood& input, const UnfoldOptions& unfolding,
                    const EmbeddingOptions& options, int depth, const Progress& progress) {
  const Unfolding flat = unfold(rim.positions, unfolding, progress);
  if (flat.outcome != UnfoldOutcome::projected && depth > 0) {
    const std::vector<Chord> best = chords(rim, input, 1);
    if (!best.empty()) return embed_divided(rim, best.front(), input, unfolding, options, depth - 1, progress);
  }
  if (flat.polygon.empty()) throw CompletionError(stage, "A part of the divided rim could not be unfolded.");
  return embed(rim, triangulate_polygon(flat.polygon), options, progress);
}

}  // namespace

std::vector<Chord> chords(const Rim& rim, const InputNeighbourhood& input, std::size_t count) {
  const std::size_t n = rim.positions.size();
  std::vector<double> way(n + 1, 0.0);  // along the rim
  for (std::size_t i = 0; i < n; ++i) way[i + 1] = way[i] + (rim.positions[(i + 1) % n] - rim.positions[i]).norm();
  struct Candidate {
    double ratio;
    Chord chord;
    bool operator<(const Candidate& other) const {
      return ratio != other.ratio ? ratio < other.ratio : chord < other.chord;
    }
  };
  std::vector<Candidate> candidates;
  const std::size_t step = (n + most_ends - 1) / most_ends;
  for (Index i = 0; i < n; i += static_cast<Index>(step))
    for (Index k = i + 2; k < n; k += static_cast<Index>(step)) {
      const double arc = std::min(way[k] - way[i], way[n] - (way[k] - way[i]));
      if (arc < least_share * way[n] || std::binary_search(rim.forbidden.begin(), rim.forbidden.end(), Chord(i, k)))
        continue;
      candidates.push_back({(rim.positions[k] - rim.positions[i]).norm() / arc, {i, k}});
    }
  std::sort(candidates.begin(), candidates.end());
  const auto apart = [&](Index a, Index b) {
    const std::size_t distance = a > b ? a - b : b - a;
    return static_cast<double>(std::min(distance, n - distance)) > closeness * static_cast<double>(n);
  };
  std::vector<Chord> chosen;
  for (const Candidate& candidate : candidates) {
    if (chosen.size() == count) break;
    const auto [i, k] = candidate.chord;
    const bool close = std::any_of(chosen.begin(), chosen.end(), [&, i = i, k = k](const Chord& other) {
      return (!apart(i, other.first) && !apart(k, other.second)) || (!apart(i, other.second) && !apart(k, other.first));
    });
    if (!close && !is_obstructed(input, rim.positions[i], rim.positions[k])) chosen.push_back(candidate.chord);
  }
  return chosen;
}

PatchMesh embed_divided(const Rim& rim, const Chord& chord, const InputNeighbourhood& input, const UnfoldOptions& unfolding,
                        const EmbeddingOptions& options, int depth, const Progress& progress) {
  const auto [from, to] = chord;
  const Index n = static_cast<Index>(rim.positions.size());
  const Vector3 &a = rim.positions[from], &b = rim.positions[to];
  const double target = options.edge_length.value_or(0.5 * (rim.edge_length[from] + rim.edge_length[to])) / options.resolution;
  if ((b - a).norm() > most_pieces * target)
    throw CompletionError(stage, "A chord would need too many vertices at this edge length; ask for longer edges.");
  const int pieces = std::max(1, static_cast<int>(std::lround((b - a).norm() / target)));
  std::vector<Vector3> points;
  std::vector<double> lengths;
  for (int i = 1; i < pieces; ++i) {
    const double share = static_cast<double>(i) / pieces;
    points.push_back(as_stored(a + share * (b - a)));
    lengths.push_back((1 - share) * rim.edge_length[from] + share * rim.edge_length[to]);
  }
  const Side first = side_of(rim, from, to, points, lengths, true), second = side_of(rim, to, from, points, lengths, false);

  std::vector<Vector3> positions = rim.positions;
  positions.insert(positions.end(), points.begin(), points.end());
  std::vector<Triangle> triangles;
  for (const Side* side : {&first, &second}) {
    const PatchMesh part = fill_side(side->rim, input, unfolding, options, depth, progress);
    const Index size = static_cast<Index>(side->vertex.size()), offset = static_cast<Index>(positions.size()) - size;
    for (Triangle t : part.triangles()) {
      for (Index& corner : t) corner = corner < size ? side->vertex[corner] : corner + offset;
      triangles.push_back(t);
    }
    positions.insert(positions.end(), part.positions().begin() + size, part.positions().end());
  }
  return PatchMesh(std::move(positions), n, std::move(triangles));
}

}  // namespace meshcomplete
