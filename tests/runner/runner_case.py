"""What the tests of the runner share: running it, and making, writing and reading small meshes."""

import json
import math
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ["MESHCOMPLETE"]
PLUGINS = os.environ["MESHCOMPLETE_TEST_PLUGINS"]
CHECK = "Check Completion"


def as_float(value):
    """The 32-bit float nearest to value."""
    return struct.unpack("<f", struct.pack("<f", value))[0]


def grid(n=8, hole=True, origin=(0.0, 0.0, 0.0), scale=1.0):
    """An n by n sheet of quads in two triangles each, wavy, with one quad left out in the middle."""
    vertices, faces = [], []
    for j in range(n + 1):
        for i in range(n + 1):
            z = 0.3 * math.sin(i * 0.7) * math.cos(j * 0.9)
            vertices.append(tuple(as_float(o + scale * c) for o, c in zip(origin, (i / 3, j / 7, z))))
    for j in range(n):
        for i in range(n):
            if hole and i == n // 2 and j == n // 2:
                continue
            a = j * (n + 1) + i
            faces += [(a, a + 1, a + n + 2), (a, a + n + 2, a + n + 1)]
    return vertices, faces


def sphere(rings=12, segments=16, hole=True, origin=(0.0, 0.0, 0.0), scale=1.0):
    """A closed sphere of triangles, with a few left out at the equator when hole is set."""
    def place(x, y, z):
        return tuple(as_float(o + scale * c) for o, c in zip(origin, (x, y, z)))

    vertices = [place(0, 0, 1)]
    for r in range(1, rings):
        polar = math.pi * r / rings
        for s in range(segments):
            turn = 2 * math.pi * s / segments
            vertices.append(place(math.sin(polar) * math.cos(turn), math.sin(polar) * math.sin(turn), math.cos(polar)))
    vertices.append(place(0, 0, -1))
    at = lambda r, s: 1 + (r - 1) * segments + s % segments
    faces = []
    for s in range(segments):
        faces.append((0, at(1, s), at(1, s + 1)))
        for r in range(1, rings - 1):
            if hole and r == rings // 2 and s < 3:
                continue
            faces += [(at(r, s), at(r + 1, s), at(r + 1, s + 1)), (at(r, s), at(r + 1, s + 1), at(r, s + 1))]
        faces.append((at(rings - 1, s), len(vertices) - 1, at(rings - 1, s + 1)))
    return vertices, faces


def without(vertices, faces, leave_out):
    """The faces whose mean height is not in an interval of `leave_out`."""
    def height(face):
        return sum(vertices[v][2] for v in face) / 3
    return [face for face in faces if not any(low < height(face) < high for low, high in leave_out)]


def outer_half_torus(around=48, across=16, small=0.6):
    """The outer half of a torus of radius 1: two disks close it with less area than a ring."""
    vertices = []
    for i in range(around):
        turn = 2 * math.pi * i / around
        for j in range(across + 1):
            angle = math.pi * (j / across - 0.5)
            r = 1 + small * math.cos(angle)
            vertices.append((r * math.cos(turn), r * math.sin(turn), small * math.sin(angle)))
    faces = []
    for i in range(around):
        for j in range(across):
            a, b = i * (across + 1) + j, (i + 1) % around * (across + 1) + j
            faces += [(a, b, b + 1), (a, b + 1, a + 1)]
    return vertices, faces


def write_off(path, vertices, faces):
    with open(path, "w") as file:
        file.write(f"OFF\n{len(vertices)} {len(faces)} 0\n")
        file.writelines(f"{x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in vertices)
        file.writelines(f"{len(face)} {' '.join(map(str, face))}\n" for face in faces)


def write_obj(path, vertices, faces):
    with open(path, "w") as file:
        file.writelines(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in vertices)
        file.writelines("f " + " ".join(str(v + 1) for v in face) + "\n" for face in faces)


def write_stl(path, vertices, faces):
    with open(path, "wb") as file:
        file.write(b"binary".ljust(80) + struct.pack("<I", len(faces)))
        for face in faces:
            file.write(struct.pack("<3f", 0, 0, 1))
            for v in face:
                file.write(struct.pack("<3f", *vertices[v]))
            file.write(struct.pack("<H", 0))


def write_ply(path, vertices, faces, colours=None, quality=None, normals=None):
    """Binary PLY; colours are (r, g, b, a), one for each vertex."""
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property float {axis}" for axis in "xyz"]
    if normals:
        header += [f"property float n{axis}" for axis in "xyz"]
    if colours:
        header += [f"property uchar {name}" for name in ("red", "green", "blue", "alpha")]
    if quality:
        header.append("property float quality")
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    with open(path, "wb") as file:
        file.write(("\n".join(header) + "\n").encode())
        for i, vertex in enumerate(vertices):
            file.write(struct.pack("<3f", *vertex))
            if normals:
                file.write(struct.pack("<3f", *normals[i]))
            if colours:
                file.write(struct.pack("<4B", *colours[i]))
            if quality:
                file.write(struct.pack("<f", quality[i]))
        for face in faces:
            file.write(struct.pack(f"<B{len(face)}i", len(face), *face))


class Ply:
    """A PLY file: `vertices` and `faces` are lists of dicts by property name, a list property being a tuple."""

    TYPES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d"}

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        end = data.index(b"end_header\n") + len(b"end_header\n")
        header = data[:end].decode().split("\n")
        self.binary = "format binary_little_endian 1.0" in header
        elements = []
        for line in header:
            words = line.split()
            if words[:1] == ["element"]:
                elements.append((words[1], int(words[2]), []))
            elif words[:1] == ["property"]:
                elements[-1][2].append(words[1:])
        self.properties = {name: [words[-1] for words in properties] for name, _, properties in elements}
        self.elements = {}
        self._data, self._at = data, end
        self._words = iter(data[end:].split()) if not self.binary else None
        for name, count, properties in elements:
            self.elements[name] = [self._row(properties) for _ in range(count)]
        self.complete = self._at == len(data) if self.binary else next(self._words, None) is None

    def _value(self, kind):
        if not self.binary:
            word = next(self._words)
            return as_float(float(word)) if kind in ("float", "double") else int(word)
        code = "<" + self.TYPES[kind]
        (value,) = struct.unpack_from(code, self._data, self._at)
        self._at += struct.calcsize(code)
        return value

    def _row(self, properties):
        row = {}
        for words in properties:
            if words[0] == "list":
                row[words[-1]] = tuple(self._value(words[2]) for _ in range(self._value(words[1])))
            else:
                row[words[-1]] = self._value(words[0])
        return row

    @property
    def points(self):
        return [(v["x"], v["y"], v["z"]) for v in self.elements["vertex"]]

    @property
    def triangles(self):
        return [face["vertex_indices"] for face in self.elements["face"]]


def bits(points):
    """The bit patterns of points as 32-bit floats, so that -0 and NaN count."""
    return [struct.pack("<3f", *point) for point in points]


class RunnerCase(unittest.TestCase):
    """Every test has a folder of its own, and whatever it does must not leave hidden files there."""

    maxDiff = None

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="runner test ")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def tearDown(self):
        self.assert_no_junk()

    def assert_no_junk(self):
        junk = [name for _, folders, files in os.walk(self.folder) for name in folders + files if name.startswith(".")]
        self.assertEqual(junk, [])

    def path(self, name):
        return os.path.join(self.folder, name)

    def command(self, *arguments):
        return [PROGRAM, "--plugins", PLUGINS, *map(str, arguments)]

    def run_program(self, *arguments, environment=None, **options):
        return subprocess.run(self.command(*arguments), cwd=self.folder, capture_output=True, text=True, timeout=60,
                              env={**os.environ, **(environment or {})}, **options)

    def check(self, code, *arguments, **options):
        """Runs the program and expects an exit code."""
        result = self.run_program(*arguments, **options)
        self.assertEqual(result.returncode, code, f"{arguments}\n{result.stdout}\n{result.stderr}")
        return result

    def read_report(self, name="report.json"):
        def not_json(text):
            raise ValueError(text)
        with open(self.path(name)) as file:
            return json.load(file, parse_constant=not_json)

    def make_sphere(self, name="sphere.ply", **options):
        vertices, faces = sphere(**options)
        write_ply(self.path(name), vertices, faces)
        return vertices, faces


class ClosingCase(RunnerCase):
    """Tests of one filter that closes holes: `filter` is its name."""

    def write(self, name, vertices, faces):
        used = sorted({v for face in faces for v in face})
        number = {v: i for i, v in enumerate(used)}
        write_ply(self.path(name), [vertices[v] for v in used], [tuple(number[v] for v in face) for face in faces])

    def close(self, *parameters, inputs=("in.ply",), code=0):
        """Closes the holes; returns what Check Completion and the report say, and the mesh."""
        options = ["-p", *parameters] if parameters else []
        result = self.check(code, "-i", *inputs, "-f", self.filter, *options, "-f", CHECK, "-o", "out.ply", "--report",
                            "report.json")
        self.log = result.stdout
        self.assertIn("Self-intersecting pairs of faces: 0", self.log)
        return Ply(self.path("out.ply"))

    def said(self, name):
        """A number that Check Completion gave."""
        return int(next(line for line in self.log.split("\n") if line.startswith(name + ":")).split()[-1])

    def components(self):
        return self.said("Connected components")

    def refused(self, code, *parameters, inputs=("in.ply",)):
        """The filter does not run: nothing is written, and the inputs stay as they are. Returns the message."""
        def contents():
            return [pathlib.Path(self.path(name)).read_bytes() for name in inputs]
        if os.path.exists(self.path("out.ply")):
            os.remove(self.path("out.ply"))
        before = contents()
        result = self.check(code, "-i", *inputs, "-f", self.filter, "-p", *parameters, "-o", "out.ply")
        self.assertFalse(os.path.exists(self.path("out.ply")), result.stderr)
        self.assertEqual(contents(), before)
        return result.stderr

    def assert_cancels(self, *parameters, delays):
        """Ctrl-C after each of these delays (seconds) ends a run that would take long, soon, and nothing is written."""
        for delay in delays:
            process = subprocess.Popen(self.command("-i", "in.ply", "-f", self.filter, "-p", *parameters, "-o", "out.ply"),
                                       cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(delay)
            start = time.monotonic()
            process.send_signal(signal.SIGINT)
            # A signal that comes before the program's first line ends it as it ends any program.
            self.assertIn(process.wait(timeout=60), (130, -signal.SIGINT))
            self.assertLess(time.monotonic() - start, 5)
            self.assertFalse(os.path.exists(self.path("out.ply")))

    def assert_threads_do_not_matter(self):
        """One thread, two, and two again give the same file."""
        results = []
        for threads in (1, 2, 2):
            self.check(0, "-i", "in.ply", "-f", self.filter, "-o", "out.ply", "--threads", threads)
            results.append(pathlib.Path(self.path("out.ply")).read_bytes())
        self.assertEqual(results[0], results[1])
        self.assertEqual(results[1], results[2])
