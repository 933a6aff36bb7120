#include "filter_poissoncompletion/surface_meshing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "common/core/error.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch.h"
#include "common/core/sheets.h"
#include "common/core/threads.h"
#include "filter_poissoncompletion/non_manifold_places.h"

namespace meshcomplete {
namespace {

constexpr const char* stage = "meshing the surface";

// Steps in which the surface is looked for along a line, each twice as long as the one before: the first is
// a thousandth of the reach.
constexpr int most_steps = 10;

// Starts that are tried in one task: about a millisecond.
constexpr std::size_t starts_per_task = 256;

// Rounding of the function's differences does not show in its slope over this part of the reach.
constexpr double slope_step = 1e-3;

// The corners of a cube: somewhere among them is the surface, where the slope leads nowhere.
const std::array<Vector3, 8>& directions() {
  static const std::array<Vector3, 8> all = [] {
    std::array<Vector3, 8> result;
    for (int k = 0; k < 8; ++k)
      result[static_cast<std::size_t>(k)] =
          Vector3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1) / std::sqrt(3.0);
    return result;
  }();
  return all;
}

class SurfaceFinder {
 public:
  SurfaceFinder(const ImplicitFunction& function, double reach, double tolerance)
      : function_(function), reach_(reach), tolerance_(tolerance) {}

  std::optional<Vector3> from(const Vector3& start) const {
    const double value = function_.value(start);
    if (value == 0) return start;
    Vector3 slope;
    for (int k = 0; k < 3; ++k) {
      const Vector3 step = slope_step * reach_ * Vector3::Unit(k);
      slope[k] = function_.value(start + step) - function_.value(start - step);
    }
    const double steepness = slope.norm();
    if (steepness > 0) {
      const Vector3 down = slope / (value > 0 ? -steepness : steepness);
      if (const auto found = along(start, value, down)) return found;
    }
    for (const Vector3& way : directions())
      if (const auto found = along(start, value, way)) return found;
    return std::nullopt;
  }

 private:
  std::optional<Vector3> along(const Vector3& start, double value, const Vector3& way) const {
    Vector3 before = start;
    double value_before = value;
    for (int step = 0; step <= most_steps; ++step) {
      const Vector3 here = start + std::ldexp(reach_, step - most_steps) * way;
      const double value_here = function_.value(here);
      if (const auto found = crossing(function_, before, here, value_before, value_here, tolerance_))
        return found;
      before = here;
      value_before = value_here;
    }
    return std::nullopt;
  }

  const ImplicitFunction& function_;
  double reach_, tolerance_;
};

// Takes apart what touches still.
SeparatingSurface separated(SeparatingSurface surface) {
  if (non_manifold_places(surface.triangles).empty()) return surface;
  const TriangleMesh nothing;
  SeparatingSurface result;
  for (const Sheet& sheet : split_into_sheets(nothing, build_topology(nothing), surface, nothing)) {
    const Index first = static_cast<Index>(result.vertices.size());
    result.vertices.insert(result.vertices.end(), sheet.vertices.begin(), sheet.vertices.end());
    for (const Triangle& t : sheet.triangles)
      result.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return result;
}

}  // namespace

std::vector<Vector3> find_surface_points(const ImplicitFunction& function, const std::vector<Vector3>& starts,
                                         double reach, double tolerance, const Progress& progress) {
  const SurfaceFinder finder(function, reach, tolerance);
  std::vector<std::optional<Vector3>> found(starts.size());
  for_each(starts.size(), starts_per_task, progress,
           [&](std::size_t i) { found[i] = finder.from(starts[i]); });
  std::vector<Vector3> points;
  for (const auto& point : found)
    if (point) points.push_back(as_stored(*point));
  return points;
}

TriangleMesh mesh_surface(const ImplicitFunction& function, const std::vector<Vector3>& points,
                          const SurfaceMeshingOptions& options, const Progress& progress) {
  RefinementOptions refinement;
  refinement.criteria = options.criteria;
  refinement.manifold = true;
  refinement.max_points = options.max_points;
  refinement.points_for_distance =
      options.vertices_for_distance - std::min(options.vertices_for_distance, points.size());
  const DelaunayComplex complex = refine_delaunay(function, points, refinement, progress);
  SeparatingSurface surface;
  std::vector<Index> number(complex.vertices.size(), DelaunayComplex::none);
  for (Triangle t : separating_facets(complex)) {
    for (Index& v : t) {
      if (complex.is_far(v)) throw CompletionError(stage, "The surface is not closed.");
      if (number[v] == DelaunayComplex::none) {
        number[v] = static_cast<Index>(surface.vertices.size());
        surface.vertices.push_back({complex.vertices[v]});
      }
      v = number[v];
    }
    surface.triangles.push_back(t);
  }
  if (surface.triangles.empty()) throw CompletionError(stage, "No surface was found.");
  surface = separated(std::move(surface));
  TriangleMesh mesh;
  for (const SheetVertex& v : surface.vertices) mesh.vertices.push_back(as_stored(v.position));
  mesh.triangles = std::move(surface.triangles);
  return mesh;
}

}  // namespace meshcomplete
