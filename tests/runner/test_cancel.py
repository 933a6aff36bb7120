"""Ctrl-C at any moment: exit code 130 or done, the output whole or absent, nothing left behind."""

import os
import random
import signal
import subprocess
import time
import unittest

from runner_case import Ply, RunnerCase, grid, write_ply

PROBE = "Probe: Everything"


class Cancel(RunnerCase):
    def interrupt(self, delay, *arguments, signals=(signal.SIGINT,), gap=0.3):
        """Starts the program and sends it signals; returns exit code, stderr and seconds it took to end."""
        process = subprocess.Popen(self.command(*arguments), cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        time.sleep(delay)
        start = time.monotonic()
        for number, what in enumerate(signals):
            if number:
                time.sleep(gap)
            process.send_signal(what)
        _, errors = process.communicate(timeout=60)
        code = process.returncode
        # A signal that comes before the program's first line ends it as it ends any program; shells call that 130, too.
        if code == -signal.SIGINT and not errors:
            code = 130
        return code, errors, time.monotonic() - start

    def test_random_moments(self):
        vertices, faces = grid(400)
        write_ply(self.path("big.ply"), vertices, faces)
        arguments = ("-i", "big.ply", "-f", PROBE, "-p", "Seconds=0.1", "-o", "out.ply", "-o", "out.obj", "--report",
                     "report.json")
        start = time.monotonic()
        self.check(0, *arguments)
        whole = time.monotonic() - start
        random.seed(7)
        codes = []
        for _ in range(20):
            for name in ("out.ply", "out.obj", "report.json"):
                if os.path.exists(self.path(name)):
                    os.remove(self.path(name))
            delay = random.uniform(0.02, 1.05 * whole)
            code, errors, _ = self.interrupt(delay, *arguments)
            with self.subTest(delay=delay, errors=errors):
                self.assertIn(code, (0, 130))
                self.assert_no_junk()
                for name in ("out.ply", "out.obj"):
                    self.assertEqual(os.path.exists(self.path(name)), code == 0)
                if code == 0:
                    self.assertEqual(len(Ply(self.path("out.ply")).triangles), len(faces) + 1)
                elif os.path.exists(self.path("report.json")):
                    self.assertEqual(self.read_report()["status"], "cancelled")
            codes.append(code)
        self.assertIn(130, codes)

    def test_filter_stops_soon_and_reports(self):
        for what in (signal.SIGINT, signal.SIGTERM):
            self.make_sphere()
            code, errors, seconds = self.interrupt(0.5, "-i", "sphere.ply", "-f", PROBE, "-p", "Seconds=30", "-o", "out.ply",
                                                   "--report", "report.json", signals=(what,))
            self.assertEqual(code, 130, errors)
            self.assertLess(seconds, 5)
            self.assertIn("Cancelled", errors)
            self.assertFalse(os.path.exists(self.path("out.ply")))
            self.assertEqual(self.read_report()["exit_code"], 130)

    def test_second_signal_ends_a_deaf_filter(self):
        self.make_sphere()
        code, errors, seconds = self.interrupt(0.5, "-i", "sphere.ply", "-f", "Probe: Bad Code", "-p", "How=deaf", "-o",
                                               "out.ply", "--report", "report.json", signals=(signal.SIGINT, signal.SIGINT))
        self.assertEqual(code, 130, errors)
        self.assertLess(seconds, 5)
        self.assertEqual(self.read_report()["status"], "cancelled")

    def test_old_output_survives(self):
        self.make_sphere()
        self.make_sphere("out.ply", hole=False)
        with open(self.path("out.ply"), "rb") as file:
            before = file.read()
        self.interrupt(0.3, "-i", "sphere.ply", "-f", PROBE, "-p", "Seconds=30", "-o", "out.ply")
        with open(self.path("out.ply"), "rb") as file:
            self.assertEqual(file.read(), before)


if __name__ == "__main__":
    unittest.main()
