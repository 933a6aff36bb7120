"""The filters "Range Volume: ..." as users run them: from scans with poses to a closed surface, step by step."""

import math
import os
import pathlib
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

from runner_case import CHECK, Ply, RunnerCase, sphere, write_ply

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import range_scans  # noqa: E402
from png_images import read_png  # noqa: E402

MERGE, VOXELIZE, OPEN, SAVE, MORPHOLOGY, FILL, EXTRACT, SLICE = (
    f"Range Volume: {name}"
    for name in ("Merge Scans", "Voxelize Mesh", "Open", "Save", "Morphology", "Fill", "Extract Surface", "Slice"))
VOXEL = 0.06
MERGED = ("-f", MERGE, "-p", f"VoxelSize={VOXEL}", "Ramp=0.18", "LineOfSight=Z axis of each layer")
# What is unseen and open to the outside goes; what is left is the inside of the observed surface.
STRIPPED = ("-f", MORPHOLOGY, "-p", "Operators=e60", "Measure=false")
EMPTY, UNSEEN, SEEN = (0, 0, 0), (139, 90, 43), (255, 255, 255)


class VolumeCase(RunnerCase):
    @classmethod
    def setUpClass(cls):
        cls.scans = pathlib.Path(tempfile.mkdtemp(prefix="range scans "))
        cls.addClassCleanup(shutil.rmtree, cls.scans, ignore_errors=True)
        cls.project = range_scans.make_project(cls.scans)
        cls.half = cls.scans / "half.mlp"

    def merged(self, *arguments, project=None, code=0):
        """Merges the scans and goes on as the arguments say."""
        return self.check(code, "-p", project or self.project, *MERGED, *arguments)

    def figures(self, filter_name, number=0):
        """The report's figures of a filter: of the first one of that name, or the number-th."""
        found = [entry for entry in self.read_report()["filters"] if entry["name"] == filter_name]
        return found[number]["figures"]

    def said(self, result, pattern):
        found = re.search(pattern, result.stdout)
        self.assertIsNotNone(found, f"{pattern} not in\n{result.stdout}")
        return found

    def size(self, result):
        return tuple(int(n) for n in self.said(result, r"Volume of (\d+) x (\d+) x (\d+) voxels").groups())

    def counts(self, result):
        """Seen, unseen and empty voxels of every volume that the log tells of, in order."""
        return [tuple(map(int, found)) for found in
                re.findall(r"voxels of \S+: (\d+) seen, (\d+) unseen, (\d+) empty", result.stdout)]

    def assert_solid(self, result, genus):
        """What Check Completion says of a closed manifold surface of one component."""
        for line in ("Boundary edges: 0", "Non-manifold edges: 0", "Non-manifold vertices: 0", "Watertight: yes",
                     "Connected components: 1", f"Genus: {genus}", "Self-intersecting pairs of faces: 0"):
            self.assertIn(line, result.stdout)

    def refused(self, *arguments, code=1, outputs=("out.ply",)):
        """The run fails and writes nothing; returns its message."""
        result = self.check(code, *arguments, "-o", "out.ply")
        for name in outputs:
            self.assertFalse(os.path.exists(self.path(name)), result.stderr)
        return " ".join(result.stderr.split())


class Merging(VolumeCase):
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
        step = 0.05
        lattice = ((step * (i + 0.5) - 1, step * (j + 0.5) - 1, step * (k + 0.5) - 1)
                   for i in range(68) for j in range(40) for k in range(40))
        truth = step ** 3 * sum(map(range_scans.inside, lattice))
        self.assertAlmostEqual(volume, truth, delta=0.03 * truth)

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
        carved = self.merged("-o", "a.ply")
        plain = self.check(0, "-p", self.project, *MERGED, "Carving=false", "-o", "b.ply")
        self.assertEqual(self.counts(carved)[0][0], self.counts(plain)[0][0])
        self.assertGreaterEqual(self.counts(carved)[0][2], self.counts(plain)[0][2])

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


class Slices(VolumeCase):
    def origin(self, axis="z", position=0):
        """The middle of voxel (0, 0, 0), from the slice layer at the volume's low end."""
        self.merged("-f", SLICE, "-p", f"Axis={axis}", "Middle=false", f"Position={position}", "-o", "slice.ply")
        points = Ply(self.path("slice.ply")).points
        return [min(point[i] for point in points) + (0 if i == "xyz".index(axis) else VOXEL / 2) for i in range(3)]

    def test_images_of_all_slices(self):
        result = self.merged("-f", SLICE, "-p", "Axis=z", "Folder=deep/slices", "-o", "out.ply")
        width, height, depth = self.size(result)
        names = sorted(os.listdir(self.path("deep/slices")))
        self.assertEqual(names, [f"z_{number:04}.png" for number in range(depth)])
        images = [read_png(pathlib.Path(self.path("deep/slices")) / name) for name in names]
        self.assertEqual({image[:2] for image in images}, {(width, height)})
        pixels = [pixel for _, _, rows in images for row in rows for pixel in row]
        self.assertEqual(tuple(pixels.count(colour) for colour in (SEEN, UNSEEN, EMPTY)), self.counts(result)[0])
        origin = self.origin()

        def colour(point):
            x, y, z = (round((p - o) / VOXEL) for p, o in zip(point, origin))
            return images[z][2][height - 1 - y][x]
        self.assertEqual(colour((0, 0, 0)), UNSEEN)  # inside the ball
        self.assertEqual(colour((-0.6, 0, 0)), UNSEEN)
        self.assertEqual(colour((0.8, 0.8, 0.8)), EMPTY)  # a scanner looked through it at the ball
        self.assertEqual(colour((2.4, 0, 0)), SEEN)
        self.assertEqual(colour((2.2, 0.95, 0)), SEEN)
        self.assertEqual(colour(tuple(-1 / math.sqrt(3) for _ in range(3))), SEEN)

    def test_images_of_normals_and_weights(self):
        self.merged("-f", SLICE, "-p", "Axis=x", "View=Weights", "Folder=w", "-f", SLICE, "-p", "Axis=x", "View=Normals",
                    "Folder=n", "-o", "out.ply")
        brightest = 0
        for name in os.listdir(self.path("w")):
            for row in read_png(pathlib.Path(self.path("w")) / name)[2]:
                self.assertTrue(all(r == g == b for r, g, b in row))
                brightest = max(brightest, *(r for r, _, _ in row))
        self.assertEqual(brightest, 255)
        with_normal = 0
        for name in os.listdir(self.path("n")):
            for row in read_png(pathlib.Path(self.path("n")) / name)[2]:
                for pixel in row:
                    if pixel != (0, 0, 0):
                        with_normal += 1
                        length = math.sqrt(sum((2 * c / 255 - 1) ** 2 for c in pixel))
                        self.assertAlmostEqual(length, 1, delta=0.03)
        self.assertGreater(with_normal, 10000)

    def test_a_slice_as_a_layer(self):
        result = self.merged("-f", SLICE, "-p", "Axis=y", "Middle=false", "Position=20", "-o", "slice.ply")
        width, height, depth = self.size(result)
        mesh = Ply(self.path("slice.ply"))
        points = mesh.points
        self.assertEqual(len(mesh.triangles), 2 * width * depth)
        colours = [tuple(face[c] for c in ("red", "green", "blue")) for face in mesh.elements["face"]]
        counted = self.said(result, r"y = 20: (\d+) seen, (\d+) unseen, (\d+) empty").groups()
        self.assertEqual([colours.count(c) // 2 for c in (SEEN, UNSEEN, EMPTY)], [int(n) for n in counted])
        heights = {round(point[1], 5) for point in points}
        self.assertEqual(len(heights), 1)
        for face, colour in zip(mesh.triangles, colours):
            middle = [sum(points[v][i] for v in face) / 3 for i in range(3)]
            if math.dist(middle, (0, 0, 0)) < 0.6:
                self.assertEqual(colour, UNSEEN)
            elif abs(math.dist(middle, (0, 0, 0)) - 1) < 0.06 and middle[0] < 0:
                self.assertEqual(colour, SEEN)

    def test_a_slice_outside_the_volume(self):
        message = self.refused("-p", self.project, *MERGED, "-f", SLICE, "-p", "Middle=false", "Position=4000")
        self.assertRegex(message, r"The slice lies outside the volume: along z it has the voxels 0 to \d+")


class Changing(VolumeCase):
    """With half of the scans: the back of the ball is a hole, where unseen and empty voxels meet."""

    def changed(self, *parameters, steps=()):
        return self.merged(*steps, "-f", MORPHOLOGY, "-p", *parameters, "Measure=false", "-o", "out.ply", project=self.half)

    def test_erosion_and_dilation_keep_what_was_seen(self):
        for operators in ("e1", "d1", "d2 e2"):
            seen = {counts[0] for counts in self.counts(self.changed(f"Operators={operators}"))}
            self.assertEqual(len(seen), 1, operators)
        before, after = self.counts(self.changed("Operators=e1"))
        changed = before[1] - after[1]
        self.assertGreater(changed, 0)
        self.assertEqual(after[2] - before[2], changed)
        before, grown = self.counts(self.changed("Operators=d1"))
        self.assertGreater(grown[1], before[1])
        before, expanded = self.counts(self.changed("Operators=x1"))
        self.assertGreaterEqual(expanded[0], before[0])

    def test_boxes_in_voxels_and_in_mesh_units(self):
        """The same box given both ways changes the same voxels, and fewer than no box does."""
        whole = self.said(self.changed("Operators=d1"), r"d1: (\d+) voxels changed")[1]
        result = self.merged("-f", SLICE, "-p", "Middle=false", "Position=0", "-o", "slice.ply", project=self.half)
        points = Ply(self.path("slice.ply")).points
        low = [min(point[i] for point in points) + VOXEL / 2 * (i < 2) for i in range(3)]
        size = self.size(result)
        first, last = (0, 0, 0), (size[0] - 1, size[1] // 2, size[2] - 1)
        in_units = [[o + VOXEL * n for o, n in zip(low, corner)] for corner in (first, last)]
        margin = 0.2 * VOXEL
        of_voxels = self.changed("Operators=d1", "Box=Box, in voxels", "BoxFrom=" + " ".join(map(str, first)),
                                 "BoxTo=" + " ".join(map(str, last)))
        of_units = self.changed("Operators=d1", "Box=Box, in mesh units",
                                "BoxFrom=" + " ".join(f"{x - margin:.6f}" for x in in_units[0]),
                                "BoxTo=" + " ".join(f"{x + margin:.6f}" for x in in_units[1]))
        changed = [int(self.said(run, r"d1: (\d+) voxels changed")[1]) for run in (of_voxels, of_units)]
        self.assertEqual(changed[0], changed[1])
        self.assertEqual(self.counts(of_voxels), self.counts(of_units))
        self.assertGreater(changed[0], 0)
        self.assertLess(changed[0], int(whole))

    def test_the_selection_in_a_slice(self):
        """The box goes through the whole depth: as one in mesh units that is open along the slice's axis."""
        slice_and_select = ("-f", SLICE, "-p", "Axis=z", "-f", "Conditional Face Selection", "-p",
                            "condSelect=(x0 < 0) && (x1 < 0) && (x2 < 0)")
        selected = self.changed("Operators=e3", "Box=Selection in a slice", steps=slice_and_select)
        named = self.changed("Operators=e3", "Box=Selection in a slice", "SliceLayer=5", steps=slice_and_select)
        self.assertEqual(self.counts(named), self.counts(selected))
        self.merged(*slice_and_select, "-o", "slice.ply", project=self.half)
        points = Ply(self.path("slice.ply")).points
        edge = max(x for x in {point[0] for point in points} if x < 0)
        half = self.changed("Operators=e3", "Box=Box, in mesh units", "BoxFrom=-100 -100 -100",
                            f"BoxTo={edge - VOXEL / 4:.6f} 100 100")
        self.assertEqual(self.counts(selected)[1], self.counts(half)[1])
        self.assertNotEqual(self.counts(selected)[0], self.counts(selected)[1])

    def test_before_and_after_are_measured(self):
        self.merged("-f", MORPHOLOGY, "-p", "Operators=e60", "-o", "out.ply", "--report", "report.json")
        figures = self.figures(MORPHOLOGY)
        self.assertEqual((figures["after genus"], figures["after components"], figures["after boundary loops"]), (1, 1, 0))
        self.assertGreaterEqual(figures["before genus"], 1)
        self.assertGreater(figures["before faces"], 0)

    def test_a_new_layer_keeps_the_old_volume(self):
        """Layers 0 to 3 are the scans, 4 is the volume, 5 the result."""
        self.merged("-f", SAVE, "-p", "File=before.vdb", "-f", MORPHOLOGY, "-p", "Operators=e3", "AsNewLayer=true",
                    "Measure=false", "-f", SAVE, "-p", "File=after.vdb", "-f", "Change the current layer", "-p", "layer=4",
                    "-f", SAVE, "-p", "File=still.vdb", "-f", EXTRACT, "-o", "out.ply", project=self.half)
        surfaces = {}
        for name in ("before", "after", "still"):
            self.check(0, "-f", OPEN, "-p", f"File={name}.vdb", "-f", EXTRACT, "-o", "surface.ply")
            surfaces[name] = pathlib.Path(self.path("surface.ply")).read_bytes()
        self.assertEqual(surfaces["before"], surfaces["still"])
        self.assertNotEqual(surfaces["before"], surfaces["after"])
        self.assertEqual(pathlib.Path(self.path("out.ply")).read_bytes(), surfaces["before"])

    def test_filling_a_mesh_with_a_hole(self):
        vertices, faces = sphere(rings=24, segments=36)
        write_ply(self.path("in.ply"), vertices, faces)
        volume = ("-i", "in.ply", "-f", VOXELIZE, "-p", "VoxelSize=0.05")
        observed = self.check(0, *volume, "-f", EXTRACT, "-p", "ObservedOnly=true", "-f", CHECK, "-o", "observed.ply",
                              "--report", "report.json")
        self.assertIn("edges at holes: what lies behind them was not seen", observed.stdout)
        self.assertEqual(self.figures(EXTRACT)["surface boundary loops"], 1)
        filled = self.check(0, *volume, "-f", FILL, "-p", "Iterations=60", "-f", EXTRACT, "-f", CHECK, "-o", "out.ply",
                            "--report", "report.json")
        self.assert_solid(filled, genus=0)
        self.assertEqual(self.figures(FILL)["after boundary loops"], 0)
        seen = {counts[0] for counts in self.counts(filled)}
        self.assertEqual(len(seen), 1, "diffusion changes no state")
        # The membrane over the hole is flat without the filler and goes on with the sphere's surface by it.
        radii = [math.dist(point, (0, 0, 0)) for point in Ply(self.path("out.ply")).points]
        self.assertGreater(min(radii), 0.85)
        self.assertLess(max(radii), 1.1)

    def test_iterations_and_reach_bound_the_diffusion(self):
        few = self.changed("Operators=v1", "Iterations=1")
        many = self.changed("Operators=v1", "Iterations=30")
        near = self.changed("Operators=v1", "Iterations=30", "Reach=2")
        few, many, near = (int(self.said(run, r"v1: (\d+) voxels changed")[1]) for run in (few, many, near))
        self.assertLess(few, many)
        self.assertLess(near, many)


class Files(VolumeCase):
    def save(self, name="volume.vdb"):
        self.merged(*STRIPPED, "-f", SAVE, "-p", f"File={name}", "-f", EXTRACT, "-o", "direct.ply")
        return pathlib.Path(self.path(name))

    def test_saved_and_opened_gives_the_same_surface(self):
        self.save()
        opened = self.check(0, "-f", OPEN, "-p", "File=volume.vdb", "-f", EXTRACT, "-f", CHECK, "-o", "opened.ply")
        self.assert_solid(opened, genus=1)
        self.assertEqual(*(pathlib.Path(self.path(name)).read_bytes() for name in ("direct.ply", "opened.ply")))

    @unittest.skipUnless(shutil.which("vdb_print"), "OpenVDB's programs are not installed")
    def test_openvdb_reads_it(self):
        path = self.save()
        printed = subprocess.run(["vdb_print", path], capture_output=True, text=True, timeout=60, check=True).stdout
        for grid, kind in (("distance", "float"), ("weight", "float"), ("normal", "int32"), ("state", "bool")):
            self.assertRegex(printed, rf"(?m)^{grid}\s+{kind}\s")

    def test_damaged_files(self):
        path = self.save()
        whole = path.read_bytes()
        flipped = bytearray(whole)
        flipped[len(whole) // 2] ^= 0x40
        for name, content in (("short.vdb", whole[:-1000]), ("cut.vdb", whole[:len(whole) // 3]),
                              ("flipped.vdb", bytes(flipped)), ("empty.vdb", b""), ("text.vdb", b"not a volume\n" * 99)):
            with self.subTest(name):
                pathlib.Path(self.path(name)).write_bytes(content)
                message = self.refused("-f", OPEN, "-p", f"File={name}", "-f", EXTRACT)
                self.assertIn(f'The file "{name}', message.replace(self.folder + "/", ""))
                self.assertRegex(message, "damaged|not complete|is not a|no OpenVDB|cut off|empty")

    def test_a_missing_file(self):
        message = self.refused("-f", OPEN, "-p", "File=nowhere.vdb", "-f", EXTRACT, code=1)
        self.assertIn("nowhere.vdb", message)
        self.assertIn("File is empty", self.refused("-f", OPEN, "-f", EXTRACT))

    def test_a_place_that_cannot_be_written(self):
        message = self.refused("-p", self.project, *MERGED, "-f", SAVE, "-p", "File=nowhere/volume.vdb")
        self.assertIn("cannot be written", message)
        self.assertFalse(os.path.exists(self.path("nowhere")))


class Refusals(VolumeCase):
    def test_no_layers(self):
        self.assertRegex(self.refused(*MERGED, code=self.code_without_layers()), "layer|mesh")

    def code_without_layers(self):
        return self.run_program(*MERGED, "-o", "out.ply").returncode or self.fail("a run without layers succeeded")

    def test_a_layer_without_faces(self):
        write_ply(self.path("points.ply"), [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [])
        message = self.refused("-i", self.scans / "scan_0.ply", "points.ply", *MERGED)
        self.assertIn("points.ply", message)
        self.assertIn("has no faces", message)

    def test_voxel_sizes(self):
        for size in ("0", "-1"):
            message = self.refused("-p", self.project, "-f", MERGE, "-p", f"VoxelSize={size}", code=2)
            self.assertIn('"VoxelSize": "' + size + '" is out of range', message)
        for filter_name, inputs in ((MERGE, ("-p", self.project)), (VOXELIZE, ("-i", self.scans / "scan_0.ply"))):
            message = self.refused(*inputs, "-f", filter_name, "-p", "VoxelSize=0.00001")
            self.assertRegex(message, r"Voxels of 1e-05 would need about \S+ [GTM]B of memory; 4 GB are allowed")
            self.assertRegex(message, r"Voxels of \S+ would fit")

    def test_the_voxel_size_that_the_message_suggests_fits(self):
        message = self.refused("-p", self.project, "-f", MERGE, "-p", f"VoxelSize={VOXEL}", "MaxMemory=0.0005")
        fitting = re.search(r"Voxels of (\S+) would fit", message)[1]
        self.check(0, "-p", self.project, "-f", MERGE, "-p", f"VoxelSize={fitting}", "MaxMemory=0.0005", "-o", "out.ply")

    def test_a_box_outside_the_volume(self):
        for kind in ("Box, in voxels", "Box, in mesh units"):
            message = self.refused("-p", self.project, *MERGED, "-f", MORPHOLOGY, "-p", f"Box={kind}", "BoxFrom=900 900 900",
                                   "BoxTo=910 910 910")
            self.assertIn("lies outside the volume. The volume has the voxels from", message)
        message = self.refused("-p", self.project, *MERGED, "-f", FILL, "-p", "Box=Box, in voxels", "BoxFrom=9 9 9",
                               "BoxTo=8 20 20")
        self.assertIn("has no voxels", message)
        message = self.refused("-p", self.project, *MERGED, "-f", FILL, "-p", "Box=Box, in voxels", "BoxFrom=0.5 0 0",
                               "BoxTo=8 20 20")
        self.assertIn("must be three whole numbers", message)

    def test_operators(self):
        for text, phrase in (("d2 q1", 'Unknown operator "q" at character 4'), ("3d", "There is no letter before the count"),
                             ("d0", "is 0"), ("d1001", "is larger than 1000"), (" ", "There are no operators")):
            with self.subTest(text):
                message = self.refused("-p", self.project, *MERGED, "-f", MORPHOLOGY, "-p", f"Operators={text}")
                self.assertIn(phrase, message)
                self.assertIn("e (erosion), d (dilation), x (expansion) and v (diffusion)", message)

    def test_a_layer_without_a_volume(self):
        for name, *parameters in ((MORPHOLOGY,), (FILL,), (EXTRACT,), (SLICE,), (SAVE, "-p", "File=volume.vdb")):
            with self.subTest(name):
                message = self.refused("-p", self.project, "-f", name, *parameters, outputs=("out.ply", "volume.vdb"))
                self.assertIn('The layer "scan_7.ply" holds no range volume.', message)
                self.assertIn("Range Volume: Merge Scans", message)

    def test_no_selection_in_a_slice(self):
        selected = ("-f", MORPHOLOGY, "-p", "Box=Selection in a slice")
        for steps in ((), ("-f", SLICE)):
            message = self.refused("-p", self.project, *MERGED, *steps, *selected)
            self.assertIn("No face of a slice of this volume is selected", message)
        message = self.refused("-p", self.project, *MERGED, *selected, "SliceLayer=2")
        self.assertIn('The layer "scan_2.ply" is no slice of a volume', message)

    def test_two_slices_with_a_selection(self):
        """The last one counts when it is named."""
        steps = []
        for axis in "xz":
            steps += ["-f", SLICE, "-p", f"Axis={axis}", "-f", "Select All"]
        selected = ("-f", MORPHOLOGY, "-p", "Operators=e1", "Measure=false", "Box=Selection in a slice")
        message = self.refused("-p", self.project, *MERGED, *steps, *selected)
        self.assertIn("More than one slice of this volume has selected faces", message)
        self.merged(*steps, *selected, "SliceLayer=9", "-o", "out.ply")

    def test_a_camera_that_is_not_there(self):
        message = self.refused("-p", self.project, "-f", MERGE, "-p", f"VoxelSize={VOXEL}",
                               "LineOfSight=Camera of each layer")
        self.assertIn('The layer "scan_0.ply" has no camera. Choose another line of sight.', message)

    def test_a_viewpoint_on_the_surface(self):
        point = " ".join(f"{c:.6f}" for c in Ply(self.scans / "scan_0.ply").points[700])
        message = self.refused("-i", self.scans / "scan_0.ply", "-f", MERGE, "-p", f"VoxelSize={VOXEL}",
                               "LineOfSight=Viewpoint", f"Viewpoint={point}")
        self.assertIn("lies on its surface, or nearer to it than the ramp", message)

    def test_a_ramp_below_a_voxel(self):
        message = self.refused("-p", self.project, "-f", MERGE, "-p", f"VoxelSize={VOXEL}", "Ramp=0.01")
        self.assertIn("The ramp must be at least as long as a voxel", message)

    def test_a_surface_without_components_of_that_size(self):
        message = self.refused("-p", self.project, *MERGED, "-f", EXTRACT, "-p", "SmallestComponent=2000000000")
        self.assertIn("There is no surface in this volume", message)


class Cancelling(VolumeCase):
    def test_ctrl_c_during_a_long_merge(self):
        for delay in (0.7, 1.5, 3):
            command = self.command("-p", self.project, "-f", MERGE, "-p", "VoxelSize=0.004", "Ramp=0.1", "MaxMemory=20",
                                   "LineOfSight=Z axis of each layer", "-f", EXTRACT, "-o", "out.ply")
            process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(delay)
            self.assertIsNone(process.poll(), "the merge is not long")
            start = time.monotonic()
            process.send_signal(signal.SIGINT)
            self.assertIn(process.wait(timeout=60), (130, -signal.SIGINT))
            self.assertLess(time.monotonic() - start, 5)
            self.assertEqual(os.listdir(self.folder), [])
