"""Broken and unusual meshes in MeshLab's own meshlabserver: no crash, a clear message, and the mesh as it was."""
import math
import sys
import unittest

import mesh_files
from meshlab import MeshLabTest, step


class BadInput(MeshLabTest):
    def mesh(self, vertices, faces, name="bad.ply"):
        path = self.folder / name
        mesh_files.write_ply(path, vertices, faces)
        return path

    def assert_only_added(self, path, **values):
        """Runs the filter: whatever it can close, the rest stays as MeshLab itself read it."""
        before = self.untouched(path)
        run = self.close(path, **values)
        self.assertEqual(run.code, 0, run)
        return before, self.assert_kept(before, run), run

    def test_point_cloud(self):
        path = self.mesh(mesh_files.band()[0], [])
        self.assert_refused(self.close(path), "has no faces, it is a cloud of 216 points", "Screened Poisson")
        self.assert_refused(self.server(path, [step("Check Completion")]), "has no faces")

    def test_empty_file(self):
        run = self.close(self.mesh([], []))
        self.assertIn(run.code, (0, 255), run)
        self.assertFalse(run.saved and len(mesh_files.Ply(run.output).faces), run)

    def test_truncated_file(self):
        path = self.mesh(*mesh_files.band())
        path.write_bytes(path.read_bytes()[:-100])
        run = self.close(path)
        self.assertNotIn(run.code, (134, 139), run)
        self.assertFalse(run.saved, run)

    def test_coordinates_that_are_not_numbers(self):
        vertices, faces = mesh_files.band()
        vertices[30] = (math.nan, 0.0, 0.0)
        vertices[80] = (0.0, math.inf, 0.0)
        run = self.close(self.mesh(vertices, faces))
        self.assertNotIn(run.code, (134, 139), run)
        if run.saved:  # MeshLab removed the vertices when it opened the file
            for position in mesh_files.Ply(run.output).positions:
                self.assertTrue(all(math.isfinite(coordinate) for coordinate in position))
        else:
            self.assertIn("infinite or not numbers", run.log)

    def test_moebius_strip(self):
        before, after, run = self.assert_only_added(self.mesh(*mesh_files.moebius()))
        self.assertEqual(len(after.faces), len(before.faces), run)
        self.assertIn("Closed 0 of 1 hole", run.log)
        self.assertRegex(run.log, r"NOT closed: .+|left open: .+")

    def test_rim_with_a_non_manifold_edge(self):
        vertices, faces = mesh_files.band()
        fin = len(vertices)
        # A third and a fourth face at an edge that ends at the lower rim, and a fin at an edge of the upper one.
        vertices = vertices + [(2.0, 0.0, -1.0), (2.0, 0.5, -1.0)]
        faces = faces + [(0, 24, fin), (24, 0, fin + 1)]
        before, after, run = self.assert_only_added(self.mesh(vertices, faces))
        undirected, _ = mesh_files.edge_counts(after.faces)
        self.assertEqual(sorted(count for count in undirected.values() if count > 2),
                         sorted(count for count in mesh_files.edge_counts(before.faces)[0].values() if count > 2), run)
        self.assertRegex(run.log, r"NOT closed: .+|left open: .+")

    def test_faces_without_area_at_the_rim(self):
        vertices, faces = mesh_files.band()
        middle = tuple((a + b) / 2 for a, b in zip(vertices[0], vertices[1]))
        needle = (0, len(vertices), 1)
        self.assert_only_added(self.mesh(vertices + [middle], faces + [needle]))

    def test_isolated_triangle_and_open_sheet(self):
        sheet = [(x / 4, y / 4, 0.0) for y in range(9) for x in range(9)]
        faces = [f for y in range(8) for x in range(8)
                 for f in ((9 * y + x, 9 * y + x + 1, 9 * y + x + 10), (9 * y + x, 9 * y + x + 10, 9 * y + x + 9))]
        sheet += [(5.0, 0.0, 0.0), (6.0, 0.0, 0.0), (5.0, 1.0, 0.0)]
        before, after, run = self.assert_only_added(self.mesh(sheet, faces + [(81, 82, 83)]))
        self.assertEqual(len(after.faces), len(before.faces), run)
        self.assertIn("Closed 0 of 2 holes", run.log)

    def test_triangle_soup(self):
        vertices, faces = mesh_files.band(segments=12, rings=4)
        soup = [vertices[corner] for face in faces for corner in face]
        path = self.mesh(soup, [(3 * f, 3 * f + 1, 3 * f + 2) for f in range(len(faces))])
        before, after, run = self.assert_only_added(path)
        self.assertEqual(len(after.faces), len(before.faces), run)

    def test_far_from_the_origin(self):
        _, after, run = self.assert_only_added(self.mesh(*mesh_files.band(centre=(1000.0, -2000.0, 500.0))))
        self.assertTrue(mesh_files.is_closed_manifold(after.faces), run)

    def test_very_large_and_very_small(self):
        for radius in (1e9, 1e-9):
            with self.subTest(radius=radius):
                _, after, run = self.assert_only_added(self.mesh(*mesh_files.band(radius=radius)))
                self.assertTrue(mesh_files.is_closed_manifold(after.faces), run)

    def test_unreferenced_vertices_keep_their_place(self):
        vertices, faces = mesh_files.band()
        moved = [tuple(corner + 3 for corner in face) for face in faces]
        _, after, run = self.assert_only_added(self.mesh([(9.0, 9.0, 9.0)] * 3 + vertices, moved))
        self.assertTrue(mesh_files.is_closed_manifold(after.faces), run)

    def test_polygons(self):
        vertices, faces = mesh_files.band()
        quads = [faces[i][:3] + (faces[i + 1][2],) for i in range(0, len(faces), 2)]
        _, after, run = self.assert_only_added(self.mesh(vertices, quads))
        self.assertIn("Closed 2 of 2 holes.", run.log)


class BadInputOfAtomicVolumes(BadInput):
    filter = "Close Holes: Atomic Volumes"

    def test_faces_without_area_at_the_rim(self):
        """No cube is small enough to keep apart what lies on one another: the budget ends it."""
        vertices, faces = mesh_files.band()
        middle = tuple((a + b) / 2 for a, b in zip(vertices[0], vertices[1]))
        path = self.mesh(vertices + [middle], faces + [(0, len(vertices), 1)])
        run = self.close(path, NodeBudget=100000)
        if run.saved:
            self.assert_kept(self.untouched(path), run)
        else:
            self.assert_refused(run, "NodeBudget")


class BadInputOfPoissonDriven(BadInput):
    filter = "Close Holes: Poisson-driven"


class BadInputOfTriangleFan(BadInput):
    filter = "Close Holes: Triangle Fan"


class BadInputOfRangeVolumes(MeshLabTest):
    def band_volume(self, *steps):
        return self.server(self.band(), [step("Range Volume: Voxelize Mesh"), *steps])

    def test_a_cloud_is_no_scan(self):
        points = self.folder / "points.ply"
        mesh_files.write_ply(points, mesh_files.band()[0], [])
        self.assert_refused(self.server(points, [step("Range Volume: Merge Scans")]), "has no faces")

    def test_voxel_sizes(self):
        for name, sight in (("Merge Scans", {"LineOfSight": 4}), ("Voxelize Mesh", {})):
            run = self.server(self.band(), [step(f"Range Volume: {name}", VoxelSize=0, **sight)])
            self.assert_refused(run, 'Parameter "VoxelSize" must be greater than 0')
            run = self.server(self.band(), [step(f"Range Volume: {name}", VoxelSize=1e-5, **sight)])
            self.assert_refused(run, "Voxels of 1e-05 would need about", "would fit")

    def test_no_volume(self):
        for name in ("Morphology", "Fill", "Extract Surface", "Slice"):
            run = self.server(self.band(), [step(f"Range Volume: {name}")])
            self.assert_refused(run, 'The layer "band.ply" holds no range volume.')

    def test_boxes_and_operators(self):
        morphology = "Range Volume: Morphology"
        self.assert_refused(self.band_volume(step(morphology, Operators="d2 q1")), 'Unknown operator "q"')
        self.assert_refused(self.band_volume(step(morphology, Box=3)), "No face of a slice of this volume is selected")
        self.assert_refused(self.band_volume(step(morphology, Box=1, BoxFrom="900 900 900", BoxTo="901 901 901")),
                            "lies outside the volume")

    def test_files(self):
        volume = self.folder / "volume.vdb"
        for content in (None, b"", b"no volume at all\n" * 100):
            if content is not None:
                volume.write_bytes(content)
            self.assert_refused(self.server(self.band(), [step("Range Volume: Open", File=volume)]), str(volume))
        self.assert_refused(self.band_volume(step("Range Volume: Save", File=self.folder / "nowhere/volume.vdb")),
                            "cannot be written")


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))
