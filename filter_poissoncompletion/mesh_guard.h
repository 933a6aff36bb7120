// What a refinement does where it comes near to the mesh that it leaves alone.
#pragma once

#include <optional>
#include <vector>

#include "common/core/implicit_function.h"
#include "common/core/mesh.h"
#include "filter_poissoncompletion/cushion.h"

namespace meshcomplete {

/// The mesh that a refinement leaves alone.
struct ProtectedMesh {
  const TriangleMesh& mesh;
  const Cushion& cushion;             ///< where no point is inserted but vertices of the mesh
  const std::vector<Index>& initial;  ///< the mesh's vertex at each initial point
};

/// Says which vertices of the mesh come instead of points near it, each of them once: what the refinement has
/// come near to has to be there in its own resolution, or the surface is taken for one with it. Refers to
/// what it is given.
class MeshGuard {
 public:
  struct Answer {
    bool in_cushion = false;      ///< the point itself is not to be inserted
    std::optional<Index> vertex;  ///< of the mesh, to be inserted instead
  };

  MeshGuard(const ProtectedMesh& around, const ImplicitFunction& function);

  /// For a point of the function's surface with the target edge length `size` (mesh units). Takes it that the
  /// vertex is inserted then. Cost: that of `Cushion::nearest`, and six values of the function.
  Answer ask(const Vector3& point, double size);

 private:
  std::optional<Index> take_vertex(Index triangle, const Vector3& point);

  const ProtectedMesh around_;
  const ImplicitFunction& function_;
  std::vector<char> taken_;  // vertices of the mesh
};

}  // namespace meshcomplete
