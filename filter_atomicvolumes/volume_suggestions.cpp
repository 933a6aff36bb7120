#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "common/core/closest_point.h"
#include "filter_atomicvolumes/rigid_cubes.h"
#include "filter_atomicvolumes/springs.h"
#include "filter_atomicvolumes/volume_smoothing.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;

class Suggester {
 public:
  Suggester(const LatticeMesh& mesh, const Decomposition& decomposition, const VolumeComplex& complex,
            const LabelledSurface& surface, const VolumeSmoothingOptions& options)
      : mesh_(mesh), decomposition_(decomposition), complex_(complex), surface_(surface), options_(options) {}

  std::vector<NodeTie> run(const Progress& progress) {
    relax(progress);
    if (options_.cost.weight() != CutWeight::area)
      faces_ = measure_faces(mesh_, complex_, options_.cost, progress);
    progress.update(0.5);
    for (Index t = 0; t < surface_.triangles.size(); ++t) {
      if (t % 256 == 0) progress.check();
      const auto& [a, b, c] = surface_.triangles[t];
      see({positions_[a], positions_[b], positions_[c]});
    }
    progress.update(1);
    return ties();
  }

 private:
  // What of the surface is closest to a volume's centre.
  struct Sight {
    double distance = std::numeric_limits<double>::infinity();
    double height = 0;  // of the centre above the triangle's plane
    double price = 0;
  };

  void relax(const Progress& progress);
  void see(const Corners& triangle);
  void look(Cell node, const StoredBox& box, const Corners& triangle);
  std::vector<NodeTie> ties() const;
  // Of a cube's six faces one, as the cut counts it; smaller neighbours divide it.
  double face_of(Cell node, double side) const {
    return options_.cost.weight() == CutWeight::area ? side * side
                                                     : faces_.of_node[static_cast<std::size_t>(node)] / 6;
  }

  const LatticeMesh& mesh_;
  const Decomposition& decomposition_;
  const VolumeComplex& complex_;
  const LabelledSurface& surface_;
  const VolumeSmoothingOptions& options_;
  std::vector<Vector3> positions_;
  std::map<Cell, Sight> sights_;
  FaceMeasure faces_;  // for weights other than the area
};

void Suggester::relax(const Progress& progress) {
  const Springs springs(surface_);
  for (const VolumeVertex& v : surface_.vertices) positions_.push_back(v.position);
  std::vector<Vector3> next = positions_;
  for (int i = 0; i < options_.iterations; ++i) {
    progress.check();
    for (Index v = 0; v < next.size(); ++v)
      if (is_octree_point(surface_.vertices[v]))
        next[v] = springs.rest(v, [&](Index n) { return positions_[n]; });
    positions_ = next;
  }
}

// Cubes only: tetrahedra are smaller than the stairs, and those near the smoothed surface would make new
// ones along the rim.
void Suggester::see(const Corners& triangle) {
  const Box round = bounding_box(triangle[0], triangle[1], triangle[2]);
  visit_leaves(mesh_, decomposition_.octree, round, [&](Index cube) {
    if (decomposition_.volumes[cube].kind != VolumeKind::blank) return;
    const StoredBox box = stored_box(mesh_, decomposition_.octree, cube);
    if (enters(triangle, box.low, box.high)) look(complex_.cube_cells[cube], box, triangle);
  });
}

void Suggester::look(Cell node, const StoredBox& box, const Corners& t) {
  const Vector3 centre = 0.5 * (box.low + box.high),
                away = centre - closest_point(centre, t[0], t[1], t[2]).position;
  const double side = box.high[0] - box.low[0];
  const double distance = away.norm(), height = (t[1] - t[0]).cross(t[2] - t[0]).normalized().dot(away);
  Sight& sight = sights_[node];
  // Of triangles with a common closest point the one that faces the centre most tells the side.
  const bool nearer =
      distance < sight.distance || (distance == sight.distance && std::abs(height) > std::abs(sight.height));
  if (nearer) sight = {distance, height, options_.suggestion * face_of(node, side)};
}

std::vector<NodeTie> Suggester::ties() const {
  std::vector<NodeTie> ties;
  for (const auto& [node, sight] : sights_)
    if (sight.height != 0 && sight.price > 0) ties.push_back({node, sight.height < 0, sight.price});
  return ties;
}

}  // namespace

std::vector<NodeTie> suggest_by_springs(const LatticeMesh& mesh, const Decomposition& decomposition,
                                        const VolumeComplex& complex, const LabelledSurface& surface,
                                        const VolumeSmoothingOptions& options, const Progress& progress) {
  return Suggester(mesh, decomposition, complex, surface, options).run(progress);
}

}  // namespace meshcomplete
