// Which atomic volume a point lies in.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "filter_atomicvolumes/lattice_mesh.h"
#include "filter_atomicvolumes/nearest_side.h"
#include "filter_atomicvolumes/volume_complex.h"

namespace meshcomplete {

/// What is at a point.
struct VolumePlace {
  enum Kind {
    beyond,   ///< outside the octree's root
    free,     ///< in a volume that the cut decides about
    inside,   ///< inside according to the mesh
    outside,  ///< outside according to the mesh
    unknown,  ///< on the mesh
  };
  Kind kind = beyond;
  Cell node = unknown_cell;   ///< of a free volume
  Index leaf = Octree::none;  ///< of the octree; `none` beyond the root
};

/// The leaf that holds the point, and the lattice point with even coordinates beside it; absent outside the
/// root. Cost: O(depth).
struct LeafOfPoint {
  Index leaf;
  LatticePoint point;
};
std::optional<LeafOfPoint> find_leaf(const Lattice& lattice, const Octree& octree, const Vector3& point);

/// Whether a point in a leaf that the mesh meets is inside according to the mesh: by what of it is nearest,
/// or where that is a boundary by the first face on the way to the mesh. Absent on the mesh. Cost: O(log
/// faces), or O(triangles of the leaf).
std::optional<bool> side_in_leaf(const LatticeMesh& mesh, const Decomposition& decomposition,
                                 const SideFinder& sides, const LeafOfPoint& at, const Vector3& point);

/// The corners of a free tetrahedron: the base, counter-clockwise seen from outside the cube, and the apex.
std::array<Vector3, 4> corners_of(const VolumeComplex& complex,
                                  const VolumeComplex::Tetrahedron& tetrahedron);

/// Refers to its arguments, which must outlive it. Immutable, safe to ask from many threads.
class VolumeLocator {
 public:
  VolumeLocator(const LatticeMesh& mesh, const Decomposition& decomposition, const VolumeComplex& complex,
                const SideFinder& sides)
      : mesh_(mesh), decomposition_(decomposition), complex_(complex), sides_(sides) {}

  /// Cost: O(depth), and O(log faces), near the boundary O(triangles of the leaf), where the mesh is.
  VolumePlace locate(const Vector3& point) const;

 private:
  bool find_part(const Vector3& point, VolumePlace& place) const;

  const LatticeMesh& mesh_;
  const Decomposition& decomposition_;
  const VolumeComplex& complex_;
  const SideFinder& sides_;
};

}  // namespace meshcomplete
