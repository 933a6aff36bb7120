"""The filters "Range Volume: ..." as users run them on a volume: to a closed surface, step by step."""

import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time
import unittest

from runner_case import CHECK, Ply, sphere, without, write_ply
from volume_case import (EXTRACT, FILL, MERGE, MERGED, MORPHOLOGY, OPEN, SAVE, SLICE, STRIPPED, VOXEL, VOXELIZE, VolumeCase,
                         range_scans)

from png_images import read_png  # in tests/support, which volume_case adds to the path

EMPTY, UNSEEN, SEEN = (0, 0, 0), (139, 90, 43), (255, 255, 255)


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

    def test_filling_a_wide_hole(self):
        """A sphere without its cap of 120 degrees. Unfilled it ends flat. Filled it is whole: not without the normals, nor as
        far as voxelizing says that what lies before the flat end is empty and the filter is to believe that."""
        vertices, faces = sphere(rings=36, segments=54, hole=False)
        write_ply(self.path("in.ply"), vertices, without(vertices, faces, [(0.5, 2)]))
        sightless = ("Measure=false", "LineOfSight=false")
        share = {}
        for name, steps in (("unfilled", ()), ("filled", ("-f", FILL, "-p", *sightless)),
                            ("sight", ("-f", FILL, "-p", "Measure=false")),
                            ("normals", ("-f", FILL, "-p", *sightless, "Normals=false")),
                            ("operator", ("-f", MORPHOLOGY, "-p", "Operators=v1", *sightless))):
            result = self.check(0, "-i", "in.ply", "-f", VOXELIZE, "-p", "VoxelSize=0.08", *steps, "-f", EXTRACT, "-f", CHECK,
                                "-o", f"{name}.ply")
            self.assert_solid(result, genus=0)
            share[name] = float(self.said(result, r"(?m)^Volume: ([\d.]+)$")[1]) / (4 / 3 * math.pi)
        self.assertAlmostEqual(share["filled"], 1, delta=0.03)
        for name in ("unfilled", "sight", "normals"):
            self.assertLess(share[name], 0.95, name)
        self.assertGreater(int(self.said(result, r"v1: (\d+) voxels changed")[1]), 1000)
        self.assertEqual(*(pathlib.Path(self.path(f"{name}.ply")).read_bytes() for name in ("filled", "operator")))

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
    def assert_cancels(self, delay, *arguments, begun=None):
        """Ctrl-C so many seconds after the start, or after a filter has begun, ends a long run soon; nothing is written."""
        process = subprocess.Popen(self.command(*arguments, "-o", "out.ply"), cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        if begun:
            self.assertTrue(any(begun in line for line in process.stderr), f"{begun} did not begin")
        time.sleep(delay)
        self.assertIsNone(process.poll(), "the run is not long")
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertIn(process.returncode, (130, -signal.SIGINT))
        self.assertLess(time.monotonic() - start, 5)
        self.assertEqual(os.listdir(self.folder), [])

    def test_ctrl_c_during_a_long_merge(self):
        for delay in (0.7, 1.5, 3):
            self.assert_cancels(delay, "-p", self.project, "-f", MERGE, "-p", "VoxelSize=0.004", "Ramp=0.1", "MaxMemory=20",
                                "LineOfSight=Z axis of each layer", "-f", EXTRACT)

    def test_ctrl_c_while_a_volume_changes(self):
        """While it is filled, and while a long sequence of operators goes over it."""
        volume = self.scans / "volume.vdb"
        self.merged("-f", SAVE, "-p", f"File={volume}", "-o", "out.ply", project=self.half)
        os.remove(self.path("out.ply"))
        for name, *parameters in ((FILL, "Iterations=100000"), (MORPHOLOGY, "Operators=" + 2000 * "d3 e3 ")):
            for delay in (0, 0.5):
                with self.subTest(name, delay=delay):
                    self.assert_cancels(delay, "-f", OPEN, "-p", f"File={volume}", "-f", name, "-p", *parameters,
                                        "Measure=false", begun=name)
