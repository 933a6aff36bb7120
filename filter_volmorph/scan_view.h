// A range scan as its sensor sees it: which point of it is met first along a line of sight, and whether all
// of it is before or behind a block of voxels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/core/mesh.h"
#include "filter_volmorph/line_of_sight.h"

namespace meshcomplete {

/// What a scan can say of a block of voxels.
enum class BlockView : std::uint8_t {
  nothing,       ///< no line of sight to the surface goes through it, or it is behind
  empty,         ///< all of it is before the surface, farther than the ramp
  partly_empty,  ///< the same, but perhaps not for all of it
  near           ///< perhaps within the ramp of the surface, -ramp < distance <= ramp
};

/// Where a line of sight meets the surface first.
struct SightHit {
  double distance = 0;  ///< from there to the point asked for, along the line; positive towards the sensor
  Triangle corners{};   ///< of the triangle that is met
  std::array<double, 3> parts{};  ///< of the corners at the hit, at least 0; their sum is 1
};

/// What a scan can say of a point, and where it is `near`, why.
struct Sighting {
  BlockView view = BlockView::nothing;
  SightHit hit;
};

/// One image of a scan: the lines of sight that are parallel, or those from a viewpoint that go through one
/// side of a cube around it, or through a part of that. Immutable, safe to ask from many threads.
///
/// An image has about as many pixels as faces. Where many faces crowd in few pixels, since others lie far
/// away or are much larger, the image is halved until they do not. Every pixel knows the faces in it, bounds
/// of their depth, and whether they cover all of it; squares of two by two pixels know the same, and so on
/// up. Cover only changes at the scan's boundary edges, so a pixel without one is covered where its middle
/// is.
class ScanView {
 public:
  /// The images that together hold a scan: one for parallel lines of sight, up to six for a viewpoint, more
  /// where faces crowd. A point lies in one image only, or on the border of two of the six.
  /// `line_of_sight` is one of these. All faces have an area and look towards the sensor, and are farther
  /// than `nearest` (above 0) from a viewpoint. Lengths are in voxels: decisions are padded for rounding in
  /// that unit. Cost: O(faces) for faces that are about equally large; for
  /// others at most about forty times that.
  static std::vector<ScanView> make(const TriangleMesh& scan, const LineOfSight& line_of_sight,
                                    double nearest);

  /// Of the cube of the given half side. Never says that more is known than is. Cost: O(1).
  BlockView look(const Vector3& middle, double half_side, double ramp) const;

  /// Of a single point, exactly: never `partly_empty`. Points on a common edge of faces meet one of them:
  /// there are no cracks. Cost: O(faces in a pixel).
  Sighting sight(const Vector3& point, double ramp) const;

  std::size_t memory() const;  ///< bytes

 private:
  struct Image;
  explicit ScanView(std::shared_ptr<const Image> image);
  static void add_views(std::shared_ptr<Image> image, const std::vector<Triangle>& candidates,
                        const TriangleMesh& scan, const std::vector<Index>& boundary,
                        std::vector<ScanView>& views);
  std::shared_ptr<const Image> image_;
};

}  // namespace meshcomplete
