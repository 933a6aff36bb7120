#!/usr/bin/env python3
"""Writes shapes whose holes have several rims: what global filters close and a disk for each rim does not.

    scripts/make_atomic_shapes.py SHAPE FILE.off        one of the shapes below
    scripts/make_atomic_shapes.py gap FILE.off MESH.off AXIS FROM TO
                                                        a mesh without the slab between two coordinates along x, y or z

pierced-sphere   a sphere with an opening at either pole, and an open pipe through both (the paper's figure 1)
outer-half-torus a fat torus without the half that is nearer to its axis (figure 2)
inside-the-ring  points in the middle of that torus: a layer for OutsideLayer
island           a sphere without a ring round its pole: the cap is left, and touches nothing
broken-ring      a torus without a third of its turn
guide-tube       a tube in the middle of the outer half torus, facing its axis: a layer for GuideLayer
unlike-halves    the lower half of a sphere in small triangles and a cap of it in large ones, a band apart
"""

import math
import sys

sys.dont_write_bytecode = True  # the checkout stays as it is
from mesh_shapes import kept, read_off, together  # noqa: E402

AROUND = 96  # vertices round the axis


def revolve(profile, around=AROUND, keep=lambda i, j: True, closed=False):
    """A surface of revolution about the z axis. The profile (radius, height) has the outside on its left."""
    points, faces = [], []
    for r, z in profile:
        points += [(r * math.cos(2 * math.pi * j / around), r * math.sin(2 * math.pi * j / around), z) for j in range(around)]
    for i in range(len(profile) if closed else len(profile) - 1):
        for j in range(around):
            if not keep(i, j):
                continue
            here, ahead = i * around, (i + 1) % len(profile) * around
            a, b, c, d = here + j, ahead + j, here + (j + 1) % around, ahead + (j + 1) % around
            faces += [(a, b, d), (a, d, c)]
    return points, faces


def arc(first, last, steps, radius=1.0, centre=0.0):
    """Part of a circle, as a profile: angles in degrees, 0 at the top, growing away from the axis."""
    angles = [math.radians(first + (last - first) * i / steps) for i in range(steps + 1)]
    return [(centre + radius * math.sin(a), radius * math.cos(a)) for a in angles]


def with_pole(mesh, around=AROUND):
    """Closes the first row of a surface of revolution with one vertex more."""
    points, faces = mesh
    top = len(points)
    height = points[0][2] + 0.0005
    return points + [(0.0, 0.0, height)], faces + [(top, j, (j + 1) % around) for j in range(around)]


def upside_down(mesh):
    points, faces = mesh
    return [(x, -y, -z) for x, y, z in points], faces


def pierced_sphere():
    sphere = revolve(arc(24, 156, 58))
    pipe = revolve([(0.2, 1.45 - 2.9 * i / 100) for i in range(101)], around=40)
    return together(sphere, pipe)


def outer_half_torus():
    return revolve(arc(0, 180, 40, radius=0.6, centre=1.0))


def inside_the_ring():
    return [(0.0, 0.0, -0.4), (0.0, 0.0, 0.0), (0.0, 0.0, 0.4)], []


def island():
    cap = with_pole(revolve(arc(2, 18, 8)))
    # The other way round, so that both poles are closed by the same function.
    return together(cap, upside_down(with_pole(revolve(arc(2, 138, 68)))))


def broken_ring():
    profile = arc(0, 360, 32, radius=0.35, centre=1.0)[:-1]
    return revolve(profile, keep=lambda i, j: j >= AROUND // 3, closed=True)


def guide_tube():
    return revolve([(0.4, -0.3 + 0.1 * i) for i in range(7)], around=32)


def unlike_halves():
    coarse = with_pole(revolve(arc(2, 56, 7), around=24), around=24)
    return together(coarse, upside_down(with_pole(revolve(arc(2, 96, 47)))))


def without_slab(path, axis, low, high):
    k = "xyz".index(axis)
    return kept(read_off(path), lambda centre: not low < centre[k] < high)


SHAPES = {
    "pierced-sphere": pierced_sphere,
    "outer-half-torus": outer_half_torus,
    "inside-the-ring": inside_the_ring,
    "island": island,
    "broken-ring": broken_ring,
    "guide-tube": guide_tube,
    "unlike-halves": unlike_halves,
}


def main():
    name, path, *more = sys.argv[1:]
    points, faces = without_slab(more[0], more[1], float(more[2]), float(more[3])) if name == "gap" else SHAPES[name]()
    with open(path, "w") as out:
        out.write(f"OFF\n{len(points)} {len(faces)} 0\n")
        out.writelines("%.7g %.7g %.7g\n" % p for p in points)
        out.writelines("3 %d %d %d\n" % t for t in faces)


if __name__ == "__main__":
    if not (len(sys.argv) == 3 and sys.argv[1] in SHAPES) and not (len(sys.argv) == 7 and sys.argv[1] == "gap"):
        sys.exit(__doc__)
    main()
