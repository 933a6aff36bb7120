// Constraints and hints (paper, sections 4.3 and 7): points, lines of sight and symmetries, and what they
// mean for the volumes of an octree.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/core/progress.h"
#include "filter_atomicvolumes/atomic_volumes.h"
#include "filter_atomicvolumes/decomposition.h"
#include "filter_atomicvolumes/labelling.h"
#include "filter_atomicvolumes/lattice_mesh.h"
#include "filter_atomicvolumes/lines_of_sight.h"
#include "filter_atomicvolumes/nearest_side.h"
#include "filter_atomicvolumes/symmetry_hints.h"
#include "filter_atomicvolumes/volume_complex.h"

namespace meshcomplete {

/// The constraints as far as they do not depend on the octree; one serves many octrees. Refers to the mesh,
/// the topology and the neighbourhood, which must outlive it. Immutable, safe to use from many threads.
///
/// Left out, with a note each: what is not finite, points given as inside and as outside both, and lines of
/// sight that contradict the mesh (see `lines_of_sight`).
class PreparedConstraints {
 public:
  /// Cost: O(faces log faces) where points or symmetries are given, and that of `lines_of_sight`.
  PreparedConstraints(const TriangleMesh& mesh, const MeshTopology& topology,
                      const InputNeighbourhood& neighbourhood, const VolumeConstraints& constraints,
                      const Progress& progress = Progress());

  /// Whether there is nothing to refine for and to tie.
  bool empty() const;
  const VolumeConstraints& given() const { return given_; }  ///< without what was left out, and without views
  const std::vector<LineOfSight>& lines() const { return lines_.lines; }
  const SideFinder& sides() const { return *sides_; }  ///< where there are points or symmetries
  const SymmetryHints* symmetries() const { return symmetries_.get(); }  ///< absent: none
  /// Leaves are not split for points below this side, mesh units: a quarter of `spacing`.
  double finest_leaf() const { return 0.25 * spacing_; }
  double spacing() const { return spacing_; }    ///< mean length of boundary edges, mesh units
  double diagonal() const { return diagonal_; }  ///< of the mesh's bounding box, mesh units
  const std::vector<std::string>& notes() const { return lines_.notes; }  ///< for the user

 private:
  void leave_out_useless_points();

  VolumeConstraints given_;
  LinesOfSight lines_;
  std::unique_ptr<SideFinder> sides_;
  std::unique_ptr<SymmetryHints> symmetries_;
  double spacing_ = 0, diagonal_ = 0;
};

/// Splits leaves that constraints and hints need finer, before the complex is built:
/// - blank leaves that hold an inside and an outside point, until these are apart;
/// - crossed leaves in which the mesh contradicts a point, until it is in a blank leaf or its leaf is no
/// larger
///   than a quarter of the mesh's boundary edges: in a large leaf the mesh decides far beyond its faces;
/// - blank leaves that are seen through and hold an inside point, until they are no larger than a quarter of
///   the mesh's boundary edges;
/// - blank leaves that an image of the mesh under a symmetry crosses where the mesh is missing, until they
///   are as small as its boundary edges;
/// - `leaves`, which `tie_constraints` asked for: until each part has points of one kind.
/// Returns whether any leaf was split. Throws CompletionError beyond the cube budget, `Cancelled`. Cost:
/// O((points + lines) * depth) for every level split, and the new cubes.
bool refine_for_constraints(Decomposition& decomposition, const LatticeMesh& mesh,
                            const DecompositionOptions& options, const PreparedConstraints& constraints,
                            const std::vector<Index>& leaves = {}, const Progress& progress = Progress());

struct TiedConstraints {
  std::vector<NodeTie> ties;
  /// Leaves with points inside and outside in one volume, and hole leaves larger than a quarter of the mesh's
  /// boundary edges in which the mesh contradicts a point; ascending. Refine for them and build the complex
  /// again. As long as that is not done, or cannot be (at the greatest depth), such points have no effect.
  std::vector<Index> split;
  std::vector<std::string> notes;  ///< for the user: what could not be imposed
};

/// What the constraints mean for the complex. A point ties the volume that holds it; where the mesh decides
/// already it is satisfied, or noted as contradicted. A volume that is seen through is outside, unless it
/// holds an inside point: the user set that by hand, and scans have noise. Hints have a price, in what faces
/// cost (for points what as many faces cost as have that area on average). Deterministic. Cost: O(points *
/// log faces + lines * leaves passed + nodes * images under symmetries * log faces), threaded.
TiedConstraints tie_constraints(const LatticeMesh& mesh, const Decomposition& decomposition,
                                const VolumeComplex& complex, const FaceCost& cost,
                                const PreparedConstraints& constraints,
                                const Progress& progress = Progress());

}  // namespace meshcomplete
