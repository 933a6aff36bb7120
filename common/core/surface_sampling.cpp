#include "common/core/surface_sampling.h"

#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "common/core/error.h"
#include "common/core/threads.h"

namespace meshcomplete {
namespace {

// Triangles that one go of a thread samples; part of the result, so it must not depend on the machine.
constexpr std::size_t grain = 4096;

// A triangle is divided as long as its longest side is longer than this many cubes: then one size of cubes is
// right for all of it.
constexpr double longest_side = 2;

// The nearest points by which the area that a point stands for is measured: enough for the mean to be steady,
// few enough to stay on one side of the surface.
constexpr unsigned neighbours = 10;

// Points on each face of a cube at least: with fewer, cubes follow the noise in the spacing of the points
// (Kazhdan and Hoppe take 1.5 samples per node for clean scans).
constexpr double points_per_cube = 2;

// The same for the cubes over which normals are spread: the sum of so many is steady. With 4 smooth surfaces
// become bumpy, with 16 small features fade.
constexpr double normals_per_cube = 9;

constexpr double pi = 3.14159265358979323846;

// The two numbers whose multiples fill the unit square most evenly (Roberts' R2 sequence).
constexpr double first_step = 0.7548776662466927, second_step = 0.5698402909980532;

// Parts of triangles, or samples, between two looks whether the user wants to stop, or there are too many
// samples: about a millisecond.
constexpr std::size_t parts_per_check = 4096;

class Sampler {
 public:
  Sampler(const TriangleMesh& mesh, const Lattice& lattice, const SamplingOptions& options,
          std::atomic<std::size_t>& total, const Progress& progress)
      : mesh_(mesh), lattice_(lattice), options_(options), total_(total), progress_(progress) {}

  std::vector<OrientedSample> sample(std::size_t begin, std::size_t end) {
    samples_.clear();
    owed_ = 0.5;
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& t = mesh_.triangles[i];
      const Vector3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
      const Vector3 normal = (b - a).cross(c - a);
      if (normal.allFinite() && !normal.isZero(0)) add(a, b, c, normal.normalized());
    }
    check();
    return std::move(samples_);
  }

 private:
  void check() {
    progress_.check();
    total_ += samples_.size() - counted_;
    counted_ = samples_.size();
    if (total_ > options_.max_samples)
      throw CompletionError("sampling the surface",
                            "The octree is too fine: it would need tens of millions of samples. Choose a "
                            "smaller maximum depth, or fewer samples.");
  }

  void add(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& normal) {
    const int depth = depth_of(lattice_, options_.cube_size((a + b + c) / 3), options_);
    const double side = lattice_.side() / static_cast<double>(std::int64_t{1} << depth);
    const std::array<double, 3> sides = {(b - a).norm(), (c - b).norm(), (a - c).norm()};
    const auto longest = std::max_element(sides.begin(), sides.end()) - sides.begin();
    if (sides[longest] > longest_side * side) {
      const Vector3* corners[] = {&a, &b, &c};
      const Vector3 &from = *corners[longest], &to = *corners[(longest + 1) % 3],
                    &across = *corners[(longest + 2) % 3], middle = 0.5 * (from + to);
      add(from, middle, across, normal);
      add(middle, to, across, normal);
      return;
    }
    if (++parts_ % parts_per_check == 0) check();
    const double area = side * side / options_.density;
    owed_ += 0.5 * (b - a).cross(c - a).norm() / area;
    for (; owed_ >= 1; owed_ -= 1, ++count_) {
      double u = std::fmod(0.5 + first_step * count_, 1.0), v = std::fmod(0.5 + second_step * count_, 1.0);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      samples_.push_back({a + u * (b - a) + v * (c - a), area * normal, depth});
      if (samples_.size() % parts_per_check == 0) check();
    }
  }

  const TriangleMesh& mesh_;
  const Lattice& lattice_;
  const SamplingOptions& options_;
  std::vector<OrientedSample> samples_;
  double owed_ = 0;  // samples that the triangles so far were too small for
  double count_ = 0;
  std::atomic<std::size_t>& total_;  // of all samplers
  const Progress& progress_;
  std::size_t parts_ = 0, counted_ = 0;
};

}  // namespace

int depth_of(const Lattice& lattice, double size, const SamplingOptions& options) {
  const double halvings = std::ceil(std::log2(lattice.side() / size));
  return static_cast<int>(
      std::clamp(halvings, static_cast<double>(options.min_depth), static_cast<double>(options.max_depth)));
}

std::vector<OrientedSample> sample_surface(const TriangleMesh& mesh, const Lattice& lattice,
                                           const SamplingOptions& options, const Progress& progress) {
  const std::size_t ranges = (mesh.triangles.size() + grain - 1) / grain;
  std::vector<std::vector<OrientedSample>> parts(ranges);
  std::atomic<std::size_t> total{0};
  for_each(ranges, 1, progress, [&](std::size_t range) {
    parts[range] = Sampler(mesh, lattice, options, total, progress)
                       .sample(range * grain, std::min((range + 1) * grain, mesh.triangles.size()));
  });
  std::vector<OrientedSample> samples;
  for (const std::vector<OrientedSample>& part : parts)
    samples.insert(samples.end(), part.begin(), part.end());
  return samples;
}

std::vector<OrientedSample> sample_points(const std::vector<Vector3>& points,
                                          const std::vector<Vector3>& normals, const Lattice& lattice,
                                          const SamplingOptions& options, const Progress& progress) {
  using Kernel = CGAL::Simple_cartesian<double>;
  using Item = std::pair<Kernel::Point_3, std::size_t>;
  using Traits = CGAL::Search_traits_adapter<Item, CGAL::First_of_pair_property_map<Item>,
                                             CGAL::Search_traits_3<Kernel>>;
  using Search = CGAL::Orthogonal_k_neighbor_search<Traits>;
  std::vector<Item> items;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].allFinite() && normals[i].allFinite() && !normals[i].isZero(0))
      items.emplace_back(Kernel::Point_3(points[i][0], points[i][1], points[i][2]), i);
  if (items.empty()) return {};
  Search::Tree tree(items.begin(), items.end());
  tree.build();
  std::vector<OrientedSample> samples(items.size());
  for_each(items.size(), grain, progress, [&](std::size_t i) {
    const Search search(tree, items[i].first, neighbours + 1);
    double reach = 0;  // squared
    std::size_t found = 0;
    for (const auto& [item, squared] : search) {
      reach = std::max(reach, static_cast<double>(squared));
      ++found;
    }
    const std::size_t point = items[i].second;
    // So many points on the disc that reaches half way beyond the last of them.
    const double area = found > 1 ? pi * reach / (static_cast<double>(found) - 0.5) : 0;
    const double cube = std::max(options.cube_size(points[point]), std::sqrt(points_per_cube * area));
    const int depth = depth_of(lattice, cube, options);
    const int steady = depth_of(lattice, std::sqrt(normals_per_cube * area), options);
    samples[i] = {points[point], area * normals[point].normalized(), depth, std::max(0, depth - steady)};
  });
  samples.erase(std::remove_if(samples.begin(), samples.end(),
                               [](const OrientedSample& s) { return s.area_normal.isZero(0); }),
                samples.end());
  return samples;
}

Lattice root_cube(const std::vector<const TriangleMesh*>& meshes, const std::vector<Vector3>& points,
                  double scale) {
  Eigen::AlignedBox3d box;
  for (const TriangleMesh* mesh : meshes)
    for (const Triangle& t : mesh->triangles)
      for (Index v : t)
        if (mesh->vertices[v].allFinite()) box.extend(mesh->vertices[v]);
  for (const Vector3& p : points)
    if (p.allFinite()) box.extend(p);
  const double side = box.isEmpty() ? 0 : scale * box.sizes().maxCoeff();
  if (!(side > 0)) throw CompletionError("sampling the surface", "The mesh has no extent.");
  return Lattice(box.center() - Vector3::Constant(0.5 * side), side);
}

}  // namespace meshcomplete
