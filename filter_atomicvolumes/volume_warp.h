// The atomic volumes round a patch, warped by the patch's vertices: where may these go without a volume's
// centre leaving it?
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/core/progress.h"
#include "filter_atomicvolumes/extraction.h"

namespace meshcomplete {

/// A point that the user has put into a volume, which it must not leave.
struct VolumePoint {
  Cell node;  ///< of the volume
  Vector3 position;
};

/// Whether a vertex is a point of the octree. All others lie on the mesh, or where planes through it meet.
inline bool is_octree_point(const VolumeVertex& vertex) {
  return vertex.key.kind == VertexKey::lattice_point;
}

/// The positions of a surface's vertices and the blank cubes and tetrahedra (also those whose side is known)
/// at those that may move: points of the octree, but not at cubes that are cut into convex cells. A volume is
/// bounded by the triangles of its squares, and a tetrahedron by its sides; its centre is its centroid, or
/// the user's points in it. Volumes share the vertices of their faces, so that all of them warp when one
/// moves. Refers to the surface, which must outlive it.
class VolumeWarp {
 public:
  /// Points of the octree are rounded to floats. Cost: O(squares of the complex) to look at each once, and
  /// O(volumes at the patch * their squares), threaded. Throws `Cancelled`.
  VolumeWarp(const LatticeMesh& mesh, const Decomposition& decomposition, const VolumeComplex& complex,
             const LabelledSurface& surface, const std::vector<VolumePoint>& points,
             const Progress& progress = Progress());

  bool may_move(Index vertex) const { return movable_[vertex]; }
  const Vector3& position(Index vertex) const { return positions_[vertex]; }
  const Vector3& start(Index vertex) const { return start_[vertex]; }
  bool moved(Index vertex) const { return positions_[vertex] != start_[vertex]; }

  /// Moves a vertex that may move, whatever comes of it.
  void place(Index vertex, const Vector3& position) { positions_[vertex] = position; }
  /// Whether every face at the vertex has the centres of its two volumes strictly on their sides: then the
  /// volumes are, near that vertex, star-shaped about their centres. Exact. Cost: O(faces of volumes there).
  bool holds_at(Index vertex) const;
  /// Moves a vertex to a position that is rounded to floats before, unless that breaks what holds at it.
  bool try_to_place(Index vertex, const Vector3& position);

  /// Every volume at a moved vertex gets its centroid for its centre, if all of its faces keep that on their
  /// sides. The user's points stay. Cost: O(faces of these volumes).
  void follow_centroids();

  /// Puts back vertices, and with them all those of volumes that do not hold without; such a volume also gets
  /// its first centre back. Returns all vertices put back, ascending. Cost: O(faces of volumes there).
  std::vector<Index> put_back(const std::vector<Index>& vertices);

 private:
  friend class VolumeWarpBuilder;

  struct Face {
    std::array<Index, 3> corners;  // counter-clockwise seen from outside the volume
    Index volume;
  };
  struct Body {
    Index first_face, past_face;
    Index first_centre, past_centre;
    bool pinned;  // by the user's points
  };

  bool holds(const Face& face) const;
  bool holds(const Body& body, const Vector3& centre) const;
  bool is_behind(const Face& face, const Vector3& centre) const;
  Vector3 centroid(const Body& body) const;

  std::size_t surface_vertices_ = 0;
  std::vector<Vector3> positions_, start_;  // of the surface's vertices, then of others that are never moved
  std::vector<char> movable_;               // of the surface's vertices
  std::vector<Face> faces_;                 // volume by volume
  std::vector<Body> bodies_;
  std::vector<Vector3> centres_, first_centres_;
  std::vector<std::size_t> first_at_;  // of each surface vertex, in `faces_at_`
  std::vector<Index> faces_at_;        // of vertices that may move
};

}  // namespace meshcomplete
