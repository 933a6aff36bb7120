// From a clean but rough patch to a fair one with the resolution of the mesh round it.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/core/fairing.h"
#include "common/core/patch_check.h"
#include "common/core/patch_mending.h"
#include "common/core/patch_mesh.h"
#include "common/core/progress.h"
#include "common/core/rim.h"

namespace meshcomplete {

struct FinishingOptions {
  bool remesh = true;  ///< give it the resolution of the mesh around
  std::optional<SurfaceEnergy> fairing = SurfaceEnergy::normal_variation;  ///< absent: none
  std::optional<double> edge_length;                                       ///< absent: as the mesh around
  /// What is tried instead where the patch then meets something: a membrane stays close to the rough patch,
  /// and none at all to its very shape.
  std::optional<SurfaceEnergy> calm = SurfaceEnergy::membrane;
  /// The normal variation is lowered from the rough patch's own shape, and moves no vertex farther than this
  /// share of the diagonal of the patch and the mesh's ring round it; absent: only the rim counts.
  std::optional<double> near_rough;
  /// The route of a patch that could only be left as it came.
  std::string plain_route = "faces of the volumes";

  /// Whether fairing with this energy keeps near the rough patch's shape.
  bool keeps_shape(const std::optional<SurfaceEnergy>& energy) const {
    return near_rough && energy == SurfaceEnergy::normal_variation;
  }
};

/// What a patch is finished against.
struct FinishingContext {
  const Rim& rim;
  const InputNeighbourhood& input;
  const std::vector<std::array<Vector3, 3>>& obstacles;  ///< beyond the input: patches of other holes
  std::function<PatchFault(const PatchMesh&)> find;      ///< the exact check
};

struct FinishedPatch {
  PatchMesh mesh;
  std::string route;   ///< how it was finished
  std::string defect;  ///< what is wrong with it; empty when nothing is
};

/// Remeshes and fairs a patch freely, and mends it where it then meets something. Where that is no help,
/// starts again from `rough`, which is clean, and remeshes and fairs it in guarded steps that keep it so.
/// Throws `Cancelled`. Cost: near-linear in the patch; guarded steps are some ten times dearer.
FinishedPatch finish(const PatchMesh& rough, const FinishingOptions& options, const FinishingContext& context,
                     const Progress& progress = Progress());

}  // namespace meshcomplete
