#!/usr/bin/env python3
"""Makes the cases of the paper on Poisson-driven completion from meshes of Debian's package libcgal-demo.

    scripts/make_paper_cases.py CASE FOLDER

Writes CASE.off, and what guides its completion, into FOLDER. The meshes come from the cache (scripts/fetch_demo.sh).

fist        a hand without what scanners do not see: between the touching fingers, behind the thumb (figure 10a)
slices      the bunny, cut by many thin slabs in several directions, and rings cut round islands (figure 10d)
assembled   the bunny in two parts, with another head, an island, simple holes, and openings on both sides that a
            tube joins: assembled-tube.off is the guide (figure 1)
head        the bunny's body in small triangles, and a panther's head in large ones, some way off (figure 12)
horseshoe   a torus without a third of its turn, too wide to be bridged: horseshoe-points.ply is the guide
"""

import math
import pathlib
import subprocess
import sys

sys.dont_write_bytecode = True  # the checkout stays as it is
from mesh_shapes import (components, dot, kept, moved, read_off, together, tube, used_only, without_crumbs, write_off,  # noqa: E402
                         write_points)

TOP = pathlib.Path(__file__).resolve().parent.parent


def demo(name):
    subprocess.run([TOP / "scripts/fetch_demo.sh", name], check=True)
    return read_off(TOP / ".cache/data" / name)


def loop_subdivided(mesh):
    """One step of Loop's subdivision of a closed mesh."""
    points, faces = mesh
    ends, across = {}, {}
    for t in faces:
        for k in range(3):
            side = tuple(sorted((t[k], t[(k + 1) % 3])))
            across.setdefault(side, []).append(t[(k + 2) % 3])
    neighbours = [[] for _ in points]
    for a, b in across:
        neighbours[a].append(b)
        neighbours[b].append(a)
    result = []
    for p, around in zip(points, neighbours):
        n = len(around)
        share = (5 / 8 - (3 / 8 + math.cos(2 * math.pi / n) / 4) ** 2) / n
        result.append(tuple((1 - n * share) * p[k] + share * sum(points[v][k] for v in around) for k in range(3)))
    for side, (c, d) in across.items():
        ends[side] = len(result)
        a, b = (points[v] for v in side)
        result.append(tuple(3 / 8 * (a[k] + b[k]) + 1 / 8 * (points[c][k] + points[d][k]) for k in range(3)))
    finer = []
    for a, b, c in faces:
        ab, bc, ca = (ends[tuple(sorted(side))] for side in ((a, b), (b, c), (c, a)))
        finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return result, finer


def directions(count):
    """Directions all round, evenly."""
    golden = math.pi * (3 - math.sqrt(5))
    for i in range(count):
        z = 1 - (2 * i + 1) / count
        r = math.sqrt(1 - z * z)
        yield r * math.cos(golden * i), r * math.sin(golden * i), z


def times_seen(mesh, views, pixel, depth, slope):
    """How often each vertex is seen by an orthographic camera: nothing is before it, and it is not seen too flatly."""
    points, faces = mesh
    normals = [(0.0, 0.0, 0.0)] * len(points)
    for t in faces:
        a, b, c = (points[v] for v in t)
        u, w = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
        n = (u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0])
        for v in t:
            normals[v] = tuple(x + y for x, y in zip(normals[v], n))
    count = [0] * len(points)
    for eye in directions(views):
        side = (-eye[1], eye[0], 0.0) if abs(eye[2]) < 0.9 else (0.0, -eye[2], eye[1])
        length = math.sqrt(dot(side, side))
        side = tuple(x / length for x in side)
        up = (eye[1] * side[2] - eye[2] * side[1], eye[2] * side[0] - eye[0] * side[2],
              eye[0] * side[1] - eye[1] * side[0])
        nearest, cells = {}, []
        for p in points:
            cell = (math.floor(dot(side, p) / pixel), math.floor(dot(up, p) / pixel))
            height = dot(eye, p)
            cells.append((cell, height))
            if height > nearest.get(cell, -1e30):
                nearest[cell] = height
        for v, (cell, height) in enumerate(cells):
            n = normals[v]
            if height > nearest[cell] - depth and dot(eye, n) > slope * math.sqrt(dot(n, n)):
                count[v] += 1
    return count


def fist(write):
    mesh = loop_subdivided(loop_subdivided(demo("hand.off")))
    points, faces = mesh
    seen = times_seen(mesh, views=40, pixel=0.02, depth=0.02, slope=0.45)
    hidden = [t for t in faces if min(seen[v] for v in t) < 6]
    largest = {hidden[i] for i in components(hidden)[0]}
    write("fist", without_crumbs((points, [t for t in faces if t not in largest]), 100))


# Slabs that are cut out of the bunny: a normal, where the first one is, how far the next, and how thick.
SLABS = [((0.95, 0.31, 0.0), -0.42, 0.145, 0.02), ((-0.2, 0.98, 0.1), -0.36, 0.17, 0.016),
         ((0.25, 0.15, 0.96), -0.17, 0.19, 0.016)]
# Islands: round these points a ring is cut out between two radii.
ISLANDS = [((0.28, 0.0, 0.3), 0.035, 0.055), ((0.05, -0.15, -0.3), 0.03, 0.05), ((-0.42, 0.2, 0.13), 0.02, 0.035),
           ((0.3, -0.2, -0.3), 0.04, 0.06)]


def nearest_point(points, place):
    return min(points, key=lambda p: math.dist(p, place))


def slices(write):
    mesh = demo("bunny00.off")
    rings = [(nearest_point(mesh[0], place), low, high) for place, low, high in ISLANDS]

    def keep(p):
        for normal, first, step, thickness in SLABS:
            if (dot(normal, p) - first) % step < thickness:
                return False
        return not any(low < math.dist(p, centre) < high for centre, low, high in rings)

    write("slices", without_crumbs(kept(mesh, keep), 60))


# The plane between the bunny's body and its head, and the middle of its neck.
NECK, NECK_NORMAL = (-0.339, 0.013, 0.12), (-0.766, 0.643, 0.0)


def in_body(p):
    return dot(NECK_NORMAL, [p[k] - NECK[k] for k in range(3)]) < 0 and p[1] < 0.25


def panther_head(gap, scale):
    """The panther's head above the bunny's neck; it looks along z in its file, and the bunny along -x."""
    head = demo("lion-head.off")
    tilt = math.radians(-18)
    c, s = math.cos(tilt), math.sin(tilt)
    turn = ((0, -s, -c), (0, c, -s), (1, 0, 0))
    return moved(head, scale, turn, (0.11, -0.06, -0.34), [NECK[k] + gap * NECK_NORMAL[k] for k in range(3)])


def head(write):
    body = without_crumbs(kept(demo("bunny00.off"), in_body), 1000)
    write("head", together(body, panther_head(0.06, 0.53)))


# Openings on both sides of the bunny, round a line along z, and the tube that joins them.
PASSAGE, OPENING, TUBE = (-0.08, -0.2), 0.13, 0.07
# Other holes: round these points faces are taken out up to a radius.
SIMPLE_HOLES = [((-0.4, -0.2, 0.15), 0.05), ((-0.2, 0.1, 0.15), 0.035), ((0.05, 0.1, 0.15), 0.03), ((-0.2, -0.4, 0.3), 0.03),
                ((0.45, -0.3, -0.1), 0.03)]
# The island, and the slab between the two parts of the body.
RING, SLAB = ((0.28, -0.2, 0.35), 0.06, 0.1), ((0.96, 0.28, 0.0), 0.13, 0.17)


def assembled(write):
    bunny = demo("bunny00.off")
    ring = nearest_point(bunny[0], RING[0])
    holes = [(nearest_point(bunny[0], place), radius) for place, radius in SIMPLE_HOLES]

    def keep(p):
        return (in_body(p) and not SLAB[1] < dot(SLAB[0], p) < SLAB[2]
                and math.hypot(p[0] - PASSAGE[0], p[1] - PASSAGE[1]) > OPENING
                and not RING[1] < math.dist(p, ring) < RING[2]
                and all(math.dist(p, centre) > radius for centre, radius in holes))

    body = without_crumbs(kept(bunny, keep), 60)
    write("assembled", together(body, panther_head(0.06, 0.53)))
    write("assembled-tube", tube((*PASSAGE, -0.25), (*PASSAGE, 0.25), TUBE))


def horseshoe(write, folder):
    around, across, small = 96, 32, 0.35
    points = [((1 + small * math.cos(b)) * math.cos(a), (1 + small * math.cos(b)) * math.sin(a), small * math.sin(b))
              for a in (2 * math.pi * i / around for i in range(around))
              for b in (2 * math.pi * j / across for j in range(across))]
    faces = []
    for i in range(around // 3, around):
        for j in range(across):
            a, b = i * across + j, (i + 1) % around * across + j
            c, d = i * across + (j + 1) % across, (i + 1) % around * across + (j + 1) % across
            faces += [(a, b, d), (a, d, c)]
    write("horseshoe", used_only(points, faces))
    places, normals = [], []
    for i in range(3, around // 3 - 2, 3):
        for j in range(0, across, 4):
            a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
            normals.append((math.cos(b) * math.cos(a), math.cos(b) * math.sin(a), math.sin(b)))
            places.append(points[i * across + j])
    write_points(folder / "horseshoe-points.ply", places, normals)


CASES = {"fist": fist, "slices": slices, "assembled": assembled, "head": head, "horseshoe": horseshoe}


def main():
    if len(sys.argv) != 3 or sys.argv[1] not in CASES:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[2])

    def write(name, mesh):
        write_off(folder / f"{name}.off", *mesh)

    if sys.argv[1] == "horseshoe":
        horseshoe(write, folder)
    else:
        CASES[sys.argv[1]](write)


if __name__ == "__main__":
    main()
