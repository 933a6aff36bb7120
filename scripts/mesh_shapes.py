"""What the scripts share that make meshes: reading and writing OFF files, taking faces away, moving, putting together."""

import collections
import math


def read_off(path):
    """Vertices and triangles of an OFF file."""
    with open(path) as file:
        words = file.read().split()
    vertices, triangles = int(words[1]), int(words[2])
    numbers = [float(word) for word in words[4 : 4 + 3 * vertices]]
    corners = [int(word) for word in words[4 + 3 * vertices : 4 + 3 * vertices + 4 * triangles]]
    points = [tuple(numbers[3 * i : 3 * i + 3]) for i in range(vertices)]
    return points, [tuple(corners[4 * i + 1 : 4 * i + 4]) for i in range(triangles)]


def write_off(path, points, faces):
    with open(path, "w") as out:
        out.write(f"OFF\n{len(points)} {len(faces)} 0\n")
        out.writelines("%.9g %.9g %.9g\n" % p for p in points)
        out.writelines("3 %d %d %d\n" % t for t in faces)


def write_points(path, points, normals):
    """A point set with normals, as a PLY file in text."""
    with open(path, "w") as out:
        out.write(f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n")
        out.writelines(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
        out.write("end_header\n")
        out.writelines("%.9g %.9g %.9g %.9g %.9g %.9g\n" % (*p, *n) for p, n in zip(points, normals))


def together(*meshes):
    points, faces = [], []
    for more_points, more_faces in meshes:
        faces += [tuple(v + len(points) for v in t) for t in more_faces]
        points += more_points
    return points, faces


def used_only(points, faces):
    """Without the vertices that no face has."""
    number = {v: i for i, v in enumerate(sorted({v for t in faces for v in t}))}
    return [points[v] for v in number], [tuple(number[v] for v in t) for t in faces]


def kept(mesh, keep):
    """The faces whose centre is one to keep."""
    points, faces = mesh
    return used_only(points, [t for t in faces if keep(tuple(sum(points[v][k] for v in t) / 3 for k in range(3)))])


def components(faces):
    """The faces, grouped by connection through common sides, the largest group first."""
    sides, group = {}, list(range(len(faces)))

    def root(i):
        while group[i] != i:
            group[i] = group[group[i]]
            i = group[i]
        return i

    for i, t in enumerate(faces):
        for a, b in zip(t, t[1:] + t[:1]):
            other = sides.setdefault((min(a, b), max(a, b)), i)
            group[root(other)] = root(i)
    groups = {}
    for i in range(len(faces)):
        groups.setdefault(root(i), []).append(i)
    return sorted(groups.values(), key=lambda g: (-len(g), g[0]))


def without_crumbs(mesh, least):
    """Without components of fewer faces than `least`, and with one fan of faces at each vertex."""
    points, faces = mesh
    while True:
        faces = [faces[i] for group in components(faces) if len(group) >= least for i in sorted(group)]
        spare = several_fans(faces)
        if not spare:
            return used_only(points, faces)
        faces = [t for t in faces if not spare & set(t)]


def several_fans(faces):
    """Vertices with more than two rim edges: faces meet there in the vertex only."""
    directed = {(a, b) for t in faces for a, b in zip(t, t[1:] + t[:1])}
    rim = [a for a, b in directed if (b, a) not in directed]
    return {v for v, count in collections.Counter(rim).items() if count > 1}


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def moved(mesh, scale=1.0, turn=((1, 0, 0), (0, 1, 0), (0, 0, 1)), centre=(0, 0, 0), to=(0, 0, 0)):
    """Scaled and turned about a centre that is then put somewhere else."""
    points, faces = mesh
    def image(p):
        q = [scale * (p[k] - centre[k]) for k in range(3)]
        return tuple(dot(row, q) + to[k] for k, row in enumerate(turn))
    return [image(p) for p in points], faces


def tube(start, end, radius, around=48, steps=24):
    """A tube along the z axis from a point to another, facing its axis."""
    points, faces = [], []
    for i in range(steps + 1):
        middle = [a + (b - a) * i / steps for a, b in zip(start, end)]
        for j in range(around):
            turn = 2 * math.pi * j / around
            points.append((middle[0] + radius * math.cos(turn), middle[1] + radius * math.sin(turn), middle[2]))
    for i in range(steps):
        for j in range(around):
            a, b = i * around + j, i * around + (j + 1) % around
            faces += [(a, a + around, b), (b, a + around, b + around)]
    return points, faces


def nearest_faces_removed(mesh, share, disks):
    """Without disks that have a share of all faces together, evenly spread over the list of vertices."""
    points, faces = mesh
    centres = [points[(2 * i + 1) * len(points) // (2 * disks)] for i in range(disks)]
    middles = [tuple(sum(points[v][k] for v in t) / 3 for k in range(3)) for t in faces]
    gone = set()
    for centre in centres:
        order = sorted(range(len(faces)), key=lambda i: math.dist(middles[i], centre))
        gone.update(order[: int(share * len(faces) / disks)])
    rest = [t for i, t in enumerate(faces) if i not in gone]
    return without_crumbs((points, rest), len(rest) // 2)
