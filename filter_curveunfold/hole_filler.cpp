#include "filter_curveunfold/hole_filler.h"

#include "common/core/error.h"
#include "common/core/rim.h"
#include "common/core/triangle_intersection.h"
#include "filter_curveunfold/embedding.h"
#include "filter_curveunfold/polygon_triangulation.h"

#include <chrono>
#include <optional>

namespace meshcomplete {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// One way to close the hole.
struct Try {
  bool stretched;  // the second unfolding
  SurfaceEnergy energy;
  double resolution;
};

SurfaceEnergy other_energy(SurfaceEnergy energy) {
  return energy == SurfaceEnergy::membrane ? SurfaceEnergy::thin_plate : SurfaceEnergy::membrane;
}

// What is asked for; the other energy; more resolution; and all of them again with another unfolding.
std::vector<Try> tries(const CurveUnfoldingOptions& options) {
  std::vector<Try> list;
  for (bool stretched : {false, true}) {
    list.push_back({stretched, options.energy, 1.0});
    list.push_back({stretched, other_energy(options.energy), 1.0});
    list.push_back({stretched, options.energy, 2.0});
    list.push_back({stretched, other_energy(options.energy), 2.0});
  }
  return list;
}

std::string unfolding_name(UnfoldOutcome outcome) {
  switch (outcome) {
    case UnfoldOutcome::projected: return "projected";
    case UnfoldOutcome::annealed: return "annealed";
    case UnfoldOutcome::untangled: return "untangled";
    case UnfoldOutcome::knotted: return "knotted";
    case UnfoldOutcome::not_unfolded: return "not unfolded";
  }
  return "";
}

std::string why_not_unfolded(const Unfolding& unfolding) {
  if (unfolding.outcome == UnfoldOutcome::knotted)
    return "the rim is knotted (determinant " + std::to_string(unfolding.knot_determinant.value_or(0)) +
           "), so no disk without self-intersections can close it";
  return "the rim could not be unfolded to the plane without crossing itself; try the other unfolding method or more "
         "restarts";
}

class HoleFiller {
 public:
  HoleFiller(const HoleFillerContext& context, const BoundaryLoop& loop,
             const std::vector<std::array<Vector3, 3>>& obstacles, const Progress& progress)
      : context_(context), loop_(loop), obstacles_(obstacles), progress_(progress),
        rim_(collect_rim(context.mesh, context.topology, loop)) {}

  FilledHole fill();

 private:
  bool unfold_rim(bool stretched);
  Patch attempt(const Try& plan);
  std::string defect_of(const Patch& patch);
  Patch as_patch(const EmbeddedPatch& embedded) const;

  const HoleFillerContext& context_;
  const BoundaryLoop& loop_;
  const std::vector<std::array<Vector3, 3>>& obstacles_;
  const Progress& progress_;
  Rim rim_;
  Unfolding unfolding_;
  FilledHole result_;
};

// Unfolds and triangulates; false when that cannot be done, with the reason set for the first unfolding.
bool HoleFiller::unfold_rim(bool stretched) {
  UnfoldOptions options = context_.options.unfolding;
  options.stretch = stretched;
  Unfolding unfolding = unfold(rim_.positions, options, progress_);
  result_.times.unfolding += unfolding.seconds;
  result_.times.restarts += unfolding.restarts;
  result_.times.steps += unfolding.steps;
  if (unfolding.polygon.empty()) {
    if (!stretched) result_.reason = why_not_unfolded(unfolding);
    return false;
  }
  const auto start = Clock::now();
  unfolding_ = std::move(unfolding);
  result_.polygon = unfolding_.polygon;
  result_.flat = triangulate_polygon(unfolding_.polygon);
  result_.times.embedding += seconds_since(start);
  return true;
}

Patch HoleFiller::as_patch(const EmbeddedPatch& embedded) const {
  Patch patch;
  patch.input_vertices = static_cast<Index>(context_.mesh.vertices.size());
  const Index rim_size = static_cast<Index>(loop_.vertices.size());
  for (const Vector3& p : embedded.inner) patch.vertices.push_back(as_stored(p));
  for (Triangle t : embedded.triangles) {
    for (Index& corner : t)
      corner = corner < rim_size ? loop_.vertices[corner] : patch.input_vertices + (corner - rim_size);
    patch.triangles.push_back(t);
  }
  return patch;
}

std::string HoleFiller::defect_of(const Patch& patch) {
  const auto start = Clock::now();
  const PatchCheck check = check_patch(context_.neighbourhood, patch, {&loop_}, progress_);
  std::string defect = check.passed() ? std::string() : describe(check.defect);
  if (defect.empty() && !obstacles_.empty()) {
    std::vector<std::array<Vector3, 3>> triangles;
    for (const Triangle& t : patch.triangles) {
      const auto corner = [&](int k) {
        return t[k] < patch.input_vertices ? context_.mesh.vertices[t[k]] : patch.vertices[t[k] - patch.input_vertices];
      };
      triangles.push_back({corner(0), corner(1), corner(2)});
    }
    if (!improper_pairs_between(triangles, obstacles_).empty()) defect = "the patch meets the patch of another hole";
  }
  result_.times.checking += seconds_since(start);
  return defect;
}

Patch HoleFiller::attempt(const Try& plan) {
  const auto start = Clock::now();
  EmbeddingOptions options;
  options.energy = plan.energy;
  options.weights = context_.options.weights;
  options.edge_length = context_.options.edge_length;
  options.resolution = plan.resolution;
  const EmbeddedPatch embedded = embed(rim_, result_.flat, options, progress_);
  result_.times.embedding += seconds_since(start);
  return as_patch(embedded);
}

FilledHole HoleFiller::fill() {
  std::optional<bool> unfolded;  // with or without stretching, what `result_.flat` holds
  int count = 0;
  for (const Try& plan : tries(context_.options)) {
    progress_.check();
    if (unfolded != plan.stretched) {
      if (!unfold_rim(plan.stretched)) break;
      unfolded = plan.stretched;
    }
    ++count;
    std::string defect;
    try {
      Patch patch = attempt(plan);
      defect = defect_of(patch);
      if (defect.empty()) {
        result_.patch = std::move(patch);
        result_.reason.clear();
        result_.route = unfolding_name(unfolding_.outcome) + (plan.stretched ? " and stretched" : "") + ", " +
                        name(plan.energy) + (plan.resolution > 1 ? ", finer" : "") +
                        (count > 1 ? ", try " + std::to_string(count) : "");
        return std::move(result_);
      }
    } catch (const Cancelled&) {
      throw;
    } catch (const CompletionError& error) {
      defect = error.what();
    }
    if (result_.reason.empty()) result_.reason = defect;
  }
  return std::move(result_);
}

}  // namespace

FilledHole fill_hole(const HoleFillerContext& context, const BoundaryLoop& loop,
                     const std::vector<std::array<Vector3, 3>>& obstacles, const Progress& progress) {
  return HoleFiller(context, loop, obstacles, progress).fill();
}

}  // namespace meshcomplete
