"""Our filters in MeshLab's window: found by its search, shown in its dialog, applied, and reported in its log.

The window is watched through its titles, through what MeshLab prints, and through the picture of the screen; the
pictures stay in gui-test/ in the build folder.
"""
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import mesh_files
from meshlab import BUILD, STAGED

PICTURES = BUILD / "gui-test"
CURVE_UNFOLDING = "Close Holes: Curve Unfolding"
ATOMIC_VOLUMES = "Close Holes: Atomic Volumes"
POISSON_DRIVEN = "Close Holes: Poisson-driven"
TRIANGLE_FAN = "Close Holes: Triangle Fan"
VOXELIZE = "Range Volume: Voxelize Mesh"


class Screen:
    """An X server of our own with a window manager."""

    def __init__(self):
        self.processes = []
        self.environment = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"}
        reading, writing = os.pipe()
        server = self.start(["Xvfb", "-displayfd", str(writing), "-screen", "0", "1280x1024x24", "+extension", "GLX"],
                            pass_fds=[writing])
        os.close(writing)
        with os.fdopen(reading) as pipe:
            number = pipe.readline().strip()
        if not number:
            raise RuntimeError(f"Xvfb did not start, exit code {server.poll()}")
        self.environment["DISPLAY"] = ":" + number
        self.start(["openbox"])

    def start(self, command, **arguments):
        arguments.setdefault("stdout", subprocess.DEVNULL)
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stderr=subprocess.STDOUT, env=self.environment,
                                   start_new_session=True, **arguments)
        self.processes.append(process)
        return process

    def close(self):
        for process in reversed(self.processes):
            # The server removes its socket from /tmp when it is asked to end.
            for how in (signal.SIGTERM, signal.SIGKILL):
                if process.poll() is None:
                    os.killpg(process.pid, how)
                try:
                    process.wait(timeout=10)
                    break
                except subprocess.TimeoutExpired:
                    pass

    def call(self, *command):
        result = subprocess.run(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.DEVNULL, text=True, timeout=30, check=False)
        return result.stdout

    def windows(self):
        """Window numbers by title."""
        found = {}
        for number in self.call("xdotool", "search", "--onlyvisible", "--name", ".").split():
            found[self.call("xdotool", "getwindowname", number).strip()] = number
        return found

    def size(self, window):
        geometry = self.call("xdotool", "getwindowgeometry", "--shell", window)
        return tuple(int(re.search(rf"{key}=(\d+)", geometry)[1]) for key in ("WIDTH", "HEIGHT"))

    def picture(self, name):
        path = PICTURES / f"{name}.png"
        self.call("import", "-window", "root", str(path))
        return path


def reddish_pixels(path):
    """How many pixels have the colour in which MeshLab shows selected faces."""
    pixels = subprocess.run(["convert", str(path), "-depth", "8", "rgb:-"], stdout=subprocess.PIPE, check=True).stdout
    count = 0
    for i in range(0, len(pixels) - 2, 3):
        red, green, blue = pixels[i], pixels[i + 1], pixels[i + 2]
        count += red > 150 and red - green > 50 and abs(green - blue) < 30
    return count


class Window(unittest.TestCase):
    def setUp(self):
        PICTURES.mkdir(parents=True, exist_ok=True)
        self.home = Path(tempfile.mkdtemp(prefix="mesh complete home "))
        self.addCleanup(shutil.rmtree, self.home, ignore_errors=True)
        self.screen = Screen()
        self.addCleanup(self.screen.close)
        self.screen.environment["HOME"] = str(self.home)
        self.log_path = self.home / "meshlab.log"

    def log(self):
        return self.log_path.read_text(errors="replace")

    def wait_for(self, what, condition, seconds=60):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            value = condition()
            if value:
                return value
            time.sleep(0.2)
        self.screen.picture("missing")
        return self.fail(f"waited {seconds} s for {what}; windows: {sorted(self.screen.windows())}; log:\n{self.log()}")

    def open(self, mesh):
        with open(self.log_path, "w", encoding="utf-8") as log:
            self.screen.start([str(STAGED / "bin/meshlab"), str(mesh)], stdout=log, cwd=self.home)
        self.wait_for("the mesh", lambda: "All files opened" in self.log())
        return self.wait_for("the main window", lambda: next(
            (number for title, number in self.screen.windows().items() if title.startswith("MeshLab 2020")), None))

    def open_dialog(self, main_window, pictures, name=CURVE_UNFOLDING):
        """Finds the filter as a user does: ctrl+f, its name, the first hit."""
        def search():
            self.screen.call("xdotool", "windowactivate", "--sync", main_window)
            self.screen.call("xdotool", "key", "ctrl+f")
            time.sleep(1)
            self.screen.call("xdotool", "key", "ctrl+a")
            self.screen.call("xdotool", "type", "--delay", "30", name)
            time.sleep(1.5)
            self.screen.picture(f"{pictures}-1-search")
            self.screen.call("xdotool", "key", "Down")
            time.sleep(0.3)
            self.screen.call("xdotool", "key", "Return")
            end = time.monotonic() + 10
            while time.monotonic() < end:
                if name in self.screen.windows():
                    return self.screen.windows()[name]
                time.sleep(0.2)
            return None
        dialog = self.wait_for("the filter's dialog", search, seconds=40)
        self.screen.picture(f"{pictures}-2-dialog")
        return dialog

    def apply(self, dialog):
        """The Apply button is the right one in the last row of the dialog."""
        width, height = self.screen.size(dialog)
        self.screen.call("xdotool", "mousemove", "--window", dialog, str(3 * width // 4), str(height - 22), "click", "1")

    def close_holes(self, name, pictures):
        mesh = self.home / "band.ply"
        mesh_files.write_ply(mesh, *mesh_files.band())
        main_window = self.open(mesh)
        before = reddish_pixels(self.screen.picture(f"{pictures}-0-opened"))
        dialog = self.open_dialog(main_window, pictures, name)
        self.apply(dialog)
        self.wait_for("the filter", lambda: f"Applied filter {name}" in self.log())
        self.assertIn("Closed 2 of 2 holes.", self.log())
        self.assertNotIn("Filter Failure", self.screen.windows())
        self.screen.call("xdotool", "windowclose", dialog)
        time.sleep(1)
        after = reddish_pixels(self.screen.picture(f"{pictures}-3-applied"))
        self.assertGreater(after, before + 2000, "the new faces are not shown as selected")

    def test_curve_unfolding(self):
        self.close_holes(CURVE_UNFOLDING, "curve-unfolding")

    def test_atomic_volumes(self):
        self.close_holes(ATOMIC_VOLUMES, "atomic-volumes")

    def test_poisson_driven(self):
        self.close_holes(POISSON_DRIVEN, "poisson-driven")

    def test_triangle_fan(self):
        self.close_holes(TRIANGLE_FAN, "triangle-fan")

    def test_range_volume(self):
        mesh = self.home / "band.ply"
        mesh_files.write_ply(mesh, *mesh_files.band())
        main_window = self.open(mesh)
        self.apply(self.open_dialog(main_window, "range-volume", VOXELIZE))
        self.wait_for("the filter", lambda: f"Applied filter {VOXELIZE}" in self.log())
        self.screen.picture("range-volume-3-applied")
        self.assertRegex(self.log(), r"Volume of \d+ x \d+ x \d+ voxels of \S+: \d+ seen, \d+ unseen, \d+ empty")
        self.assertNotIn("Filter Failure", self.screen.windows())

    def test_a_failure_is_a_message(self):
        mesh = self.home / "cloud.ply"
        mesh_files.write_ply(mesh, mesh_files.band()[0], [])
        main_window = self.open(mesh)
        self.apply(self.open_dialog(main_window, "failure"))
        self.wait_for("the message", lambda: "Filter Failure" in self.screen.windows())
        self.screen.picture("failure-3-message")
        self.assertIn("has no faces, it is a cloud of 216 points", self.log())
        self.screen.call("xdotool", "key", "Return")
        self.wait_for("the end of the message", lambda: "Filter Failure" not in self.screen.windows())
        self.assertIn("Filter failed", self.log())


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))
