// Symmetries of a shape: given by the user or found in the mesh, they hint where missing parts are.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "common/core/mesh.h"
#include "common/core/progress.h"

namespace meshcomplete {

enum class SymmetryKind { reflection, rotation, translation };

/// A rigid motion that takes the complete shape to itself.
struct Symmetry {
  SymmetryKind kind = SymmetryKind::reflection;
  Eigen::Isometry3d motion =
      Eigen::Isometry3d::Identity();  ///< an affine isometry; a reflection has determinant -1
  /// Of the mesh's area, the share whose image lies on the mesh; absent for a symmetry that was given.
  std::optional<double> support;
  /// Of the area whose image says something about the motion, the share that agrees (see `detect_symmetry`);
  /// absent for a symmetry that was given.
  std::optional<double> agreement;
};

/// The reflection in the plane through `point` with this normal. Throws CompletionError when the normal has
/// no length.
Symmetry reflection(const Vector3& point, const Vector3& normal);

/// The rotation about the axis through `point` by 360 / `fold` degrees. Throws CompletionError when the axis
/// has no length or `fold` is less than 2.
Symmetry rotation(const Vector3& point, const Vector3& axis, int fold);

/// The translation by `shift`. Throws CompletionError when it is zero.
Symmetry translation(const Vector3& shift);

struct SymmetryDetectionOptions {
  SymmetryKind kind = SymmetryKind::reflection;
  double tolerance =
      0.01;  ///< how far an image may lie from the mesh, relative to the bounding box's diagonal
  double least_support =
      0.4;  ///< share of the area that must be matched, more than 0; what is missing has no match
  double least_agreement = 0.7;  ///< share of the area that says something that must agree, more than 0
  int highest_fold = 12;         ///< of rotations, 2 to 36
  double least_shift =
      0.05;  ///< of translations, relative to the bounding box's diagonal, more than the tolerance
};

/// The symmetry of this kind that fits best, refined by registering the mesh to its image; absent when none
/// has enough support. Whether a motion fits is judged by what is there: images that fall beyond a boundary,
/// where the surface is missing, speak neither for nor against it (nor do those that a translation moves out
/// of the bounding box), and parts that only slide along the surface, as a cylinder's wall does under
/// rotation, count for little. Of the rest at least `least_support` must agree, too. A surface that
/// continuously slides along itself has no fold of its own; any may be found.
///
/// Deterministic, whatever the number of threads. Throws `CompletionError` when an option is out of range or
/// the mesh has no area, and `Cancelled`. Cost: O(faces), and about half a second for the search whatever the
/// mesh. Source: the paper's section 7, which names automatic detection [KFR04] without a method of its own;
/// the method here is a search over motions and the iterative closest points of Chen and Medioni (1992),
/// trimmed, so that missing parts do not pull.
std::optional<Symmetry> detect_symmetry(const TriangleMesh& mesh, const SymmetryDetectionOptions& options,
                                        const Progress& progress = Progress());

/// What a user is told: "reflection in the plane through (..) with normal (..), 83 % of the area matched".
std::string describe(const Symmetry& symmetry);

}  // namespace meshcomplete
