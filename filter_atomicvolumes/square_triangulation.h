// The squares in which cubes touch, triangulated so that neither the octree's other corners nor the mesh
// cross a side.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "common/core/octree.h"
#include "filter_atomicvolumes/exact_planes.h"
#include "filter_atomicvolumes/lattice_mesh.h"

namespace meshcomplete {

/// Thrown when two features that are in general position in almost every octree coincide in this one: the
/// caller starts again with a cube that lies elsewhere.
struct Coincidence {};

/// Thrown when triangles that a hole cube holds intersect each other.
struct TangledCube {};

/// What a vertex of the decomposition is, so that the same one is known again from every cube and square it
/// belongs to.
struct VertexKey {
  enum Kind : std::uint64_t {
    lattice_point,
    edge_in_plane,
    triangle_on_line,
    input_vertex,
    edge_in_cube,
    cut_on_line,
    cut_in_square,
    cut_in_cube,
    middle_of_cut
  };
  Kind kind;
  std::uint64_t a, b, c;

  static VertexKey at(const LatticePoint& p);  ///< corners and centres of squares
  static VertexKey crossing(Index edge, int axis,
                            std::int64_t plane);  ///< a mesh edge and a plane of the octree
  /// A triangle and a line of the octree along `axis`, at the coordinates of `p` in the other two.
  static VertexKey crossing(Index triangle, int axis, const LatticePoint& p);
  static VertexKey vertex(Index input_vertex);
  static VertexKey apex(Index cube);
  /// Where the cuts of convex cells meet a line of the octree: one of them, counted along the line.
  static VertexKey cut_on(int axis, const LatticePoint& p, std::size_t number);

  bool is_cut() const { return kind >= cut_on_line; }  ///< made by the planes between convex cells
  bool operator==(const VertexKey& o) const { return kind == o.kind && a == o.a && b == o.b && c == o.c; }
};

struct VertexKeyHash {
  std::size_t operator()(const VertexKey& key) const;
};

/// A vertex of the decomposition.
struct VolumeVertex {
  static constexpr Index none = 0xffffffffu;
  VertexKey key;
  Vector3 position;
  Index input = none;     ///< the boundary vertex that it is
  Index rim_edge = none;  ///< the boundary half-edge on which it lies (a Steiner point), else none
};

/// A square's points, its triangles (counter-clockwise seen from above, corners are positions in `points`),
/// and where the mesh crosses it: going along a segment, the front of the triangle is on the left.
struct SquareTriangulation {
  struct Segment {
    Index from, to;
    Index triangle;  ///< of the mesh
  };
  std::vector<VolumeVertex> points;
  std::vector<std::array<Index, 3>> triangles;
  std::vector<Segment> segments;
};

/// What the triangulation of a square has to hold beside the mesh and the octree's corners.
struct SquareOverlay {
  struct Point {
    const ExactPoint* point;
    LatticePoint origin;           ///< of its coordinates
    std::optional<VertexKey> key;  ///< needed on the square's sides
  };
  std::vector<Point> points;
  std::vector<std::array<Index, 2>> lines;  ///< between points

  /// Filled in: which point of the triangulation each point is, and the points along each line from end to
  /// end.
  std::vector<Index> places;
  std::vector<std::vector<Index>> chains;
};

/// `candidates` are the mesh triangles that may cross the square. Exact: what is near in doubles is told
/// apart by exact arithmetic (CGAL's constrained Delaunay triangulation). Throws `Coincidence`,
/// `TangledCube`. Thread-safe. Cost: O(n log n) for n points.
SquareTriangulation triangulate_square(const LatticeMesh& mesh, const Octree& octree,
                                       const LeafSquare& square, const std::vector<Index>& candidates);

/// The same with points and lines beside; lines and the mesh may cross each other. `number` is the square's
/// among all squares, for the keys of new points.
SquareTriangulation triangulate_square(const LatticeMesh& mesh, const Octree& octree,
                                       const LeafSquare& square, const std::vector<Index>& candidates,
                                       Index number, SquareOverlay& overlay);

}  // namespace meshcomplete
