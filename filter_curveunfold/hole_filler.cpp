#include "filter_curveunfold/hole_filler.h"

#include "common/core/error.h"
#include "common/core/patch_relaxation.h"
#include "common/core/patch_retriangulation.h"
#include "common/core/patch_untangling.h"
#include "common/core/rim.h"
#include "common/core/triangle_intersection.h"
#include "filter_curveunfold/divided_rim.h"
#include "filter_curveunfold/embedding.h"
#include "filter_curveunfold/pinched_rim.h"
#include "filter_curveunfold/polygon_triangulation.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

namespace meshcomplete {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// What is done, one after the other, to a patch that is tangled somewhere: its triangles there replaced by others, over few
// rings and then more; relaxed, with enough sweeps for a few rings to settle on the membrane; and at last vertices moved one
// by one, as long as that helps.
enum class Mending { retriangulate, relax, untangle };
struct MendingStep {
  Mending mending;
  int rings;
};
constexpr std::array<MendingStep, 12> mending_steps = {{{Mending::retriangulate, 0},
                                                        {Mending::retriangulate, 1},
                                                        {Mending::relax, 1},
                                                        {Mending::retriangulate, 1},
                                                        {Mending::relax, 2},
                                                        {Mending::retriangulate, 1},
                                                        {Mending::retriangulate, 2},
                                                        {Mending::retriangulate, 3},
                                                        {Mending::untangle, 0},
                                                        {Mending::untangle, 0},
                                                        {Mending::untangle, 1},
                                                        {Mending::retriangulate, 2}}};
constexpr int relaxation_sweeps = 10;
constexpr int untangling_rounds = 3;
// Patches with more tangled triangles are not worth it. The bounds are per patch, but for the last one, which is for all
// tries with one flat triangulation together.
constexpr std::size_t most_to_mend = 300;
constexpr std::size_t most_to_untangle = 60;
constexpr int most_untanglings = 3;

// With more tangled triangles than this another energy or resolution is no help: only another triangulation may be.
constexpr std::size_t most_to_try_again = 1000;

// A patch of more triangles is not tried again at twice the resolution: that takes long, and its trouble is its shape. Nor
// with another unfolding when the patches of other holes are in its way: they are there whatever the unfolding.
constexpr std::size_t most_triangles_to_refine = 5000;

// Ways to the plane, each with another triangulation: what is asked for; descended even where a shorter way was found, so
// that the rim develops as a whole; opened further towards a convex polygon; and divided by a chord into rims that are
// unfolded each by itself.
enum class Way { asked, descended, stretched, divided };

// How many chords are tried, and how often their sides are divided again.
constexpr std::size_t most_chords = 4;
constexpr int divisions = 2;

// One way to close the hole.
struct Try {
  Way way;
  SurfaceEnergy energy;
  double resolution;
  double flap_height;  // of the flaps that open a pinched rim
  std::size_t chord = 0;  // of the best chords, to divide the rim by
};

// What is asked for, then the others from stiff to soft: a membrane overshoots least.
std::vector<SurfaceEnergy> energies(SurfaceEnergy asked) {
  switch (asked) {
    case SurfaceEnergy::normal_variation: return {asked, SurfaceEnergy::thin_plate, SurfaceEnergy::membrane};
    case SurfaceEnergy::thin_plate: return {asked, SurfaceEnergy::membrane};
    case SurfaceEnergy::membrane: return {asked, SurfaceEnergy::thin_plate};
  }
  return {asked};
}

// What is asked for; the other energies; more resolution; and then other unfoldings. A pinched rim is opened behind the
// surface first, where it shows least.
std::vector<Try> tries(const CurveUnfoldingOptions& options, bool pinched) {
  std::vector<Try> list;
  const std::vector<double> heights = pinched ? std::vector<double>{0.2, -0.2, 0.07, -0.07} : std::vector<double>{0.0};
  for (Way way : {Way::asked, Way::descended, Way::stretched}) {
    if (way == Way::descended && options.unfolding.method != UnfoldMethod::automatic) continue;
    for (double height : heights) {
      for (SurfaceEnergy energy : energies(options.energy)) list.push_back({way, energy, 1.0, height});
      if (way == Way::asked && height == heights.front()) list.push_back({way, options.energy, 2.0, height});
    }
  }
  for (std::size_t chord = 0; chord < most_chords; ++chord)
    for (SurfaceEnergy energy : {SurfaceEnergy::thin_plate, SurfaceEnergy::membrane})
      list.push_back({Way::divided, energy, 1.0, heights.front(), chord});
  return list;
}

// Of a closed polygon.
template <class Points>
double length(const Points& points) {
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) sum += (points[i] - points[(i + 1) % points.size()]).norm();
  return sum;
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
        rim_(collect_rim(context.mesh, context.topology, loop)), pinched_(is_pinched(rim_)) {}

  FilledHole fill();

 private:
  bool unfold_rim(const Try& plan);
  std::string attempt(const Try& plan);
  bool mend(PatchMesh& embedded, const std::vector<Index>& tangled, const MendingStep& step);
  std::vector<Index> tangled_triangles(const Patch& patch, std::string& defect);
  Patch as_patch(const PatchMesh& embedded) const;
  std::string route(const Try& plan, int count) const;

  const HoleFillerContext& context_;
  const BoundaryLoop& loop_;
  const std::vector<std::array<Vector3, 3>>& obstacles_;
  const Progress& progress_;
  Rim rim_;
  const bool pinched_;
  OpenedRim opened_;  // what is unfolded and filled
  Unfolding unfolding_;
  std::optional<std::tuple<Way, double, std::size_t>> unfolded_;  // way, flap height, chord: what is at hand
  std::vector<Chord> chords_;
  FilledHole result_;
  bool mended_ = false;
  int untanglings_ = 0;
  bool hopeless_ = false;     // with the flat triangulation at hand
  bool all_hopeless_ = true;  // with all of them
  std::size_t triangles_ = 0;  // of the last embedded patch
};

// Opens the rim, unfolds and triangulates it; false when that cannot be done, with the reason set if there is none yet.
bool HoleFiller::unfold_rim(const Try& plan) {
  const std::tuple wanted(plan.way, plan.flap_height, plan.chord);
  const bool divided = plan.way == Way::divided;
  if (unfolded_ == wanted) return divided ? plan.chord < chords_.size() : !result_.flat.empty();
  unfolded_ = wanted;
  untanglings_ = 0;
  hopeless_ = false;
  opened_ = open_pinches(rim_, plan.flap_height);
  if (divided) {
    if (plan.chord == 0 && unfolding_.outcome != UnfoldOutcome::knotted)
      chords_ = chords(opened_.rim, context_.neighbourhood, most_chords);
    return plan.chord < chords_.size();
  }
  result_.flat.clear();
  UnfoldOptions options = context_.options.unfolding;
  options.stretch = plan.way == Way::stretched;
  if (plan.way == Way::descended) options.method = UnfoldMethod::descent;
  Unfolding unfolding = unfold(opened_.rim.positions, options, progress_);
  result_.times.unfolding += unfolding.seconds;
  result_.times.restarts += unfolding.restarts;
  result_.times.steps += unfolding.steps;
  if (unfolding.polygon.empty()) {
    unfolding_ = std::move(unfolding);
    if (result_.reason.empty()) result_.reason = why_not_unfolded(unfolding_);
    return false;
  }
  const auto start = Clock::now();
  unfolding_ = std::move(unfolding);
  result_.polygon = unfolding_.polygon;
  const double scale = length(opened_.rim.positions) / length(result_.polygon);
  for (Eigen::Vector2d& p : result_.polygon) p *= scale;
  result_.flat = triangulate_polygon(unfolding_.polygon);
  result_.times.embedding += seconds_since(start);
  return true;
}

Patch HoleFiller::as_patch(const PatchMesh& embedded) const {
  Patch patch;
  patch.input_vertices = static_cast<Index>(context_.mesh.vertices.size());
  const Index rim_size = static_cast<Index>(loop_.vertices.size());
  patch.vertices = opened_.corners;
  const Index first_inner = patch.input_vertices + static_cast<Index>(opened_.corners.size());
  for (Index v = rim_size; v < embedded.vertex_count(); ++v) patch.vertices.push_back(as_stored(embedded.position(v)));
  const auto rim_vertex = [&](Index v) {
    return v < rim_size ? loop_.vertices[v] : patch.input_vertices + (v - rim_size);
  };
  for (const Triangle& t : embedded.triangles()) {
    Triangle corners;
    for (int k = 0; k < 3; ++k)
      corners[k] = t[k] < rim_size ? rim_vertex(opened_.vertex_of[t[k]]) : first_inner + (t[k] - rim_size);
    patch.triangles.push_back(corners);
  }
  for (const Triangle& t : opened_.flaps) patch.triangles.push_back({rim_vertex(t[0]), rim_vertex(t[1]), rim_vertex(t[2])});
  return patch;
}

// Checks the patch. When triangles meet what they must not, returns them; `defect` is empty when all is well.
std::vector<Index> HoleFiller::tangled_triangles(const Patch& patch, std::string& defect) {
  const auto start = Clock::now();
  PatchCheck check = check_patch(context_.neighbourhood, patch, {&loop_}, progress_);
  defect = check.passed() ? std::string() : describe(check.defect);
  if (defect.empty() && !obstacles_.empty()) {
    std::vector<std::array<Vector3, 3>> triangles;
    for (const Triangle& t : patch.triangles) triangles.push_back(corners(context_.mesh, patch, t));
    for (const auto& pair : improper_pairs_between(triangles, obstacles_)) check.patch_triangles.push_back(pair.first);
    if (!check.patch_triangles.empty()) defect = "the patch meets the patch of another hole";
  }
  result_.times.checking += seconds_since(start);
  return std::move(check.patch_triangles);
}

// Embeds, checks, and relaxes the patch where it is tangled. Returns the defect that is left, or fills `result_.patch`.
std::string HoleFiller::attempt(const Try& plan) {
  auto start = Clock::now();
  EmbeddingOptions options;
  options.energy = plan.energy;
  options.weights = context_.options.weights;
  options.edge_length = context_.options.edge_length;
  options.resolution = plan.resolution;
  mended_ = false;
  PatchMesh embedded = plan.way == Way::divided
                           ? embed_divided(opened_.rim, chords_[plan.chord], context_.neighbourhood,
                                           context_.options.unfolding, options, divisions, progress_)
                           : embed(opened_.rim, result_.flat, options, progress_);
  result_.times.embedding += seconds_since(start);
  triangles_ = embedded.triangle_count();
  std::string defect;
  Patch patch = as_patch(embedded);
  std::vector<Index> tangled = tangled_triangles(patch, defect);
  const std::string first_defect = defect;
  for (std::size_t before = tangled.size() + 1; !defect.empty() && tangled.size() < before;) {
    before = tangled.size();
    for (const MendingStep& step : mending_steps) {
      // The flaps follow the embedded triangles; they stay as they are, and what meets them moves.
      tangled.erase(std::lower_bound(tangled.begin(), tangled.end(), embedded.triangle_count()), tangled.end());
      if (defect.empty() || tangled.empty() || tangled.size() > most_to_mend) break;
      start = Clock::now();
      const bool changed = mend(embedded, tangled, step);
      result_.times.embedding += seconds_since(start);
      if (!changed) continue;
      mended_ = true;
      patch = as_patch(embedded);
      tangled = tangled_triangles(patch, defect);
    }
  }
  hopeless_ = tangled.size() > most_to_try_again;
  all_hopeless_ = all_hopeless_ && hopeless_;
  if (!defect.empty()) return first_defect;
  result_.patch = std::move(patch);
  return {};
}

bool HoleFiller::mend(PatchMesh& embedded, const std::vector<Index>& tangled, const MendingStep& step) {
  switch (step.mending) {
    case Mending::retriangulate:
      return retriangulate(embedded, tangled, opened_.rim, context_.neighbourhood, obstacles_, step.rings, progress_) > 0;
    case Mending::relax:
      relax_around(embedded, tangled, step.rings, relaxation_sweeps);
      return true;
    case Mending::untangle:
      if (tangled.size() > most_to_untangle || ++untanglings_ > most_untanglings) return false;
      return untangle(embedded, tangled, context_.neighbourhood, obstacles_, opened_.rim.forbidden, step.rings,
                      untangling_rounds, progress_) > 0;
  }
  return false;
}

std::string HoleFiller::route(const Try& plan, int count) const {
  std::string route = unfolding_name(unfolding_.outcome);
  if (plan.way == Way::stretched) route += " and stretched";
  if (plan.way == Way::divided) route = "divided by a chord";
  if (pinched_) route = "opened where the rim touches itself, " + route;
  route += std::string(", ") + name(plan.energy);
  if (plan.resolution > 1) route += ", finer";
  if (mended_) route += ", mended locally";
  if (count > 1) route += ", try " + std::to_string(count);
  return route;
}

FilledHole HoleFiller::fill() {
  const std::size_t obstructed = obstructed_edges(context_.neighbourhood, loop_).size();
  if (obstructed > 0) {
    result_.reason = "other faces of the mesh pass through " + std::to_string(obstructed) +
                     (obstructed == 1 ? " edge" : " edges") +
                     " of this rim, so that every patch would meet them; apply 'Select Self Intersecting Faces' and delete "
                     "them first";
    return std::move(result_);
  }
  int count = 0;
  for (const Try& plan : tries(context_.options, pinched_)) {
    progress_.check();
    if (plan.way != Way::asked && !context_.thorough) continue;
    if ((plan.resolution > 1 || (plan.way != Way::asked && !obstacles_.empty())) && triangles_ > most_triangles_to_refine)
      continue;
    if (plan.way == Way::divided && count > 0 && all_hopeless_) continue;
    std::string defect;
    try {
      if (!unfold_rim(plan) || hopeless_) continue;
      ++count;
      defect = attempt(plan);
    } catch (const Cancelled&) {
      throw;
    } catch (const CompletionError& error) {
      defect = error.what();
    }
    if (defect.empty()) {
      result_.reason.clear();
      result_.route = route(plan, count);
      break;
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
