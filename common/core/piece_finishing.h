// The pieces of a patch joined to the mesh, remeshed and faired, each for itself and then beside the others.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/core/finishing.h"
#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch_check.h"
#include "common/core/patch_pieces.h"
#include "common/core/progress.h"

namespace meshcomplete {

class PieceFinisher {
 public:
  /// `divided` is the input as space was divided by it: what the rough patches keep clear of. All must
  /// outlive this.
  PieceFinisher(const TriangleMesh& mesh, const MeshTopology& topology, const InputNeighbourhood& input,
                const InputNeighbourhood& divided, const FinishingOptions& options)
      : mesh_(mesh), topology_(topology), input_(input), divided_(divided), options_(options) {}

  /// Makes the patches of the wanted pieces from number `first` on; the pieces before are in their way. In
  /// threads. Throws `Cancelled`.
  void finish(std::vector<PatchPiece>& pieces, std::size_t first, const Progress& progress) const;

  /// Patches that were finished each for itself may meet. The later one is finished again with the others in
  /// its way. Where that is no help it goes back to the rough patch, which meets those of no other
  /// piece, those that meet it are finished again with it in their way, and then it with them in its. What
  /// still meets another then has a defect.
  void separate(std::vector<PatchPiece>& pieces, const Progress& progress) const;

 private:
  using Corners = std::array<Vector3, 3>;

  void prepare(PatchPiece& piece, const Progress& progress) const;
  void finish_one(PatchPiece& piece, const FinishingOptions& options, const std::vector<Corners>& obstacles,
                  const Progress& progress) const;
  void leave_plain(PatchPiece& piece, const Progress& progress) const;
  bool finish_beside(std::vector<PatchPiece>& pieces, std::size_t piece, const Progress& progress) const;
  std::vector<std::size_t> in_conflict(const std::vector<PatchPiece>& pieces, bool later_only) const;
  std::vector<Corners> obstacles_of(const std::vector<PatchPiece>& pieces, std::size_t piece,
                                    std::size_t others) const;

  const TriangleMesh& mesh_;
  const MeshTopology& topology_;
  const InputNeighbourhood &input_, &divided_;
  const FinishingOptions options_;
};

}  // namespace meshcomplete
