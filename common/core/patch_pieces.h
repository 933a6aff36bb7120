// The pieces of a patch, and which boundary loops each of them closes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch.h"
#include "common/core/rim_patch.h"
#include "common/core/sheets.h"

namespace meshcomplete {

/// A connected piece of the patch, from its first triangles to what is appended to the mesh.
struct PatchPiece {
  Sheet sheet;
  std::vector<std::size_t> loops;  ///< that it closes, or parts of them; ascending
  bool wanted = false;
  std::optional<RimPatch> rough;  ///< its first triangles, joined to the mesh
  Patch patch;
  std::string route;   ///< how it was finished
  std::string part;    ///< what of its holes the patch closes; empty when all
  std::string defect;  ///< why there is no patch; empty when there is
};

/// Which loop a boundary half-edge belongs to.
class LoopNumbers {
 public:
  LoopNumbers(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops);
  std::optional<std::size_t> of(Index half_edge) const;

 private:
  std::unordered_map<Index, std::size_t> loop_;
};

/// The sheets that touch a rim. A sheet with an edge that is no boundary of `topology` is open there.
std::vector<PatchPiece> make_pieces(std::vector<Sheet> sheets, const MeshTopology& topology,
                                    const LoopNumbers& loops);

/// Pieces that share a loop stand or fall together: positions in `pieces`, ascending.
std::vector<std::vector<std::size_t>> group_by_loops(const std::vector<PatchPiece>& pieces);

/// The loops that any of these pieces closes; ascending.
std::vector<std::size_t> loops_of(const std::vector<PatchPiece>& pieces,
                                  const std::vector<std::size_t>& group);

/// What keeps a group from closing its loops, `Sheet::Flaw::none` when nothing does: the worst flaw of its
/// sheets, or that an edge of a loop has no sheet.
Sheet::Flaw flaw_of(const std::vector<PatchPiece>& pieces, const std::vector<std::size_t>& group,
                    const std::vector<BoundaryLoop>& loops);

}  // namespace meshcomplete
