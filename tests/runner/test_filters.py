"""The suite's own filters, run the way users run them. Real meshes only when a folder with some is given."""

import glob
import os
import unittest

from runner_case import PROGRAM, Ply, RunnerCase, bits, grid, sphere, write_ply

CURVES = "Close Holes: Curve Unfolding"
CHECK = "Check Completion"
MESHES = os.environ.get("MESHCOMPLETE_TEST_MESHES", "")


def needs(*filters):
    """Skips a test where a filter was not built."""
    plugins = os.path.join(os.path.dirname(PROGRAM), "..", "lib", "meshlab", "plugins")
    files = {CURVES: "libfilter_curveunfold.so", CHECK: "libfilter_checkcompletion.so"}
    missing = [name for name in filters if not os.path.exists(os.path.join(plugins, files[name]))]
    return unittest.skipIf(missing, f"not built: {missing}")


class Threads(RunnerCase):
    @needs(CURVES)
    def test_number_of_threads_does_not_matter(self):
        vertices, faces = [], []
        for i in range(40):  # Many holes, so that there is work to share out.
            part = sphere(rings=10 + i % 5, origin=(3.0 * i, 0, 0))
            faces += [tuple(v + len(vertices) for v in face) for face in part[1]]
            vertices += part[0]
        write_ply(self.path("in.ply"), vertices, faces)
        results = []
        for threads in (1, 2, 1):
            self.check(0, "-i", "in.ply", "-f", CURVES, "-o", "out.ply", "--threads", threads)
            with open(self.path("out.ply"), "rb") as file:
                results.append(file.read())
        self.assertEqual(results[0], results[1])
        self.assertEqual(results[0], results[2])


class CurveUnfolding(RunnerCase):
    @needs(CURVES, CHECK)
    def test_closes_a_hole_and_keeps_the_mesh(self):
        vertices, faces = self.make_sphere("in.ply")
        result = self.check(0, "-i", "in.ply", "-f", CURVES, "-f", CHECK, "-o", "out.ply", "--report", "report.json")
        self.assertIn("Watertight: yes", result.stdout)
        after = Ply(self.path("out.ply"))
        self.assertEqual(bits(after.points[:len(vertices)]), bits(vertices))
        self.assertEqual(after.triangles[:len(faces)], faces)
        report = self.read_report()
        self.assertEqual((report["totals"]["holes"], report["totals"]["closed"]), (1, 1))
        self.assertEqual(report["totals"]["faces_added"], len(after.triangles) - len(faces))
        self.assertEqual(report["totals"]["vertices_added"], len(after.points) - len(vertices))
        self.assertGreater(report["holes"][0]["perimeter"], 0)
        self.assertTrue(report["holes"][0]["route"])

    @needs(CURVES)
    def test_nothing_to_do_is_done(self):
        vertices, faces = self.make_sphere("in.ply", hole=False)
        self.check(0, "-i", "in.ply", "-f", CURVES, "-o", "out.ply", "--report", "report.json")
        self.assertEqual(Ply(self.path("out.ply")).triangles, faces)
        self.assertEqual(self.read_report()["holes"], [])

    @needs(CURVES)
    def test_scales_and_places(self):
        for name, options in (("large", {"scale": 1e9}), ("small", {"scale": 1e-9}), ("far", {"origin": (1000, 2000, 3000)})):
            with self.subTest(name):
                self.make_sphere("in.ply", **options)
                self.check(0, "-i", "in.ply", "-f", CURVES, "-o", "out.ply")

    @needs(CURVES)
    def test_describes_every_parameter(self):
        text = self.check(0, "--describe", CURVES).stdout
        for name in ("Selected", "MaxHoleEdges", "MaxHolePerimeter", "KeepLargest", "NewFaceSelected", "AsNewLayer"):
            self.assertIn(f"\n  {name}\n", text)

    @needs(CURVES)
    def test_wrong_parameter_suggests(self):
        self.make_sphere("in.ply")
        result = self.check(2, "-i", "in.ply", "-f", CURVES, "-p", "MaxHoleEdge=3", "-o", "out.ply")
        self.assertIn('Did you mean "MaxHoleEdges"?', result.stderr)

    @needs(CURVES)
    def test_new_layer_is_saved_and_the_old_one_is_as_it_was(self):
        vertices, faces = self.make_sphere("in.ply")
        self.check(0, "-i", "in.ply", "-f", CURVES, "-p", "AsNewLayer=true", "-o", "new.ply", "-o", "old.ply", "-l", "0")
        self.assertEqual(Ply(self.path("old.ply")).triangles, faces)
        self.assertGreater(len(Ply(self.path("new.ply")).triangles), len(faces))

    @needs(CURVES)
    def test_not_a_number_and_points_only(self):
        vertices, faces = sphere()
        for points, triangles in (([(float("nan"), 0, 0)] + vertices[1:], faces), (vertices, [])):
            write_ply(self.path("in.ply"), points, triangles)
            result = self.run_program("-i", "in.ply", "-f", CURVES, "-o", "out.ply", "--report", "report.json")
            self.assertIn(result.returncode, (0, 1, 3), result.stderr)
            self.assertNotIn("crashed", result.stderr)
            self.assertEqual(self.read_report()["exit_code"], result.returncode)

    @needs(CURVES)
    def test_colours_and_quality_of_the_mesh_stay(self):
        vertices, faces = grid()
        colours = [(i % 256, 9, 200 - i, 255) for i in range(len(vertices))]
        quality = [float(i) for i in range(len(vertices))]
        write_ply(self.path("in.ply"), vertices, faces, colours, quality)
        self.check(0, "-i", "in.ply", "-f", CURVES, "-p", "KeepLargest=true", "-o", "out.ply")
        after = Ply(self.path("out.ply")).elements["vertex"][:len(vertices)]
        self.assertEqual([(v["red"], v["green"], v["blue"], v["alpha"]) for v in after], colours)
        self.assertEqual([v["quality"] for v in after], quality)

    @needs(CURVES)
    @unittest.skipUnless(MESHES, "no folder with real meshes was given")
    def test_real_meshes(self):
        files = sorted(path for path in glob.glob(os.path.join(MESHES, "*.off")) if os.path.getsize(path) < 2_000_000)
        self.assertTrue(files)
        for path in files:
            with self.subTest(os.path.basename(path)):
                result = self.run_program("-i", path, "-f", CURVES, "-o", "out.ply", "--report", "report.json")
                self.assertIn(result.returncode, (0, 1, 3), result.stderr)
                self.assertNotIn("crashed", result.stderr)
                self.read_report()


if __name__ == "__main__":
    unittest.main()
