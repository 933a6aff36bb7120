// Mending a patch that meets itself, the input or other patches in a few places.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/patch_check.h"
#include "common/core/patch_mesh.h"
#include "common/core/progress.h"
#include "common/core/rim.h"

namespace meshcomplete {

/// What is wrong with a patch: empty when nothing is, and the triangles (numbers in the patch mesh,
/// ascending) that may be changed to mend it; none when nothing local is wrong.
struct PatchFault {
  std::string defect;
  std::vector<Index> triangles;
};

/// Whether another triangulation of a spot may mend it; anything else is wrong with the whole patch.
bool can_be_mended(PatchDefect defect);

struct MendingOptions {
  const Rim& rim;
  const std::vector<double>& wanted;  ///< edge length at each vertex of the rim
  const InputNeighbourhood& input;
  const std::vector<std::array<Vector3, 3>>& obstacles;
  int untanglings = 3;  ///< how often vertices may be moved one by one, the dearest step; counted down
};

struct Mending {
  PatchFault first;      ///< before anything was done
  PatchFault last;       ///< what is left
  bool changed = false;  ///< whether anything was done
};

/// As long as `find` tells of triangles, has them replaced by others over few rings and then more, relaxed,
/// and at last untangled. `find` is asked after every change. The patch is compacted. Throws `Cancelled`.
/// Cost: a few times that of `find`, and for every tangled spot that of `retriangulate`, `relax_around`,
/// `untangle`.
Mending mend(PatchMesh& patch, MendingOptions& options,
             const std::function<PatchFault(const PatchMesh&)>& find, const Progress& progress = Progress());

}  // namespace meshcomplete
