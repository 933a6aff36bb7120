"""The scripts at the top of the checkout: what they can say without installing or building anything."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("MESHCOMPLETE_SOURCE", Path(__file__).resolve().parents[2]))


def run(*command, cwd=None):
    return subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=60, check=False, cwd=cwd)


class Usage(unittest.TestCase):
    def assert_usage_error(self, *arguments, message):
        result = run(SOURCE / "complete", *arguments, cwd="/")
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn(message, result.stdout)

    def test_wrong_arguments(self):
        self.assert_usage_error("--nonsense", message="Unknown option: --nonsense")
        self.assert_usage_error("--filter", message="--filter needs the name of a filter.")
        self.assert_usage_error("only one file", message="Name an input and an output file, or neither.")
        self.assert_usage_error("a", "b", "c", message="Name an input and an output file, or neither.")
        self.assert_usage_error("no such file", "out.ply", message="The input file cannot be read: no such file")

    def test_help(self):
        for option in ("-h", "--help"):
            result = run(SOURCE / "complete", option)
            self.assertEqual(result.returncode, 0, result.stdout)
            self.assertIn("./complete INPUT OUTPUT [--filter NAME] [PARAMETER=VALUE ...]", result.stdout)
            self.assertNotIn("set -e", result.stdout)

    def test_install_knows_only_remove(self):
        self.assertEqual(run(SOURCE / "install", "--delete").returncode, 2)

    def test_every_plugin_is_installed(self):
        """The list of plugins that `install` handles is the list that the build makes."""
        common = (SOURCE / "scripts/common.sh").read_text()
        names = common.split("plugin_names=(")[1].split(")")[0].split()
        built = [path.parent.name for pattern in ("filter_*/filter_*.cpp", "tools/filter_*/filter_*.cpp")
                 for path in SOURCE.glob(pattern) if path.stem == path.parent.name]
        self.assertEqual(sorted(names), sorted(built))


class SourceLines(unittest.TestCase):
    def lines(self, name, text):
        with tempfile.TemporaryDirectory(prefix="apt sources ") as folder:
            path = Path(folder) / name
            path.write_text(text)
            result = run(SOURCE / "scripts/source_lines.sh", path, Path(folder) / "missing.list")
        self.assertEqual(result.returncode, 0, result.stdout)
        return result.stdout.splitlines()

    def test_one_line_format(self):
        self.assertEqual(
            self.lines("a.list", "# deb http://no bookworm main\n"
                                 "deb http://x/debian bookworm main contrib # comment\n"
                                 "deb [arch=amd64 signed-by=/k.gpg] https://y/debian bookworm-updates contrib main\n"
                                 "deb-src http://z/debian bookworm main\n"
                                 "deb https://vendor stable nonfree mainline\n"),
            ["deb-src [arch=amd64 signed-by=/k.gpg] https://y/debian bookworm-updates main",
             "deb-src http://x/debian bookworm main"])

    def test_deb822_format(self):
        self.assertEqual(
            self.lines("a.sources", "Types: deb deb-src\nURIs: http://x/debian\nSuites: bookworm bookworm-updates\n"
                                    "# a comment\nComponents: main contrib\nSigned-By: /k.gpg\n\n"
                                    "Types: deb\nEnabled: no\nURIs: http://off\nSuites: s\nComponents: main\n\n\n"
                                    "Types: deb\nURIs: http://y/sec\nSuites: sec\nComponents: main\n"
                                    "Signed-By:\n -----BEGIN PGP PUBLIC KEY BLOCK-----\n .\n abc\n\n"
                                    "Types: deb-src\nURIs: http://z\nSuites: s\nComponents: main\n"),
            ["deb-src [signed-by=/k.gpg] http://x/debian bookworm main",
             "deb-src [signed-by=/k.gpg] http://x/debian bookworm-updates main",
             "deb-src http://y/sec sec main"])

    def test_other_files_are_passed_over(self):
        self.assertEqual(self.lines("a.list.save", "deb http://x/debian bookworm main\n"), [])


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))
