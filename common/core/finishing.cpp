#include "common/core/finishing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <set>
#include <utility>

#include "common/core/error.h"
#include "common/core/guarded_remeshing.h"
#include "common/core/patch.h"
#include "common/core/patch_fairing.h"
#include "common/core/patch_remeshing.h"

namespace meshcomplete {
namespace {

// After four solves with remeshing in between the shape no longer changes; two are too few when the first one
// starts from coarse stairs.
constexpr int solves = 4;
constexpr int rounds_between = 3;

// By how many times a patch may grow when it is faired, and a size that is always allowed.
constexpr double swelling = 16;
constexpr std::size_t least_limit = 10000;

// Guarded steps towards the fair surface.
constexpr int approaches = 3;
constexpr int sweeps = 4;

// The edge length that each vertex of the patch should have: that of the rim, spread over the patch so that
// every vertex has that of the rim vertex nearest along edges.
std::vector<double> spread(const PatchMesh& patch, const std::vector<double>& rim_length) {
  std::vector<double> size(patch.vertex_count(), 0),
      distance(patch.vertex_count(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  for (Index v = 0; v < patch.rim_size(); ++v) {
    size[v] = rim_length[v];
    distance[v] = 0;
    queue.emplace(0.0, v);
  }
  while (!queue.empty()) {
    const auto [far, v] = queue.top();
    queue.pop();
    if (far > distance[v]) continue;
    patch.for_neighbours(v, [&, from = v, so_far = far](Index w) {
      const double now = so_far + (patch.position(w) - patch.position(from)).norm();
      if (now >= distance[w]) return;
      distance[w] = now;
      size[w] = size[from];
      queue.emplace(now, w);
    });
  }
  return size;
}

// Splits edges from one vertex to two places of a rim vertex that the rim visits more than once: in the mesh
// they would be one edge with four faces.
void split_doubled_edges(PatchMesh& patch, const Rim& rim) {
  std::map<std::array<double, 3>, std::vector<Index>> places;
  for (Index v = 0; v < patch.rim_size(); ++v)
    places[{rim.positions[v][0], rim.positions[v][1], rim.positions[v][2]}].push_back(v);
  for (const auto& [position, same] : places) {
    if (same.size() < 2) continue;
    std::set<Index> reached;
    for (Index place : same) {
      std::vector<Index> doubled;
      patch.for_neighbours(place, [&](Index v) {
        if (!patch.on_rim(v) && !reached.insert(v).second) doubled.push_back(v);
      });
      for (Index v : doubled) {
        Index edge = PatchMesh::none;
        patch.for_outgoing(v, [&](Index h) {
          if (patch.target(h) == place) edge = h;
        });
        patch.split(edge, as_stored(0.5 * (patch.position(v) + patch.position(place))));
      }
    }
  }
}

// A patch of this area at these edge lengths, and swelling: what grows beyond that has no minimum to go to.
// Never more than remeshing allows by itself.
std::size_t most_vertices(const PatchMesh& patch, const std::vector<double>& length) {
  double count = 0;
  for (Index t = 0; t < patch.triangle_count(); ++t) {
    if (!patch.alive(t)) continue;
    double mean = 0;
    for (Index v : patch.triangles()[t]) mean += length[v] / 3;
    if (mean > 0) count += 0.5 * patch.area_normal(t).norm() / (mean * mean);
  }
  const double grown = static_cast<double>(patch.vertex_count() + least_limit) + swelling * count;
  const std::size_t most = RemeshOptions().max_vertices;
  return grown < static_cast<double>(most) ? static_cast<std::size_t>(grown) : most;
}

class Finisher {
 public:
  Finisher(const PatchMesh& rough, const FinishingOptions& options, const FinishingContext& context)
      : rough_(rough), options_(options), context_(context), wanted_(context.rim.edge_length) {
    if (options.edge_length) std::fill(wanted_.begin(), wanted_.end(), *options.edge_length);
  }

  FinishedPatch freely(const std::optional<SurfaceEnergy>& energy, const Progress& progress);
  FinishedPatch guarded(const Progress& progress);

 private:
  const PatchMesh& rough_;
  const FinishingOptions& options_;
  const FinishingContext& context_;
  std::vector<double> wanted_;
};

FinishedPatch Finisher::freely(const std::optional<SurfaceEnergy>& energy, const Progress& progress) {
  FinishedPatch result{rough_, "", ""};
  PatchMesh& patch = result.mesh;
  patch.compact();
  std::vector<double> target = spread(patch, wanted_);
  RemeshOptions remeshing;
  remeshing.forbidden = context_.rim.forbidden;
  remeshing.rounds = rounds_between;
  remeshing.max_vertices = most_vertices(patch, target);
  const bool keep = options_.keeps_shape(energy);
  if (energy && !keep)
    fair(patch, context_.rim, SurfaceEnergy::membrane, LaplacianWeights::uniform, progress);
  if (options_.remesh) remesh(patch, target, remeshing, progress);
  if (keep) fair_near(patch, context_.rim, *options_.near_rough, progress);
  for (int i = 0; energy && !keep && i < solves; ++i) {
    fair(patch, context_.rim, *energy, LaplacianWeights::cotangent, progress);
    if (options_.remesh && i + 1 < solves) remesh(patch, target, remeshing, progress);
  }
  split_doubled_edges(patch, context_.rim);
  MendingOptions mending{context_.rim, wanted_, context_.input, context_.obstacles};
  const Mending mended = mend(patch, mending, context_.find, progress);
  result.defect = mended.last.defect;
  result.route = energy ? name(*energy) : "remeshed";
  if (mended.changed) result.route += ", mended locally";
  return result;
}

FinishedPatch Finisher::guarded(const Progress& progress) {
  FinishedPatch result{rough_, "", ""};
  PatchMesh& patch = result.mesh;
  patch.compact();
  std::vector<double> target = spread(patch, wanted_);
  if (options_.remesh) {
    GuardedPatch guard(patch, context_.input, context_.rim.forbidden, context_.obstacles);
    guarded_remesh(guard, target, GuardedRemeshOptions(), progress);
  }
  patch.compact();
  for (int i = 0; options_.fairing && i < approaches; ++i) {
    PatchMesh goal = patch;
    if (options_.keeps_shape(options_.fairing))
      fair_near(goal, context_.rim, *options_.near_rough / approaches, progress);
    else
      fair(goal, context_.rim, *options_.fairing,
           i == 0 ? LaplacianWeights::uniform : LaplacianWeights::cotangent, progress);
    GuardedPatch guard(patch, context_.input, context_.rim.forbidden, context_.obstacles);
    guarded_approach(guard, goal.positions(), sweeps, progress);
  }
  split_doubled_edges(patch, context_.rim);
  result.defect = context_.find(patch).defect;
  result.route = options_.fairing ? std::string(name(*options_.fairing)) + " in guarded steps"
                                  : "remeshed in guarded steps";
  return result;
}

}  // namespace

FinishedPatch finish(const PatchMesh& rough, const FinishingOptions& options, const FinishingContext& context,
                     const Progress& progress) {
  Finisher finisher(rough, options, context);
  if (options.remesh || options.fairing) {
    std::vector<std::optional<SurfaceEnergy>> energies = {options.fairing};
    if (options.fairing && options.fairing != options.calm) energies.push_back(options.calm);
    for (const std::optional<SurfaceEnergy>& energy : energies) {
      try {
        FinishedPatch free = finisher.freely(energy, progress);
        if (energy != options.fairing) free.route += std::string(" instead of ") + name(*options.fairing);
        if (free.defect.empty()) return free;
      } catch (const Cancelled&) {
        throw;
      } catch (const CompletionError&) {
        // The equations had no solution, or the patch grew too large: guarded steps need neither.
      }
    }
    FinishedPatch guarded = finisher.guarded(progress);
    if (guarded.defect.empty()) return guarded;
  }
  FinishedPatch plain{rough, options.plain_route, ""};
  plain.mesh.compact();
  plain.defect = context.find(plain.mesh).defect;
  return plain;
}

}  // namespace meshcomplete
