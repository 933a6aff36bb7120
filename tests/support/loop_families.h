// Families of closed polygons with a known knot type, made by seeded code.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete::testing {

using Loop = std::vector<Vector3>;

/// `points` samples of a closed curve with period 2 pi.
Loop sampled(int points, const std::function<Vector3(double)>& curve);

/// A rim that winds `turns` times round its axis before it closes, rising and falling once: unknotted, but
/// every projection along the axis crosses itself.
Loop wound_rim(int points, int turns, double height = 0.3);

/// Winds `turns` times up the outside of a cylinder and back down its inside: unknotted.
Loop wound_round_cylinder(int points, int turns);

/// A helix of `turns` turns whose ends are joined outside of it: unknotted.
Loop closed_helix(int points, int turns);

/// z = height cos(waves t) over a circle: unknotted.
Loop saddle(int points, int waves, double height);

/// The (p, q) torus knot; knotted when p and q are coprime and both greater than 1.
Loop torus_knot(int points, int p, int q);

/// The figure eight knot.
Loop figure_eight_knot(int points);

/// An unknot that looks like anything but: from a triangle, edges are again and again pulled out to random
/// places in a ball wherever the swept triangle meets nothing, so that the loop stays unknotted by
/// construction.
Loop random_tangle(int points, std::uint64_t seed);

/// The rim of a long hole in a coarse mesh of a head: a band that winds in waves more than half-way round a
/// bumpy ball, its sides zigzagging from edge to edge. The boundary of a disk on the ball, so unknotted.
Loop rough_rim(int points, std::uint64_t seed);

/// Whether no two edges of a polygon meet but neighbours in their common point: every pair looked at, in
/// exact integer arithmetic. Coordinates have to be multiples of 2^-40 below 2^10; `on_grid` makes them so.
bool is_simple_by_brute_force(const std::vector<Eigen::Vector2d>& polygon);
Eigen::Vector2d on_grid(const Eigen::Vector2d& point);

/// The sum of two loops: cut open where `first` is lowest and `second` is highest in z and joined there. The
/// knot type is the connected sum.
Loop connected_sum(const Loop& first, const Loop& second);

}  // namespace meshcomplete::testing
