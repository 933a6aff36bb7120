#include "filter_poissoncompletion/initial_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>
#include <utility>

namespace meshcomplete {
namespace {

// Cells of the sampling's grid along the longest side of a component: some samples of every one, however
// small.
constexpr double least_cells = 4;

// Samples that are wanted at most: where the holes are small, more of a large mesh are of no use to them.
constexpr double most_samples = 20000;

constexpr Index none = 0xffffffffu;

class PointChooser {
 public:
  explicit PointChooser(const TriangleMesh& mesh) : mesh_(mesh), chosen_(mesh.vertices.size(), 0) {}

  InitialPoints run(const MeshTopology& topology, const std::vector<const BoundaryLoop*>& loops, int rings,
                    const std::function<double(const Vector3&)>& neighbourhood, const TriangleBlocks& blocks,
                    double sample_share) {
    take_rims(loops);
    take_inner_edges(topology);
    take_rings(rings);
    take_near(neighbourhood, blocks);
    if (sample_share > 0) take_samples(topology, sample_share);
    return std::move(points_);
  }

 private:
  void take(Index v) {
    if (chosen_[v]) return;
    chosen_[v] = 1;
    points_.vertices.push_back(v);
  }

  void take_rims(const std::vector<const BoundaryLoop*>& loops) {
    for (const BoundaryLoop* loop : loops)
      for (std::size_t k = 0; k < loop->faces.size(); ++k)
        points_.half_edges.push_back(half_edge_at(mesh_, *loop, k));
    for (Index h : points_.half_edges) {
      take(mesh_.triangles[h / 3][h % 3]);
      take(mesh_.triangles[h / 3][(h % 3 + 1) % 3]);
    }
    points_.on_rims = points_.vertices.size();
  }

  // Of the faces that have a corner on a rim.
  void take_inner_edges(const MeshTopology& topology) {
    points_.rim_edges = points_.half_edges.size();
    for (Index t = 0; t < mesh_.triangles.size(); ++t) {
      const Triangle& corners = mesh_.triangles[t];
      if (std::none_of(corners.begin(), corners.end(), [&](Index v) { return chosen_[v]; })) continue;
      for (Index h = 3 * t; h < 3 * t + 3; ++h) {
        const Index other = topology.opposite[h];
        const bool at_rim = chosen_[corners[h % 3]] || chosen_[corners[(h % 3 + 1) % 3]];
        if (at_rim && other < topology.opposite.size() && other > h) points_.half_edges.push_back(h);
      }
    }
  }

  // What is near a rim without being in its rings: the other side of a thin wall.
  void take_near(const std::function<double(const Vector3&)>& neighbourhood, const TriangleBlocks& blocks) {
    const std::size_t rims = points_.on_rims;
    for (std::size_t i = 0; i < rims; ++i) {
      const Vector3 at = mesh_.vertices[points_.vertices[i]];
      const double radius = neighbourhood(at);
      const Vector3 low = at - Vector3::Constant(radius), high = at + Vector3::Constant(radius);
      Box box;
      for (int k = 0; k < 3; ++k) {
        box.low[k] = low[k];
        box.high[k] = high[k];
      }
      blocks.visit(box, [&](Index t) {
        for (Index v : mesh_.triangles[t])
          if ((mesh_.vertices[v] - at).squaredNorm() < radius * radius) take(v);
        return true;
      });
    }
  }

  void take_rings(int rings) {
    std::vector<char> in_ring(mesh_.triangles.size(), 0);
    for (int ring = 0; ring < rings; ++ring) {
      std::vector<Index> fresh;
      for (Index t = 0; t < mesh_.triangles.size(); ++t) {
        const Triangle& corners = mesh_.triangles[t];
        if (in_ring[t] || std::none_of(corners.begin(), corners.end(), [&](Index v) { return chosen_[v]; }))
          continue;
        in_ring[t] = 1;
        fresh.push_back(t);
      }
      for (Index t : fresh)
        for (Index v : mesh_.triangles[t]) take(v);
    }
  }

  // The first vertex in every cell of a grid, for each component by itself.
  void take_samples(const MeshTopology& topology, double share) {
    const auto [component, boxes] = components(topology);
    double area = 0;
    for (const Triangle& t : mesh_.triangles) {
      const Vector3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
      area += 0.5 * (b - a).cross(c - a).norm();
    }
    const double wanted = std::min(share * static_cast<double>(mesh_.vertices.size()), most_samples);
    const double spacing = std::sqrt(area / std::max(wanted, 1.0));
    std::vector<Index> tried(mesh_.vertices.size(), none);  // with which component last
    std::unordered_set<std::uint64_t> taken;
    for (Index t = 0; t < mesh_.triangles.size(); ++t) {
      const Index own = component[t];
      const double cell = std::min(spacing, boxes[own].sizes().maxCoeff() / least_cells);
      if (!(cell > 0)) continue;
      for (Index v : mesh_.triangles[t]) {
        if (chosen_[v] || tried[v] == own) continue;
        tried[v] = own;
        std::uint64_t key = (own + std::uint64_t{1}) * 0xbf58476d1ce4e5b9u;
        for (int k = 0; k < 3; ++k) {
          const double step = std::floor((mesh_.vertices[v][k] - boxes[own].min()[k]) / cell);
          key = (key ^ static_cast<std::uint64_t>(step)) * 0x9e3779b97f4a7c15u;
          key ^= key >> 29;
        }
        if (taken.insert(key).second) take(v);
      }
    }
  }

  // The component of each triangle, and the box of each component.
  std::pair<std::vector<Index>, std::vector<Eigen::AlignedBox3d>> components(
      const MeshTopology& topology) const {
    std::vector<Index> component(mesh_.triangles.size(), none), open;
    std::vector<Eigen::AlignedBox3d> boxes;
    for (Index start = 0; start < component.size(); ++start) {
      if (component[start] != none) continue;
      const Index own = static_cast<Index>(boxes.size());
      Eigen::AlignedBox3d box;
      component[start] = own;
      open.assign(1, start);
      while (!open.empty()) {
        const Index t = open.back();
        open.pop_back();
        for (Index v : mesh_.triangles[t]) box.extend(mesh_.vertices[v]);
        for (Index h = 3 * t; h < 3 * t + 3; ++h) {
          const Index other = topology.opposite[h];
          if (other >= topology.opposite.size() || component[other / 3] != none) continue;
          component[other / 3] = own;
          open.push_back(other / 3);
        }
      }
      boxes.push_back(box);
    }
    return {std::move(component), std::move(boxes)};
  }

  const TriangleMesh& mesh_;
  std::vector<char> chosen_;
  InitialPoints points_;
};

}  // namespace

InitialPoints choose_initial_points(const TriangleMesh& mesh, const MeshTopology& topology,
                                    const std::vector<const BoundaryLoop*>& loops, int rings,
                                    const std::function<double(const Vector3&)>& neighbourhood,
                                    const TriangleBlocks& blocks, double sample_share) {
  return PointChooser(mesh).run(topology, loops, rings, neighbourhood, blocks, sample_share);
}

}  // namespace meshcomplete
