"""What reading and writing keeps: exact positions, order, attributes; links, permissions and side files."""

import os
import random
import stat
import struct
import subprocess
import unittest

from runner_case import PROGRAM, Ply, RunnerCase, as_float, bits, grid, sphere, write_obj, write_off, write_ply, write_stl

PROBE = "Probe: Everything"


def awkward_floats(count, seed=1):
    """Floats of all sizes that need up to nine digits, both zeros among them."""
    random.seed(seed)
    values = [0.0, -0.0, 1e-38, 3.4e38, as_float(0.1), as_float(1 / 3), 16777217.0, 1e9, 1e-9]
    while len(values) < count:
        value = struct.unpack("<f", struct.pack("<I", random.getrandbits(32)))[0]
        if value == value and abs(value) < 3.4e38:
            values.append(value)
    return values


def awkward_mesh(n=300):
    """Positions that are hard to print; a face that has a vertex twice, one without area, and unused vertices."""
    values = awkward_floats(3 * n)
    vertices = [tuple(values[3 * i:3 * i + 3]) for i in range(n)]
    faces = [(i, i + 1, i + 2) for i in range(0, n - 20, 2)] + [(5, 5, 6), (0, 1, 0)]
    return vertices, faces


class Preservation(RunnerCase):
    def test_ply_keeps_every_bit_and_every_attribute(self):
        vertices, faces = awkward_mesh()
        random.seed(2)
        colours = [tuple(random.randrange(256) for _ in range(4)) for _ in vertices]
        quality = awkward_floats(len(vertices), seed=3)
        normals = [tuple(awkward_floats(12, seed=i)[9:12]) for i in range(len(vertices))]
        write_ply(self.path("in.ply"), vertices, faces, colours, quality, normals)
        self.check(0, "-i", "in.ply", "-o", "out.ply")
        before, after = Ply(self.path("in.ply")), Ply(self.path("out.ply"))
        self.assertTrue(after.binary and after.complete)
        self.assertEqual(bits(after.points), bits(vertices))
        self.assertEqual(after.triangles, faces)
        for name in ("nx", "ny", "nz", "red", "green", "blue", "alpha", "quality"):
            self.assertEqual([struct.pack("<d", v[name]) for v in after.elements["vertex"]],
                             [struct.pack("<d", v[name]) for v in before.elements["vertex"]], name)

    def test_no_attributes_are_made_up(self):
        self.make_sphere("in.ply")
        self.check(0, "-i", "in.ply", "-o", "out.ply")
        self.assertEqual(Ply(self.path("out.ply")).properties["vertex"], ["x", "y", "z"])
        self.assertEqual(Ply(self.path("out.ply")).properties["face"], ["vertex_indices"])

    def test_attributes_chosen_and_added(self):
        self.make_sphere("in.ply")
        self.check(0, "-i", "in.ply", "-o", "out.ply", "-m", "vn", "vq")
        self.assertEqual(Ply(self.path("out.ply")).properties["vertex"], ["x", "y", "z", "nx", "ny", "nz", "quality"])
        self.check(0, "-i", "in.ply", "-f", "Vertex Color Filling", "-o", "out.ply")
        self.assertIn("red", Ply(self.path("out.ply")).properties["vertex"])

    def test_text_formats_keep_every_bit(self):
        vertices, faces = awkward_mesh()
        write_ply(self.path("in.ply"), vertices, faces)
        for name, extra in (("out.off", []), ("out.obj", []), ("text.ply", ["-m", "sa"])):
            with self.subTest(name):
                self.check(0, "-i", "in.ply", "-o", name, *extra)
                self.check(0, "-i", name, "-o", "back.ply")
                back = Ply(self.path("back.ply"))
                self.assertEqual(bits(back.points), bits(vertices))
                # MeshLab's OBJ reader leaves out faces that have a vertex twice.
                self.assertEqual(back.triangles, faces[:-2] if name == "out.obj" else faces)

    def test_text_formats_with_attributes(self):
        vertices, faces = grid()
        colours = [(i % 256, (3 * i) % 256, 7, 255) for i in range(len(vertices))]
        write_ply(self.path("in.ply"), vertices, faces, colours)
        for name, extra in (("out.off", []), ("out.obj", []), ("text.ply", ["-m", "sa"])):
            with self.subTest(name):
                self.check(0, "-i", "in.ply", "-o", name, *extra)
                self.check(0, "-i", name, "-o", "back.ply")
                back = Ply(self.path("back.ply"))
                self.assertEqual(bits(back.points), bits(vertices))
                # MeshLab writes the colours of OBJ as fractions with six digits, and cuts off when it reads them.
                slack = 1 if name == "out.obj" else 0
                for vertex, colour in zip(back.elements["vertex"], colours):
                    for channel, value in zip(("red", "green", "blue"), colour):
                        self.assertLessEqual(abs(vertex[channel] - value), slack)

    def test_stl_keeps_every_bit_and_merges(self):
        vertices, faces = sphere()
        write_stl(self.path("in.stl"), vertices, faces)
        for name, extra in (("out.stl", []), ("text.stl", ["-m", "sa"])):
            result = self.check(0, "-i", "in.stl", "-o", name, *extra)
            self.assertIn("merged", result.stdout)
            self.check(0, "-i", name, "-o", "back.ply")
            back = Ply(self.path("back.ply"))
            self.assertEqual(len(back.points), len(vertices))
            corners = [tuple(back.points[v] for v in face) for face in back.triangles]
            self.assertEqual(corners, [tuple(vertices[v] for v in face) for face in faces])

    def test_off_and_obj_are_read_exactly(self):
        vertices, faces = grid()
        write_off(self.path("in.off"), vertices, faces)
        write_obj(self.path("in.obj"), vertices, faces)
        for name in ("in.off", "in.obj"):
            self.check(0, "-i", name, "-o", "back.ply")
            self.assertEqual(bits(Ply(self.path("back.ply")).points), bits(vertices))
            self.assertEqual(Ply(self.path("back.ply")).triangles, faces)

    def test_obj_with_all_kinds_of_corners(self):
        lines = ["# comment", "v 0 0 0", "v 1 0 0 \\", "", "v 1 1 0", "v 0 1 0", "vt 0 0", "vt 1 0", "vn 0 0 1", "g group",
                 "f 1/1/1 2/2/1 3/2/1", "f -4 -2 -1", "f 1//1 2 4/2", "l 1 2"]
        with open(self.path("in.obj"), "w") as file:
            file.write("\n".join(lines))
        self.check(0, "-i", "in.obj", "-o", "out.ply")
        after = Ply(self.path("out.ply"))
        self.assertEqual(after.points, [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)])
        self.assertEqual(after.triangles, [(0, 1, 2), (0, 2, 3), (0, 1, 3)])

    def test_a_filter_changes_nothing_but_what_it_adds(self):
        vertices, faces = self.make_sphere("in.ply")
        self.check(0, "-i", "in.ply", "-f", PROBE, "-o", "out.ply")
        after = Ply(self.path("out.ply"))
        self.assertEqual(bits(after.points), bits(vertices))
        self.assertEqual(after.triangles, faces + [(0, 2, 1)])

    def test_quads_stay_where_the_format_has_them(self):
        vertices, _ = grid()
        quads = [(a, a + 1, a + 10, a + 9) for a in range(8)]
        write_off(self.path("in.off"), vertices, quads)
        self.check(0, "-i", "in.off", "-o", "out.off", "-o", "out.ply")
        self.assertEqual(len(Ply(self.path("out.ply")).triangles), 16)
        with open(self.path("out.off")) as file:
            indices = [int(word) for line in file.read().split("\n")[83:] for word in line.split()[1:]]
        self.assertLess(max(indices), len(vertices))

    def test_formats_that_round_say_so(self):
        self.make_sphere("in.ply")
        self.assertIn("PLY keeps them", self.check(0, "-i", "in.ply", "-o", "out.wrl").stderr)


class Outputs(RunnerCase):
    def test_link_stays_a_link(self):
        self.make_sphere("in.ply")
        os.mkdir(self.path("there"))
        os.symlink("there/target.ply", self.path("link.ply"))
        for _ in range(2):  # First the target does not exist, then it does.
            self.check(0, "-i", "in.ply", "-f", PROBE, "-o", "link.ply")
            self.assertTrue(os.path.islink(self.path("link.ply")))
            self.assertTrue(Ply(self.path("there/target.ply")).complete)
        self.assert_no_junk()

    def test_over_the_input(self):
        _, faces = self.make_sphere("same.ply")
        self.check(0, "-i", "same.ply", "-f", PROBE, "-o", "same.ply")
        self.assertEqual(len(Ply(self.path("same.ply")).triangles), len(faces) + 1)

    def test_permissions_are_kept(self):
        self.make_sphere("in.ply")
        self.check(0, "-i", "in.ply", "-o", "out.ply")
        os.chmod(self.path("out.ply"), 0o604)
        self.check(0, "-i", "in.ply", "-o", "out.ply")
        self.assertEqual(stat.S_IMODE(os.stat(self.path("out.ply")).st_mode), 0o604)

    def test_no_permission(self):
        if os.geteuid() == 0:
            # Root may write everywhere, so the program runs as somebody else, who has to be able to run it.
            become = {"user": 65534, "group": 65534, "extra_groups": []}
        else:
            become = {}
        self.make_sphere("in.ply")
        os.mkdir(self.path("closed"))
        os.chmod(self.path("closed"), 0o555)
        os.chmod(self.folder, 0o755)
        try:
            subprocess.run([PROGRAM, "--version"], check=True, capture_output=True, **become)
        except (OSError, subprocess.CalledProcessError):
            self.skipTest("an ordinary user cannot run the program here")
        result = self.check(2, "-i", "in.ply", "-o", "closed/out.ply", **become)
        self.assertIn("no permission", result.stderr)
        os.chmod(self.path("in.ply"), 0)
        self.assertIn("no permission", self.check(2, "-i", "in.ply", "-o", "/tmp/never.ply", **become).stderr)

    def test_failed_run_leaves_the_old_output(self):
        self.make_sphere("in.ply")
        with open(self.path("out.ply"), "w") as file:
            file.write("precious")
        self.check(1, "-i", "in.ply", "-f", PROBE, "-p", "Fail=1", "-o", "out.ply")
        with open(self.path("out.ply")) as file:
            self.assertEqual(file.read(), "precious")

    def test_materials_of_obj_have_the_right_name(self):
        self.make_sphere("in.ply")
        self.check(0, "-i", "in.ply", "-f", "Per Face Color Function", "-o", "out.obj")
        names = sorted(os.listdir(self.folder))
        self.assertEqual(names, ["in.ply", "out.obj", "out.obj.mtl"])
        with open(self.path("out.obj")) as file:
            self.assertIn("mtllib ./out.obj.mtl", file.read())

    def test_several_outputs_and_names_with_odd_letters(self):
        self.make_sphere("in \u00e4 %1.ply")
        result = self.check(0, "-i", "in \u00e4 %1.ply", "-o", "out \u00e9 %2.ply", "-o", "b.off", environment={"LC_ALL": "C"})
        self.assertIn("out \u00e9 %2.ply: ", result.stdout)
        self.assertTrue(Ply(self.path("out \u00e9 %2.ply")).complete)
        self.assertTrue(os.path.exists(self.path("b.off")))

    def test_full_disk(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full here")
        self.make_sphere("in.ply")
        self.assertIn("ordinary file", self.check(2, "-i", "in.ply", "-o", self.link_to_full()).stderr)

    def link_to_full(self):
        os.symlink("/dev/full", self.path("full.ply"))
        return self.path("full.ply")


if __name__ == "__main__":
    unittest.main()
