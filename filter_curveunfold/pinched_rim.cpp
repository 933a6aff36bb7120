#include "filter_curveunfold/pinched_rim.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "common/core/patch.h"

namespace meshcomplete {
namespace {

using Position = std::array<double, 3>;
Position key(const Vector3& p) { return {p.x(), p.y(), p.z()}; }

// Groups of rim vertices at one position, those with one member left out.
std::vector<std::vector<Index>> coincident_groups(const Rim& rim) {
  std::map<Position, std::vector<Index>> at;
  for (Index v = 0; v < rim.positions.size(); ++v) at[key(rim.positions[v])].push_back(v);
  std::vector<std::vector<Index>> groups;
  for (auto& [position, vertices] : at)
    if (vertices.size() > 1) groups.push_back(std::move(vertices));
  std::sort(groups.begin(), groups.end());
  return groups;
}

// The directions into the surface and out of it at a rim vertex.
struct Frame {
  Vector3 inwards = Vector3::Zero();
  Vector3 normal = Vector3::Zero();
};

Frame frame_at(const Rim& rim, Index vertex) {
  Frame frame;
  for (const Triangle& t : rim.ring.triangles)
    for (int k = 0; k < 3; ++k) {
      if (t[k] != vertex) continue;
      const Vector3 a = rim.ring.vertices[t[(k + 1) % 3]] - rim.ring.vertices[vertex];
      const Vector3 b = rim.ring.vertices[t[(k + 2) % 3]] - rim.ring.vertices[vertex];
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      frame.inwards += angle * (a.normalized() + b.normalized());
      frame.normal += angle * a.cross(b).stableNormalized();
    }
  frame.inwards.stableNormalize();
  frame.normal.stableNormalize();
  return frame;
}

class PinchOpener {
 public:
  PinchOpener(const Rim& rim, double height) : original_(rim), height_(height) {
    opened_.rim = rim;
    opened_.vertex_of.resize(rim.positions.size());
    std::iota(opened_.vertex_of.begin(), opened_.vertex_of.end(), 0u);
  }

  OpenedRim open() {
    for (const std::vector<Index>& group : coincident_groups(original_))
      for (std::size_t i = 1; i < group.size(); ++i) {
        cover(group[i]);
        for (std::size_t j = 0; j < i; ++j) forbid_twin_edges(group[i], group[j]);
      }
    auto& forbidden = opened_.rim.forbidden;
    std::sort(forbidden.begin(), forbidden.end());
    forbidden.erase(std::unique(forbidden.begin(), forbidden.end()), forbidden.end());
    return std::move(opened_);
  }

 private:
  void cover(Index vertex) {
    const Index n = static_cast<Index>(original_.positions.size());
    const Index before = (vertex + n - 1) % n, after = (vertex + 1) % n;
    const Vector3& p = original_.positions[vertex];
    const double edge =
        std::min((original_.positions[before] - p).norm(), (original_.positions[after] - p).norm());
    const Frame frame = frame_at(original_, vertex);
    const Vector3 corner = as_stored(p + edge * (std::abs(height_) * frame.inwards - height_ * frame.normal));
    const Index number = n + static_cast<Index>(opened_.corners.size());
    opened_.corners.push_back(corner);
    opened_.flaps.push_back({opened_.vertex_of[before], vertex, number});
    opened_.flaps.push_back({vertex, opened_.vertex_of[after], number});
    opened_.vertex_of[vertex] = number;
    opened_.rim.positions[vertex] = corner;
    opened_.rim.ring.vertices[vertex] = corner;
  }

  // An edge from the twin to a neighbour of the covered vertex would lie on an edge that exists.
  void forbid_twin_edges(Index covered, Index twin) {
    const Index n = static_cast<Index>(original_.positions.size());
    auto& forbidden = opened_.rim.forbidden;
    const auto forbid = [&](Index a, Index b) {
      if (a != b) forbidden.emplace_back(std::min(a, b), std::max(a, b));
    };
    for (const auto& [a, b] : original_.forbidden) {
      if (a == covered) forbid(twin, b);
      if (b == covered) forbid(twin, a);
    }
    forbid(twin, (covered + n - 1) % n);
    forbid(twin, (covered + 1) % n);
    forbid(covered, (twin + n - 1) % n);
    forbid(covered, (twin + 1) % n);
  }

  const Rim& original_;
  const double height_;
  OpenedRim opened_;
};

}  // namespace

bool is_pinched(const Rim& rim) { return !coincident_groups(rim).empty(); }

OpenedRim open_pinches(const Rim& rim, double height) { return PinchOpener(rim, height).open(); }

}  // namespace meshcomplete
