"""Files that are wrong, and meshes that are odd: a clear message or a clean run, never a crash."""

import math
import os
import random
import unittest

from runner_case import Ply, RunnerCase, as_float, bits, grid, sphere, write_obj, write_off, write_ply, write_stl

PROBE = "Probe: Everything"


def moebius(n=40):
    vertices, faces = [], []
    for i in range(n):
        turn = 2 * math.pi * i / n
        for side in (-0.3, 0.3):
            radius = 1 + side * math.cos(turn / 2)
            vertices.append(tuple(map(as_float, (radius * math.cos(turn), radius * math.sin(turn), side * math.sin(turn / 2)))))
    for i in range(n):
        a, b = 2 * i, 2 * i + 1
        c, d = (a + 2, b + 2) if i + 1 < n else (1, 0)
        faces += [(a, c, b), (b, c, d)]
    return vertices, faces


def odd_meshes():
    """Meshes by name that ordinary code trips over."""
    vertices, faces = sphere()
    ring, band = sphere(hole=False)
    yield "points only", vertices, []
    yield "one triangle", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]
    yield "moebius", *moebius()
    yield "non-manifold rim", *[grid()[0], grid()[1] + [(0, 40, 1), (0, 1, 60)]]
    yield "faces without area", vertices, faces + [(0, 1, 1), (2, 2, 2), (3, 4, 3)]
    yield "collinear", [(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)], [(0, 1, 2), (1, 2, 3)]
    yield "all at one place", [(1, 2, 3)] * 9, [(0, 1, 2), (3, 4, 5), (6, 7, 8)]
    yield "not a number", [(math.nan, 0, 0)] + vertices[1:], faces
    yield "infinite", [(math.inf, 0, -math.inf)] + vertices[1:], faces
    yield "duplicate faces", ring, band + band
    yield "huge", *sphere(scale=1e9)
    yield "tiny", *sphere(scale=1e-9)
    yield "far away", *sphere(origin=(1e6, -1e6, 1e6))
    yield "unused vertices", vertices + [(9, 9, 9)] * 5, faces


class OddMeshes(RunnerCase):
    def test_through_every_format_and_filter(self):
        for name, vertices, faces in odd_meshes():
            with self.subTest(name):
                write_ply(self.path("in.ply"), vertices, faces)
                self.check(0, "-i", "in.ply", "-o", "out.ply")
                after = Ply(self.path("out.ply"))
                self.assertEqual(bits(after.points), bits(vertices))
                self.assertEqual(after.triangles, [tuple(face) for face in faces])
                self.check(0, "-i", "in.ply", "-f", PROBE, "-o", "out.ply", "--report", "report.json")
                self.read_report()
                result = self.run_program("-i", "in.ply", "-f", "Close Holes", "-o", "out.ply", "--report", "report.json")
                self.assertIn(result.returncode, (0, 1), result.stderr)
                if name != "faces without area":  # MeshLab's own filter stops the program at these.
                    self.assertNotIn("crashed", result.stderr)
                self.read_report()

    def test_as_stl_and_off(self):
        for name, vertices, faces in odd_meshes():
            with self.subTest(name):
                write_stl(self.path("in.stl"), vertices, faces)
                write_off(self.path("in.off"), vertices, faces)
                for file in ("in.stl", "in.off"):
                    result = self.run_program("-i", file, "-o", "out.ply")
                    self.assertIn(result.returncode, (0, 1), result.stderr)
                    self.assertNotIn("crashed", result.stderr)


class DamagedFiles(RunnerCase):
    def refuse(self, name):
        result = self.check(1, "-i", name, "-o", "out.ply", "--report", "report.json")
        self.assertIn(os.path.basename(name), result.stderr)
        self.assertFalse(os.path.exists(self.path("out.ply")))
        self.assertEqual(self.read_report()["status"], "failed")
        return result.stderr

    def test_empty_files(self):
        for name in ("a.ply", "a.off", "a.obj", "a.stl"):
            open(self.path(name), "w").close()
            self.assertIn("empty", self.refuse(name))

    def test_truncated_off(self):
        vertices, faces = grid(3)
        write_off(self.path("whole.off"), vertices, faces)
        with open(self.path("whole.off")) as file:
            lines = file.read().split("\n")
        for count in range(len(lines) - 1):
            with open(self.path("cut.off"), "w") as file:
                file.write("\n".join(lines[:count]))
            with self.subTest(lines=count):
                self.refuse("cut.off")

    def test_wrong_off(self):
        for text, expected in (("OFF\n1 1 0\n0 0 0\n3 0 0 7\n", "not there"), ("OFF\n1 1 0\n0 0 0\n3 0 0 -1\n", "not there"),
                               ("OFF\n1 1 0\n0 0 x\n3 0 0 0\n", "no number"), ("OFF\n1 1 0\n0 0 0\n2 0 0\n", "three corners"),
                               ("OFF\nfew some 0\n", "missing"), ("hello\n", "OFF"),
                               ("OFF\n999999999999 1 0\n", "missing"), ("OFF\n2000000000 1 0\n1 2 3\n", "ends at vertex 1")):
            with open(self.path("bad.off"), "w") as file:
                file.write(text)
            with self.subTest(text):
                self.assertIn(expected, self.refuse("bad.off"))

    def test_unusual_but_right_off(self):
        for text in ("OFF 3 1 0\n0 0 0 1 0 0\n0 1 0\n3 0 1 2\n", "# c\nOFF\n\n3 1 0\n0 0 0\n1 0 0 \n+0 1e0 .0\r\n3 0 1 2 255 0 0\n",
                     "OFF\n3 1\n0 0 0 # first\n   \n1 0 0\n\t\n0 1 0\n  \n#c\n  3 0\n1 2\n",
                     "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 255 0 0 255\n0 1 0 255 0 0 255\n3\t0 1 2\n"):
            with open(self.path("odd.off"), "w") as file:
                file.write(text)
            self.check(0, "-i", "odd.off", "-o", "out.ply")
            self.assertEqual(len(Ply(self.path("out.ply")).triangles), 1)

    def test_truncated_ply(self):
        vertices, faces = grid(3)
        write_ply(self.path("whole.ply"), vertices, faces)
        with open(self.path("whole.ply"), "rb") as file:
            data = file.read()
        for length in range(1, len(data), 37):
            with open(self.path("cut.ply"), "wb") as file:
                file.write(data[:length])
            with self.subTest(length=length):
                self.refuse("cut.ply")

    def test_wrong_indices(self):
        vertices, faces = grid(3)
        for bad in (len(vertices), -1, 10 ** 8):
            write_ply(self.path("bad.ply"), vertices, faces + [(0, 1, bad)])
            self.refuse("bad.ply")
        write_obj(self.path("bad.obj"), vertices, faces + [(0, 1, 10 ** 6)])
        self.refuse("bad.obj")

    def test_random_damage(self):
        random.seed(11)
        vertices, faces = grid(4)
        writers = {"ply": write_ply, "off": write_off, "obj": write_obj, "stl": write_stl}
        for extension, write in writers.items():
            write(self.path("whole." + extension), vertices, faces)
            with open(self.path("whole." + extension), "rb") as file:
                data = file.read()
            for round_number in range(25):
                damaged = bytearray(data)
                for _ in range(random.choice((1, 3, 20))):
                    damaged[random.randrange(len(damaged))] = random.randrange(256)
                if random.random() < 0.3:
                    del damaged[random.randrange(len(damaged)):]
                name = f"damaged.{extension}"
                with open(self.path(name), "wb") as file:
                    file.write(damaged)
                with self.subTest(extension, round=round_number):
                    result = self.run_program("-i", name, "-f", PROBE, "-o", "out.ply", "--report", "report.json")
                    self.assertIn(result.returncode, (0, 1), result.stderr)
                    self.read_report()

    def test_other_files_with_mesh_names(self):
        for extension in ("ply", "off", "obj", "stl", "dae", "x3d", "ctm", "3ds", "xyz", "ptx"):
            with open(self.path("text." + extension), "w") as file:
                file.write("The quick brown fox jumps over the lazy dog.\n" * 20)
            with self.subTest(extension):
                result = self.run_program("-i", "text." + extension, "-o", "out.ply")
                self.assertIn(result.returncode, (0, 1), result.stderr)


if __name__ == "__main__":
    unittest.main()
