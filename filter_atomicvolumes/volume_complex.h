// Space divided into atomic volumes: cubes and tetrahedra, the faces between them, and what is known of them
// already.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/progress.h"
#include "filter_atomicvolumes/decomposition.h"
#include "filter_atomicvolumes/square_triangulation.h"

namespace meshcomplete {

/// A volume on one side of a face: a node of the graph (0 and up), or one that is known.
using Cell = std::int32_t;
constexpr Cell inside_cell = -1;
constexpr Cell outside_cell = -2;
constexpr Cell unknown_cell = -3;  ///< a square of which nothing can be told

/// Between two volumes; the mesh crosses none of them. The normal points from `behind` to `before`.
struct VolumeFace {
  std::array<Index, 3> corners;  ///< vertices of the complex
  Cell behind, before;
};

/// A square between two cubes of which neither is a hole cube; triangulated only where the patch needs it.
struct VolumeSquare {
  Index square;         ///< in `squares`
  Cell behind, before;  ///< below and above
};

struct VolumeComplex {
  std::vector<VolumeVertex> vertices;
  std::vector<LeafSquare> squares;
  std::vector<VolumeFace> faces;
  std::vector<VolumeSquare> whole_squares;
  std::vector<Cell>
      cube_cells;         ///< per cube of the octree: the node of a blank leaf, `unknown_cell` for all others
  std::size_t nodes = 0;  ///< blank leaves first, then free tetrahedra, then free convex cells
  std::size_t tetrahedra = 0;
  /// Which hole cube and which apex a free tetrahedron has: for constraints and smoothing. One per node after
  /// the blank leaves, up to the convex cells.
  struct Tetrahedron {
    Index cube, apex;
    std::array<Index, 3> base;  ///< counter-clockwise seen from outside the cube
  };
  std::vector<Tetrahedron> free_tetrahedra;
  /// A convex part of an unresolved hole cube.
  struct ConvexCell {
    struct Plane {
      Vector3 normal;  ///< unit, into the cell
      double offset;   ///< normal . p + offset is positive inside
    };
    Index cube;
    Cell cell;       ///< a node, or `inside_cell` or `outside_cell` when the mesh tells
    Vector3 centre;  ///< the mean of its corners
    std::vector<Plane> sides;
    bool holds(const Vector3& point) const;  ///< rounded
  };
  std::vector<ConvexCell> convex_cells;  ///< cube by cube, ascending; the free ones are the last nodes
  std::size_t blank_nodes = 0;
  /// Crossed leaves that disagree about an uncrossed square between them.
  std::vector<Index> disagreeing;
};

/// Builds the complex. Throws `Coincidence`, `Cancelled`. Hole cubes whose triangles intersect become
/// `unresolved` in `decomposition`; those cubes are cut into convex cells. Cost: near-linear in the leaves,
/// threaded.
VolumeComplex build_complex(const LatticeMesh& mesh, Decomposition& decomposition,
                            const Progress& progress = Progress());

}  // namespace meshcomplete
