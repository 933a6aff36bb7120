"""Range scans of a simple solid, as a scanner makes them, with nothing but Python: range grids of parallel rays.

The solid is a ball with a handle of four sides, a frame of three bars: its surface has the genus 1. Everything that
tests ask of it is exact: where a ray meets it, and whether a point is inside.
"""
import math
import struct

RADIUS = 1.0
BARS = (((0.5, 0.55, -0.2), (2.4, 0.95, 0.2)), ((0.5, -0.95, -0.2), (2.4, -0.55, 0.2)),
        ((2.0, -0.95, -0.2), (2.4, 0.95, 0.2)))
DIRECTIONS = tuple((x, y, z) for x in (1, -1) for y in (1, -1) for z in (1, -1))  # no side of a bar is only grazed


def inside(point):
    """Whether a point is in the solid."""
    return math.dist(point, (0, 0, 0)) < RADIUS or any(
        all(low < x < high for x, low, high in zip(point, *bar)) for bar in BARS)


def first_hit(start, way):
    """How far along a ray the solid begins; None where the ray passes it."""
    hits = []
    along = -sum(p * d for p, d in zip(start, way))
    apart = sum(p * p for p in start) - along * along
    if apart < RADIUS * RADIUS:
        hits.append(along - math.sqrt(RADIUS * RADIUS - apart))
    for low, high in BARS:
        enter, leave = -math.inf, math.inf
        for p, d, a, b in zip(start, way, low, high):
            if d == 0:
                enter = enter if a < p < b else math.inf
                continue
            enter, leave = max(enter, min((a - p) / d, (b - p) / d)), min(leave, max((a - p) / d, (b - p) / d))
        if enter < leave:
            hits.append(enter)
    return min(hits, default=None)


def pose(direction):
    """The rotation from a scan's own coordinates, where the scanner is at +z, to the world's: its three columns."""
    length = math.dist(direction, (0, 0, 0))
    z = tuple(d / length for d in direction)
    flat = math.hypot(z[0], z[2])
    x = (z[2] / flat, 0.0, -z[0] / flat)
    y = (z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0])
    return x, y, z


def scan(direction, spacing):
    """A range grid seen from a direction, in its own coordinates. Faces join neighbours in the grid whatever their
    depths are, as MeshLab does when it opens one."""
    axes = pose(direction)
    half = math.ceil(2.8 / spacing)
    way = tuple(-z for z in axes[2])
    vertices, number = [], {}
    for row in range(-half, half + 1):
        for column in range(-half, half + 1):
            own = (spacing * column, spacing * row, 4.0)
            start = tuple(sum(own[k] * axes[k][i] for k in range(3)) for i in range(3))
            depth = first_hit(start, way)
            if depth is not None:
                number[column, row] = len(vertices)
                vertices.append((own[0], own[1], own[2] - depth))
    faces = []
    for column, row in number:
        corners = [number.get(place) for place in ((column, row), (column + 1, row), (column + 1, row + 1),
                                                   (column, row + 1))]
        for face in (corners[:3], [corners[0], *corners[2:]]):
            if None not in face:
                faces.append(tuple(face))
    return vertices, faces


def write_scan(path, vertices, faces):
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property float {axis}" for axis in "xyz"]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header\n"]
    parts = ["\n".join(header).encode()]
    parts += [struct.pack("<3f", *vertex) for vertex in vertices]
    parts += [struct.pack("<B3i", 3, *face) for face in faces]
    path.write_bytes(b"".join(parts))


def write_project(path, layers):
    """A project of MeshLab: `layers` are file names, each with the three columns of a rotation. MeshLab 2020.09 crashes
    when it opens one that has no blank at the end of a matrix' rows."""
    lines = ["<!DOCTYPE MeshLabDocument>", "<MeshLabProject>", " <MeshGroup>"]
    for name, columns in layers:
        rows = [" ".join(f"{column[i]:.9g}" for column in columns) + " 0 " for i in range(3)]
        lines += [f'  <MLMesh label="{name}" filename="{name}">', "   <MLMatrix44>", *rows, "0 0 0 1 ", "</MLMatrix44>",
                  "  </MLMesh>"]
    path.write_text("\n".join(lines + [" </MeshGroup>", " <RasterGroup/>", "</MeshLabProject>", ""]))


def make_project(folder, spacing=0.06, directions=DIRECTIONS):
    """Writes scans and the project `scans.mlp` that poses them; returns the project's path. Beside it `half.mlp` has the
    first half of them only: by default none sees the back of the ball."""
    layers = []
    for number, direction in enumerate(directions):
        name = f"scan_{number}.ply"
        write_scan(folder / name, *scan(direction, spacing))
        layers.append((name, pose(direction)))
    write_project(folder / "scans.mlp", layers)
    write_project(folder / "half.mlp", layers[:len(layers) // 2])
    return folder / "scans.mlp"
