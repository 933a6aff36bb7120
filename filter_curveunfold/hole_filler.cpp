#include "filter_curveunfold/hole_filler.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "common/core/error.h"
#include "common/core/patch_mending.h"
#include "common/core/rim.h"
#include "common/core/triangle_intersection.h"
#include "filter_curveunfold/divided_rim.h"
#include "filter_curveunfold/embedding.h"
#include "filter_curveunfold/pinched_rim.h"
#include "filter_curveunfold/polygon_triangulation.h"

namespace meshcomplete {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// How often the vertices of patches are moved one by one, for all tries with one flat triangulation together.
constexpr int most_untanglings = 3;

// With more tangled triangles than this another energy or resolution is no help: only another triangulation
// may be. Of a patch that will have many triangles a coarse one is made first, with enough of them to follow
// its rim, and tells how many there will be: patches meet along curves, so that their number grows with the
// square root of all.
constexpr std::size_t most_to_try_again = 1000;
constexpr double triangles_to_probe = 20000;
constexpr double triangles_of_probe = 10000;
constexpr double probe_triangles_per_edge = 4;

// A patch of more triangles is not tried again at twice the resolution: that takes long, and its trouble is
// its shape. Nor with another unfolding when the patches of other holes are in its way: they are there
// whatever the unfolding.
constexpr std::size_t large_patch = 5000;

// Ways to the plane, each with another triangulation: what is asked for; descended even where a shorter way
// was found, so that the rim develops as a whole; opened further towards a convex polygon; and divided by a
// chord into rims that are unfolded each by itself.
enum class Way { asked, descended, stretched, divided };

// How many chords are tried, and how often their sides are divided again.
constexpr std::size_t most_chords = 4;
constexpr int divisions = 2;

// What is in the way of a patch is called a piece of its own up to this size; larger ones are not searched to
// their end.
constexpr std::size_t most_faces_of_a_piece = 20000;

// One way to close the hole.
struct Try {
  Way way;
  SurfaceEnergy energy;
  double resolution;
  double flap_height;     // of the flaps that open a pinched rim
  std::size_t chord = 0;  // of the best chords, to divide the rim by
};

// What is asked for, then the others from stiff to soft: a membrane overshoots least.
std::vector<SurfaceEnergy> energies(SurfaceEnergy asked) {
  switch (asked) {
    case SurfaceEnergy::normal_variation:
      return {asked, SurfaceEnergy::thin_plate, SurfaceEnergy::membrane};
    case SurfaceEnergy::thin_plate:
      return {asked, SurfaceEnergy::membrane};
    case SurfaceEnergy::membrane:
      return {asked, SurfaceEnergy::thin_plate};
  }
  return {asked};
}

// What is asked for; the other energies; more resolution; and then other unfoldings. A pinched rim is opened
// behind the surface first, where it shows least.
std::vector<Try> tries(const CurveUnfoldingOptions& options, bool pinched) {
  std::vector<Try> list;
  const std::vector<double> heights =
      pinched ? std::vector<double>{0.2, -0.2, 0.07, -0.07} : std::vector<double>{0.0};
  for (Way way : {Way::asked, Way::descended, Way::stretched}) {
    if (way == Way::descended && options.unfolding.method != UnfoldMethod::automatic) continue;
    // Annealing again would take as long as the first time, to end in much the same polygon.
    if (way == Way::stretched && options.unfolding.method == UnfoldMethod::annealing) continue;
    for (double height : heights) {
      for (SurfaceEnergy energy : energies(options.energy)) list.push_back({way, energy, 1.0, height});
      if (way == Way::asked && height == heights.front()) list.push_back({way, options.energy, 2.0, height});
    }
  }
  for (std::size_t chord = 0; chord < most_chords; ++chord)
    for (SurfaceEnergy energy : energies(options.energy))
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

std::string why_not_unfolded(const Unfolding& unfolding) {
  if (unfolding.outcome == UnfoldOutcome::knotted)
    return "the rim is knotted (determinant " + std::to_string(unfolding.knot_determinant.value_or(0)) +
           "), so no disk without self-intersections can close it";
  return "the rim could not be unfolded to the plane without crossing itself; try the other unfolding method "
         "or more "
         "restarts";
}

class HoleFiller {
 public:
  HoleFiller(const HoleFillerContext& context, const BoundaryLoop& loop,
             const std::vector<std::array<Vector3, 3>>& obstacles, const Progress& progress)
      : context_(context),
        loop_(loop),
        obstacles_(obstacles),
        progress_(progress),
        rim_(collect_rim(context.mesh, context.topology, loop)),
        pinched_(is_pinched(rim_)) {}

  FilledHole fill();

 private:
  bool unfold_rim(const Try& plan);
  bool divide_rim(std::size_t chord);
  Vector3 flap_corner(Index corner) const;
  std::string attempt(const Try& plan);
  PatchMesh embed_flat(const Try& plan, const EmbeddingOptions& options);
  std::string probe(const Try& plan, EmbeddingOptions options);
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
  DividedRim divided_;
  std::vector<std::array<Vector3, 3>> in_the_way_;  // the obstacles, and the flaps
  FilledHole result_;
  bool mended_ = false;
  int untanglings_ = most_untanglings;  // left for the flat triangulation at hand
  bool hopeless_ = false;               // with the flat triangulation at hand
  std::size_t triangles_ = 0;           // of the last patch that was embedded at the resolution asked for
  std::vector<Index> met_;              // triangles of the input that the last patch to meet any of them met
  std::vector<double> wanted_;          // edge lengths, per vertex of the rim
};

// Opens the rim, unfolds and triangulates it; false when that cannot be done, with the reason set if there is
// none yet.
bool HoleFiller::unfold_rim(const Try& plan) {
  const std::tuple wanted(plan.way, plan.flap_height, plan.chord);
  const bool divided = plan.way == Way::divided;
  if (unfolded_ == wanted) return !result_.flat.empty();
  unfolded_ = wanted;
  untanglings_ = most_untanglings;
  hopeless_ = false;
  opened_ = open_pinches(rim_, plan.flap_height);
  in_the_way_ = obstacles_;
  for (const Triangle& t : opened_.flaps)
    in_the_way_.push_back({flap_corner(t[0]), flap_corner(t[1]), flap_corner(t[2])});
  result_.polygon.clear();
  result_.flat.clear();
  if (divided) return divide_rim(plan.chord);
  UnfoldOptions options = context_.options.unfolding;
  options.stretch = plan.way == Way::stretched;
  if (plan.way == Way::descended) options.method = UnfoldMethod::descent;
  unfolding_ = unfold(opened_.rim.positions, options, progress_);
  result_.times.unfolding += unfolding_.seconds;
  result_.times.restarts += unfolding_.restarts;
  result_.times.steps += unfolding_.steps;
  if (unfolding_.polygon.empty()) {
    if (result_.reason.empty()) result_.reason = why_not_unfolded(unfolding_);
    return false;
  }
  const auto start = Clock::now();
  result_.polygon = unfolding_.polygon;
  const double scale = length(opened_.rim.positions) / length(result_.polygon);
  for (Eigen::Vector2d& p : result_.polygon) p *= scale;
  result_.flat = triangulate_polygon(unfolding_.polygon);
  result_.times.embedding += seconds_since(start);
  return true;
}

// Divides the rim by one of the best chords, and lays its sides out one beside the other, as long as they are
// in space.
bool HoleFiller::divide_rim(std::size_t chord) {
  if (unfolding_.outcome == UnfoldOutcome::knotted) return false;
  const auto start = Clock::now();
  if (chord == 0) chords_ = chords(opened_.rim, context_.neighbourhood, most_chords, progress_);
  if (chord >= chords_.size()) return false;
  divided_ = divide(opened_.rim, chords_[chord], context_.neighbourhood, context_.options.edge_length,
                    divisions, progress_);
  result_.times.steps += divided_.steps;
  double left = 0;
  for (const FlatSide& side : divided_.sides) {
    const double scale = length(side.rim.positions) / length(side.polygon);
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : side.polygon) box.extend(scale * p);
    const Index first = static_cast<Index>(result_.polygon.size());
    for (const Eigen::Vector2d& p : side.polygon)
      result_.polygon.push_back(scale * p + Eigen::Vector2d(left - box.min().x(), -box.min().y()));
    for (const Triangle& t : side.flat) result_.flat.push_back({t[0] + first, t[1] + first, t[2] + first});
    left += 1.1 * box.sizes().x();
  }
  result_.times.unfolding += seconds_since(start);
  return true;
}

// A corner of a flap, as `opened_` numbers it.
Vector3 HoleFiller::flap_corner(Index corner) const {
  const Index n = static_cast<Index>(loop_.vertices.size());
  return corner < n ? context_.mesh.vertices[loop_.vertices[corner]] : opened_.corners[corner - n];
}

Patch HoleFiller::as_patch(const PatchMesh& embedded) const {
  Patch patch;
  patch.input_vertices = static_cast<Index>(context_.mesh.vertices.size());
  const Index rim_size = static_cast<Index>(loop_.vertices.size());
  patch.vertices = opened_.corners;
  const Index first_inner = patch.input_vertices + static_cast<Index>(opened_.corners.size());
  for (Index v = rim_size; v < embedded.vertex_count(); ++v)
    patch.vertices.push_back(as_stored(embedded.position(v)));
  const auto rim_vertex = [&](Index v) {
    return v < rim_size ? loop_.vertices[v] : patch.input_vertices + (v - rim_size);
  };
  for (const Triangle& t : embedded.triangles()) {
    Triangle corners;
    for (int k = 0; k < 3; ++k)
      corners[k] = t[k] < rim_size ? rim_vertex(opened_.vertex_of[t[k]]) : first_inner + (t[k] - rim_size);
    patch.triangles.push_back(corners);
  }
  for (const Triangle& t : opened_.flaps)
    patch.triangles.push_back({rim_vertex(t[0]), rim_vertex(t[1]), rim_vertex(t[2])});
  return patch;
}

// Checks the patch. When triangles meet what they must not, returns them, but none of the flaps, which follow
// the embedded triangles and stay as they are. `defect` is empty when all is well.
std::vector<Index> HoleFiller::tangled_triangles(const Patch& patch, std::string& defect) {
  const auto start = Clock::now();
  PatchCheck check = check_patch(context_.neighbourhood, patch, {&loop_}, progress_);
  defect = check.passed() ? std::string() : describe(check.defect);
  if (!check.passed() && !can_be_mended(check.defect)) check.patch_triangles.clear();
  if (check.defect == PatchDefect::meets_input) met_ = std::move(check.input_triangles);
  if (defect.empty() && !obstacles_.empty()) {
    std::vector<std::array<Vector3, 3>> triangles;
    for (const Triangle& t : patch.triangles) triangles.push_back(corners(context_.mesh, patch, t));
    for (const auto& pair : improper_pairs_between(triangles, obstacles_))
      check.patch_triangles.push_back(pair.first);
    if (!check.patch_triangles.empty()) defect = "the patch meets the patch of another hole";
  }
  const std::size_t embedded = patch.triangles.size() - opened_.flaps.size();
  auto& tangled = check.patch_triangles;
  tangled.erase(std::lower_bound(tangled.begin(), tangled.end(), embedded), tangled.end());
  result_.times.checking += seconds_since(start);
  return std::move(tangled);
}

PatchMesh HoleFiller::embed_flat(const Try& plan, const EmbeddingOptions& options) {
  return plan.way == Way::divided ? embed(opened_.rim, divided_, options, progress_)
                                  : embed(opened_.rim, result_.flat, options, progress_);
}

// Finds out from a coarse patch whether a large one is hopeless; returns the defect of the coarse one.
std::string HoleFiller::probe(const Try& plan, EmbeddingOptions options) {
  const double expected = plan.way == Way::divided ? expected_triangles(divided_, options)
                                                   : expected_triangles(opened_.rim, result_.flat, options);
  const double edges = static_cast<double>(loop_.vertices.size());
  const double wanted = std::max(triangles_of_probe, probe_triangles_per_edge * edges);
  if (expected < triangles_to_probe || expected < 2 * wanted) return {};
  const auto start = Clock::now();
  options.resolution *= std::sqrt(wanted / expected);
  const PatchMesh coarse = embed_flat(plan, options);
  result_.times.embedding += seconds_since(start);
  std::string defect;
  const double tangled = static_cast<double>(tangled_triangles(as_patch(coarse), defect).size());
  const double share = expected / static_cast<double>(coarse.triangle_count());
  hopeless_ = !defect.empty() && tangled * std::sqrt(share) > most_to_try_again;
  return defect;
}

// Embeds, checks, and mends the patch where it is tangled. Returns the defect that is left, or fills
// `result_.patch`.
std::string HoleFiller::attempt(const Try& plan) {
  EmbeddingOptions options;
  options.energy = plan.energy;
  options.weights = context_.options.weights;
  options.edge_length = context_.options.edge_length;
  options.resolution = plan.resolution;
  wanted_ = target_lengths(opened_.rim, options);
  mended_ = false;
  if (std::string defect = probe(plan, options); hopeless_) return defect;
  const auto start = Clock::now();
  PatchMesh embedded = embed_flat(plan, options);
  if (plan.resolution <= 1) triangles_ = embedded.triangle_count();
  const double checking = result_.times.checking;
  MendingOptions mending{opened_.rim, wanted_, context_.neighbourhood, in_the_way_, untanglings_};
  Patch patch;
  const Mending mended = mend(
      embedded, mending,
      [&](const PatchMesh& now) {
        patch = as_patch(now);
        PatchFault fault;
        fault.triangles = tangled_triangles(patch, fault.defect);
        return fault;
      },
      progress_);
  untanglings_ = mending.untanglings;
  mended_ = mended.changed;
  result_.times.embedding += seconds_since(start) - (result_.times.checking - checking);
  hopeless_ = mended.last.triangles.size() > most_to_try_again;
  if (!mended.last.defect.empty()) return mended.first.defect;
  result_.patch = std::move(patch);
  return {};
}

std::string HoleFiller::route(const Try& plan, int count) const {
  std::string route = name(unfolding_.outcome);
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
                     " of this rim, so that every patch would meet them; apply 'Select Self Intersecting "
                     "Faces' and delete "
                     "them first";
    return std::move(result_);
  }
  int count = 0;
  for (const Try& plan : tries(context_.options, pinched_)) {
    progress_.check();
    if (plan.way != Way::asked && !context_.thorough) continue;
    const bool costly = plan.resolution > 1 || (plan.way != Way::asked && !obstacles_.empty());
    if (costly && triangles_ > large_patch) continue;
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
  if (result_.patch.empty() && result_.reason == describe(PatchDefect::meets_input))
    if (const std::size_t faces = separate_piece(context_.topology, met_, loop_.faces, most_faces_of_a_piece))
      result_.reason += "; a piece of " + std::to_string(faces) +
                        (faces == 1 ? " face that is" : " faces that are") +
                        " not connected to this rim is in the way: delete or move it first";
  return std::move(result_);
}

}  // namespace

FilledHole fill_hole(const HoleFillerContext& context, const BoundaryLoop& loop,
                     const std::vector<std::array<Vector3, 3>>& obstacles, const Progress& progress) {
  return HoleFiller(context, loop, obstacles, progress).fill();
}

}  // namespace meshcomplete
