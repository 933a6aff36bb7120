"""The filters "Range Volume: ..." and the layers that they are given: wrong ones, named oddly, or with a camera."""

import math
import os
import unittest

from runner_case import Ply, RunnerCase, grid, sphere, write_ply

VOXELIZE, MERGE, SLICE, EXTRACT = (
    f"Range Volume: {name}" for name in ("Voxelize Mesh", "Merge Scans", "Slice", "Extract Surface"))


class VolumeLayers(RunnerCase):
    def refused(self, *arguments):
        result = self.check(1, *arguments, "-o", "out.ply")
        self.assertFalse(os.path.exists(self.path("out.ply")))
        return " ".join(result.stderr.split())

    def test_no_points_are_voxelized(self):
        """Whether a voxel size is given or not."""
        vertices, _ = sphere()
        write_ply(self.path("cloud.ply"), vertices, [])
        for parameters in ((), ("-p", "VoxelSize=0.1")):
            message = self.refused("-i", "cloud.ply", "-f", VOXELIZE, *parameters)
            self.assertIn('The layer "cloud.ply" has no faces. Triangulate its points first', message)

    def test_no_volumes_and_slices_are_voxelized(self):
        write_ply(self.path("in.ply"), *sphere(hole=False))
        made = ("-i", "in.ply", "-f", VOXELIZE, "-p", "VoxelSize=0.2")
        for parameters in ((), ("-p", "VoxelSize=0.1")):
            message = self.refused(*made, "-f", VOXELIZE, *parameters)
            self.assertIn('The layer "in.ply volume" holds a range volume', message)
            self.assertIn("Make the layer of a mesh current", message)
            message = self.refused(*made, "-f", SLICE, "-f", VOXELIZE, *parameters)
            self.assertIn("shows a slice of a range volume. Make the layer of a mesh current.", message)

    def test_a_slice_that_is_too_large_for_a_layer(self):
        """Images of it can be written all the same."""
        write_ply(self.path("far.ply"), [(0, 0, 0), (1, 0, 0), (0, 1, 0), (4050, 4050, 0), (4051, 4050, 0), (4050, 4051, 0)],
                  [(0, 1, 2), (3, 4, 5)])
        made = ("-i", "far.ply", "-f", VOXELIZE, "-p", "VoxelSize=1")
        message = self.refused(*made, "-f", SLICE)
        self.assertIn("The slice has 4064 x 4064 pixels; a layer may have 16000000. Write images", message)
        self.check(0, *made, "-f", SLICE, "-p", "Axis=x", "-o", "out.ply")
        self.assertEqual(len(Ply(self.path("out.ply")).triangles), 2 * 4064 * 16)

    def test_what_was_not_observed_is_selected_and_has_no_weight(self):
        """And may be left as it is; the surface is the same."""
        write_ply(self.path("in.ply"), *sphere())
        made = ("-i", "in.ply", "-f", VOXELIZE, "-p", "VoxelSize=0.1", "-f", EXTRACT)
        self.check(0, *made, "-o", "all.ply", "--report", "report.json")
        figures = self.read_report()["filters"][1]["figures"]
        observed, bounded = figures["surface observed faces"], figures["surface boundary faces"]
        self.assertGreater(min(observed, bounded), 10)
        self.assertEqual(figures["surface filled faces"], 0)
        everything = Ply(self.path("all.ply"))
        self.assertEqual(len(everything.triangles), observed + bounded)
        self.check(0, *made, "-f", "Delete Selected Faces", "-o", "kept.ply")
        self.assertEqual(len(Ply(self.path("kept.ply")).triangles), observed)
        self.check(0, *made, "-p", "FilledSelected=false", "Measure=false", "-f", "Delete Selected Faces", "-o", "left.ply",
                   "--report", "report.json")
        self.assertEqual(Ply(self.path("left.ply")).triangles, everything.triangles)
        self.assertNotIn("surface genus", self.read_report()["filters"][1]["figures"])

    def test_an_extracted_surface_is_no_scan(self):
        write_ply(self.path("in.ply"), *grid())
        merge = ("-f", MERGE, "-p", "VoxelSize=0.1", "LineOfSight=Z axis of each layer")
        result = self.check(0, "-i", "in.ply", *merge, "-f", EXTRACT, *merge, "-o", "out.ply", "--report", "report.json")
        self.assertIn("Left out: range volume surface, a surface that was extracted from a volume", result.stdout)
        first, _, again = (entry["figures"] for entry in self.read_report()["filters"])
        self.assertEqual(again, first)

    def test_layers_far_apart(self):
        write_ply(self.path("here.ply"), *grid())
        write_ply(self.path("far.ply"), *grid(origin=(0, 1e6, 0)))
        message = self.refused("-i", "here.ply", "far.ply", "-f", MERGE, "-p", "VoxelSize=0.1")
        self.assertIn("The visible layers span 1e+07 voxels of 0.1 along y; at most 1048576 are possible", message)
        self.assertNotIn("memory", message)

    def test_a_camera_of_parallel_rays(self):
        """The scan is seen along its axis, wherever it stands."""
        write_ply(self.path("in.ply"), *grid())
        lines = []
        for place in ("0 0 9", "50 -20 400"):
            result = self.check(0, "-i", "in.ply", "-f", "Probe: Parallel Camera", "-p", f"From={place}",
                                "Towards=0.3 0 -1", "-f", MERGE, "-p", "VoxelSize=0.1",
                                "LineOfSight=Camera of each layer", "-o", "out.ply")
            lines.append(next(line for line in result.stdout.splitlines() if "; seen " in line))
        self.assertEqual(lines[0], lines[1])
        before, _, numbers = lines[0].partition("; seen along (")
        self.assertTrue(numbers, before)
        axis = tuple(map(float, numbers.rstrip(")").split()))
        for found, expected in zip(axis, (-0.3 / math.hypot(0.3, 1), 0, 1 / math.hypot(0.3, 1))):
            self.assertAlmostEqual(found, expected, places=3)

    def test_names_that_look_like_places_for_arguments(self):
        write_ply(self.path("scan %2 %11.ply"), *grid())
        result = self.check(0, "-i", "scan %2 %11.ply", "-f", MERGE, "-p", "VoxelSize=0.1", "LineOfSight=Own axis of each scan",
                            "-o", "out.ply")
        self.assertRegex(result.stdout, r"'scan %2 %11.ply': 126 faces, 0 dropped \(0 long, 0 grazing, 0 from behind, "
                                        r"0 degenerate\); seen along \(\S+ \S+ \S+\)")
        write_ply(self.path("mesh %2 %3.ply"), *sphere(hole=False))
        result = self.check(0, "-i", "mesh %2 %3.ply", "-f", VOXELIZE, "-p", "VoxelSize=0.2", "-f", SLICE, "-p",
                            "Axis=x", "Middle=false", "Position=5", "-o", "out.ply")
        self.assertIn("mesh %2 %3.ply volume x = 5: ", result.stdout)


if __name__ == "__main__":
    unittest.main()
