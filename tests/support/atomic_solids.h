// A mesh completed by the cut alone, as tests of constraints need it: its topology, and how far the patch is
// from where it should be.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/sheets.h"
#include "filter_atomicvolumes/constraints.h"

namespace meshcomplete {
namespace test {

/// What the pipeline from the octree to the sheets makes of a mesh; nothing is smoothed.
struct AtomicSolid {
  bool closed = false;            ///< whether the sheets close every boundary edge
  int components = 0;             ///< of mesh and sheets together
  int genus = 0;                  ///< sum over the components
  std::size_t leaves = 0;         ///< of the octree
  std::vector<Vector3> vertices;  ///< of the sheets
  std::vector<Triangle> triangles;
  std::vector<std::string> notes;
  std::vector<char> labels;  ///< for each point that was asked about: 1 inside, 0 outside, -1 not known

  double area() const;
  /// The mean of `distance` over the area of the sheets.
  double mean(const std::function<double(const Vector3&)>& distance) const;
};

AtomicSolid complete_by_cut(const TriangleMesh& mesh, const VolumeConstraints& constraints,
                            std::uint64_t seed = 1, const std::vector<Vector3>& asked = {},
                            CutWeight weight = CutWeight::area, const DecompositionOptions& options = {});

}  // namespace test
}  // namespace meshcomplete
