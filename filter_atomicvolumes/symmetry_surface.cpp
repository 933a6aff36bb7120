#include "filter_atomicvolumes/symmetry_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/closest_point.h"
#include "common/core/error.h"

namespace meshcomplete {
namespace {

// Samples whose images are looked at: shares of the area are known to within 0.8 % (one standard deviation).
constexpr std::size_t sample_count = 4096;
// Sites of the table, so many that they are nearer to each other than cells are.
constexpr std::size_t site_count = 16384;
// Cells along the diagonal; at most 80^3 / 3^1.5 lie in the bounding box, which fit a processor's cache.
constexpr double cells_per_diagonal = 80;
// How far the table reaches beyond the bounding box. Images further out are told their distance, which is all
// they need.
constexpr double table_margin = 0.1;

// Triangles in a leaf of the tree: a box costs as much memory as four triangles' numbers and time as two of
// them.
constexpr std::size_t leaf_size = 8;

Vector3 area_vector(const TriangleMesh& mesh, Index triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Vector3& a = mesh.vertices[t[0]];
  return 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

// 0 for a triangle that has none or is not finite.
double area_of(const TriangleMesh& mesh, Index triangle) {
  const double area = area_vector(mesh, triangle).norm();
  return std::isfinite(area) ? area : 0;
}

// Calls take(item, i, position) for the positions (i + 1/2) / count of the way along items laid end to end;
// `position` says where in the item, from 0 to 1.
template <class Take>
void spread(const std::vector<double>& lengths, double total, std::size_t count, Take&& take) {
  double before = 0;
  std::size_t item = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = total * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    while (item + 1 < lengths.size() && before + lengths[item] <= at) before += lengths[item++];
    if (lengths[item] > 0) take(item, i, std::clamp((at - before) / lengths[item], 0.0, 1.0));
  }
}

// The i-th of a sequence that fills the unit square evenly (the additive recurrence of the plastic number).
std::pair<double, double> in_square(std::size_t i) {
  const double n = static_cast<double>(i), u = 0.5 + n * 0.75487766624669276,
               v = 0.5 + n * 0.56984029099805327;
  return {u - std::floor(u), v - std::floor(v)};
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum;
}

}  // namespace

SampledSurface::SampledSurface(const TriangleMesh& mesh, const Progress& progress)
    : mesh_(mesh), topology_(build_topology(mesh, progress.part(0, 0.3, "finding the boundary"))) {
  rim_vertex_.assign(mesh.vertices.size(), false);
  for (Index h : topology_.boundary_half_edges) {
    rim_vertex_[mesh.triangles[h / 3][h % 3]] = true;
    rim_vertex_[mesh.triangles[h / 3][(h % 3 + 1) % 3]] = true;
  }
  std::vector<double> areas(mesh.triangles.size());
  for (Index t = 0; t < areas.size(); ++t) areas[t] = area_of(mesh, t);
  const double area = sum_of(areas);
  if (!(area > 0 && std::isfinite(area)))
    throw CompletionError("finding symmetries", "The mesh has no surface whose symmetries could be found.");
  build_tree(areas);
  progress.update(0.5);
  take_samples(areas);
  take_rim_sites(std::sqrt(area / site_count));
  progress.update(0.7);
  fill_table();
  progress.update(1);
}

void SampledSurface::build_tree(const std::vector<double>& areas) {
  Eigen::AlignedBox3d whole;
  std::vector<Index> triangles;
  for (Index t = 0; t < areas.size(); ++t) {
    if (!(areas[t] > 0)) continue;
    triangles.push_back(t);
    for (Index corner : mesh_.triangles[t]) whole.extend(mesh_.vertices[corner]);
  }
  diagonal_ = whole.diagonal().norm();
  middle_ = whole.center();
  half_size_ = 0.5 * whole.diagonal() / diagonal_;
  std::vector<Box> boxes;
  std::vector<std::array<Eigen::Vector3f, 3>> corners;
  for (Index t : triangles) {
    corners.emplace_back();
    for (int k = 0; k < 3; ++k)
      corners.back()[k] = in_frame(mesh_.vertices[mesh_.triangles[t][k]]).cast<float>();
    const auto& [a, b, c] = corners.back();
    boxes.push_back(bounding_box(a.cast<double>(), b.cast<double>(), c.cast<double>()));
  }
  std::vector<Box> leaves((triangles.size() + leaf_size - 1) / leaf_size);
  for (Index i : spatial_order(boxes)) {
    leaves[order_.size() / leaf_size].include(boxes[i]);
    order_.push_back(triangles[i]);
    corners_.insert(corners_.end(), corners[i].begin(), corners[i].end());
  }
  tree_ = BoxTree(std::move(leaves));
}

SurfacePoint SampledSurface::point_of(Index triangle, double u, double v) const {
  const Triangle& t = mesh_.triangles[triangle];
  const Vector3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
  SurfacePoint point;
  point.position = in_frame(a + u * (b - a) + v * (c - a));
  point.normal = area_vector(mesh_, triangle).normalized();
  return point;
}

void SampledSurface::take_samples(const std::vector<double>& areas) {
  const double area = sum_of(areas);
  const auto take = [&](std::size_t count, std::vector<SurfacePoint>& points) {
    spread(areas, area, count, [&](std::size_t triangle, std::size_t i, double) {
      auto [u, v] = in_square(i);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      points.push_back(point_of(static_cast<Index>(triangle), u, v));
    });
  };
  take(sample_count, samples_);
  take(site_count, sites_);
}

// Images beyond a rim have a site of the rim as their neighbour, however large the triangles there are.
void SampledSurface::take_rim_sites(double spacing) {
  std::vector<Index> edges;
  std::vector<double> lengths;
  for (Index h : topology_.boundary_half_edges)
    if (area_of(mesh_, h / 3) > 0) {
      const Triangle& t = mesh_.triangles[h / 3];
      edges.push_back(h);
      lengths.push_back((mesh_.vertices[t[(h % 3 + 1) % 3]] - mesh_.vertices[t[h % 3]]).norm());
    }
  if (edges.empty()) return;
  const double length = sum_of(lengths);
  const double wanted = std::clamp(length / spacing, 1.0, static_cast<double>(site_count));
  spread(lengths, length, static_cast<std::size_t>(wanted), [&](std::size_t edge, std::size_t, double at) {
    const Index h = edges[edge];
    const double u[3] = {at, 1 - at, 0}, v[3] = {0, at, 1 - at};
    sites_.push_back(point_of(h / 3, u[h % 3], v[h % 3]));
    sites_.back().on_rim = true;
  });
}

// Every cell takes over the site of a neighbour that is nearer to its centre, swept along each axis both
// ways: nearly the nearest site, in six passes.
void SampledSurface::fill_table() {
  table_corner_ = -half_size_ - Vector3::Constant(table_margin);
  std::size_t total = 1;
  for (int k = 0; k < 3; ++k) {
    cells_[k] = static_cast<int>(std::ceil(2 * (half_size_[k] + table_margin) * cells_per_diagonal));
    total *= static_cast<std::size_t>(cells_[k]);
  }
  table_.assign(total, -1);
  std::vector<double> best(total, std::numeric_limits<double>::infinity());
  const std::array<int, 3> stride = {1, cells_[0], cells_[0] * cells_[1]};
  const auto offer = [&](const std::array<int, 3>& cell, std::int32_t site) {
    if (site < 0) return;
    const Vector3 centre =
        table_corner_ + (Vector3(cell[0], cell[1], cell[2]) + Vector3::Constant(0.5)) / cells_per_diagonal;
    const std::size_t at = static_cast<std::size_t>(cell[0] + stride[1] * cell[1] + stride[2] * cell[2]);
    const double distance = (sites_[site].position - centre).squaredNorm();
    if (!(distance < best[at])) return;
    best[at] = distance;
    table_[at] = site;
  };
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    const Vector3 at = (sites_[i].position - table_corner_) * cells_per_diagonal;
    std::array<int, 3> cell;
    for (int k = 0; k < 3; ++k) cell[k] = std::clamp(static_cast<int>(at[k]), 0, cells_[k] - 1);
    offer(cell, static_cast<std::int32_t>(i));
  }
  for (int axis = 0; axis < 3; ++axis)
    for (int way : {1, -1}) {
      std::array<int, 3> cell;
      const int i = axis, j = (axis + 1) % 3, k = (axis + 2) % 3;
      for (cell[k] = 0; cell[k] < cells_[k]; ++cell[k])
        for (cell[j] = 0; cell[j] < cells_[j]; ++cell[j])
          for (int step = 1; step < cells_[i]; ++step) {
            cell[i] = way > 0 ? step : cells_[i] - 1 - step;
            const int at = cell[0] + stride[1] * cell[1] + stride[2] * cell[2];
            offer(cell, table_[static_cast<std::size_t>(at - way * stride[i])]);
          }
    }
}

const SurfacePoint& SampledSurface::rough_neighbour(const Vector3& x) const {
  const Vector3 at = (x - table_corner_) * cells_per_diagonal;
  std::size_t cell = 0;
  for (int k = 2; k >= 0; --k) {
    const double last = cells_[k] - 1;
    cell =
        cell * static_cast<std::size_t>(cells_[k]) + static_cast<std::size_t>(std::clamp(at[k], 0.0, last));
  }
  return sites_[static_cast<std::size_t>(table_[cell])];
}

// Of the triangles whose normal, of any length, has `accept(normal, its squared length)`.
template <class Accept>
bool SampledSurface::search(const Vector3& x, double radius, Accept&& accept, SurfacePoint& found) const {
  double best = radius * radius;
  std::size_t nearest = order_.size();
  ClosestPoint closest;
  const auto try_triangle = [&](std::size_t i) {
    const Vector3 a = corners_[3 * i].cast<double>(), b = corners_[3 * i + 1].cast<double>(),
                  c = corners_[3 * i + 2].cast<double>();
    const Vector3 normal = (b - a).cross(c - a);
    const double squared_length = normal.squaredNorm(), height = normal.dot(x - a);
    if (!(height * height < best * squared_length) || !accept(normal, squared_length)) return;
    const ClosestPoint here = closest_point(x, a, b, c);
    const double distance = (here.position - x).squaredNorm();
    if (!(distance < best)) return;
    best = distance;
    nearest = i;
    closest = here;
  };
  tree_.descend([&](const Box& box) { return squared_distance(box, x) < best; },
                [&](std::size_t leaf) {
                  const std::size_t past = std::min((leaf + 1) * leaf_size, order_.size());
                  for (std::size_t i = leaf * leaf_size; i < past; ++i) try_triangle(i);
                  return true;
                });
  if (nearest == order_.size()) return false;
  found.position = closest.position;
  found.normal = area_vector(mesh_, order_[nearest]).normalized();
  found.on_rim = is_on_rim(order_[nearest], closest.place);
  return true;
}

bool SampledSurface::is_on_rim(Index triangle, int place) const {
  if (place >= ClosestPoint::corner)
    return rim_vertex_[mesh_.triangles[triangle][static_cast<std::size_t>(place - ClosestPoint::corner)]];
  return place >= ClosestPoint::edge &&
         topology_.opposite[3 * triangle + static_cast<Index>(place)] == MeshTopology::boundary;
}

bool SampledSurface::closest(const Vector3& x, double radius, SurfacePoint& found) const {
  return search(
      x, radius, [](const Vector3&, double) { return true; }, found);
}

bool SampledSurface::closest_facing(const Vector3& x, const Vector3& normal, double radius,
                                    SurfacePoint& found) const {
  const auto alike = [&](const Vector3& other, double squared_length) {
    const double dot = normal.dot(other);
    return dot > 0 && dot * dot >= least_alike * least_alike * squared_length;
  };
  return search(x, radius, alike, found);
}

}  // namespace meshcomplete
