#include "filter_atomicvolumes/volume_smoothing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "common/core/patch.h"
#include "filter_atomicvolumes/rigid_cubes.h"
#include "filter_atomicvolumes/springs.h"
#include "filter_atomicvolumes/surface_contacts.h"

namespace meshcomplete {
namespace {

// A move that does not fit is halved so often: then it is some hundredths of what was wanted. Moving all the
// way or not at all, as the paper does, leaves half of the vertices where they are, and the patch rougher.
constexpr int most_halvings = 5;

class ConstrainedSmoother {
 public:
  ConstrainedSmoother(const LatticeMesh& mesh, const Decomposition& decomposition,
                      const VolumeComplex& complex, LabelledSurface& surface,
                      const VolumeSmoothingOptions& options, const Progress& progress)
      : mesh_(mesh),
        decomposition_(decomposition),
        surface_(surface),
        options_(options),
        springs_(surface),
        warp_(mesh, decomposition, complex, surface, options.points, progress) {
    list_triangles();
    for (Index v = 0; v < surface.vertices.size(); ++v)
      if (warp_.may_move(v) && first_[v + 1] > first_[v]) movable_.push_back(v);
  }

  VolumeSmoothingFigures run(const Progress& progress);

 private:
  void list_triangles();
  bool iterate(const Progress& progress);
  bool pull(Index vertex, const Vector3& target);
  bool try_to_move(Index vertex, const Vector3& to);
  bool enters_rigid(Index vertex) const;
  bool touches_moved(Index triangle) const;
  void copy_positions();
  std::size_t put_back_what_meets(const Progress& progress);
  template <class Visit>
  void for_triangles(Index vertex, Visit&& visit) const {
    for (std::size_t i = first_[vertex]; i < first_[vertex + 1]; ++i) visit(triangles_[i]);
  }

  const LatticeMesh& mesh_;
  const Decomposition& decomposition_;
  LabelledSurface& surface_;
  const VolumeSmoothingOptions& options_;
  Springs springs_;
  VolumeWarp warp_;
  std::vector<Index> movable_;      // ascending
  std::vector<std::size_t> first_;  // of each vertex, in `triangles_`
  std::vector<Index> triangles_;    // of the surface, at each vertex
};

void ConstrainedSmoother::list_triangles() {
  first_.assign(surface_.vertices.size() + 1, 0);
  for (const Triangle& t : surface_.triangles)
    for (Index v : t) ++first_[v + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  triangles_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (Index t = 0; t < surface_.triangles.size(); ++t)
    for (Index v : surface_.triangles[t]) triangles_[next[v]++] = t;
}

bool ConstrainedSmoother::enters_rigid(Index vertex) const {
  std::vector<std::array<Vector3, 3>> round;
  Box box;
  for_triangles(vertex, [&](Index t) {
    const auto& [a, b, c] = surface_.triangles[t];
    round.push_back({warp_.position(a), warp_.position(b), warp_.position(c)});
    box.include(bounding_box(round.back()[0], round.back()[1], round.back()[2]));
  });
  for (const StoredBox& cube : rigid_cubes_near(mesh_, decomposition_, box))
    for (const std::array<Vector3, 3>& triangle : round)
      if (enters(triangle, cube.low, cube.high)) return true;
  return false;
}

bool ConstrainedSmoother::try_to_move(Index vertex, const Vector3& to) {
  const Vector3 before = warp_.position(vertex);
  if (!to.allFinite() || as_stored(to) == before || !warp_.try_to_place(vertex, to)) return false;
  if (!enters_rigid(vertex)) return true;
  warp_.place(vertex, before);
  return false;
}

// As far as it may go: all the way, half, a quarter, ... Returns whether it moved.
bool ConstrainedSmoother::pull(Index vertex, const Vector3& target) {
  const Vector3 from = warp_.position(vertex);
  double share = 1;
  for (int i = 0; i <= most_halvings; ++i, share *= 0.5)
    if (try_to_move(vertex, from + share * (target - from))) return true;
  return false;
}

// Returns whether any vertex moved.
bool ConstrainedSmoother::iterate(const Progress& progress) {
  std::vector<Vector3> targets;
  targets.reserve(movable_.size());
  for (Index v : movable_) targets.push_back(springs_.rest(v, [&](Index n) { return warp_.position(n); }));
  bool any = false;
  for (std::size_t i = 0; i < movable_.size(); ++i) {
    any |= pull(movable_[i], targets[i]);
    if (i % 1024 == 0) progress.check();
  }
  if (any && options_.moving_centres) warp_.follow_centroids();
  return any;
}

bool ConstrainedSmoother::touches_moved(Index triangle) const {
  const Triangle& t = surface_.triangles[triangle];
  return warp_.moved(t[0]) || warp_.moved(t[1]) || warp_.moved(t[2]);
}

void ConstrainedSmoother::copy_positions() {
  for (Index v = 0; v < surface_.vertices.size(); ++v) surface_.vertices[v].position = warp_.position(v);
}

// Ends because every round puts back a vertex, or is the last.
std::size_t ConstrainedSmoother::put_back_what_meets(const Progress& progress) {
  std::vector<Index> changed;
  for (Index t = 0; t < surface_.triangles.size(); ++t)
    if (touches_moved(t)) changed.push_back(t);
  std::size_t count = 0;
  while (!changed.empty()) {
    copy_positions();
    std::vector<Index> vertices;
    for (Index t : triangles_in_contact(mesh_, decomposition_, surface_, changed, progress))
      for (Index v : surface_.triangles[t]) vertices.push_back(v);
    const std::vector<Index> back = warp_.put_back(vertices);
    count += back.size();
    changed.clear();
    for (Index v : back) for_triangles(v, [&](Index t) { changed.push_back(t); });
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  }
  copy_positions();
  return count;
}

VolumeSmoothingFigures ConstrainedSmoother::run(const Progress& progress) {
  for (int i = 0; i < options_.iterations && iterate(progress); ++i)
    progress.update(static_cast<double>(i + 1) / (options_.iterations + 1));
  VolumeSmoothingFigures figures;
  figures.movable = movable_.size();
  figures.put_back = put_back_what_meets(progress);
  for (Index v : movable_) figures.moved += warp_.moved(v);
  progress.update(1);
  return figures;
}

}  // namespace

VolumeSmoothingFigures smooth_constrained(const LatticeMesh& mesh, const Decomposition& decomposition,
                                          const VolumeComplex& complex, LabelledSurface& surface,
                                          const VolumeSmoothingOptions& options, const Progress& progress) {
  progress.check();
  if (options.iterations <= 0) return {};
  return ConstrainedSmoother(mesh, decomposition, complex, surface, options, progress).run(progress);
}

double mean_normal_jump(const LabelledSurface& surface) {
  std::vector<Vector3> normals;
  std::vector<std::array<Index, 3>> sides;  // lower end, higher end, triangle
  for (const Triangle& t : surface.triangles) {
    for (int k = 0; k < 3; ++k)
      sides.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3]),
                       static_cast<Index>(normals.size())});
    const Vector3& p = surface.vertices[t[0]].position;
    normals.push_back((surface.vertices[t[1]].position - p).cross(surface.vertices[t[2]].position - p));
  }
  std::sort(sides.begin(), sides.end());
  double sum = 0, weight = 0;
  for (std::size_t i = 0, past; i < sides.size(); i = past) {
    for (past = i; past < sides.size() && sides[past][0] == sides[i][0] && sides[past][1] == sides[i][1];)
      ++past;
    if (past != i + 2) continue;
    const Vector3 &m = normals[sides[i][2]], &n = normals[sides[i + 1][2]];
    const double length =
        (surface.vertices[sides[i][0]].position - surface.vertices[sides[i][1]].position).norm();
    sum += length * std::atan2(m.cross(n).norm(), m.dot(n));
    weight += length;
  }
  return weight > 0 ? sum / weight * 180 / std::acos(-1.0) : 0;
}

}  // namespace meshcomplete
