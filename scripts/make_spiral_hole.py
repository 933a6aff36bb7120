#!/usr/bin/env python3
"""Writes a ring with one hole that winds round its tube: a rim that crosses itself in every projection.

    scripts/make_spiral_hole.py FILE.off
"""

import math
import sys

RADIUS, TUBE = 1.0, 0.38
ALONG, AROUND = 300, 100  # vertices along the ring and round its tube
FIRST, LAST = 0.15 * math.pi, 0.85 * math.pi  # where the hole starts and ends, along the ring
TURNS = 5.0  # of the hole, if it went once along the ring
HALF_WIDTH = 0.7  # of the hole, round the tube


def in_hole(u, v):
    off_centre = (v - TURNS * u + math.pi) % (2 * math.pi) - math.pi
    return FIRST < u < LAST and abs(off_centre) < HALF_WIDTH


def main():
    points, faces = [], []
    for i in range(ALONG):
        for j in range(AROUND):
            u, v = 2 * math.pi * i / ALONG, 2 * math.pi * j / AROUND
            r = RADIUS + TUBE * math.cos(v)
            points.append((r * math.cos(u), r * math.sin(u), TUBE * math.sin(v)))
            if in_hole(2 * math.pi * (i + 0.5) / ALONG, 2 * math.pi * (j + 0.5) / AROUND):
                continue
            here, ahead = i * AROUND, (i + 1) % ALONG * AROUND
            a, b, c, d = here + j, ahead + j, here + (j + 1) % AROUND, ahead + (j + 1) % AROUND
            faces += [(a, b, d), (a, d, c)]
    with open(sys.argv[1], "w") as out:
        out.write(f"OFF\n{len(points)} {len(faces)} 0\n")
        out.writelines("%.7g %.7g %.7g\n" % p for p in points)
        out.writelines("3 %d %d %d\n" % t for t in faces)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main()
