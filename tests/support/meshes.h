// The catalogue of test meshes: every test asks for a mesh by property. All are made in code, the same on
// every run.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete {
namespace test {

// Every coordinate of every mesh below is exactly a float. Unless the comment says otherwise a mesh is
// manifold, consistently oriented with normals outwards (or upwards), free of self-intersections and of
// zero-area faces, and every vertex is used.

// --- closed
// -------------------------------------------------------------------------------------------------------

/// Icosahedron subdivided `subdivisions` times: 20 * 4^subdivisions nearly equal faces. Genus 0.
TriangleMesh icosphere(int subdivisions, double radius = 1, const Vector3& centre = Vector3::Zero());

/// Sphere of latitude rings with two poles, faces far from equal near the poles: 2 * segments * (rings - 1)
/// faces. Genus 0.
TriangleMesh uv_sphere(int rings, int segments, double radius = 1);

/// Genus 1, around the z axis: 2 * major_segments * minor_segments faces.
TriangleMesh torus(int major_segments, int minor_segments, double major_radius = 1,
                   double minor_radius = 0.4);

/// Axis-aligned, 8 vertices with integer coordinates for integer arguments, 12 faces.
TriangleMesh cube(double side = 1, const Vector3& corner = Vector3::Zero());

/// Three edges of length `side` along the axes from the origin. 4 faces.
TriangleMesh tetrahedron(double side = 1);

/// A plate of unit voxels with `tunnels` square tunnels through it: genus `tunnels`, integer coordinates,
/// flat regions with many coplanar faces.
TriangleMesh plate_with_tunnels(int tunnels);

/// Star-shaped about the origin, radius between 1 - roughness and 1 + roughness, changing from vertex to
/// vertex.
TriangleMesh rough_sphere(int subdivisions, double roughness, std::uint32_t seed);

// --- with holes
// ---------------------------------------------------------------------------------------------------

/// Icosphere of radius 1 without the faces of which a corner is within `angle` radians of the +z pole: one
/// round hole.
TriangleMesh sphere_with_hole(int subdivisions = 3, double angle = 0.5);

/// Icosphere of radius 1 with `holes` (1 to 6) holes around the ends of the axes, in the order +x -x +y -y +z
/// -z. `angle` up to 0.5 keeps the rest in one piece.
TriangleMesh sphere_with_holes(int holes, int subdivisions = 3, double angle = 0.4);

/// As `sphere_with_hole` with `outer_angle`, and the cap within `inner_angle` of the pole still there: two
/// components, and one ring-shaped gap between two boundary loops.
TriangleMesh sphere_with_island(int subdivisions = 4, double outer_angle = 0.8, double inner_angle = 0.4);

/// Around the z axis from z = 0 to `height`, open at both ends: two loops of `segments` edges.
TriangleMesh open_cylinder(int segments = 24, int rings = 8, double radius = 1, double height = 2);

/// `rough_sphere` with `holes` ragged holes: randomly grown sets of faces removed. Loops may touch themselves
/// and each other at vertices, so non-manifold vertices do occur; small islands too.
TriangleMesh rough_sphere_with_ragged_holes(int subdivisions, int holes, std::uint32_t seed,
                                            double roughness = 0.1);

/// Icosphere without the one-rings of two vertices that have one neighbour in common: two holes that touch at
/// a vertex with two fans. Loops that follow the fans are one loop that visits the vertex twice; cut there
/// they are two.
TriangleMesh sphere_with_touching_holes(int subdivisions = 2);

/// Strip of quads around a closed polygon: the rim vertices come first, in the order given, then their copies
/// moved by `rim[i] -> outer[i]`. The rim is a boundary loop of any shape that the test wants; the polygon of
/// copies is another. Orientation: a patch triangle walks the rim in the order given. Free of
/// self-intersections only if the arguments are.
TriangleMesh collar(const std::vector<Vector3>& rim, const std::vector<Vector3>& outer);

// --- open sheets
// --------------------------------------------------------------------------------------------------

/// Flat grid of columns * rows unit squares in the plane z = 0, integer coordinates, normals up. One loop.
TriangleMesh flat_grid(int columns, int rows);

/// `flat_grid` with random heights (uniform in [-roughness, roughness]) and `holes` ragged holes. Neither
/// self-intersecting nor overhanging; non-manifold vertices and small islands do occur.
TriangleMesh rough_sheet(int columns, int rows, double roughness, int holes, std::uint32_t seed);

/// Half twist around the z axis: one loop, not orientable.
TriangleMesh moebius_strip(int segments = 24);

/// One face.
TriangleMesh isolated_triangle();

// --- not manifold, degenerate
// -------------------------------------------------------------------------------------

/// Two tetrahedra that share one vertex and nothing else: closed, one vertex with two fans.
TriangleMesh pinched_tetrahedra();

/// `pages` triangles at the edge from the origin to (0, 0, 1): an edge with `pages` faces.
TriangleMesh book(int pages = 3);

/// `sphere_with_hole`, and one more face outside that stands on an edge near the -z pole: one edge with three
/// faces, far from the hole.
TriangleMesh sphere_with_hole_and_fin(int subdivisions = 3, double angle = 0.5);

/// Cube with one edge split on one side only; a face without area closes the slit: closed, one zero-area
/// face.
TriangleMesh cube_with_zero_area_face();

// --- made from other meshes
// ---------------------------------------------------------------------------------------

/// Both, the second one's indices after the first one's: components that share nothing.
TriangleMesh join(const TriangleMesh& first, const TriangleMesh& second);

/// Translated, then rounded to floats: far from the origin short edges come out uneven, and tiny ones vanish.
TriangleMesh translated(TriangleMesh mesh, const Vector3& offset);

/// Multiplied by `factor`, then rounded to floats; powers of two are exact.
TriangleMesh scaled(TriangleMesh mesh, double factor);

/// All faces turned over.
TriangleMesh flipped(TriangleMesh mesh);

/// The mesh without the faces for which `remove` is true, and without the vertices that only they used.
TriangleMesh without_faces(const TriangleMesh& mesh, const std::function<bool(Index face)>& remove);

/// Without the faces of which at least one corner is closer than `radius` to `centre`.
TriangleMesh without_ball(const TriangleMesh& mesh, const Vector3& centre, double radius);

/// Three vertices of its own for every face, as in an STL file.
TriangleMesh unwelded(const TriangleMesh& mesh);

/// Vertices and faces renumbered at random, and each face's corners rotated: the same surface.
TriangleMesh shuffled(const TriangleMesh& mesh, std::uint32_t seed);

/// The corners of every face, as the intersection tests take them.
std::vector<std::array<Vector3, 3>> corners_of(const TriangleMesh& mesh);

}  // namespace test
}  // namespace meshcomplete
