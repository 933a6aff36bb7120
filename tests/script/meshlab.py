"""Runs MeshLab's own meshlabserver, with our plugins, on filter scripts."""
import os
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path
from xml.sax.saxutils import quoteattr

import mesh_files

SOURCE = Path(os.environ.get("MESHCOMPLETE_SOURCE", Path(__file__).resolve().parents[2]))
BUILD = Path(os.environ.get("MESHCOMPLETE_BUILD", SOURCE / "build"))
STAGED = BUILD / "meshlab-staged"

CLOSE_HOLES = [("RichBool", "Selected", "false"), ("RichInt", "MaxHoleEdges", "0"),
               ("RichAbsPerc", "MaxHolePerimeter", "0"), ("RichBool", "KeepLargest", "false"),
               ("RichBool", "NewFaceSelected", "false"), ("RichBool", "AsNewLayer", "false")]

BOX = [("RichEnum", "Box", "0"), ("RichPoint3f", "BoxFrom", "0 0 0"), ("RichPoint3f", "BoxTo", "0 0 0"),
       ("RichEnum", "SliceLayer", "0")]
DIFFUSION = [("RichInt", "Iterations", "100"), ("RichInt", "Reach", "32"), ("RichBool", "LineOfSight", "true"),
             ("RichBool", "Normals", "true")]
RESULT = [("RichBool", "Measure", "true"), ("RichBool", "AsNewLayer", "false")]

# MeshLab 2020.09 stops with an assertion unless a script gives every parameter, in the filter's order.
FILTERS = {
    "Close Holes: Curve Unfolding": CLOSE_HOLES + [
        ("RichEnum", "Energy", "0"), ("RichEnum", "Weights", "0"), ("RichEnum", "Unfolding", "0"),
        ("RichInt", "Restarts", "100"), ("RichInt", "Seed", "1"), ("RichAbsPerc", "EdgeLength", "0"),
        ("RichBool", "UnfoldedLayer", "false")],
    "Close Holes: Atomic Volumes": CLOSE_HOLES + [
        ("RichInt", "MaxDepth", "0"), ("RichEnum", "DepthLimit", "0"), ("RichInt", "NodeBudget", "5000000"),
        ("RichEnum", "Weight", "0"), ("RichInt", "Shifts", "3"), ("RichInt", "Seed", "1"), ("RichEnum", "InsideLayer", "0"),
        ("RichEnum", "OutsideLayer", "0"), ("RichEnum", "HintInsideLayer", "0"), ("RichEnum", "HintOutsideLayer", "0"),
        ("RichFloat", "HintPrice", "0.01"), ("RichBool", "CarveLayers", "false"), ("RichEnum", "Symmetry", "0"),
        ("RichPoint3f", "SymmetryPoint", "0 0 0"), ("RichPoint3f", "SymmetryDirection", "1 0 0"),
        ("RichInt", "SymmetryFold", "2"), ("RichFloat", "SymmetryPrice", "0.5"), ("RichEnum", "Smoothing", "1"),
        ("RichInt", "SmoothingIterations", "5"), ("RichBool", "MovingCentres", "false"), ("RichBool", "Remesh", "true"),
        ("RichEnum", "Fairing", "2"), ("RichAbsPerc", "EdgeLength", "0")],
    "Close Holes: Poisson-driven": CLOSE_HOLES + [
        ("RichEnum", "GuideLayer", "0"), ("RichBool", "GuideVisible", "false"), ("RichInt", "MinDepth", "5"),
        ("RichInt", "MaxDepth", "0"), ("RichFloat", "Scale", "2.2"), ("RichEnum", "Boundary", "0"),
        ("RichFloat", "Screening", "16"), ("RichFloat", "Samples", "4"), ("RichEnum", "Interpolation", "0"),
        ("RichBool", "PartialFill", "false"), ("RichInt", "RemoveRings", "0"), ("RichAbsPerc", "EdgeLength", "0"),
        ("RichInt", "Rings", "3"), ("RichAbsPerc", "CushionRadius", "0"), ("RichEnum", "Fairing", "0")],
    "Close Holes: Triangle Fan": CLOSE_HOLES + [("RichBool", "AsPublished", "false"), ("RichEnum", "Spanning", "0")],
    "Check Completion": [("RichBool", "SelfIntersections", "true")],
    "Range Volume: Merge Scans": [
        ("RichAbsPerc", "VoxelSize", "0.06"), ("RichAbsPerc", "Ramp", "0.18"), ("RichFloat", "MaxMemory", "4"),
        ("RichEnum", "LineOfSight", "4"), ("RichPoint3f", "Viewpoint", "0 0 0"), ("RichBool", "Carving", "true"),
        ("RichBool", "Surroundings", "true"),
        ("RichAbsPerc", "LongestEdge", "0"), ("RichFloat", "GrazingAngle", "75"), ("RichFloat", "GrazingPower", "1"),
        ("RichAbsPerc", "BoundaryFalloff", "0")],
    "Range Volume: Voxelize Mesh": [("RichAbsPerc", "VoxelSize", "0.1"), ("RichAbsPerc", "Ramp", "0"),
                                    ("RichFloat", "MaxMemory", "4")],
    "Range Volume: Open": [("RichOpenFile", "File", "")],
    "Range Volume: Save": [("RichSaveFile", "File", "")],
    "Range Volume: Morphology": [("RichString", "Operators", "d2 e2")] + BOX + DIFFUSION + RESULT,
    "Range Volume: Fill": DIFFUSION + BOX + RESULT,
    "Range Volume: Extract Surface": [("RichBool", "ObservedOnly", "false"), ("RichInt", "SmallestComponent", "0"),
                                      ("RichBool", "FilledSelected", "true"), ("RichBool", "Measure", "true")],
    "Range Volume: Slice": [("RichEnum", "Axis", "2"), ("RichBool", "Middle", "true"), ("RichInt", "Position", "0"),
                            ("RichEnum", "View", "0"), ("RichString", "Folder", "")],
    "Select All": [("RichBool", "allFaces", "true"), ("RichBool", "allVerts", "true")],
    "Select None": [("RichBool", "allFaces", "true"), ("RichBool", "allVerts", "true")],
    "Select Border": [],
}


def step(name, **values):
    """One filter of a script, with defaults for the parameters that are not given."""
    parameters = [(kind, key, str(values.pop(key, default))) for kind, key, default in FILTERS[name]]
    if values:
        raise KeyError(f"{name} has no parameter {sorted(values)}")
    return name, parameters


def script_text(steps):
    lines = ["<!DOCTYPE FilterScript>", "<FilterScript>"]
    for name, parameters in steps:
        lines.append(f" <filter name={quoteattr(name)}>")
        for kind, key, value in parameters:
            more = {"RichAbsPerc": ' min="0" max="1"', "RichEnum": ' enum_cardinality="1" enum_val0="x"',
                    "RichOpenFile": ' exts_cardinality="1" exts_val0="vdb"', "RichSaveFile": ' ext="vdb"'}.get(kind, "")
            held = f"value={quoteattr(value)}"
            if kind == "RichPoint3f":
                held = 'x="{}" y="{}" z="{}"'.format(*value.split())
            lines.append(f'  <Param type="{kind}" name="{key}" {held}{more}/>')
        lines.append(" </filter>")
    return "\n".join(lines + ["</FilterScript>", ""])


# Without -noreset the server starts anew when its only client has gone, and signals xvfb-run that it is ready again. If
# that comes while xvfb-run removes its temporary folder after a program that failed, it takes the program's exit code for
# rm's, ends with 5 instead, and leaves the server running.
SERVER_ARGUMENTS = "-screen 0 1280x1024x24 -noreset"


def run_in_display(command, folder, timeout=120):
    """Runs a program with a virtual display; returns its exit code and what it printed."""
    environment = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"}
    process = subprocess.Popen(["xvfb-run", "-a", "-s", SERVER_ARGUMENTS, *command], stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=folder, env=environment,
                               start_new_session=True)
    try:
        console = process.communicate(timeout=timeout)[0]
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        raise
    return process.returncode, console.decode(errors="replace")


class Run:
    """What one call of meshlabserver did."""

    def __init__(self, code, log, console, output):
        self.code, self.log, self.console, self.output = code, log, console, output

    @property
    def saved(self):
        return self.output.exists()

    def __str__(self):
        return f"exit code {self.code}\n--- log\n{self.log}\n--- console\n{self.console}"


class MeshLabTest(unittest.TestCase):
    """Gives every test a folder of its own (with a space in its name) and runs meshlabserver in it."""
    filter = "Close Holes: Curve Unfolding"

    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="mesh complete ")
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def server(self, mesh, steps, attributes=(), output="out.ply"):
        """Runs a script on a mesh, on several, each a layer, or on a project; the last layer is the current one."""
        out, log, script = self.folder / output, self.folder / "log.txt", self.folder / "script.mlx"
        for stale in (out, log):
            stale.unlink(missing_ok=True)
        meshes = mesh if isinstance(mesh, list) else [mesh]
        opened = ["-p" if str(mesh).endswith(".mlp") else "-i", *map(str, meshes)]
        arguments = ["-l", str(log), *opened, "-o", str(out)]
        if attributes:
            arguments += ["-m", *attributes]
        if steps:
            script.write_text(script_text(steps))
            arguments += ["-s", str(script)]
        code, console = run_in_display([str(STAGED / "bin/meshlabserver"), *arguments], self.folder)
        text = log.read_text(errors="replace") if log.exists() else ""
        return Run(code, text, console, out)

    def close(self, mesh, attributes=(), **values):
        return self.server(mesh, [step(self.filter, **values)], attributes)

    def band(self, **arguments):
        """A file with a band, which has two holes."""
        path = self.folder / "band.ply"
        mesh_files.write_ply(path, *mesh_files.band(**arguments))
        return path

    def untouched(self, mesh, attributes=()):
        """The mesh as MeshLab itself writes it when no filter has run."""
        run = self.server(mesh, [], attributes, output="untouched.ply")
        self.assertTrue(run.saved, run)
        return mesh_files.Ply(run.output)

    def assert_kept(self, before, run):
        self.assertTrue(run.saved, run)
        after = mesh_files.Ply(run.output)
        self.assertIsNone(mesh_files.difference(before, after), run)
        return after

    def assert_closes_the_band(self):
        mesh = self.band()
        before = self.untouched(mesh)
        run = self.close(mesh)
        after = self.assert_kept(before, run)
        self.assertTrue(mesh_files.is_closed_manifold(after.faces), run)
        self.assertIn("Closed 2 of 2 holes.", run.log)
        return before, after, run

    def assert_refused(self, run, *phrases):
        """The filter failed with this message: no crash, and nothing was written."""
        self.assertEqual(run.code, 255, run)
        self.assertFalse(run.saved, run)
        for phrase in phrases:
            self.assertIn(phrase, run.log, run)
