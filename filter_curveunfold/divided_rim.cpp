#include "filter_curveunfold/divided_rim.h"

#include <algorithm>
#include <cmath>

#include "common/core/error.h"
#include "common/core/patch.h"
#include "filter_curveunfold/loop_geometry.h"
#include "filter_curveunfold/polygon_triangulation.h"

namespace meshcomplete {
namespace {

constexpr const char* stage = "dividing the rim";

// Of longer rims only so many vertices, evenly spread, are ends of chords.
constexpr std::size_t most_ends = 400;

// Each part of the rim keeps at least this share of its length.
constexpr double least_share = 0.2;

// A chord of more edges costs too much: all pairs of its points are kept from being joined.
constexpr double most_pieces = 1000;

// A chord close to an obstructed one is not looked at, and after so many obstructed ones the search ends.
constexpr double closeness_to_obstructed = 0.05;
constexpr std::size_t most_obstructed = 200;

// Two chords are close to each other when both pairs of ends are, by this share of the rim's vertices.
constexpr double closeness = 0.1;

// The part of the rim from position `from` to position `to`, both included, and the chord's points on the way
// back. They are numbered from one end of the chord to the other; `backwards` says that this side meets them
// in the other order.
FlatSide side_of(const Rim& rim, Index from, Index to, const std::vector<Vector3>& points,
                 const std::vector<double>& lengths, bool backwards) {
  const Index n = static_cast<Index>(rim.positions.size());
  FlatSide side;
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
  for (Index i = 0; i < along; ++i) number[side.vertex[i]] = i;
  side.rim.ring.vertices = side.rim.positions;
  for (Index v = 0; v < number.size(); ++v) {
    if (number[v] != PatchMesh::none) continue;
    number[v] = static_cast<Index>(side.rim.ring.vertices.size());
    side.rim.ring.vertices.push_back(rim.ring.vertices[v]);
  }
  for (const Triangle& t : rim.ring.triangles)
    side.rim.ring.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});

  const auto forbid = [&](Index a, Index b) {
    side.rim.forbidden.emplace_back(std::min(a, b), std::max(a, b));
  };
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

// Adds the side, unfolded, or what it is divided into.
void add_side(FlatSide side, const InputNeighbourhood& input, std::optional<double> edge_length, int depth,
              Index rim_size, DividedRim& divided, const Progress& progress) {
  if (std::optional<std::vector<Eigen::Vector2d>> polygon =
          simple_projection(side.rim.positions, projection_directions)) {
    side.polygon = std::move(*polygon);
    side.flat = triangulate_polygon(side.polygon);
    divided.sides.push_back(std::move(side));
    return;
  }
  if (depth > 0) {
    const std::vector<Chord> best = chords(side.rim, input, 1, progress);
    try {
      if (!best.empty()) {
        DividedRim parts = divide(side.rim, best.front(), input, edge_length, depth - 1, progress);
        const Index size = static_cast<Index>(side.vertex.size());
        const Index offset = rim_size + static_cast<Index>(divided.points.size());
        for (FlatSide& part : parts.sides) {
          for (Index& v : part.vertex) v = v < size ? side.vertex[v] : v - size + offset;
          divided.sides.push_back(std::move(part));
        }
        divided.points.insert(divided.points.end(), parts.points.begin(), parts.points.end());
        divided.steps += parts.steps;
        return;
      }
    } catch (const CompletionError&) {
      // Perhaps it unfolds as a whole.
    }
  }
  Unfolding unfolding = unfold(side.rim.positions, UnfoldOptions(), progress);
  divided.steps += unfolding.steps;
  if (unfolding.polygon.empty())
    throw CompletionError(stage, "A part of the divided rim could not be unfolded.");
  side.polygon = std::move(unfolding.polygon);
  side.flat = triangulate_polygon(side.polygon);
  divided.sides.push_back(std::move(side));
}

}  // namespace

std::vector<Chord> chords(const Rim& rim, const InputNeighbourhood& input, std::size_t count,
                          const Progress& progress) {
  const std::size_t n = rim.positions.size();
  std::vector<double> way(n + 1, 0.0);  // along the rim
  for (std::size_t i = 0; i < n; ++i)
    way[i + 1] = way[i] + (rim.positions[(i + 1) % n] - rim.positions[i]).norm();
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
      if (i == 0 && k + 1 == n) continue;  // an edge of the rim
      const double arc = std::min(way[k] - way[i], way[n] - (way[k] - way[i]));
      if (arc < least_share * way[n] ||
          std::binary_search(rim.forbidden.begin(), rim.forbidden.end(), Chord(i, k)))
        continue;
      candidates.push_back({(rim.positions[k] - rim.positions[i]).norm() / arc, {i, k}});
    }
  std::sort(candidates.begin(), candidates.end());
  const auto are_close = [&](const Chord& one, const Chord& other, double share) {
    const auto near = [&](Index a, Index b) {
      const std::size_t distance = a > b ? a - b : b - a;
      return static_cast<double>(std::min(distance, n - distance)) <= share * static_cast<double>(n);
    };
    return (near(one.first, other.first) && near(one.second, other.second)) ||
           (near(one.first, other.second) && near(one.second, other.first));
  };
  std::vector<Chord> chosen, obstructed;
  for (const Candidate& candidate : candidates) {
    const auto close_to_any = [&](const std::vector<Chord>& others, double share) {
      return std::any_of(others.begin(), others.end(),
                         [&](const Chord& other) { return are_close(candidate.chord, other, share); });
    };
    if (chosen.size() == count || obstructed.size() == most_obstructed) break;
    if (close_to_any(chosen, closeness) || close_to_any(obstructed, closeness_to_obstructed)) continue;
    progress.check();
    const auto [i, k] = candidate.chord;
    (is_obstructed(input, rim.positions[i], rim.positions[k]) ? obstructed : chosen)
        .push_back(candidate.chord);
  }
  return chosen;
}

DividedRim divide(const Rim& rim, const Chord& chord, const InputNeighbourhood& input,
                  std::optional<double> edge_length, int depth, const Progress& progress) {
  const auto [from, to] = chord;
  const Vector3 &a = rim.positions[from], &b = rim.positions[to];
  const double target = edge_length.value_or(0.5 * (rim.edge_length[from] + rim.edge_length[to]));
  if ((b - a).norm() > most_pieces * target)
    throw CompletionError(stage,
                          "A chord would need too many vertices at this edge length; ask for longer edges.");
  const int pieces = std::max(1, static_cast<int>(std::lround((b - a).norm() / target)));
  DividedRim divided;
  std::vector<double> lengths;
  for (int i = 1; i < pieces; ++i) {
    const double share = static_cast<double>(i) / pieces;
    divided.points.push_back(as_stored(a + share * (b - a)));
    lengths.push_back((1 - share) * rim.edge_length[from] + share * rim.edge_length[to]);
  }
  const Index n = static_cast<Index>(rim.positions.size());
  FlatSide first = side_of(rim, from, to, divided.points, lengths, true);
  FlatSide second = side_of(rim, to, from, divided.points, lengths, false);
  add_side(std::move(first), input, edge_length, depth, n, divided, progress);
  add_side(std::move(second), input, edge_length, depth, n, divided, progress);
  return divided;
}

double expected_triangles(const DividedRim& divided, const EmbeddingOptions& options) {
  double sum = 0;
  for (const FlatSide& side : divided.sides) sum += expected_triangles(side.rim, side.flat, options);
  return sum;
}

PatchMesh embed(const Rim& rim, const DividedRim& divided, const EmbeddingOptions& options,
                const Progress& progress) {
  std::vector<Vector3> positions = rim.positions;
  positions.insert(positions.end(), divided.points.begin(), divided.points.end());
  std::vector<Triangle> triangles;
  for (const FlatSide& side : divided.sides) {
    const PatchMesh part = embed(side.rim, side.flat, options, progress);
    const Index size = static_cast<Index>(side.vertex.size());
    const Index offset = static_cast<Index>(positions.size()) - size;
    for (Triangle t : part.triangles()) {
      for (Index& corner : t) corner = corner < size ? side.vertex[corner] : corner + offset;
      triangles.push_back(t);
    }
    positions.insert(positions.end(), part.positions().begin() + size, part.positions().end());
  }
  return PatchMesh(std::move(positions), rim.positions.size(), std::move(triangles));
}

}  // namespace meshcomplete
