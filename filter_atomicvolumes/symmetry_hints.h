// What the images of a mesh under its symmetries say about the places where it is missing.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "common/core/progress.h"
#include "filter_atomicvolumes/decomposition.h"
#include "filter_atomicvolumes/nearest_side.h"
#include "filter_atomicvolumes/symmetry.h"

namespace meshcomplete {

/// All motions that follow from a symmetry, the identity left out, nearest first: a rotation and its powers
/// round the full turn, a translation and its multiples both ways. `size` is the mesh's diagonal, mesh units:
/// motions that move everything further tell nothing. Of a rotation that closes after no 36 turns only the
/// first ones are used.
std::vector<Eigen::Isometry3d> images_under(const Symmetry& symmetry, const Vector3& middle, double size);

/// Which side the image of a point is on. An image tells the side only where the mesh is near enough to know:
/// a point takes the label of the image that is nearest to the mesh, since missing parts can only make that
/// further; unless what is nearest is a boundary, or the mesh is as near to the point itself (then it knows
/// better, and an imperfect symmetry must not lay a second skin over it).
///
/// Refers to the finder, which must outlive it. Immutable, safe to ask from many threads.
class SymmetryHints {
 public:
  /// `misfit`: by how much an image may lie beside the mesh, mesh units, positive.
  SymmetryHints(const SideFinder& sides, const std::vector<Symmetry>& symmetries, const Vector3& middle,
                double size, double misfit);

  std::size_t symmetries() const { return images_.size(); }

  struct Suggestion {
    double inside = 0;    ///< from 1, surely inside, to -1, surely outside; 0: nothing is known
    double distance = 0;  ///< from the image to the mesh, mesh units
  };
  /// Where a search begins (`SideFinder::nearest`): kept from point to neighbouring point.
  struct Starts {
    Index own = 0;
    std::vector<Index> images;
  };
  /// Cost: that of `SideFinder::nearest` for every image.
  Suggestion suggest(std::size_t symmetry, const Vector3& point, Starts& starts) const;
  /// Whether some image of the point is within `reach` of the mesh, away from its boundary.
  bool is_near(std::size_t symmetry, const Vector3& point, double reach, Starts& starts) const;
  /// Whether the image that tells the side, more surely than not, is within `reach` of the mesh.
  bool is_known(std::size_t symmetry, const Vector3& point, double reach, Starts& starts) const;

 private:
  const SideFinder& sides_;
  std::vector<std::vector<Eigen::Isometry3d>> images_;  // of each symmetry
  double misfit_;
};

/// Splits blank leaves that an image of the mesh passes through where the mesh itself is missing, until they
/// are no larger than `finest` (mesh units), or the octree has `budget` more cubes. Returns whether any was
/// split.
bool refine_near_images(Decomposition& decomposition, const LatticeMesh& mesh,
                        const DecompositionOptions& options, const SymmetryHints& hints, double finest,
                        std::size_t budget, const Progress& progress = Progress());

}  // namespace meshcomplete
