"""Our filters in MeshLab's own meshlabserver: holes closed, the input kept bit for bit, messages in the log."""
import math
import re
import sys
import unittest

import mesh_files
from meshlab import SOURCE, MeshLabTest, step

sys.path.insert(0, str(SOURCE / "tests/support"))
import range_scans  # noqa: E402

ELEPHANT = SOURCE / ".cache/data/elephant-with-holes.off"


class CloseHoles(MeshLabTest):
    def test_closes_both_holes(self):
        before, after, _ = self.assert_closes_the_band()
        self.assertGreater(len(after.positions), len(before.positions), "patches are refined")

    def test_keeps_colours_quality_and_normals(self):
        vertices, faces = mesh_files.band()
        path = self.folder / "coloured.ply"
        vertex_extra = [("float", "nx"), ("float", "ny"), ("float", "nz"), ("uchar", "red"), ("uchar", "green"),
                        ("uchar", "blue"), ("uchar", "alpha"), ("float", "quality")]
        face_extra = [("uchar", "red"), ("uchar", "green"), ("uchar", "blue"), ("uchar", "alpha"), ("float", "quality")]
        mesh_files.write_ply(
            path, vertices, faces, vertex_extra, face_extra,
            [(0.0, 0.6, 0.8, i % 256, 2 * i % 256, 3 * i % 256, 255, 0.5 * i) for i in range(len(vertices))],
            [(5 * i % 256, 7 * i % 256, i % 256, 255, 0.25 * i) for i in range(len(faces))])
        attributes = ("vc", "vq", "vn", "fc", "fq")
        before = self.untouched(path, attributes)
        self.assertIn(["uchar", "red"], before.properties["face"])
        run = self.close(path, attributes)
        after = self.assert_kept(before, run)
        self.assertTrue(mesh_files.is_closed_manifold(after.faces), run)

    def test_only_selected_holes(self):
        mesh = self.band()
        run = self.server(mesh, [step("Select Border"), step("Close Holes: Curve Unfolding", Selected="true")])
        self.assertIn("Closed 2 of 2 holes.", run.log)
        run = self.server(mesh, [step("Close Holes: Curve Unfolding", Selected="true")])
        self.assert_refused(run, "Close Holes: Curve Unfolding failed:", "elect")

    def test_holes_that_are_too_large_stay_open(self):
        mesh = self.band()
        before = self.untouched(mesh)
        for values in ({"MaxHoleEdges": 23}, {"MaxHolePerimeter": 0.01}):
            run = self.close(mesh, **values)
            after = self.assert_kept(before, run)
            self.assertEqual(len(after.faces), len(before.faces), run)
            self.assertIn("Closed 0 of 2 holes", run.log)

    def test_the_largest_hole_can_be_kept(self):
        vertices, faces = mesh_files.band()
        path = self.folder / "uneven.ply"
        mesh_files.write_ply(path, vertices, faces[2 * 24:])  # without the lowest ring: its hole is larger
        run = self.close(path, KeepLargest="true")
        after = self.assert_kept(self.untouched(path), run)
        self.assertEqual(mesh_files.boundary_edges(after.faces), 24, run)
        self.assertIn("Closed 1 of 2 holes", run.log)

    def test_a_second_run_finds_nothing_to_do(self):
        filter_step = step("Close Holes: Curve Unfolding")
        run = self.server(self.band(), [filter_step, filter_step])
        self.assertIn("The mesh has no holes: there is nothing to close.", run.log)

    def test_every_energy_and_unfolding(self):
        mesh = self.band(segments=16, rings=5)
        before = self.untouched(mesh)
        for values in ({"Energy": 1}, {"Energy": 2}, {"Weights": 1}, {"Unfolding": 1}, {"Unfolding": 2}):
            run = self.close(mesh, **values)
            after = self.assert_kept(before, run)
            self.assertTrue(mesh_files.is_closed_manifold(after.faces), run)

    def test_an_edge_length_is_kept_to(self):
        mesh = self.band()
        counts = []
        for length in (0.4, 0.05):
            run = self.close(mesh, EdgeLength=length)
            after = self.assert_kept(self.untouched(mesh), run)
            counts.append(len(after.faces))
        self.assertGreater(counts[1], 4 * counts[0])

    def test_parameters_out_of_range_are_refused(self):
        mesh = self.band()
        for values, message in (({"Restarts": 0}, 'Parameter "Restarts" must lie between 1 and 10000 runs; it is 0.'),
                                ({"MaxHoleEdges": -1}, 'Parameter "MaxHoleEdges" must lie between 0'),
                                ({"MaxHoleEdges": 2}, "at least 3"),
                                ({"EdgeLength": -0.5}, 'Parameter "EdgeLength" must be at least 0'),
                                ({"Energy": 3}, 'Parameter "Energy": 3 is not one of its 3 choices')):
            with self.subTest(**values):
                self.assert_refused(self.close(mesh, **values), message)

    def test_a_real_model(self):
        self.assertTrue(ELEPHANT.exists(), "scripts/fetch_demo.sh elephant-with-holes.off fetches this mesh")
        before = self.untouched(ELEPHANT)
        run = self.close(ELEPHANT)
        after = self.assert_kept(before, run)
        self.assertIn("Closed 106 of 106 holes.", run.log)
        self.assertEqual(mesh_files.boundary_edges(after.faces), 0, run)
        _, directed = mesh_files.edge_counts(after.faces[len(before.faces):])
        self.assertTrue(all(count == 1 for count in directed.values()), "new faces agree on their orientation")


class AtomicVolumes(MeshLabTest):
    filter = "Close Holes: Atomic Volumes"

    def test_closes_both_holes(self):
        _, _, run = self.assert_closes_the_band()
        self.assertRegex(run.log, r"Figures: leaves \d+, .*nodes \d+, .*depth \d+")

    def test_layers_of_points(self):
        """Layers are counted from 1; 0 is none. The last mesh is the current layer."""
        points = self.folder / "points.ply"
        mesh_files.write_ply(points, [(0.1, 0.0, 0.0)], [])
        run = self.close([points, self.band()], InsideLayer=1)
        self.assertTrue(run.saved, run)
        self.assertTrue(mesh_files.is_closed_manifold(mesh_files.Ply(run.output).faces), run)
        self.assert_refused(self.close([points, self.band()], InsideLayer=1, OutsideLayer=1), "is chosen twice")
        self.assert_refused(self.close([points, self.band()], InsideLayer=2), "the layer that the filter works on")
        self.assert_refused(self.close(self.band(), InsideLayer=7), "there is no layer 7")

    def test_faces_are_removed_in_the_new_layer_that_is_saved(self):
        """One rim edge is nearly a point: the cube that holds its ends is not simple at the depth limit."""
        vertices, faces = mesh_files.band()
        undirected, _ = mesh_files.edge_counts(faces)
        a, b = next(edge for edge, count in sorted(undirected.items()) if count == 1)
        vertices = list(vertices)
        vertices[b] = tuple(p + 1e-4 * (q - p) for p, q in zip(vertices[a], vertices[b]))
        path = self.folder / "pinched.ply"
        mesh_files.write_ply(path, vertices, faces)
        run = self.close(path, MaxDepth=8, DepthLimit=1)
        self.assertTrue(run.saved, run)
        self.assertRegex(run.log, r"The new layer lacks \d+ faces? of the input, counted from 0: \d+")
        listed = re.search(r"counted from 0: ([\d, ]+)", run.log)[1]
        removed = {int(number) for number in listed.split(",")}
        after = mesh_files.Ply(run.output)
        kept = [tuple(face) for number, face in enumerate(faces) if number not in removed]
        self.assertEqual([tuple(face) for face in after.faces[:len(kept)]], kept)
        self.assertTrue(mesh_files.is_closed_manifold(after.faces), run)

    def test_a_given_symmetry(self):
        run = self.close(self.band(), Symmetry=4, SymmetryPoint="0 0 0", SymmetryDirection="0 0 1")
        self.assertTrue(run.saved, run)
        self.assertIn("Symmetry: reflection", run.log)

    def test_parameters_out_of_range_are_refused(self):
        mesh = self.band()
        for values, message in (({"MaxDepth": 2}, 'Parameter "MaxDepth" must be 0, for any depth, or at least 3'),
                                ({"NodeBudget": 10}, 'Parameter "NodeBudget" must'),
                                ({"HintPrice": 0}, 'Parameter "HintPrice" must be greater than 0'),
                                ({"Fairing": 4}, 'Parameter "Fairing": 4 is not one of its 4 choices'),
                                ({"CarveLayers": "true"}, "no other visible layer has a camera")):
            with self.subTest(**values):
                self.assert_refused(self.close(mesh, **values), message)


class PoissonDriven(MeshLabTest):
    filter = "Close Holes: Poisson-driven"

    def test_closes_both_holes(self):
        before, after, run = self.assert_closes_the_band()
        self.assertGreater(len(after.positions), len(before.positions), "patches are refined")
        self.assertRegex(run.log, r"Figures: samples \d+, .*octree depth \d+, .*Delaunay vertices \d+")

    def test_guides(self):
        """A tube that faces its axis, through both holes of the band: they become one, and the band a ring."""
        vertices, faces = mesh_files.band()
        narrow = [(0.2 * x / math.hypot(x, y), 0.2 * y / math.hypot(x, y), 0.8 * z) for x, y, z in vertices]
        guide = self.folder / "guide.ply"
        mesh_files.write_ply(guide, narrow, [face[::-1] for face in faces])
        for values in ({"GuideLayer": 1}, {"GuideVisible": "true"}):
            with self.subTest(**values):
                run = self.close([guide, self.band()], Fairing=1, **values)
                self.assertTrue(run.saved, run)
                self.assertTrue(mesh_files.is_closed_manifold(mesh_files.Ply(run.output).faces), run)
                self.assertRegex(run.log, r"Hole 1 \(48 edges.*: closed")
                self.assertIn("Closed 1 of 1 hole.", run.log)
        self.assertIn('Guide: the layer "guide.ply"', run.log)
        self.assert_refused(self.close([guide, self.band()], GuideLayer=2), "the layer that the filter works on")
        self.assert_refused(self.close(self.band(), GuideLayer=7), "there is no layer 7")

    def test_every_choice(self):
        mesh = self.band(segments=16, rings=5)
        before = self.untouched(mesh)
        for values in ({"Boundary": 1}, {"Interpolation": 1}, {"Fairing": 1}, {"Fairing": 2}, {"Fairing": 3}):
            with self.subTest(**values):
                run = self.close(mesh, **values)
                after = self.assert_kept(before, run)
                self.assertTrue(mesh_files.is_closed_manifold(after.faces), run)

    def test_parameters_out_of_range_are_refused(self):
        mesh = self.band()
        points = self.folder / "points.ply"
        mesh_files.write_ply(points, [(0.1, 0.0, 0.0)], [])
        for values, message in (({"MinDepth": 0}, 'Parameter "MinDepth" must lie between 1 and 8 levels; it is 0.'),
                                ({"MaxDepth": 4}, "MaxDepth must lie between MinDepth and 16, or be 0"),
                                ({"Scale": 1}, "Scale must lie above 1 and be at most 10."),
                                ({"Screening": 0}, 'Parameter "Screening" must be greater than 0'),
                                ({"Samples": -1}, 'Parameter "Samples" must be greater than 0'),
                                ({"Rings": 101}, 'Parameter "Rings" must lie between 1 and 100 rings; it is 101.'),
                                ({"EdgeLength": -0.5}, 'Parameter "EdgeLength" must be at least 0'),
                                ({"Boundary": 2}, 'Parameter "Boundary": 2 is not one of its 2 choices'),
                                ({"Fairing": 5}, 'Parameter "Fairing": 5 is not one of its 5 choices'),
                                ({"GuideVisible": "true"}, "there is no other visible layer")):
            with self.subTest(**values):
                self.assert_refused(self.close(mesh, **values), message)
        self.assert_refused(self.close([points, mesh], GuideLayer=1), "points that have no normals")


class TriangleFan(MeshLabTest):
    filter = "Close Holes: Triangle Fan"

    def test_closes_both_holes(self):
        before, after, _ = self.assert_closes_the_band()
        self.assertEqual(len(after.positions), len(before.positions) + 2)
        self.assertEqual(len(after.faces), len(before.faces) + 48)

    def test_as_published(self):
        """A face between three vertices of one rim, and a second band that is not connected to the first."""
        vertices, faces = mesh_files.band()
        more, _ = mesh_files.band(radius=0.2, centre=(5.0, 0.0, 0.0), segments=24)
        spanning = (0, 8, 16)
        path = self.folder / "spanned.ply"
        small = [tuple(v + len(vertices) for v in face) for face in faces[:40]]
        mesh_files.write_ply(path, vertices + more, [spanning] + faces + small)
        run = self.close(path, AsPublished="true")
        self.assertTrue(run.saved, run)
        after = mesh_files.Ply(run.output)
        self.assertTrue(mesh_files.is_closed_manifold(after.faces), run)
        self.assertEqual([tuple(face) for face in after.faces[:len(faces)]], faces)
        self.assertIn("Removed 41 hole-spanning faces, in 2 pieces", run.log)
        self.assertRegex(run.log, r"The new layer lacks 41 faces of the input, counted from 0: 0, ")

    def test_parameters_out_of_range_are_refused(self):
        mesh = self.band()
        for values, message in (({"Spanning": 2}, 'Parameter "Spanning": 2 is not one of its 2 choices'),
                                ({"Spanning": 1}, '"Spanning" says which faces "AsPublished" removes')):
            with self.subTest(**values):
                self.assert_refused(self.close(mesh, **values), message)


class RangeVolumes(MeshLabTest):
    """From scans with poses in a project to a closed surface."""

    def scans(self):
        return range_scans.make_project(self.folder)

    def assert_surface(self, run):
        """One closed surface with one handle, where the solid ends."""
        self.assertTrue(run.saved, run)
        mesh = mesh_files.Ply(run.output)
        self.assertTrue(mesh_files.is_closed_manifold(mesh.faces), run)
        euler = len(mesh.positions) - len(mesh_files.edge_counts(mesh.faces)[0]) + len(mesh.faces)
        self.assertEqual(euler, 0, "a surface of genus 1")
        ball = [math.dist(point, (0, 0, 0)) for point in mesh.positions if point[0] < 0]
        self.assertLess(max(abs(radius - range_scans.RADIUS) for radius in ball), 0.06)
        return run.output.read_bytes()

    def test_merged_stripped_saved_and_opened(self):
        volume = self.folder / "volume.vdb"
        extract = step("Range Volume: Extract Surface")
        run = self.server(self.scans(), [
            step("Range Volume: Merge Scans"), step("Range Volume: Morphology", Operators="e60"),
            step("Range Volume: Save", File=volume), extract])
        surface = self.assert_surface(run)
        self.assertRegex(run.log, r"Volume of \d+ x \d+ x \d+ voxels of 0.06: \d+ seen, \d+ unseen, \d+ empty")
        self.assertRegex(run.log, r"After: \d+ vertices, \d+ faces, genus 1, 1 components, 0 boundary loops")
        self.assertTrue(volume.exists(), run)
        run = self.server(self.band(), [step("Range Volume: Open", File=volume), extract])
        self.assertEqual(self.assert_surface(run), surface)

    def test_the_selection_in_a_slice(self):
        """All of a slice is selected: the operator works everywhere."""
        run = self.server(self.scans(), [
            step("Range Volume: Merge Scans"), step("Range Volume: Slice"), step("Select All"),
            step("Range Volume: Morphology", Operators="e60", Box=3, Measure="false"),
            step("Range Volume: Extract Surface")])
        self.assert_surface(run)

    def test_images_of_slices(self):
        images = self.folder / "images"
        run = self.server(self.scans(), [step("Range Volume: Merge Scans"), step("Range Volume: Slice", Folder=images)])
        self.assertEqual(run.code, 0, run)
        depth = int(re.search(r"Volume of \d+ x \d+ x (\d+) voxels", run.log)[1])
        self.assertEqual(sorted(path.name for path in images.iterdir()), [f"z_{i:04}.png" for i in range(depth)])

    def test_a_mesh_with_holes_is_filled(self):
        run = self.server(self.band(), [
            step("Range Volume: Voxelize Mesh", VoxelSize=0.08), step("Range Volume: Fill", Iterations=40),
            step("Range Volume: Extract Surface")])
        self.assertTrue(run.saved, run)
        mesh = mesh_files.Ply(run.output)
        self.assertTrue(mesh_files.is_closed_manifold(mesh.faces), run)
        self.assertRegex(run.log, r"After: .* genus 0, 1 components, 0 boundary loops")


class CheckCompletion(MeshLabTest):
    def check(self, vertices, faces):
        path = self.folder / "checked.ply"
        mesh_files.write_ply(path, vertices, faces)
        before = self.untouched(path)
        run = self.server(path, [step("Check Completion")])
        self.assertEqual(run.code, 0, run)
        after = self.assert_kept(before, run)
        self.assertEqual(len(after.faces), len(before.faces))
        return run.log

    def test_says_what_is_open(self):
        self.assertRegex(self.check(*mesh_files.band(segments=20)), r"(?i)boundary.*\b40\b|\b20\b.*\b20\b")

    def test_counts_intersections(self):
        first, faces = mesh_files.band(segments=16, rings=7)
        second, _ = mesh_files.band(segments=16, rings=7, centre=(0.5, 0.0, 0.0))
        shifted = [tuple(corner + len(first) for corner in face) for face in faces]
        log = self.check(first + second, faces + shifted)
        self.assertRegex(log, r"(?i)intersect[^\n]*[1-9]|[1-9][^\n]*intersect")

    def test_after_closing_nothing_is_open(self):
        run = self.server(self.band(), [step("Close Holes: Curve Unfolding"), step("Check Completion")])
        self.assertEqual(run.code, 0, run)
        self.assertIn("Boundary edges: 0", run.log)


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))
