// How long the edges of a patch should be: as those of the mesh round the rims, everywhere between them.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete {

/// A place on a rim, and the length of the mesh's edges there.
struct RimSample {
  Vector3 position;
  double edge_length;  ///< mesh units, positive
};

/// The target edge length at every point of space. At the samples it is about theirs, and between them it
/// changes by no more than `gradation` times the way: the mean of the least and the greatest function with
/// this slope that goes through them (McShane's extensions), both held between the shortest and the longest
/// of the samples. So it is the same everywhere for rims of one density, and changes evenly from one rim to
/// another of unlike density. Continuous. Source: the paper, section 3.3, takes one average for all rims.
/// Immutable, safe to ask from many threads.
class EdgeLengthField {
 public:
  /// Neighbouring triangles of a mesh that grows so fast stay well shaped.
  static constexpr double gradation = 0.3;

  /// At least one sample. Cost: O(n log n).
  explicit EdgeLengthField(std::vector<RimSample> samples);

  /// Cost: O(1) for one density, else O(log samples) and the samples about as near as the nearest.
  double at(const Vector3& point) const;

  /// How far the nearest sample is. Cost: O(log samples).
  double distance(const Vector3& point) const;

  double shortest() const { return shortest_; }
  double longest() const { return longest_; }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    double shortest, longest;
    std::size_t begin, past;
    Index right;  // the left child comes next; 0: a leaf
  };

  Index build(std::size_t begin, std::size_t past);
  template <class Bound, class Offer>
  void descend(Index node, const Vector3& point, Bound& bound, Offer& offer) const;

  std::vector<RimSample> samples_;
  std::vector<Node> nodes_;
  double shortest_, longest_;
};

/// Samples of a loop's vertices with lengths that are averaged along the loop. `lengths` are those at its
/// `positions`. Cost: O(n).
std::vector<RimSample> smoothed_samples(const std::vector<Vector3>& positions,
                                        const std::vector<double>& lengths);

}  // namespace meshcomplete
