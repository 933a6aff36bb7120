// The constructions of the paper on atomic volumes, in code: shapes whose holes have several rims.
#pragma once

#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete {
namespace test {

/// The mean of a face's corners.
Vector3 middle_of(const TriangleMesh& mesh, Index face);

/// Figure 1: a sphere of radius 1 without its poles, and an open pipe along the z axis through both openings.
/// Four rims: loops of 48 edges on the sphere, of 24 on the pipe.
TriangleMesh pierced_sphere();

/// Figure 2: two coaxial rims, the half of a torus that is further from the axis than 1. Two discs have less
/// area than the ring between the rims.
TriangleMesh outer_half_of_torus();

/// In the middle of that torus: outside, its hole has to be closed by a ring.
std::vector<Vector3> points_in_ring();

/// Figure 5: a sheet that is a spiral of two turns in the x-z plane, turned round the z axis. Its
/// outer side is the front. The two rims can be joined by nothing but a second sheet between the windings.
TriangleMesh spiral_torus();

/// A torus round the z axis without what lies between two angles (degrees, from the x axis).
TriangleMesh torus_without_arc(double from, double to);

/// Figure 11: two lumps that face each other across a gap at (1, 0, 0) so narrow that a bridge has less area
/// than two caps.
TriangleMesh lumps();

/// In the middle of that gap.
std::vector<Vector3> points_in_gap();

}  // namespace test
}  // namespace meshcomplete
