"""Includes run downward only: the core knows nothing of the filters, and neither knows MeshLab, Qt or vcg."""
import os
import re
import sys
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("MESHCOMPLETE_SOURCE", Path(__file__).resolve().parents[2]))
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
HOST_HEADER = re.compile(
    r"^(Q[A-Z]\w*|Qt\w*/.*|vcg/.*|wrap/.*|GL/.*|common/(interfaces|meshmodel|ml_mesh_type)\.h"
    r"|.*(mlapplication|pluginmanager)\.h)$")
THIRD_PARTY_IN_SOURCES_ONLY = re.compile(r"^(CGAL|boost|tbb|maxflow|openvdb)/")
GRIDS = SOURCE / "filter_volmorph/volume_grids.h"  # for sources beside it


def files(*folders):
    for folder in folders:
        for path in sorted((SOURCE / folder).glob("**/*")):
            if path.suffix in (".h", ".cpp"):
                yield path


def includes(path):
    return [match[1] for match in INCLUDE.findall(path.read_text())]


def filter_folders():
    return sorted(path.name for path in SOURCE.glob("filter_*") if path.is_dir())


def is_plugin(path):
    """filter_<name>/filter_*.{h,cpp}: the only files of a filter that know MeshLab."""
    return path.stem.startswith("filter_")


class IncludesRunDownward(unittest.TestCase):
    def assert_none(self, paths, forbidden, why):
        seen = 0
        for path in paths:
            seen += 1
            for name in includes(path):
                if forbidden(name):
                    self.fail(f"{path.relative_to(SOURCE)} includes {name}: {why}")
        self.assertGreater(seen, 0, "no files were looked at")

    def test_core_knows_only_itself(self):
        ours = ("common/host/", "filter_", "tools/", "tests/", "benchmarks/")
        self.assert_none(files("common/core"), lambda name: name.startswith(ours) or HOST_HEADER.match(name),
                         "the core is below everything else")

    def test_algorithms_know_the_core_and_themselves(self):
        for folder in filter_folders():
            algorithm = [path for path in files(folder) if not is_plugin(path)]
            self.assert_none(
                algorithm,
                lambda name, folder=folder: HOST_HEADER.match(name)
                or name.startswith(("common/host/", "tools/", "tests/", "benchmarks/"))
                or (name.startswith("filter_") and not name.startswith(folder + "/"))
                or name == f"{folder}/{folder}.h",
                "an algorithm knows no Qt, no MeshLab, no vcg and no other filter")

    def test_host_knows_the_core_and_meshlab(self):
        self.assert_none(files("common/host"), lambda name: name.startswith(("filter_", "tools/", "tests/")),
                         "the host is below the plugins")

    def test_meshlab_is_included_through_one_header(self):
        allowed = SOURCE / "common/host/meshlab_version.h"
        everything = [p for p in files("common", "tools", *filter_folders()) if p != allowed]
        self.assert_none(everything, lambda name: re.match(r"common/(interfaces|plugins/.*|meshmodel)\b", name)
                         and not (SOURCE / name).exists(), "MeshLab's version is known in one place")

    def test_heavy_libraries_stay_in_sources(self):
        headers = [path for path in files("common/core", *filter_folders())
                   if path.suffix == ".h" and path != GRIDS]
        self.assert_none(headers, lambda name: THIRD_PARTY_IN_SOURCES_ONLY.match(name),
                         "headers need the standard library and Eigen only")
        users = [path for path in files("common", "tools", *filter_folders())
                 if path.suffix == ".h" or path.parent != GRIDS.parent]
        self.assert_none(users, lambda name: SOURCE / name == GRIDS, "it brings OpenVDB")

    def test_meshlab_release_is_decided_on_in_one_header(self):
        conditional = re.compile(r"^\s*#\s*(if|elif).*MESHCOMPLETE_MESHLAB", re.MULTILINE)
        for path in files("common", "tools", *filter_folders()):
            if path.name != "meshlab_version.h":
                self.assertIsNone(conditional.search(path.read_text()), path)


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))
