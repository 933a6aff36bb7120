// Mesh completion by atomic volumes: space is divided into volumes that the mesh does not cross, and a
// minimum cut decides which of them are inside. Source: Podolak and Rusinkiewicz, "Atomic Volumes for Mesh
// Completion", 2005.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/fairing.h"
#include "common/core/hole_selection.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/progress.h"
#include "filter_atomicvolumes/symmetry.h"

namespace meshcomplete {

/// What the cut makes small (paper, section 4.2). Volumes grow with the distance from the rims, so that the
/// middle of a wide gap has few faces: the less a face's area counts, the rather the patch goes on across a
/// gap instead of closing each side of it by itself.
enum class CutWeight {
  area,      ///< the area of the patch
  unit,      ///< the number of its faces
  balanced,  ///< in between: the fourth roots of the areas of its faces
  poisson,   ///< the area of its faces, which counts less near a Poisson reconstruction of the mesh
};

/// How the stairs of the octree are taken out of a patch before it is faired (paper, section 5).
enum class VolumeSmoothing {
  none,
  constrained,  ///< springs; the centre of a volume never leaves it
  two_pass,  ///< springs without constraints, a new cut that prefers the volumes met, and a constrained pass
};

/// Points that are known to be inside or outside (paper, section 4.3), or thought to be (section 7).
struct VolumeConstraints {
  std::vector<Vector3> inside;   ///< must end up inside
  std::vector<Vector3> outside;  ///< must end up outside
  /// What a camera or scanner saw: everything between `from` and each of `seen` is outside.
  struct View {
    Vector3 from = Vector3::Zero();
    std::vector<Vector3> seen;
  };
  std::vector<View> views;
  std::vector<Vector3> hinted_inside;  ///< suggested, for the price below
  std::vector<Vector3> hinted_outside;
  double hint_price =
      0.01;  ///< of going against one hint, relative to the squared diagonal of the bounding box, positive
  std::vector<Symmetry> symmetries;  ///< each volume is suggested the label of its image
  double symmetry_price =
      0.5;  ///< of going against one volume's image, relative to the area of the volume's faces, positive
};

struct AtomicVolumesOptions {
  HoleSelectionOptions holes;
  VolumeConstraints constraints;
  std::optional<int> max_depth;  ///< of the octree, 3 to 30; absent: as deep as the mesh needs
  std::size_t node_budget =
      5000000;  ///< graph nodes and octree leaves, at least 1000; beyond them CompletionError
  CutWeight weight = CutWeight::balanced;
  int shifts = 3;          ///< octrees tried, 1 to 100; see `SolutionPoll` for which is kept
  std::uint64_t seed = 1;  ///< of the octrees' random positions
  VolumeSmoothing smoothing = VolumeSmoothing::constrained;
  int smoothing_iterations = 5;  ///< 0 to 1000
  bool moving_centres = false;   ///< the volumes' centres follow their volumes while smoothing (section 7)
  bool remesh = true;            ///< give the patch the resolution of the mesh round the hole
  std::optional<SurfaceEnergy> fairing = SurfaceEnergy::normal_variation;  ///< absent: none
  std::optional<double>
      edge_length;  ///< of the patch's edges, mesh units, positive; absent: as the mesh around
};

/// What the decomposition and the cut took; of the octree whose patch was kept.
struct AtomicVolumesFigures {
  std::size_t leaves = 0, blank_leaves = 0, hole_leaves = 0, crossed_leaves = 0;
  std::size_t nodes = 0;         ///< of the graph: blank cubes and free tetrahedra
  std::size_t tetrahedra = 0;    ///< in hole cubes, free or not
  int depth = 0;                 ///< of the smallest leaf
  double smallest_leaf = 0;      ///< its side, mesh units
  double smallest_distance = 0;  ///< between two vertices of the boundary, mesh units
  double cut_weight = 0;         ///< of the minimum cut: mesh units squared, faces, or roots of mesh units
  int restarts = 0;              ///< because a plane of the octree met a vertex, or two lines met in a point
};

/// The same, with names for reports.
std::vector<std::pair<std::string, double>> named(const AtomicVolumesFigures& figures);

struct AtomicVolumesResult {
  Completion completion;
  AtomicVolumesFigures figures;
};

/// Throws CompletionError on options out of range.
void check_options(const AtomicVolumesOptions& options);

/// Closes the selected holes of `mesh` by one global cut. A hole of the report may have several loops. The
/// patch has passed `check_patch`. Deterministic whatever the number of threads. Throws `CompletionError` on
/// options out of range and when the node budget does not suffice, `Cancelled`. Cost: O(faces) to look at
/// every triangle a few times; the rest near-linear in the boundary.
AtomicVolumesResult fill_by_atomic_volumes(const TriangleMesh& mesh, const MeshSelection& selection,
                                           const AtomicVolumesOptions& options,
                                           const Progress& progress = Progress());

}  // namespace meshcomplete
