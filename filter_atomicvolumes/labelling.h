// Which atomic volumes are inside: the minimum cut of the graph of volumes.
#pragma once

#include <cstddef>
#include <vector>

#include "common/core/graph_cut.h"
#include "common/core/progress.h"
#include "filter_atomicvolumes/face_cost.h"
#include "filter_atomicvolumes/volume_complex.h"

namespace meshcomplete {

/// What pulls a node to a side beyond the faces: constraints, hints.
struct NodeTie {
  Cell node;
  bool inside;
  double price;  ///< in what `cost_of_face` counts; infinite for a constraint
};

struct Labelling {
  std::vector<char> inside;  ///< per node
  double weight = 0;         ///< of the cut: the sum of what its faces cost

  bool is_inside(Cell cell) const {
    return cell >= 0 ? inside[static_cast<std::size_t>(cell)] : cell == inside_cell;
  }
};

/// What the faces of volumes come to.
struct FaceMeasure {
  std::vector<double> of_node;          ///< per node: what its faces cost
  double mean_area = 1, mean_cost = 1;  ///< of a face, mesh units squared and what it costs
};

/// As the cut counts them: a square between two cubes is one face. Cost: O(faces), threaded.
FaceMeasure measure_faces(const LatticeMesh& mesh, const VolumeComplex& complex, const FaceCost& cost,
                          const Progress& progress = Progress());

/// The labelling of least weight. Source: the paper's section 4. Faces beside unknown volumes cost nothing.
/// Cost: that of the minimum cut, near-linear in practice.
Labelling cut_complex(const LatticeMesh& mesh, const VolumeComplex& complex, const FaceCost& cost,
                      const std::vector<NodeTie>& ties, const Progress& progress = Progress());

}  // namespace meshcomplete
