// What all "Close Holes" filters share: the way from MeshLab's mesh to the appended patch.
#pragma once

#include <QString>
#include <functional>
#include <optional>
#include <vector>

#include "common/core/hole_selection.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/progress.h"
#include "common/core/vertex_splits.h"
#include "common/host/close_holes_parameters.h"
#include "common/host/filter_declaration.h"

namespace meshcomplete {
namespace host {

/// A mesh that a filter adds as a layer of its own, beside the closed one.
struct ExtraLayer {
  QString suffix;  ///< appended to the name of the layer that was closed, e.g. "unfolded"
  TriangleMesh mesh;
};

struct ClosedHoles {
  Completion completion;
  std::vector<ExtraLayer> layers;  ///< those without triangles are left out
  /// Triangles of the snapshot, ascending, that the patch does not go with: the result is then a new layer
  /// without their faces, whatever the parameters say. An empty list is such a layer too. Absent: the patch
  /// goes with the mesh as it is.
  std::optional<std::vector<Index>> removed = std::nullopt;
  /// Fans of faces that get copies of their vertices in the new layer; the faces are numbered as there: the
  /// triangles that are left, then the patch's. Only where `removed` is there.
  std::vector<VertexSplit> splits = {};
  /// Removing and splitting was asked for by itself: a new layer is made for that even if no hole was closed,
  /// and vertices that only removed faces used are not in it.
  bool cleaned = false;
};

/// What a filter itself does: everything else is common.
using CloseHolesAlgorithm =
    std::function<ClosedHoles(const TriangleMesh& mesh, const MeshSelection& selection,
                              const HoleSelectionOptions& holes, const Progress& progress)>;

/// Takes a snapshot of the current layer, runs the algorithm on it, appends its patch to the layer (or to a
/// copy in a new layer, without the faces that the algorithm names) and writes to the log what became of each
/// hole. The parameters are those of `close_holes_parameters`. Nothing is changed before the algorithm has
/// finished.
void close_holes(FilterRun& run, const CloseHolesAlgorithm& algorithm);

}  // namespace host
}  // namespace meshcomplete
