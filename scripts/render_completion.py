#!/usr/bin/env python3
"""Pictures of a mesh before and after its holes are closed, the new faces coloured.

    scripts/render_completion.py MESH PREFIX [-f FILTER [-p NAME=VALUE ...] ...] [--from=X,Y,Z] [--up=X,Y,Z]
                                 [--at=X,Y,Z] [--width W] [--size W,H] [--edges] [--unfolded]
                                 [--with LAYER]

Writes PREFIX-before.png and PREFIX-after.png, and with --unfolded PREFIX-unfolded.png. Rims are drawn in red, the inner
side of the surface dark, new faces orange. The camera looks at the point --at (default: the centre of the bounding box)
from the direction --from; --width is what the picture shows across, as a share of the bounding box's diagonal. --with
opens another mesh first, as a layer that parameters can name.

Needs the runner (build/bin/meshcomplete, or where the variable MESHCOMPLETE says), f3d, xvfb-run and ImageMagick.
"""

import argparse
import collections
import math
import os
import pathlib
import subprocess
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent
RUNNER = os.environ.get("MESHCOMPLETE", str(TOP / "build/bin/meshcomplete"))
DEFAULT_FILTER = "Close Holes: Curve Unfolding"

# One scalar per face chooses its colour: mesh, inner side, new faces, rims.
COLOURS = {0.0: (0.86, 0.87, 0.90), 0.33: (0.16, 0.19, 0.24), 0.67: (1.00, 0.50, 0.10), 1.0: (0.85, 0.05, 0.05)}
MESH, INSIDE, NEW, RIM = COLOURS

# The inner side is drawn as a second surface just below the first, the rims as bands just above it: shares of the
# diagonal, more than the depth buffer needs and less than one sees.
INSIDE_DEPTH = 0.001
RIM_HEIGHT = 0.001


def subtract(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def combine(a, b, factor):
    return (a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a) if length > 0 else (0.0, 0.0, 1.0)


def vector(text):
    return tuple(float(x) for x in text.split(","))


def as_text(values):
    return ",".join("%.9g" % x for x in values)


def read_off(path):
    """Vertices and triangles of an OFF file as the runner writes it: one element a line, whatever stands behind it."""
    lines = pathlib.Path(path).read_text().split("\n")
    vertex_count, face_count = (int(word) for word in lines[1].split()[:2])
    vertices = [tuple(float(word) for word in line.split()[:3]) for line in lines[2 : 2 + vertex_count]]
    faces = [tuple(int(word) for word in line.split()[1:4]) for line in lines[2 + vertex_count :][:face_count]]
    return vertices, faces


def vertex_normals(vertices, faces):
    sums = [(0.0, 0.0, 0.0)] * len(vertices)
    for a, b, c in faces:
        normal = cross(subtract(vertices[b], vertices[a]), subtract(vertices[c], vertices[a]))
        for v in (a, b, c):
            sums[v] = combine(sums[v], normal, 1.0)
    return [unit(n) for n in sums]


def rim_edges(faces):
    count = collections.Counter()
    for face in faces:
        for a, b in zip(face, face[1:] + face[:1]):
            count[min(a, b), max(a, b)] += 1
    return [(a, b) for face in faces for a, b in zip(face, face[1:] + face[:1]) if count[min(a, b), max(a, b)] == 1]


class Scene:
    """Triangles with normals and a scalar each, written as a legacy VTK file."""

    def __init__(self):
        self.points, self.normals, self.triangles, self.scalars = [], [], [], []

    def add(self, points, normals, triangles, scalars):
        first = len(self.points)
        self.points += points
        self.normals += normals
        self.triangles += [tuple(first + v for v in t) for t in triangles]
        self.scalars += scalars

    def write(self, path):
        with open(path, "w") as out:
            out.write("# vtk DataFile Version 3.0\nscene\nASCII\nDATASET POLYDATA\n")
            out.write(f"POINTS {len(self.points)} float\n")
            out.writelines("%.9g %.9g %.9g\n" % p for p in self.points)
            out.write(f"POLYGONS {len(self.triangles)} {4 * len(self.triangles)}\n")
            out.writelines("3 %d %d %d\n" % t for t in self.triangles)
            out.write(f"POINT_DATA {len(self.points)}\nNORMALS normals float\n")
            out.writelines("%.6g %.6g %.6g\n" % n for n in self.normals)
            out.write(f"CELL_DATA {len(self.triangles)}\nSCALARS part float 1\nLOOKUP_TABLE default\n")
            out.writelines("%g\n" % s for s in self.scalars)


def bounding_box(points):
    low = tuple(min(p[k] for p in points) for k in range(3))
    high = tuple(max(p[k] for p in points) for k in range(3))
    return low, high


def scene_of(vertices, faces, old_faces, diagonal, band):
    """The surface, its inner side, and a band of the given width along every rim."""
    scene = Scene()
    normals = vertex_normals(vertices, faces)
    scene.add(vertices, normals, faces, [NEW if i >= old_faces else MESH for i in range(len(faces))])
    inner = [combine(p, n, -INSIDE_DEPTH * diagonal) for p, n in zip(vertices, normals)]
    scene.add(inner, [(-n[0], -n[1], -n[2]) for n in normals], [t[::-1] for t in faces], [INSIDE] * len(faces))
    for a, b in rim_edges(faces):
        along = unit(subtract(vertices[b], vertices[a]))
        corners = []
        for v in (a, b):
            across = unit(cross(along, normals[v]))
            lifted = combine(vertices[v], normals[v], RIM_HEIGHT * diagonal)
            corners += [combine(lifted, across, -band / 2), combine(lifted, across, band / 2)]
        scene.add(corners, [normals[a]] * 2 + [normals[b]] * 2, [(0, 1, 3), (0, 3, 2)], [RIM] * 2)
    return scene


def render(scene, picture, options, centre, distance, folder):
    model = os.path.join(folder, "scene.vtk")
    scene.write(model)
    position = combine(centre, unit(options.direction), distance)
    colormap = ",".join("%g,%g,%g,%g" % (value, *colour) for value, colour in COLOURS.items())
    command = ["xvfb-run", "-a", "f3d", model, "--dry-run", "--quiet", "--output", picture,
               "--resolution", "%d,%d" % (2 * options.size[0], 2 * options.size[1]), "--bg-color", "1,1,1",
               "--scalars=part", "--cells", "--range", "0,1", "--colormap", colormap, "--roughness", "0.6",
               "--camera-position=" + as_text(position), "--camera-focal-point=" + as_text(centre),
               "--camera-view-up=" + as_text(options.up), "--camera-view-angle=30"]
    if options.edges:
        command += ["--edges", "--line-width", "2"]
    subprocess.run(command, check=True)
    # Drawn twice as large and shrunk: smooth edges. A palette keeps the file small.
    subprocess.run(["convert", picture, "-filter", "Box", "-resize", "50%", "-level", "0,68%", "-strip", "-colors", "200",
                    "-define", "png:compression-level=9", picture], check=True)


def render_surface(path, old_faces, picture, options, frame, folder):
    vertices, faces = read_off(path)
    diagonal, centre, width = frame
    distance = width / 2 / math.tan(math.radians(15)) * options.size[1] / options.size[0]
    scene = scene_of(vertices, faces, len(faces) if old_faces is None else old_faces, diagonal, 0.006 * width)
    render(scene, picture, options, centre, distance, folder)
    return len(faces)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("prefix")
    parser.add_argument("-f", dest="steps", action="append", metavar="FILTER", type=lambda name: ("-f", name))
    parser.add_argument("-p", dest="steps", action="append", metavar="NAME=VALUE", type=lambda value: ("-p", value))
    parser.add_argument("--from", dest="direction", type=vector, default=(0, 0, 1))
    parser.add_argument("--up", type=vector, default=(0, 1, 0))
    parser.add_argument("--at", type=vector)
    parser.add_argument("--width", type=float, default=1.0)
    parser.add_argument("--size", type=lambda text: [int(x) for x in text.split(",")], default=[640, 480])
    parser.add_argument("--edges", action="store_true")
    parser.add_argument("--unfolded", action="store_true")
    parser.add_argument("--with", dest="layers", action="append", default=[], metavar="LAYER")
    return parser.parse_args()


def main():
    options = arguments()
    if not os.access(RUNNER, os.X_OK):
        raise SystemExit(f"There is no runner at {RUNNER}: run ./complete once, or set MESHCOMPLETE.")
    steps = [word for step in options.steps or [("-f", DEFAULT_FILTER)] for word in step]
    if options.unfolded:
        steps += ["-p", "UnfoldedLayer=true"]
    with tempfile.TemporaryDirectory() as folder:
        before, after, flat = (os.path.join(folder, name) for name in ("before.off", "after.off", "flat.off"))
        subprocess.run([RUNNER, "--quiet", "-i", options.mesh, "-o", before], check=True)
        command = [RUNNER, "--quiet", "-i", *options.layers, options.mesh] + steps
        command += ["-o", after, "-l", str(len(options.layers))]
        if options.unfolded:
            command += ["-o", flat, "-l", "x"]
        if subprocess.run(command).returncode not in (0, 3):
            raise SystemExit("The filter failed.")
        vertices, faces = read_off(before)
        low, high = bounding_box([vertices[v] for face in faces for v in face])
        diagonal = math.dist(low, high)
        centre = options.at or tuple((a + b) / 2 for a, b in zip(low, high))
        frame = (diagonal, centre, options.width * diagonal)
        old_faces = render_surface(before, None, options.prefix + "-before.png", options, frame, folder)
        render_surface(after, old_faces, options.prefix + "-after.png", options, frame, folder)
        if options.unfolded:
            low, high = bounding_box(read_off(flat)[0])
            options.direction, options.up, options.edges = (0, 0, 1), (0, 1, 0), True
            size = max(high[0] - low[0], (high[1] - low[1]) * options.size[0] / options.size[1])
            frame = (math.dist(low, high), tuple((a + b) / 2 for a, b in zip(low, high)), 1.1 * size)
            render_surface(flat, 0, options.prefix + "-unfolded.png", options, frame, folder)


if __name__ == "__main__":
    main()
