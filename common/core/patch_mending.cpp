#include "common/core/patch_mending.h"

#include <utility>

#include "common/core/patch_relaxation.h"
#include "common/core/patch_retriangulation.h"
#include "common/core/patch_untangling.h"

namespace meshcomplete {
namespace {

// What is done, one after the other, to a patch that is tangled somewhere: its triangles there replaced by
// others, over few rings and then more; relaxed, with enough sweeps for a few rings to settle on the
// membrane; and at last vertices moved one by one, as long as that helps.
enum class Way { retriangulate, relax, untangle };
struct Step {
  Way way;
  int rings;
};
constexpr std::array<Step, 12> steps = {{{Way::retriangulate, 0},
                                         {Way::retriangulate, 1},
                                         {Way::relax, 1},
                                         {Way::retriangulate, 1},
                                         {Way::relax, 2},
                                         {Way::retriangulate, 1},
                                         {Way::retriangulate, 2},
                                         {Way::retriangulate, 3},
                                         {Way::untangle, 0},
                                         {Way::untangle, 0},
                                         {Way::untangle, 1},
                                         {Way::retriangulate, 2}}};
constexpr int relaxation_sweeps = 10;
constexpr int untangling_rounds = 3;
// Patches with more tangled triangles are not worth it.
constexpr std::size_t most_to_mend = 300;
constexpr std::size_t most_to_untangle = 60;
constexpr int most_passes = 3;  // over all steps

// Whether the step changed the patch.
bool apply(const Step& step, PatchMesh& patch, const std::vector<Index>& tangled, MendingOptions& options,
           const Progress& progress) {
  switch (step.way) {
    case Way::retriangulate:
      return retriangulate(patch, tangled, options.rim, options.wanted, options.input, options.obstacles,
                           step.rings, progress) > 0;
    case Way::relax:
      relax_around(patch, tangled, step.rings, relaxation_sweeps);
      return true;
    case Way::untangle:
      if (tangled.size() > most_to_untangle || options.untanglings <= 0) return false;
      --options.untanglings;
      untangle(patch, tangled, options.input, options.obstacles, options.rim.forbidden, step.rings,
               untangling_rounds, progress);
      return true;
  }
  return false;
}

}  // namespace

bool can_be_mended(PatchDefect defect) {
  switch (defect) {
    case PatchDefect::edge_not_manifold:
    case PatchDefect::vertex_not_manifold:
    case PatchDefect::degenerate_face:
    case PatchDefect::coincident_vertices:
    case PatchDefect::meets_itself:
    case PatchDefect::meets_input:
      return true;
    default:
      return false;
  }
}

Mending mend(PatchMesh& patch, MendingOptions& options,
             const std::function<PatchFault(const PatchMesh&)>& find, const Progress& progress) {
  Mending mending;
  mending.first = find(patch);
  PatchFault& fault = mending.last;
  fault = mending.first;
  std::size_t before = fault.triangles.size() + 1;
  for (int pass = 0; pass < most_passes && !fault.defect.empty() && fault.triangles.size() < before; ++pass) {
    before = fault.triangles.size();
    for (const Step& step : steps) {
      if (fault.triangles.empty() || fault.triangles.size() > most_to_mend) break;
      if (!apply(step, patch, fault.triangles, options, progress)) continue;
      mending.changed = true;
      fault = find(patch);
    }
  }
  return mending;
}

}  // namespace meshcomplete
