"""Close Holes: Triangle Fan, run the way users run it: what stays open and why, and the mode as published."""

import unittest

from runner_case import CHECK, ClosingCase, Ply, bits, sphere, write_ply

FILTER = "Close Holes: Triangle Fan"


def letter_u():
    """A flat sheet with a hole in the form of a U: the mean of its rim lies outside of it."""
    vertices = [(float(x), float(y), 0.0) for y in range(12) for x in range(12)]
    hole = {(x, 2) for x in range(2, 9)} | {(x, y) for x in (2, 8) for y in range(2, 9)}
    faces = []
    for y in range(11):
        for x in range(11):
            if (x, y) not in hole:
                a = 12 * y + x
                faces += [(a, a + 1, a + 13), (a, a + 13, a + 12)]
    return vertices, faces


class Case(ClosingCase):
    filter = FILTER

    def new_layer(self, *parameters, code=0):
        """Runs the mode as published; returns the old layer, the new one, and what the report says of the filter."""
        options = ["AsPublished=true", *parameters]
        result = self.check(code, "-i", "in.ply", "-f", FILTER, "-p", *options, "-f", CHECK, "-o", "new.ply", "-o", "old.ply",
                            "-l", "0", "--report", "report.json")
        self.log = result.stdout
        return Ply(self.path("old.ply")), Ply(self.path("new.ply")), self.read_report()["filters"][0]

    def assert_closed_manifold(self):
        self.assertIn("Watertight: yes", self.log)
        self.assertEqual((self.said("Boundary edges"), self.said("Non-manifold edges"), self.said("Non-manifold vertices")),
                         (0, 0, 0), self.log)


class ByDefault(Case):
    def test_closes_a_hole_and_keeps_the_mesh(self):
        vertices, faces = self.make_sphere("in.ply")
        after = self.close()
        self.assertIn("Watertight: yes", self.log)
        self.assertEqual(bits(after.points[:len(vertices)]), bits(vertices))
        self.assertEqual(after.triangles[:len(faces)], faces)
        self.assertEqual(len(after.points), len(vertices) + 1)
        (hole,) = self.read_report()["holes"]
        self.assertEqual((hole["outcome"], hole["route"], hole["reason"]), ("closed", "fan", ""))
        self.assertEqual((hole["vertices_added"], hole["faces_added"]), (1, hole["edges"]))
        self.assertEqual(len(after.triangles), len(faces) + hole["edges"])
        apex, rim = after.points[-1], {v for face in after.triangles[len(faces):] for v in face} - {len(vertices)}
        for k in range(3):
            self.assertAlmostEqual(apex[k], sum(vertices[v][k] for v in rim) / len(rim), places=6)

    def test_a_hole_whose_fan_would_intersect_stays_open(self):
        vertices, faces = letter_u()
        write_ply(self.path("in.ply"), vertices, faces)
        after = self.close(code=3)
        self.assertEqual((after.points, after.triangles), (Ply(self.path("in.ply")).points, faces))
        outcomes = {hole["outcome"]: hole["reason"] for hole in self.read_report()["holes"]}
        self.assertEqual(outcomes["failed"], "the patch intersects itself")
        self.assertIn("open, nearly flat sheet", outcomes["skipped"])

    def test_colours_and_quality_go_on(self):
        vertices, faces = sphere()
        colours = [(200, 40, 10, 255) if x > 0 else (10, 10, 10, 255) for x, _, _ in vertices]
        write_ply(self.path("in.ply"), vertices, faces, colours, quality=[x for x, _, _ in vertices])
        for parameters in ((), ("AsPublished=true",)):
            after = self.close(*parameters)
            apex = after.elements["vertex"][len(vertices)]
            self.assertEqual((apex["red"], apex["green"], apex["blue"]), (200, 40, 10))
            self.assertGreater(apex["quality"], 0.5)

    def test_pieces_say_nothing_without_as_published(self):
        self.make_sphere("in.ply")
        self.assertIn('"AsPublished"', self.refused(1, "Spanning=1"))

    def test_threads_do_not_matter(self):
        vertices, faces = [], []
        for i in range(20):
            part = sphere(rings=10 + i % 5, origin=(3.0 * i, 0, 0))
            faces += [tuple(v + len(vertices) for v in face) for face in part[1]]
            vertices += part[0]
        write_ply(self.path("in.ply"), vertices, faces)
        self.assert_threads_do_not_matter()


class AsPublished(Case):
    def test_a_face_that_spans_the_hole_goes(self):
        vertices, faces = sphere()
        used = {edge for face in faces for edge in zip(face, face[1:] + face[:1])}
        rim = sorted({a for a, b in used if (b, a) not in used})
        spanning = (rim[0], rim[3], rim[6])
        faces.insert(10, spanning)
        write_ply(self.path("in.ply"), vertices, faces)
        old, new, report = self.new_layer()
        self.assertEqual((bits(old.points), old.triangles), (bits(vertices), faces))
        self.assertEqual(report["removed_faces"], [10])
        self.assertEqual(new.triangles[:len(faces) - 1], faces[:10] + faces[11:])
        self.assert_closed_manifold()
        self.assertIn("The new layer lacks 1 face of the input, counted from 0: 10", self.log)

    def test_vertices_that_overlap_are_split(self):
        vertices, faces = sphere(hole=False)
        colours = [(i % 256, 2 * i % 256, 3 * i % 256, 255) for i in range(len(vertices))]
        low = len(vertices) - 1
        faces = [tuple(0 if v == low else v for v in face) for face in faces]
        write_ply(self.path("in.ply"), vertices, faces, colours, quality=[float(i) for i in range(len(vertices))])
        old, new, report = self.new_layer()
        self.assertEqual(old.triangles, faces)
        self.assertEqual((report["removed_faces"], report["split_vertices"]), ([], [0]))
        self.assertEqual(len(new.points), len(vertices) + 1)
        copy, original = dict(new.elements["vertex"][-1]), dict(old.elements["vertex"][0])
        self.assertEqual(copy, original)
        self.assert_closed_manifold()
        self.assertIn("The new layer has 1 copy of vertices of the input, counted from 0: 0", self.log)

    def test_all_pieces_but_the_largest_go_with_their_vertices(self):
        vertices, faces = sphere(rings=8)
        more = sphere(origin=(5.0, 0.0, 0.0))
        shift = len(vertices)
        write_ply(self.path("in.ply"), vertices + more[0], faces + [tuple(v + shift for v in face) for face in more[1]])
        old, new, report = self.new_layer()
        self.assertEqual(len(old.points), shift + len(more[0]))
        self.assertEqual(report["removed_faces"], list(range(len(faces))))
        self.assertEqual(bits(new.points[:len(more[0])]), bits(more[0]))
        self.assertEqual(new.triangles[:len(more[1])], more[1])
        self.assertEqual(len(new.points), len(more[0]) + 1)
        self.assert_closed_manifold()
        _, new, report = self.new_layer("Spanning=1")
        self.assertEqual((report["removed_faces"], self.components()), ([], 2))
        self.assert_closed_manifold()

    def test_sheets_are_closed_too(self):
        write_ply(self.path("in.ply"), *letter_u())
        _, new, report = self.new_layer()
        self.assert_closed_manifold()
        self.assertGreater(self.said("Self-intersecting pairs of faces"), 0)
        self.assertEqual(report["figures"]["self-intersecting pairs"], self.said("Self-intersecting pairs of faces"))
        self.assertTrue(any("intersect: this mode does not avoid that" in note for note in report["notes"]), report["notes"])

    def test_nothing_to_change_makes_no_layer(self):
        vertices, faces = self.make_sphere("in.ply", hole=False)
        after = self.close("AsPublished=true")
        self.assertEqual((bits(after.points), after.triangles), (bits(vertices), faces))
        self.assertIn("The mesh has no holes: there is nothing to close.", self.log)


if __name__ == "__main__":
    unittest.main()
