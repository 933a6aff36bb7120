"""What the tests of the filters "Range Volume: ..." share: scans with poses, and what reports and logs say of volumes."""

import os
import pathlib
import re
import shutil
import struct
import sys
import tempfile

from runner_case import RunnerCase

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import range_scans  # noqa: E402

MERGE, VOXELIZE, OPEN, SAVE, MORPHOLOGY, FILL, EXTRACT, SLICE = (
    f"Range Volume: {name}"
    for name in ("Merge Scans", "Voxelize Mesh", "Open", "Save", "Morphology", "Fill", "Extract Surface", "Slice"))
VOXEL = 0.06
BANDS = ("-f", MERGE, "-p", f"VoxelSize={VOXEL}", "Ramp=0.18")
MERGED = (*BANDS, "LineOfSight=Z axis of each layer")
# What is unseen and open to the outside goes; what is left is the inside of the observed surface.
STRIPPED = ("-f", MORPHOLOGY, "-p", "Operators=e60", "Measure=false")


def add_camera(path, position):
    """Gives a binary PLY file a camera, as MeshLab stores it, that looks along -z from a position."""
    values = {"view_px": position[0], "view_py": position[1], "view_pz": position[2],
              "x_axisx": 1, "x_axisy": 0, "x_axisz": 0, "y_axisx": 0, "y_axisy": 1, "y_axisz": 0,
              "z_axisx": 0, "z_axisy": 0, "z_axisz": 1, "focal": 1, "scalex": 0.1, "scaley": 0.1, "centerx": 0, "centery": 0}
    whole = ("viewportx", "viewporty")
    bends = ("k1", "k2", "k3", "k4")
    header = ["element camera 1", *(f"property float {name}" for name in values),
              *(f"property int {name}" for name in whole), *(f"property float {name}" for name in bends), ""]
    before, after = path.read_bytes().split(b"element vertex", 1)
    rest, body = after.split(b"end_header\n", 1)
    camera = struct.pack(f"<{len(values)}f2i4f", *values.values(), 640, 480, 0, 0, 0, 0)
    path.write_bytes(before + "\n".join(header).encode() + b"element vertex" + rest + b"end_header\n" + camera + body)


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
