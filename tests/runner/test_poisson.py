"""Close Holes: Poisson-driven, run the way users run it: holes of every kind, guides, and messages."""

import math
import os
import unittest
from collections import Counter

from runner_case import CHECK, ClosingCase, Ply, bits, outer_half_torus, sphere, without, write_ply

FILTER = "Close Holes: Poisson-driven"


def edge_lengths(ply, faces):
    return [math.dist(ply.points[t[k]], ply.points[t[(k + 1) % 3]]) for t in faces for k in range(3)]


def tube(radius, low, high, around=32, steps=6):
    """A tube round the z axis that faces its axis."""
    vertices = [(radius * math.cos(2 * math.pi * j / around), radius * math.sin(2 * math.pi * j / around),
                 low + (high - low) * i / steps) for i in range(steps + 1) for j in range(around)]
    faces = []
    for i in range(steps):
        for j in range(around):
            a, b = i * around + j, i * around + (j + 1) % around
            faces += [(a, a + around, b), (b, a + around, b + around)]
    return vertices, faces


class Case(ClosingCase):
    filter = FILTER

    def setUp(self):
        super().setUp()
        self.fine = sphere(rings=24, segments=32, hole=False)

    def write_fine(self, *leave_out):
        """A sphere without what lies between some heights."""
        self.write("in.ply", self.fine[0], without(*self.fine, leave_out))
        return Ply(self.path("in.ply"))

    def assert_kept(self, before, after):
        self.assertEqual(bits(after.points[:len(before.points)]), bits(before.points))
        self.assertEqual(after.triangles[:len(before.triangles)], before.triangles)

    def assert_closed(self, components=1):
        self.assertIn("Watertight: yes", self.log)
        self.assertIn("Orientation: consistent", self.log)
        self.assertEqual(self.components(), components)


class Holes(Case):
    def test_one_hole(self):
        before = self.write_fine((0.7, 1.1))
        after = self.close()
        self.assert_kept(before, after)
        self.assert_closed()
        self.assertEqual(self.said("Genus"), 0)
        for point in after.points[len(before.points):]:
            self.assertLess(abs(math.hypot(*point) - 1), 0.06, "the patch goes on as the sphere does")

    def test_triangles_like_those_around(self):
        before = self.write_fine((0.5, 1.1))
        after = self.close()
        rim = [v for v in range(len(before.points)) if before.points[v][2] > 0.45]
        rim_edge = edge_lengths(before, [t for t in before.triangles if any(v in rim for v in t)])
        new_edge = edge_lengths(after, after.triangles[len(before.triangles):])
        mean, expected = sum(new_edge) / len(new_edge), sum(rim_edge) / len(rim_edge)
        self.assertTrue(0.6 * expected < mean < 1.5 * expected, (mean, expected))

    def test_three_holes(self):
        def near(face, centre):
            return math.dist([sum(self.fine[0][v][k] for v in face) / 3 for k in range(3)], centre) < 0.45
        centres = ((0, 0, 1), (1, 0, 0), (-0.6, -0.8, 0))
        self.write("in.ply", self.fine[0], [f for f in self.fine[1] if not any(near(f, c) for c in centres)])
        before = Ply(self.path("in.ply"))
        self.assert_kept(before, self.close())
        self.assert_closed()
        report = self.read_report()
        self.assertEqual((report["totals"]["holes"], report["totals"]["closed"]), (3, 3))
        self.assertEqual([len(hole["loops"]) for hole in report["holes"]], [1, 1, 1])

    def test_an_island_in_a_hole(self):
        """The top of a sphere is cut off by a ring without faces."""
        before = self.write_fine((0.6, 0.75))
        self.assert_kept(before, self.close())
        self.assert_closed()
        holes = self.read_report()["holes"]
        self.assertEqual([len(hole["loops"]) for hole in holes], [2])

    def test_a_gap_between_two_parts(self):
        before = self.write_fine((-0.15, 0.15))
        self.assert_kept(before, self.close())
        self.assert_closed()
        self.assertEqual([len(hole["loops"]) for hole in self.read_report()["holes"]], [2])

    def test_one_of_the_two_rims_of_a_gap(self):
        before = self.write_fine((-0.15, 0.15))
        self.check(3, "-i", "in.ply", "-f", "Conditional Vertex Selection", "-p", "condSelect=(z > 0)", "-f", FILTER,
                   "-p", "Selected=true", "-o", "out.ply", "--report", "report.json")
        after = Ply(self.path("out.ply"))
        self.assertEqual((bits(after.points), after.triangles), (bits(before.points), before.triangles))
        reasons = {hole["outcome"]: hole["reason"] for hole in self.read_report()["holes"]}
        self.assertEqual(reasons["skipped"], "not selected")
        self.assertIn("close the holes beside it, too", reasons["failed"])

    def test_parts_of_unlike_density(self):
        coarse = sphere(rings=12, segments=16, hole=False)
        low, high = without(*self.fine, [(-0.2, 1.1)]), without(*coarse, [(-1.1, 0.3)])
        shift = len(self.fine[0])
        self.write("in.ply", self.fine[0] + coarse[0], low + [tuple(v + shift for v in face) for face in high])
        before = Ply(self.path("in.ply"))
        self.assert_kept(before, self.close())
        self.assert_closed()

    def test_nothing_to_do_is_done(self):
        before = self.write_fine()
        after = self.close()
        self.assertEqual((bits(after.points), after.triangles), (bits(before.points), before.triangles))
        self.assertIn("there is nothing to close", self.log)
        self.assertEqual(self.read_report()["holes"], [])

    def test_holes_that_are_not_asked_for_stay_open(self):
        before = self.write_fine((0.95, 1.1), (-1.1, -0.7))
        for parameter in ("KeepLargest=true", "MaxHolePerimeter=5"):
            with self.subTest(parameter):
                self.assert_kept(before, self.close(parameter))
                report = self.read_report()
                self.assertEqual((report["totals"]["closed"], report["totals"]["skipped"]), (1, 1))
                small, large = sorted(report["holes"], key=lambda hole: hole["perimeter"])
                self.assertTrue(small["perimeter"] < 5 < large["perimeter"])
                self.assertEqual((small["outcome"], large["outcome"]), ("closed", "skipped"))
                self.assertIn("Boundary loops: 1 ", self.log)

    def test_the_result_as_a_new_layer(self):
        before = self.write_fine((0.7, 1.1))
        self.check(0, "-i", "in.ply", "-f", FILTER, "-p", "AsNewLayer=true", "-o", "new.ply", "-o", "old.ply", "-l", "0")
        new, old = Ply(self.path("new.ply")), Ply(self.path("old.ply"))
        self.assertEqual((bits(old.points), old.triangles), (bits(before.points), before.triangles))
        self.assert_kept(before, new)
        self.assertGreater(len(new.triangles), len(old.triangles))

    def test_a_slit_stays_open_with_a_reason(self):
        """Faces are cut apart along two edges: the rim's edges lie on each other."""
        vertices, faces = self.fine
        south = faces[0][2] + 31  # a vertex of the second ring and those above and below it, on one meridian
        path = [v for v in (south - 32, south, south + 32)]
        twin = len(vertices)
        around = [f for f in faces if path[1] in f]
        side = {f for f in around if any(v == path[1] + 1 or v == path[1] + 33 or v == path[0] + 1 for v in f)}
        self.assertTrue(0 < len(side) < len(around))
        cut = [tuple(twin if v == path[1] else v for v in f) if f in side else f for f in faces]
        write_ply(self.path("in.ply"), vertices + [vertices[path[1]]], cut)
        before = Ply(self.path("in.ply"))
        after = self.close(code=3)
        self.assertEqual((bits(after.points), after.triangles), (bits(before.points), before.triangles))
        self.assertEqual(len(self.read_report()["holes"]), 1)
        hole = self.read_report()["holes"][0]
        self.assertEqual((hole["outcome"], hole["edges"]), ("failed", 4))
        self.assertIn("edges of this rim lie on each other", hole["reason"])
        self.assertIn("NOT closed: edges of this rim lie on each other", self.log)



class Strips(Case):
    """The user has selected a part of the boundary."""

    def fill_in_part(self, condition, *parameters, code=0):
        """Fills along the vertices for which MeshLab's expression holds."""
        result = self.check(code, "-i", "in.ply", "-f", "Conditional Vertex Selection", "-p", "condSelect=" + condition,
                            "-f", FILTER, "-p", "PartialFill=true", *parameters, "-f", CHECK, "-o", "out.ply",
                            "--report", "report.json")
        self.log = result.stdout
        self.assertIn("Self-intersecting pairs of faces: 0", self.log)
        self.assertIn("Orientation: consistent", self.log)
        return Ply(self.path("out.ply"))

    def test_along_one_part_of_a_rim(self):
        before = self.write_fine((0.5, 1.1))
        after = self.fill_in_part("(x > 0.2)")
        self.assert_kept(before, after)
        (hole,) = self.read_report()["holes"]
        self.assertEqual(hole["outcome"], "partial")
        self.assertRegex(hole["reason"], r"as asked, along \d+ of 32 edges")
        self.assertGreater(hole["faces_added"], 5)
        self.assertTrue(all(p[0] > 0 for p in after.points[len(before.points):]), "the other half is open still")
        self.assertIn("Boundary loops: 1 ", self.log)

    def test_a_strip_across_a_gap_and_then_the_rest(self):
        before = self.write_fine((-0.2, 0.2))
        strip = self.fill_in_part("(y > 0.75) && (abs(z) < 0.4)")
        self.assert_kept(before, strip)
        (hole,) = self.read_report()["holes"]
        self.assertEqual((hole["outcome"], len(hole["loops"])), ("partial", 2))
        self.assertEqual(self.components(), 1)
        self.assertIn("Boundary loops: 1 ", self.log)
        os.replace(self.path("out.ply"), self.path("in.ply"))
        self.assert_kept(strip, self.close())
        self.assert_closed()

    def test_other_holes_stay_open(self):
        before = self.write_fine((0.5, 1.1), (-1.1, -0.8))
        after = self.fill_in_part("(x > 0.2) && (z > 0)")
        self.assertTrue(all(p[2] > 0 for p in after.points[len(before.points):]))
        self.assertEqual(sorted(hole["outcome"] for hole in self.read_report()["holes"]), ["partial", "skipped"])

    def test_a_rim_selected_whole_is_closed_whole(self):
        self.write_fine((0.5, 1.1), (-1.1, -0.8))
        self.fill_in_part("(z > 0)")
        self.assertEqual(sorted(hole["outcome"] for hole in self.read_report()["holes"]), ["closed", "skipped"])
        self.assertIn("Boundary loops: 1 ", self.log)

    def test_messages(self):
        self.write_fine((0.5, 1.1))
        self.assertIn("no edge of the boundary is selected", self.refused(1, "PartialFill=true"))
        self.assertIn("Use one of them at a time", self.refused(1, "PartialFill=true", "RemoveRings=1"))


class Results(Case):
    def test_the_report(self):
        before = self.write_fine((0.6, 0.75))
        sides = Counter(frozenset((t[k], t[(k + 1) % 3])) for t in before.triangles for k in range(3))
        rim_edges = sum(count == 1 for count in sides.values())
        after = self.close()
        report = self.read_report()
        self.assertEqual(report["exit_code"], 0)
        (hole,) = report["holes"]
        self.assertEqual((hole["outcome"], hole["reason"], hole["filter"]), ("closed", "", FILTER))
        self.assertTrue(hole["route"].startswith("normal variation"), hole["route"])
        self.assertEqual(hole["faces_added"], len(after.triangles) - len(before.triangles))
        self.assertEqual(hole["vertices_added"], len(after.points) - len(before.points))
        self.assertEqual(hole["edges"], rim_edges)
        figures = report["filters"][0]["figures"]
        for name in ("samples", "octree cubes", "octree depth", "initial points", "Delaunay vertices", "Delaunay cells"):
            self.assertGreater(figures[name], 0, name)
        self.assertIn("gaps closed at rims", figures)
        self.assertIn("Figures: samples ", self.log)
        stages = [stage["stage"] for stage in report["stages"] if stage["filter"] == FILTER]
        for stage in ("finding the holes", "building the oracle", "choosing the first points", "refining the surface",
                      "tailoring the patches", "joining the patches"):
            self.assertIn(stage, stages)

    def test_scales_and_places(self):
        for name, options in (("large", {"scale": 1e9}), ("small", {"scale": 1e-9}), ("far", {"origin": (1000, 2000, 3000)})):
            with self.subTest(name):
                self.make_sphere("in.ply", **options)
                self.close()
                self.assert_closed()

    def test_number_of_threads_and_runs_do_not_matter(self):
        self.write_fine((0.6, 0.75))
        self.assert_threads_do_not_matter()

    def test_every_choice(self):
        before = self.write_fine((0.6, 0.75))
        for parameter in ("MinDepth=1", "MinDepth=6", "MaxDepth=5", "MaxDepth=16", "Scale=1.1", "Scale=10", "Boundary=Free",
                          "Screening=1", "Screening=1000", "Samples=1", "Samples=20", "Interpolation=Tetrahedral", "Rings=1",
                          "Rings=100", "CushionRadius=0.05", "CushionRadius=5%", "EdgeLength=4%", "EdgeLength=0.3"):
            with self.subTest(parameter):
                self.assert_kept(before, self.close(parameter))
                self.assert_closed()

    def test_every_fairing(self):
        before = self.write_fine((0.6, 0.75))
        for choice, route in (("None", "remeshed"), ("Thin plate", "thin plate"), ("Membrane", "membrane"),
                              ("Normal variation", "normal variation")):
            with self.subTest(choice):
                self.assert_kept(before, self.close("Fairing=" + choice))
                self.assert_closed()
                self.assertTrue(self.read_report()["holes"][0]["route"].startswith(route))

    def test_an_edge_length_is_kept_to(self):
        before = self.write_fine((0.6, 1.1))
        counts = [len(self.close(f"EdgeLength={length}").triangles) - len(before.triangles) for length in (0.2, 0.1, 0.05)]
        for coarse, fine in zip(counts, counts[1:]):
            self.assertGreater(fine, 2 * coarse)


class RemovedRings(Case):
    def test_in_a_new_layer_that_is_named(self):
        before = self.write_fine((0.7, 1.1))
        counts = []
        for rings in (1, 2):
            self.check(0, "-i", "in.ply", "-f", FILTER, "-p", f"RemoveRings={rings}", "-f", CHECK, "-o", "new.ply",
                       "-o", "old.ply", "-l", "0", "--report", "report.json")
            new, old = Ply(self.path("new.ply")), Ply(self.path("old.ply"))
            self.assertEqual((bits(old.points), old.triangles), (bits(before.points), before.triangles))
            (steps, _) = self.read_report()["filters"]
            removed = steps["removed_faces"]
            kept = [face for number, face in enumerate(before.triangles) if number not in removed]
            self.assertEqual(new.triangles[:len(kept)], kept)
            self.assertEqual(bits(new.points[:len(before.points)]), bits(before.points))
            self.assertTrue(any(f"lacks {len(removed)} faces of the input" in line for line in steps["log"]), steps["log"])
            counts.append(len(removed))
        self.assertTrue(0 < counts[0] < counts[1] < len(before.triangles) / 2, counts)

    def test_a_spike_at_the_rim_goes(self):
        before = self.write_fine((0.7, 1.1))
        points = list(before.points)
        spike = max(range(len(points)), key=lambda v: points[v][2])
        points[spike] = tuple(4 * x for x in points[spike])
        write_ply(self.path("in.ply"), points, before.triangles)
        after = self.close("RemoveRings=1")
        self.assert_closed()
        used = {v for face in after.triangles for v in face}
        self.assertNotIn(spike, used)

    def test_by_default_nothing_is_removed(self):
        before = self.write_fine((0.7, 1.1))
        self.assert_kept(before, self.close())
        self.assertEqual(self.read_report()["filters"][0]["removed_faces"], [])


class Guides(Case):
    """The outer half of a torus is closed by two disks; with a tube through its middle it becomes a ring."""

    def setUp(self):
        super().setUp()
        write_ply(self.path("in.ply"), *outer_half_torus())
        self.tube = tube(0.4, -0.3, 0.3)
        write_ply(self.path("tube.ply"), *self.tube)

    def genus(self, *parameters, inputs=("tube.ply", "in.ply")):
        after = self.close(*parameters, inputs=inputs)
        self.assert_closed()
        self.assert_kept(Ply(self.path("in.ply")), after)
        return self.said("Genus")

    def test_without(self):
        self.assertEqual(self.genus(), 0)
        self.assertEqual(len(self.read_report()["holes"]), 2)

    def test_a_surface(self):
        for layer in ("tube.ply", "0"):
            self.assertEqual(self.genus("GuideLayer=" + layer), 1)
        self.assertEqual([len(hole["loops"]) for hole in self.read_report()["holes"]], [2])

    def test_its_faces_are_not_added(self):
        self.assertEqual(self.genus("GuideLayer=tube.ply"), 1)
        added = set(Ply(self.path("out.ply")).points) - set(Ply(self.path("in.ply")).points)
        self.assertFalse(added & set(Ply(self.path("tube.ply")).points))

    def test_all_visible_layers(self):
        self.assertEqual(self.genus("GuideVisible=true"), 1)
        self.assertIn('Guide: the layer "tube.ply"', self.log)

    def test_points_with_normals(self):
        vertices, _ = tube(0.4, -0.3, 0.3, steps=20)
        write_ply(self.path("points.ply"), vertices, [], normals=[(-x, -y, 0) for x, y, _ in vertices])
        self.assertEqual(self.genus("GuideLayer=points.ply", inputs=("points.ply", "in.ply")), 1)

    def test_messages(self):
        write_ply(self.path("bare.ply"), self.tube[0], [], normals=[(0.0, 0.0, 0.0)] * len(self.tube[0]))
        inputs = ("bare.ply", "in.ply")
        for parameter in ("GuideLayer=bare.ply", "GuideVisible=true"):
            message = self.refused(1, parameter, inputs=inputs)
            self.assertIn('The layer "bare.ply" is a point set with points that have no normals', message)
            self.assertIn("Compute normals for point sets", message)
        message = self.refused(1, "GuideLayer=in.ply", inputs=inputs)
        self.assertIn('names "in.ply", the layer that the filter works on', message)
        message = self.refused(1, "GuideVisible=true")
        self.assertIn('"GuideVisible" is on, but there is no other visible layer', message)
        self.assertIn("there are 2 layers", self.refused(2, "GuideLayer=nowhere.ply", inputs=inputs))


class Messages(Case):
    def test_values_out_of_range(self):
        self.write_fine((0.7, 1.1))
        for parameter, code, message in (
                ("MinDepth=0", 2, "whole number, 1 to 8"), ("MinDepth=9", 2, "whole number, 1 to 8"),
                ("MaxDepth=-1", 2, "whole number, 0 to 16"), ("MaxDepth=17", 2, "whole number, 0 to 16"),
                ("MaxDepth=4", 1, "MaxDepth must lie between MinDepth and 16, or be 0"),
                ("Scale=0", 2, "greater than 0"), ("Scale=1", 1, "Scale must lie above 1 and be at most 10"),
                ("Scale=10.5", 1, "Scale must lie above 1 and be at most 10"), ("Scale=nan", 2, '"Scale"'),
                ("Screening=0", 2, "greater than 0"), ("Screening=-1", 2, "greater than 0"), ("Samples=0", 2, "greater than 0"),
                ("RemoveRings=-1", 2, "0 to 100"), ("RemoveRings=101", 2, "0 to 100"), ("Rings=0", 2, "1 to 100"), ("Rings=101", 2, "1 to 100"), ("EdgeLength=-1", 2, "at least 0"),
                ("CushionRadius=-1", 2, "at least 0"), ("Boundary=2", 2, "0 = Solid, 1 = Free"),
                ("Interpolation=2", 2, "0 = Trilinear, 1 = Tetrahedral"), ("Fairing=5", 2, "4 = Normal variation"),
                ("MaxHoleEdges=2", 1, "at least 3"), ("Selected=true", 1, "nothing is selected")):
            with self.subTest(parameter):
                self.assertIn(message, self.refused(code, parameter))

    def test_a_cloud_of_points(self):
        write_ply(self.path("in.ply"), self.fine[0], [])
        self.assertIn("has no faces, it is a cloud of 738 points", self.refused(1, "Rings=3"))

    def test_describes_every_parameter(self):
        text = self.check(0, "--describe", FILTER).stdout
        for name in ("Selected", "MaxHoleEdges", "MaxHolePerimeter", "KeepLargest", "NewFaceSelected", "AsNewLayer", "GuideLayer",
                     "GuideVisible", "MinDepth", "MaxDepth", "Scale", "Boundary", "Screening", "Samples", "Interpolation",
                     "PartialFill", "RemoveRings", "EdgeLength", "Rings", "CushionRadius", "Fairing"):
            self.assertIn(f"\n  {name}\n", text)
        self.assertIn("Marco Centin", text)


class Reconstruction(Case):
    """Surface Reconstruction: Poisson Delaunay, the other filter of the plugin."""
    filter = "Surface Reconstruction: Poisson Delaunay"

    def test_a_mesh_with_a_hole(self):
        self.write_fine((0.7, 1.1))
        flat = len(self.close("MaxDepth=7", "Distance=0.02", "Scale=3").triangles)
        self.assert_closed()
        self.assertEqual(self.said("Genus"), 0)
        after = self.close("MaxDepth=7", "Distance=0.002", "Scale=3")
        self.assert_closed()
        self.assertGreater(len(after.triangles), 2 * flat, "shorter edges are nearer to the surface")
        for point in after.points:
            self.assertLess(abs(math.hypot(*point) - 1), 0.15, "a flat lid would be 0.3 away")

    def test_edges_of_one_length(self):
        self.write_fine()
        after = self.close("MaxDepth=6", "Adaptive=false", "EdgeLength=0.15")
        self.assert_closed()
        lengths = edge_lengths(after, after.triangles)
        self.assertAlmostEqual(sum(lengths) / len(lengths), 0.15, delta=0.03)

    def test_all_visible_layers(self):
        self.write("low.ply", self.fine[0], without(*self.fine, ((-0.1, 1.1),)))
        self.write("high.ply", self.fine[0], without(*self.fine, ((-1.1, 0.1),)))
        self.close("MaxDepth=6", "VisibleLayers=true", inputs=("low.ply", "high.ply"))
        self.assert_closed()
        self.assertEqual(self.said("Genus"), 0)

    def test_bad_input(self):
        write_ply(self.path("in.ply"), self.fine[0], [])
        self.assertIn("points that have no normals", self.refused(1, "MaxDepth=6"))
        self.write_fine()
        for parameter, code, message in (("Angle=31", 2, "0 to 30"), ("MaxDepth=3", 1, "MaxDepth must lie between MinDepth"),
                                         ("Scale=1", 1, "Scale must lie above 1"), ("EdgeLength=-1", 2, "EdgeLength"),
                                         ("Share=11", 1, "Share must lie above 0")):
            with self.subTest(parameter):
                self.assertIn(message, self.refused(code, parameter))


class Cancelling(Case):
    def test_ctrl_c_ends_it_soon_and_leaves_nothing(self):
        self.write_fine((-0.5, 0.5))
        self.assert_cancels("EdgeLength=0.003", delays=(0.5, 2))


if __name__ == "__main__":
    unittest.main()
