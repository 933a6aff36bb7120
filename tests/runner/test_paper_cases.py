"""The cases of the paper on Poisson-driven completion, made by scripts/make_paper_cases.py and closed as users close them.

Most are cut out of meshes of Debian's package libcgal-demo, which ./test fetches; without these their tests are skipped.
"""

import pathlib
import subprocess
import sys
import unittest

from runner_case import CHECK, Ply, RunnerCase, bits

TOP = pathlib.Path(__file__).resolve().parents[2]
MESHES = TOP / ".cache/data"
FILTER = "Close Holes: Poisson-driven"


def read_off(path):
    sys.path.insert(0, str(TOP / "scripts"))
    try:
        import mesh_shapes
    finally:
        sys.path.pop(0)
    return mesh_shapes.read_off(path)


class PaperCase(RunnerCase):
    def make(self, case, *meshes):
        for name in meshes:
            if not (MESHES / name).exists():
                self.skipTest(f"scripts/fetch_demo.sh {name} fetches a mesh that this needs")
        subprocess.run([TOP / "scripts/make_paper_cases.py", case, self.folder], check=True, timeout=120)

    def close(self, case, *options, inputs=()):
        """Closes what is open; the input is kept and the result solid. Returns how many rims each hole has."""
        self.check(0, "-i", *inputs, f"{case}.off", "-f", FILTER, *options, "-f", CHECK, "-o", "out.ply", "--report",
                   "report.json")
        report = self.read_report()
        self.log = "\n".join(line for step in report["filters"] for line in step["log"])
        points, faces = read_off(self.path(f"{case}.off"))
        after = Ply(self.path("out.ply"))
        self.assertEqual(bits(after.points[:len(points)]), bits(points))
        self.assertEqual(after.triangles[:len(faces)], faces)
        for line in ("Watertight: yes", "Orientation: consistent", "Self-intersecting pairs of faces: 0"):
            self.assertIn(line, self.log)
        self.assertEqual(report["totals"]["closed"], report["totals"]["holes"])
        return sorted(len(hole["loops"]) for hole in report["holes"])

    def said(self, name):
        return int(next(line for line in self.log.split("\n") if line.startswith(name + ":")).split()[-1])

    def assert_topology(self, components, genus):
        self.assertEqual((self.said("Connected components"), self.said("Genus")), (components, genus))


class Repair(PaperCase):
    def test_a_convoluted_rim_between_fingers(self):
        """Figure 10a: one rim, between the fingers of a fist and behind its thumb."""
        self.make("fist", "hand.off")
        self.assertEqual(self.close("fist"), [1])
        (hole,) = self.read_report()["holes"]
        self.assertGreater(hole["edges"], 400)
        self.assert_topology(components=1, genus=0)

    def test_a_sliced_bunny(self):
        """Figure 10d: dozens of pieces, nearly all of their rims closed by one patch."""
        self.make("slices", "bunny00.off")
        self.check(0, "-i", "slices.off", "-f", CHECK, "--report", "report.json")
        self.log = "\n".join(self.read_report()["filters"][0]["log"])
        self.assertGreater(self.said("Connected components"), 30)
        self.assertGreater(self.close("slices")[-1], 30)
        self.assert_topology(components=1, genus=0)


class Assembly(PaperCase):
    def test_parts_islands_holes_and_a_passage(self):
        """Figure 1: only with the guide the openings on both sides become a passage."""
        self.make("assembled", "bunny00.off", "lion-head.off")
        loops = self.close("assembled", "-p", "GuideLayer=assembled-tube.off", inputs=["assembled-tube.off"])
        self.assertEqual(loops, [1, 1, 1, 1, 1, 2, 2, 3])
        self.assert_topology(components=1, genus=1)
        without = self.close("assembled")
        self.assertEqual(sum(without), sum(loops))
        self.assert_topology(components=1, genus=0)

    def test_parts_of_unlike_density(self):
        """Figure 12: the edges of the patch lie between those of the two rims in length."""
        self.make("head", "bunny00.off", "lion-head.off")
        self.assertEqual(self.close("head"), [2])
        self.assert_topology(components=1, genus=0)
        report = self.read_report()
        after = Ply(self.path("out.ply"))
        old = len(after.triangles) - report["totals"]["faces_added"]
        lengths = sorted(self.edges(after, after.triangles[old:]))
        self.assertGreater(lengths[-len(lengths) // 20], 2.5 * lengths[len(lengths) // 20])

    @staticmethod
    def edges(ply, faces):
        def length(a, b):
            return sum((x - y) ** 2 for x, y in zip(ply.points[a], ply.points[b])) ** 0.5
        return [length(t[k], t[(k + 1) % 3]) for t in faces for k in range(3)]


class Guided(PaperCase):
    def test_points_join_what_is_too_far_apart(self):
        """Without the guide each end of the horseshoe gets a cap; with some rings of points it becomes a ring."""
        self.make("horseshoe")
        self.assertEqual(self.close("horseshoe"), [1, 1])
        self.assert_topology(components=1, genus=0)
        loops = self.close("horseshoe", "-p", "GuideLayer=horseshoe-points.ply", inputs=["horseshoe-points.ply"])
        self.assertEqual(loops, [2])
        self.assert_topology(components=1, genus=1)


if __name__ == "__main__":
    unittest.main()
