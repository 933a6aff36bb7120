// What marching cubes does in each of a cube's 256 cases.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace meshcomplete {

/// An edge of a cube: from a corner along an axis. Bit a of a corner's number is its coordinate along axis a.
struct CubeEdge {
  std::uint8_t low;   ///< the corner where it begins; its bit `axis` is 0
  std::uint8_t axis;  ///< 0, 1 or 2
};

/// The twelve edges: number 4 * axis and on, ordered by `low`.
const std::array<CubeEdge, 12>& cube_edges();

/// Three edges, a corner of the triangle on each of them; counter-clockwise seen from the outside corners.
using CubeTriangle = std::array<std::uint8_t, 3>;

/// The triangles between the inside corners (bit c of `inside`: corner c) and the others. On a face whose
/// corners alternate the two inside corners are kept apart, in whichever of the face's two cubes, so that
/// what all cubes make together is closed and every vertex has one fan. No triangle has an edge in a cube's
/// face that the cube beyond does not have too. Worked out once, from that rule; as no triangle lies in a
/// face, none is degenerate wherever on the edges its corners are, the edges' ends excepted. Source: Lorensen
/// and Cline (1987), with the faces decided alike from both sides.
const std::vector<CubeTriangle>& cube_triangles(std::uint8_t inside);

}  // namespace meshcomplete
