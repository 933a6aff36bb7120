"""Wrong usage, suggestions, --list, --describe, and the report."""

import os
import unittest

from runner_case import RunnerCase

PROBE = "Probe: Everything"


class Usage(RunnerCase):
    def complain(self, *arguments):
        """Runs something wrong; returns what the program said."""
        result = self.check(2, *arguments)
        self.assertFalse(os.path.exists(self.path("out.ply")))
        self.assertEqual(len(result.stderr.strip().split("\n")), 1, result.stderr)
        return result.stderr

    def setUp(self):
        super().setUp()
        self.make_sphere()

    def test_nothing_to_do(self):
        self.assertIn("--help", self.complain())
        self.assertIn("-o", self.complain("-i", "sphere.ply"))

    def test_help_and_version(self):
        self.assertIn("--report", self.check(0, "--help").stdout)
        self.assertRegex(self.check(0, "--version").stdout, r"^meshcomplete \d+\.\d+\.\d+ for MeshLab 20\d\d\.\d\d\n$")

    def test_unknown_option_suggests(self):
        self.assertIn('Did you mean "--report"?', self.complain("--reprot", "x"))

    def test_option_without_value(self):
        for option in ("-i", "-o", "-s", "-f", "-p", "-w", "-l", "--report", "--threads", "--describe"):
            self.assertIn(option, self.complain(option))

    def test_unknown_filter_suggests_ours_and_meshlabs(self):
        self.assertIn('Did you mean "Probe: Everything"?', self.complain("-i", "sphere.ply", "-f", "Probe: Evrything"))
        self.assertIn('Did you mean "Close Holes"?', self.complain("-i", "sphere.ply", "-f", "Close Hols", "-o", "out.ply"))

    def test_unknown_parameter_suggests(self):
        text = self.complain("-i", "sphere.ply", "-f", PROBE, "-p", "Cuont=3", "-o", "out.ply")
        self.assertIn('Did you mean "Count"?', text)
        result = self.check(2, "-i", "sphere.ply", "-f", "Close Holes", "-p", "MaxHolSize=3", "-o", "out.ply")
        self.assertIn('Did you mean "MaxHoleSize"?', result.stderr)
        self.assertFalse(os.path.exists(self.path("out.ply")))

    def test_parameter_twice_or_without_filter(self):
        self.assertIn("twice", self.complain("-i", "sphere.ply", "-f", PROBE, "-p", "Count=3", "Count=4"))
        self.assertIn("-f NAME", self.complain("-i", "sphere.ply", "-p", "Count=3"))

    def test_missing_folder_and_unknown_formats(self):
        self.assertIn("There is no file", self.complain("-i", "nowhere.ply", "-o", "out.ply"))
        self.assertIn("is a folder", self.complain("-i", self.folder, "-o", "out.ply"))
        with open(self.path("mesh.plx"), "w") as file:
            file.write("ply")
        self.assertIn('Did you mean "ply"?', self.complain("-i", "mesh.plx", "-o", "out.ply"))
        self.assertIn("does not write", self.complain("-i", "sphere.ply", "-o", "out.xyzzy"))
        self.assertIn("no folder", self.complain("-i", "sphere.ply", "-o", "nowhere/out.ply"))
        os.mkdir(self.path("folder.ply"))
        self.assertIn("is a folder", self.complain("-i", "sphere.ply", "-o", "folder.ply"))
        self.assertIn("twice", self.complain("-i", "sphere.ply", "-o", "out.ply", "-o", "./out.ply"))

    def test_wrong_attribute_layer_and_threads(self):
        self.assertIn("vq", self.complain("-i", "sphere.ply", "-o", "out.ply", "-m", "vz"))
        self.assertIn("belongs behind", self.complain("-i", "sphere.ply", "-m", "vc"))
        self.assertIn("1 to 1024", self.complain("-i", "sphere.ply", "-o", "out.ply", "--threads", "0"))
        result = self.check(2, "-i", "sphere.ply", "-o", "out.ply", "-l", "7")
        self.assertIn("1 layers", result.stderr)

    def test_bad_scripts(self):
        for name, text, expected in (("a.mlx", "hello", "not XML"), ("b.mlx", "<a/>", "FilterScript"),
                                     ("c.mlx", "<FilterScript/>", "no filters"),
                                     ("d.mlx", "<FilterScript><filter/></FilterScript>", "no name"),
                                     ("e.mlx", "<FilterScript><xmlfilter name='a'/></FilterScript>", "xmlfilter")):
            with open(self.path(name), "w") as file:
                file.write(text)
            self.assertIn(expected, self.complain("-i", "sphere.ply", "-s", name, "-o", "out.ply"))
        self.assertIn("cannot be read", self.complain("-i", "sphere.ply", "-s", "nowhere.mlx", "-o", "out.ply"))

    def test_filter_without_mesh(self):
        self.assertIn("mesh", self.check(1, "-f", PROBE, "-o", "out.ply").stderr)

    def test_report_of_wrong_usage(self):
        self.check(2, "-i", "nowhere.ply", "-o", "out.ply", "--report", "report.json")
        report = self.read_report()
        self.assertEqual((report["exit_code"], report["status"]), (2, "wrong usage"))
        self.assertIn("nowhere.ply", report["message"])
        self.assertIn("cannot be written", self.complain("-i", "sphere.ply", "-o", "out.ply", "--report", "nowhere/r.json"))


class Descriptions(RunnerCase):
    def test_list(self):
        lines = self.check(0, "--list").stdout.split("\n")
        self.assertLess(lines.index("  Probe: Everything"), lines.index("  Close Holes"))

    def test_describe_ours(self):
        lines = self.check(0, "--describe", PROBE).stdout
        self.assertIn("\n  Count\n", lines)
        text = " ".join(lines.split())
        for part in ("Does what its parameters say.", "See: nobody.", "0 to 100", "unit: edges",
                     "default: 5", "Count: A number.", "1 = annealing", "default: annealing", "default: a quarter",
                     "per cent of the diagonal", "default: true"):
            self.assertIn(part, text)
        self.assertNotIn("<", text)

    def test_describe_meshlabs(self):
        text = self.check(0, "--describe", "Close Holes").stdout
        for part in ("  MaxHoleSize\n", "whole number; default: 30", "true or false"):
            self.assertIn(part, text)

    def test_describe_a_range_whose_minimum_is_not_allowed(self):
        merge = "Range Volume: Merge Scans"
        text = " ".join(self.check(0, "--describe", merge).stdout.split())
        self.assertIn("GrazingAngle number; above 0, up to 90; unit: degrees; default: 75", text)
        self.assertIn("MaxMemory number; greater than 0; unit: gigabytes; default: 4", text)
        self.make_sphere()
        said = self.check(2, "-i", "sphere.ply", "-f", merge, "-p", "GrazingAngle=0", "-o", "out.ply").stderr
        self.assertIn("above 0, up to 90", said)

    def test_describe_unknown(self):
        self.assertIn('Did you mean "Probe: Everything"?', self.check(2, "--describe", "everything").stderr)

    def test_every_filter_can_be_described(self):
        self.check(0, "-d", "all.txt")
        with open(self.path("all.txt")) as file:
            text = file.read()
        for name in self.check(0, "--list").stdout.split("\n"):
            if name.startswith("  "):
                self.assertIn(name.strip() + "\n", text)


class Report(RunnerCase):
    def run_probe(self, code, *parameters):
        self.make_sphere()
        self.check(code, "-i", "sphere.ply", "-f", PROBE, *sum((["-p", p] for p in parameters), []), "-o", "out.ply",
                   "--report", "report.json")
        return self.read_report()

    def test_contents(self):
        report = self.run_probe(0, "Outcome=closed", "Seconds=0.05")
        self.assertEqual((report["exit_code"], report["status"], report["message"]), (0, "done", ""))
        (hole,) = report["holes"]
        self.assertEqual(hole, {"filter": PROBE, "loops": [0, 2], "edges": 7, "perimeter": None, "centre": [1, 2, 3],
                                "outcome": "closed", "route": 'probe "route"', "reason": "", "vertices_added": 0,
                                "faces_added": 1})
        self.assertEqual(report["totals"], {"holes": 1, "closed": 1, "partial": 0, "skipped": 0, "failed": 0,
                                            "vertices_added": 0, "faces_added": 1})
        (ran,) = report["filters"]
        self.assertEqual(ran["parameters"]["Kind"], "annealing")
        self.assertEqual(ran["parameters"]["Count"], "5")
        self.assertEqual(ran["notes"], ["a note"])
        self.assertEqual(ran["figures"], {"some number": 0.5, "no number": None})
        self.assertTrue(ran["done"])
        self.assertGreaterEqual(ran["seconds"], 0.05)
        (read,), (written,) = report["inputs"], report["outputs"]
        self.assertEqual(written["faces"], read["faces"] + 1)
        self.assertEqual([stage["stage"] for stage in report["stages"]], ["load", "probing", "save"])
        self.assertGreater(report["peak_memory_mb"], 5)
        self.assertGreaterEqual(report["seconds"]["total"], report["seconds"]["filters"])

    def test_exit_code_follows_the_holes(self):
        for outcome, code in (("closed", 0), ("skipped", 0), ("partial", 0), ("failed", 3)):
            with self.subTest(outcome):
                report = self.run_probe(code, "Outcome=" + outcome)
                self.assertEqual(report["exit_code"], code)
                self.assertTrue(os.path.exists(self.path("out.ply")))
                os.remove(self.path("out.ply"))

    def test_open_holes_are_printed_also_when_quiet(self):
        self.make_sphere()
        result = self.check(3, "-i", "sphere.ply", "-f", PROBE, "-p", "Outcome=failed", "-o", "out.ply", "--quiet")
        self.assertIn("hole 1 (7 edges, near 1, 2, 3) is open: because of", result.stderr)
        self.assertIn("1 of 1 holes were left open", result.stderr)
        self.assertEqual(result.stdout, "")

    def test_quiet_says_nothing(self):
        self.make_sphere()
        result = self.check(0, "-i", "sphere.ply", "-f", PROBE, "-o", "out.ply", "-q")
        self.assertEqual((result.stdout, result.stderr), ("", ""))

    def test_failed_filter_writes_report_and_nothing_else(self):
        report = self.run_probe(1, "Fail=true")
        self.assertEqual((report["exit_code"], report["status"]), (1, "failed"))
        self.assertIn("told to fail", report["message"])
        self.assertFalse(report["filters"][0]["done"])
        self.assertFalse(os.path.exists(self.path("out.ply")))

    def test_crashes_are_failures(self):
        self.make_sphere()
        for how in ("crash", "abort", "throw"):
            with self.subTest(how):
                self.check(1, "-i", "sphere.ply", "-f", "Probe: Bad Code", "-p", "How=" + how, "-o", "out.ply",
                           "--report", "report.json")
                self.assertIn("Probe: Bad Code", self.read_report()["message"])
                self.assertFalse(os.path.exists(self.path("out.ply")))
                os.remove(self.path("report.json"))

    def test_log_goes_to_stdout_and_to_the_log_file(self):
        self.make_sphere()
        for _ in range(2):
            result = self.check(0, "-i", "sphere.ply", "-f", PROBE, "-o", "out.ply", "-l", "c", "-l", "run.log")
            self.assertIn("Count=5", result.stdout)
        with open(self.path("run.log")) as file:
            self.assertEqual(file.read().count("Count=5"), 2)


if __name__ == "__main__":
    unittest.main()
