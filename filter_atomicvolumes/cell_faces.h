// The convex cells of a cube as volumes of the complex.
#pragma once

#include <functional>
#include <unordered_map>
#include <vector>

#include "filter_atomicvolumes/convex_cells.h"
#include "filter_atomicvolumes/volume_complex.h"

namespace meshcomplete {

/// The vertices of the complex at a cube's surface: at the cells' own vertices, and along their edges from
/// the first end to the second.
struct CellSurface {
  std::unordered_map<Index, Index> vertices;
  std::unordered_map<Index, std::vector<Index>> chains;
};

/// Adds the free cells of a cube to the nodes, and the faces between its cells; returns what each cell is.
/// `number_of` numbers the complex's vertices. Cost: linear.
std::vector<Cell> add_cells(const LatticeMesh& mesh, Index cube, const ConvexCells& cells,
                            const CellSurface& surface,
                            const std::function<Index(const VolumeVertex&)>& number_of,
                            VolumeComplex& complex);

}  // namespace meshcomplete
