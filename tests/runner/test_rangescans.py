"""Range Volume: Merge Scans, as users run it: from scans with poses to what is seen, unseen and empty."""

import functools
import math
import os
import pathlib
import re
import struct

from runner_case import CHECK, Ply
from volume_case import (BANDS, EXTRACT, FILL, MERGE, MERGED, SAVE, STRIPPED, VOXEL, VolumeCase, add_camera, range_scans)


class Merging(VolumeCase):
    @staticmethod
    @functools.lru_cache
    def solid_volume():
        """Of the scanned solid, from points on a lattice."""
        step = 0.05
        lattice = ((step * (i + 0.5) - 1, step * (j + 0.5) - 1, step * (k + 0.5) - 1)
                   for i in range(68) for j in range(40) for k in range(40))
        return step ** 3 * sum(map(range_scans.inside, lattice))

    def test_a_closed_surface_with_one_handle(self):
        """All that the scanners saw of the solid is there, and its surface is where the solid ends."""
        result = self.merged(*STRIPPED, "-f", EXTRACT, "-f", CHECK, "-o", "out.ply", "--report", "report.json")
        self.assert_solid(result, genus=1)
        mesh = Ply(self.path("out.ply"))
        self.assertEqual(self.figures(EXTRACT)["surface genus"], 1)
        self.assertEqual(self.figures(EXTRACT)["surface faces"], len(mesh.triangles))
        self.assertEqual(self.figures(EXTRACT)["surface boundary loops"], 0)
        ball = [math.dist(point, (0, 0, 0)) for point in mesh.points if point[0] < 0]
        self.assertLess(max(abs(radius - range_scans.RADIUS) for radius in ball), VOXEL)
        self.assertAlmostEqual(max(point[0] for point in mesh.points), 2.4, delta=VOXEL)
        volume = float(self.said(result, r"(?m)^Volume: ([\d.]+)$")[1])
        self.assertAlmostEqual(volume, self.solid_volume(), delta=0.03 * self.solid_volume())

    def test_the_report_adds_up(self):
        result = self.merged("-f", EXTRACT, "-o", "out.ply", "--report", "report.json")
        width, height, depth = self.size(result)
        figures = self.figures(MERGE)
        self.assertEqual(sum(figures[f"{state} voxels"] for state in ("seen", "unseen", "empty")), width * height * depth)
        self.assertGreater(figures["volume bytes"], 4 * figures["seen voxels"])
        self.assertEqual(self.read_report()["exit_code"], 0)
        self.assertEqual(len(re.findall(r"the scan 'scan_\d.ply': \d+ faces, \d+ dropped", result.stdout)), 8)

    def test_faces_across_depth_steps_are_dropped(self):
        """Left in, they would be walls between the handle and the ball."""
        result = self.merged("-o", "out.ply")
        for dropped in re.findall(r"faces, (\d+) dropped", result.stdout):
            self.assertGreater(int(dropped), 20)
        kept = self.check(0, "-p", self.project, *MERGED, "LongestEdge=100", "GrazingAngle=90", "-o", "all.ply")
        for long_edges, grazing in re.findall(r"\((\d+) long, (\d+) grazing", kept.stdout):
            self.assertEqual((long_edges, grazing), ("0", "0"))
        self.assertGreater(self.counts(kept)[0][0], self.counts(result)[0][0])

    def test_the_scans_own_axes_are_found(self):
        result = self.check(0, "-p", self.project, "-f", MERGE, "-p", f"VoxelSize={VOXEL}", "Ramp=0.18",
                            "LineOfSight=Own axis of each scan", "-o", "out.ply")
        found = re.findall(r"scan_(\d).ply'.*seen along \((\S+) (\S+) (\S+)\)", result.stdout)
        self.assertEqual(len(found), 8)
        for number, *axis in found:
            truth = range_scans.pose(range_scans.DIRECTIONS[int(number)])[2]
            cosine = sum(float(a) * b for a, b in zip(axis, truth))
            self.assertGreater(cosine, math.cos(math.radians(5)))

    def test_a_viewpoint(self):
        """A scanner far away sees as parallel rays do."""
        scan = self.scans / "scan_0.ply"
        far = " ".join(str(1000 * (i == 2)) for i in range(3))
        near_z = ("-f", MERGE, "-p", f"VoxelSize={VOXEL}", "Ramp=0.18")
        parallel = self.check(0, "-i", scan, *near_z, "LineOfSight=Z axis of each layer", "-o", "a.ply")
        viewpoint = self.check(0, "-i", scan, *near_z, "LineOfSight=Viewpoint", f"Viewpoint={far}", "-o", "b.ply")
        self.assertIn("seen from (0 0 1000)", viewpoint.stdout)
        seen, from_there = self.counts(parallel)[0][0], self.counts(viewpoint)[0][0]
        self.assertLess(abs(seen - from_there), 0.02 * seen)

    def test_carving_only_empties(self):
        """What is seen stays. With neither carving nor emptied surroundings nothing is known to be empty."""
        for surroundings in ("true", "false"):
            carved, plain = (self.counts(self.merged(f"Carving={carving}", f"Surroundings={surroundings}", "-o", "out.ply"))[0]
                             for carving in ("true", "false"))
            self.assertEqual(carved[0], plain[0])
            self.assertGreaterEqual(carved[2], plain[2])
        self.assertGreater(carved[2], carved[0])
        self.assertEqual(plain[2], 0)

    def test_surroundings_become_empty(self):
        """The surface is the solid's as it is merged. Without, so is what no ray passed round it, in many parts."""
        volumes, voxels, parts = {}, {}, {}
        for surroundings in ("true", "false"):
            result = self.merged(f"Surroundings={surroundings}", "-f", EXTRACT, "-f", CHECK, "-o", "out.ply")
            if surroundings == "true":
                self.assert_solid(result, genus=1)
            volumes[surroundings] = float(self.said(result, r"(?m)^Volume: ([\d.]+)$")[1])
            voxels[surroundings] = self.counts(result)[0]
            parts[surroundings] = int(self.said(result, r"Connected components: (\d+)")[1])
        self.assertAlmostEqual(volumes["true"], self.solid_volume(), delta=0.03 * self.solid_volume())
        self.assertEqual(voxels["true"][0], voxels["false"][0])
        self.assertLess(voxels["true"][1], voxels["false"][1])
        self.assertEqual(sum(voxels["true"]), sum(voxels["false"]))
        self.assertGreater(volumes["false"], 1.5 * volumes["true"])
        self.assertGreater(parts["false"], 1)

    def test_the_input_layers_stay_as_they_are(self):
        def scans():
            return {path.name: path.read_bytes() for path in self.scans.iterdir()}
        before = scans()
        first = range_scans.scan(range_scans.DIRECTIONS[3], 0.06)
        self.merged(*STRIPPED, "-o", "volume.ply", "-o", "scan.ply", "-l", "3")
        kept = Ply(self.path("scan.ply"))
        self.assertEqual(kept.triangles, first[1])
        self.assertEqual(kept.points, [struct.unpack("<3f", struct.pack("<3f", *v)) for v in first[0]])
        self.assertEqual(scans(), before)

    def test_the_layer_shows_the_surface_as_points(self):
        self.merged("-o", "out.ply", "-m", "vn", "vq")
        mesh = Ply(self.path("out.ply"))
        self.assertEqual(mesh.triangles, [])
        self.assertGreater(len(mesh.points), 1000)
        self.assertTrue(all(vertex["quality"] > 0 for vertex in mesh.elements["vertex"]))
        for vertex in mesh.elements["vertex"]:
            point = tuple(vertex[axis] for axis in "xyz")
            if vertex["x"] < 0:
                self.assertLess(abs(math.dist(point, (0, 0, 0)) - range_scans.RADIUS), 1.8 * VOXEL)
                self.assertGreater(sum(vertex["n" + axis] * vertex[axis] for axis in "xyz"), 0.5)

    def test_threads_do_not_matter(self):
        results = []
        for threads in (1, 2):
            self.merged("-f", FILL, "-p", "Iterations=10", "Measure=false", "-f", SAVE, "-p", "File=v.vdb", "-f", EXTRACT,
                        "-o", "out.ply", "--threads", threads)
            results.append(pathlib.Path(self.path("out.ply")).read_bytes())
        self.assertEqual(results[0], results[1])


class Cameras(VolumeCase):
    """One scan, seen along x, in a project whose matrix turns its z axis to x: no number of it is rounded."""

    CAMERA, PLACE = (0, 0, 4), (4, 0, 0)  # in the layer and in the project

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        columns = range_scans.pose((1, 0, 0))
        for name, camera in (("with.ply", cls.CAMERA), ("without.ply", None)):
            range_scans.write_scan(cls.scans / name, *range_scans.scan((1, 0, 0), 0.06))
            if camera:
                add_camera(cls.scans / name, camera)
        for project, names in (("one", ("with.ply",)), ("two", ("with.ply", "without.ply"))):
            range_scans.write_project(cls.scans / f"{project}.mlp", [(name, columns) for name in names])

    def seen_by(self, *sight, project="one"):
        result = self.check(0, "-p", self.scans / f"{project}.mlp", *BANDS, *sight, "-f", EXTRACT, "-o", "out.ply")
        return result, self.counts(result)[0], pathlib.Path(self.path("out.ply")).read_bytes()

    def test_a_camera_sees_as_a_viewpoint_there(self):
        _, *there = self.seen_by("LineOfSight=Viewpoint", "Viewpoint=" + " ".join(map(str, self.PLACE)))
        camera, *from_camera = self.seen_by("LineOfSight=Camera of each layer")
        self.assertIn("seen from (4 0 0)", camera.stdout)
        self.assertEqual(from_camera, there)
        _, *parallel = self.seen_by("LineOfSight=Z axis of each layer")
        self.assertNotEqual(parallel, there)

    def test_automatic_takes_the_camera(self):
        automatic, *found = self.seen_by("LineOfSight=Automatic")
        self.assertIn("seen from (4 0 0)", automatic.stdout)
        _, *by_default = self.seen_by()
        _, *from_camera = self.seen_by("LineOfSight=Camera of each layer")
        self.assertEqual(found, from_camera)
        self.assertEqual(by_default, from_camera)

    def test_automatic_takes_the_own_axis_of_a_scan_without_a_camera(self):
        result, *_ = self.seen_by("LineOfSight=Automatic", project="two")
        self.assertRegex(result.stdout, r"with\.ply'.* seen from \(4 0 0\)")
        axis = self.said(result, r"without\.ply'.* seen along \((\S+) \S+ \S+\)")[1]
        self.assertGreater(float(axis), math.cos(math.radians(5)))
