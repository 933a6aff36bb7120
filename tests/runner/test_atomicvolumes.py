"""Close Holes: Atomic Volumes, run the way users run it: gaps and islands, what other layers say, and messages."""

import math
import unittest

from runner_case import CHECK, ClosingCase, Ply, bits, outer_half_torus, sphere, without, write_ply

FILTER = "Close Holes: Atomic Volumes"


def volume(ply):
    """Of the solid that the triangles bound."""
    total = 0.0
    for face in ply.triangles:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (ply.points[v] for v in face)
        total += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return total / 6


def write_scan(path, camera, points):
    """A layer of points with a camera, as MeshLab stores them in PLY."""
    values = {"view_px": camera[0], "view_py": camera[1], "view_pz": camera[2],
              "x_axisx": 1, "x_axisy": 0, "x_axisz": 0, "y_axisx": 0, "y_axisy": 1, "y_axisz": 0,
              "z_axisx": 0, "z_axisy": 0, "z_axisz": 1, "focal": 1, "scalex": 0.1, "scaley": 0.1,
              "centerx": 0, "centery": 0}
    header = ["ply", "format ascii 1.0", "element camera 1", *(f"property float {name}" for name in values),
              "property int viewportx", "property int viewporty", *(f"property float k{i}" for i in range(1, 5)),
              f"element vertex {len(points)}", *(f"property float {axis}" for axis in "xyz"), "end_header",
              " ".join(map(str, values.values())) + " 640 480 0 0 0 0"]
    with open(path, "w") as file:
        file.write("\n".join(header + [" ".join(map(str, point)) for point in points]) + "\n")


class Case(ClosingCase):
    filter = FILTER


class Holes(Case):
    def test_closes_a_hole_and_keeps_the_mesh(self):
        vertices, faces = self.make_sphere("in.ply")
        after = self.close()
        self.assertIn("Watertight: yes", self.log)
        self.assertEqual(bits(after.points[:len(vertices)]), bits(vertices))
        self.assertEqual(after.triangles[:len(faces)], faces)
        report = self.read_report()
        self.assertEqual((report["totals"]["holes"], report["totals"]["closed"]), (1, 1))
        figures = report["filters"][0]["figures"]
        for name in ("nodes", "leaves", "depth", "smallest leaf", "cut weight"):
            self.assertGreater(figures[name], 0, name)
        self.assertIn("Figures: leaves ", self.log)

    def test_an_island_in_a_hole(self):
        """The top of a sphere is cut off by a ring without faces: a hole with an island."""
        vertices, faces = sphere(rings=24, segments=32, hole=False)
        self.write("in.ply", vertices, without(vertices, faces, [(0.6, 0.75)]))
        self.close()
        self.assertIn("Watertight: yes", self.log)
        self.assertEqual(self.components(), 1)
        self.assertEqual(len(self.read_report()["holes"]), 1)
        self.assertEqual(len(self.read_report()["holes"][0]["loops"]), 2)

    def test_the_weight_decides_whether_a_wide_gap_is_bridged(self):
        """A sphere without a wide band: two disks have less area than the band, a reconstruction is the whole sphere."""
        vertices, faces = sphere(rings=24, segments=32, hole=False)
        self.write("in.ply", vertices, without(vertices, faces, [(-0.6, 0.6)]))
        for weight, components in (("Area", 2), ("Poisson", 1)):
            with self.subTest(weight):
                self.close("Weight=" + weight)
                self.assertIn("Watertight: yes", self.log)
                self.assertEqual(self.components(), components)
                stages = [stage["stage"] for stage in self.read_report()["stages"]]
                self.assertEqual("building the oracle" in stages, weight == "Poisson")

    def test_only_some_holes(self):
        vertices, faces = sphere(rings=24, segments=32, hole=False)
        self.write("in.ply", vertices, without(vertices, faces, [(0.9, 1.1), (-1.1, -0.7)]))
        self.close("KeepLargest=true")
        report = self.read_report()
        self.assertEqual((report["totals"]["closed"], report["totals"]["skipped"]), (1, 1))
        self.assertIn("Boundary loops: 1 ", self.log)

    def test_nothing_to_do_is_done(self):
        vertices, faces = self.make_sphere("in.ply", hole=False)
        self.assertEqual(self.close().triangles, faces)
        self.assertEqual(self.read_report()["holes"], [])

    def test_scales_and_places(self):
        for name, options in (("large", {"scale": 1e9}), ("small", {"scale": 1e-9}), ("far", {"origin": (1000, 2000, 3000)})):
            with self.subTest(name):
                self.make_sphere("in.ply", **options)
                self.close()
                self.assertIn("Watertight: yes", self.log)

    def test_number_of_threads_and_runs_do_not_matter(self):
        self.make_sphere("in.ply")
        self.assert_threads_do_not_matter()

    def test_every_choice(self):
        self.make_sphere("in.ply")
        for parameters in (["Weight=Number"], ["Weight=Poisson"], ["Weight=3", "Smoothing=Two"], ["Smoothing=None"],
                           ["Smoothing=Two"], ["MovingCentres=true"], ["Remesh=false"],
                           ["Fairing=Membrane"], ["Fairing=Normal"], ["Fairing=None", "Smoothing=None", "Remesh=false"],
                           ["Shifts=1", "Seed=7"], ["SmoothingIterations=0"], ["MaxDepth=12"]):
            with self.subTest(parameters):
                self.close(*parameters)
                self.assertIn("Watertight: yes", self.log)

    def test_an_edge_length_is_kept_to(self):
        vertices, faces = sphere(rings=24, segments=32, hole=False)
        self.write("in.ply", vertices, without(vertices, faces, [(0.7, 1.1)]))
        counts = [len(self.close(f"EdgeLength={length}").triangles) for length in (0.4, 0.05)]
        self.assertGreater(counts[1], 1.3 * counts[0])


class DepthLimit(Case):
    """One rim edge is so short that cubes at the limit hold both of its ends."""

    def setUp(self):
        super().setUp()
        vertices, faces = sphere(rings=24, segments=32, hole=False)
        self.write("in.ply", vertices, without(vertices, faces, [(0.7, 1.1)]))
        before = Ply(self.path("in.ply"))
        rim = max(range(len(before.points)), key=lambda v: before.points[v][2])
        near = max((v for v in range(len(before.points)) if v != rim),
                   key=lambda v: (before.points[v][2] > before.points[rim][2] - 1e-3,
                                  -math.dist(before.points[v], before.points[rim])))
        points = list(before.points)
        points[near] = tuple(a + 1e-4 * (b - a) for a, b in zip(points[rim], points[near]))
        write_ply(self.path("in.ply"), points, before.triangles)
        self.before = Ply(self.path("in.ply"))

    def test_the_faces_there_are_removed_in_a_new_layer(self):
        self.check(0, "-i", "in.ply", "-f", FILTER, "-p", "MaxDepth=8", "DepthLimit=Remove", "-f", CHECK, "-o", "out.ply",
                   "--report", "report.json")
        after = Ply(self.path("out.ply"))
        removed = self.read_report()["filters"][0]["removed_faces"]
        self.assertTrue(0 < len(removed) < 40, removed)
        kept = [face for number, face in enumerate(self.before.triangles) if number not in removed]
        self.assertEqual(after.triangles[:len(kept)], kept)
        self.assertEqual(bits(after.points[:len(self.before.points)]), bits(self.before.points))

    def test_the_log_lists_them(self):
        self.close("MaxDepth=8", "DepthLimit=Remove")
        self.assertIn("Watertight: yes", self.log)
        removed = self.read_report()["filters"][0]["removed_faces"]
        self.assertIn(f"lacks {len(removed)} faces of the input, counted from 0: " + ", ".join(map(str, removed)), self.log)

    def test_by_default_nothing_is_removed(self):
        after = self.close("MaxDepth=8")
        self.assertIn("Watertight: yes", self.log)
        self.assertEqual(after.triangles[:len(self.before.triangles)], self.before.triangles)
        self.assertEqual(self.read_report()["filters"][0]["removed_faces"], [])

    def test_messages(self):
        self.assertIn("set MaxDepth", self.refused(1, "DepthLimit=Remove"))
        self.assertIn("MaxDepth is too small", self.refused(1, "DepthLimit=Remove", "MaxDepth=3"))


class OtherLayers(Case):
    """The paper's second figure: the outer half of a torus becomes a disk-like solid, or with points a torus."""

    def setUp(self):
        super().setUp()
        write_ply(self.path("in.ply"), *outer_half_torus())
        write_ply(self.path("axis.ply"), [(0.01, 0.02, 0.2 * i) for i in range(-2, 3)], [])
        write_ply(self.path("middle.ply"), [(0.01, 0.02, 0.0)], [])
        self.inputs = ("axis.ply", "middle.ply", "in.ply")

    def genus(self, *parameters, inputs=None):
        self.close(*parameters, inputs=inputs or self.inputs)
        self.assertIn("Watertight: yes", self.log)
        self.assertEqual(self.components(), 1)
        return self.said("Genus")

    def test_outside_points(self):
        self.assertEqual(self.genus(), 0)
        for layer in ("axis.ply", "0"):
            self.assertEqual(self.genus("OutsideLayer=" + layer), 1)

    def test_inside_points(self):
        """Two caps of a sphere, too far apart to be joined for nothing."""
        vertices, faces = sphere(rings=24, segments=32, hole=False)
        self.write("in.ply", vertices, without(vertices, faces, [(-0.55, 0.55)]))
        self.close(inputs=self.inputs)
        self.assertEqual(self.components(), 2)
        self.close("InsideLayer=middle.ply", inputs=self.inputs)
        self.assertIn("Watertight: yes", self.log)
        self.assertEqual(self.components(), 1)

    def test_hints_have_a_price(self):
        self.assertEqual(self.genus("HintOutsideLayer=axis.ply", "HintPrice=1e-6"), 0)
        self.assertEqual(self.genus("HintOutsideLayer=axis.ply", "HintPrice=1"), 1)

    def test_what_a_camera_has_seen_through_is_outside(self):
        write_scan(self.path("scan.ply"), (0.01, 0.02, 5.0), [(0.01, 0.02, -5.0)])
        self.assertEqual(self.genus("CarveLayers=true", inputs=("scan.ply", "in.ply")), 1)
        self.assertIn('Carved with the view of the layer "scan.ply"', self.log)

    def test_contradictions_are_reported(self):
        write_ply(self.path("same.ply"), [(0.01, 0.02, 0.0)], [])
        self.close("InsideLayer=middle.ply", "OutsideLayer=same.ply", inputs=("same.ply", *self.inputs))
        self.assertIn("given as inside and as outside", self.log)

    def test_messages(self):
        self.assertIn("is chosen twice", self.refused(1, "InsideLayer=middle.ply", "OutsideLayer=1", inputs=self.inputs))
        self.assertIn("the layer that the filter works on", self.refused(1, "InsideLayer=in.ply", inputs=self.inputs))
        self.assertIn("no other visible layer has a camera", self.refused(1, "CarveLayers=true", inputs=self.inputs))
        self.assertIn("there are 3 layers", self.refused(2, "InsideLayer=nowhere.ply", inputs=self.inputs))


class Symmetries(Case):
    """A sphere without its northern cap: a flat lid is the least area, and its southern cap the image of the missing one."""

    def setUp(self):
        super().setUp()
        vertices, faces = sphere(rings=24, segments=32, hole=False)
        self.write("in.ply", vertices, without(vertices, faces, [(0.5, 1.1)]))
        self.plain = ["Remesh=false", "Fairing=None", "Smoothing=None"]

    def test_a_given_reflection_brings_the_cap_back(self):
        flat = volume(self.close(*self.plain))
        full = volume(self.close(*self.plain, "Symmetry=Given reflection plane", "SymmetryPoint=0 0 0",
                                 "SymmetryDirection=0 0 1", "SymmetryPrice=10"))
        self.assertIn("Symmetry: reflection", self.log)
        self.assertGreater(full, flat + 0.5 * math.pi * 0.25 * (3 - 0.5) / 3)

    def test_a_detected_symmetry_is_named(self):
        self.close("Symmetry=Detect reflection")
        self.assertIn("Symmetry: reflection in the plane", self.log)
        self.assertIn("Watertight: yes", self.log)

    def test_none_found_is_a_note(self):
        self.close("Symmetry=Detect translation")
        self.assertIn("Symmetry: the mesh has none of this kind", self.log)

    def test_messages(self):
        for choice in ("Given reflection plane", "Given rotation", "Given translation"):
            text = self.refused(1, f"Symmetry={choice}", "SymmetryDirection=0 0 0")
            self.assertRegex(text, "(?i)length|zero|direction|normal|axis")
        self.assertIn("2 to 1000", self.refused(2, "SymmetryFold=1"))


class Cancelling(Case):
    def test_ctrl_c_ends_it_soon_and_leaves_nothing(self):
        vertices, faces = sphere(rings=120, segments=160, hole=False)
        self.write("in.ply", vertices, without(vertices, faces, [(-0.3, 0.3)]))
        self.assert_cancels("Shifts=100", delays=(0.5, 1.5))


class Messages(Case):
    def test_values_out_of_range(self):
        self.make_sphere("in.ply")
        for parameter, code, message in (("MaxDepth=2", 1, "must be 0, for any depth, or at least 3"),
                                         ("MaxDepth=31", 2, "out of range"), ("NodeBudget=999", 2, "out of range"),
                                         ("HintPrice=0", 2, "greater than 0"), ("SymmetryPrice=-1", 2, "greater than 0"),
                                         ("Shifts=0", 2, "out of range"), ("SmoothingIterations=1001", 2, "out of range"),
                                         ("Weight=4", 2, "3 = Poisson"), ("Weight=-1", 2, "0 = Balanced"),
                                         ("SymmetryPoint=1 2", 2, "has 2 numbers, not 3")):
            with self.subTest(parameter):
                self.assertIn(message, self.refused(code, parameter))

    def test_a_budget_that_does_not_suffice(self):
        vertices, faces = sphere(rings=48, segments=64, hole=False)
        self.write("in.ply", vertices, without(vertices, faces, [(-0.5, 0.5)]))
        self.assertIn("NodeBudget", self.refused(1, "NodeBudget=1000"))

    def test_describes_every_parameter(self):
        text = self.check(0, "--describe", FILTER).stdout
        for name in ("Selected", "AsNewLayer", "MaxDepth", "DepthLimit", "InsideLayer", "SymmetryDirection", "Fairing", "EdgeLength"):
            self.assertIn(f"\n  {name}\n", text)
        self.assertIn("Joshua Podolak", text)


if __name__ == "__main__":
    unittest.main()
