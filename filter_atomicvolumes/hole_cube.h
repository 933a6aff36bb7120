// The surface of one hole cube: its triangles are the bases of the tetrahedra, and the mesh runs across them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/core/octree.h"
#include "filter_atomicvolumes/square_triangulation.h"

namespace meshcomplete {

/// What is known of a tetrahedron before the cut.
enum class Side : std::int8_t { free, inside, outside };

/// One of the squares round a cube, corners numbered as in the whole complex.
struct CubeSquare {
  Index square;  ///< its number
  const SquareTriangulation* triangulation;
  const std::vector<Index>* vertex;  ///< number in the complex of each of its points
  bool outward_is_up;                ///< the cube lies below it
};

struct HoleCubeSurface {
  struct Base {
    std::array<Index, 3> corners;  ///< counter-clockwise seen from outside the cube
    Index square;
    Index triangle;  ///< in the square's triangulation
  };
  std::vector<Base> bases;
  std::vector<Index>
      across;  ///< `across[3 * b + k]` is the base beyond the side from corner k to corner k + 1
  std::vector<char> walled;     ///< whether the mesh runs along that side
  std::vector<Side> sides;      ///< of each base's tetrahedron
  std::vector<Index> rim_ends;  ///< vertices where the boundary goes through the surface
  bool contradicting = false;   ///< the mesh's triangles do not agree about a tetrahedron
};

/// A tetrahedron with a face in a mesh triangle is outside before it and inside behind it; so are those that
/// touch the mesh only at an inner edge (paper, section 3.1: the patch must not end there). The squares must
/// tile the cube's surface. Cost: O(n log n) for n triangles.
HoleCubeSurface hole_cube_surface(const std::vector<CubeSquare>& squares);

}  // namespace meshcomplete
