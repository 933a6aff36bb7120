"""Parameter values, scripts, and mixing filters."""

import math
import unittest

from runner_case import Ply, RunnerCase, write_ply

PROBE = "Probe: Everything"
LAYERS = "Probe: Layers"


class Values(RunnerCase):
    def setUp(self):
        super().setUp()
        self.vertices, self.faces = self.make_sphere()

    def logged(self, *parameters, **options):
        """The values that the filter got."""
        result = self.check(0, "-i", "sphere.ply", "-f", PROBE, "-p", *parameters, "-o", "out.ply", **options)
        (line,) = [line for line in result.stdout.split("\n") if line.startswith("Count=")]
        return dict(part.split("=", 1) for part in line.split(" "))

    def wrong(self, parameter):
        return self.check(2, "-i", "sphere.ply", "-f", PROBE, "-p", parameter, "-o", "out.ply").stderr

    def test_numbers(self):
        self.assertEqual(self.logged("Count=0")["Count"], "0")
        self.assertEqual(self.logged("Count= 100 ")["Count"], "100")
        self.assertEqual(float(self.logged("Real=-1.5e-3")["Real"]), -0.0015)
        for bad, expected in (("Count=101", "out of range"), ("Count=-1", "out of range"), ("Count=5.5", "whole number"),
                              ("Count=", "whole number"), ("Count=99999999999", "too large"), ("Real=1,5", "point"),
                              ("Real=nan", "too large"), ("Real=1e39", "too large"), ("Real=x", "not a number")):
            with self.subTest(bad):
                self.assertIn(expected, self.wrong(bad))

    def test_booleans(self):
        for yes in ("true", "True", "1", "yes", "on"):
            result = self.run_program("-i", "sphere.ply", "-f", PROBE, "-p", "Fail=" + yes)
            self.assertEqual(result.returncode, 1)
        for no in ("false", "0", "no", "OFF"):
            self.logged("Fail=" + no)
        self.assertIn("neither true nor false", self.wrong("Fail=2"))

    def test_lengths(self):
        self.assertEqual(float(self.logged("Length=0.125")["Length"]), 0.125)
        diagonal = math.dist(*[[pick(v[axis] for v in self.vertices) for axis in range(3)] for pick in (min, max)])
        self.assertAlmostEqual(float(self.logged("Length=2%")["Length"]), 0.02 * diagonal, places=5)
        self.assertIn("out of range", self.wrong("Length=-1"))
        self.assertIn("not a number", self.wrong("Length=two%"))

    def test_choices(self):
        self.assertEqual(self.logged("Kind=2")["Kind"], "2")
        self.assertEqual(self.logged("Kind=Automatic")["Kind"], "0")
        self.assertEqual(self.logged("Kind=anneal")["Kind"], "1")
        self.assertIn("is not one of the choices", self.wrong("Kind=a"), "automatic and annealing begin so")
        self.assertIn('Did you mean "descent"?', self.wrong("Kind=decsent"))
        self.assertIn("0 = automatic", self.wrong("Kind=3"))

    def test_text_is_taken_as_it_is(self):
        self.assertEqual(self.logged("Text=a=b'\"<&>")["Text"], "a=b'\"<&>")
        self.assertEqual(self.logged("Text=")["Text"], "")

    def test_decimal_comma_locales(self):
        for locale in ("de_DE.UTF-8", "fr_FR", "C", "tr_TR.UTF-8"):
            values = self.logged("Real=1.25", environment={"LC_ALL": locale, "LANG": locale})
            self.assertEqual(values["Real"], "1.25")

    def test_defaults_equal_explicit_defaults(self):
        self.logged("Count=5")
        implicit = Ply(self.path("out.ply"))
        self.logged("Fail=false", "Change=true", "Count=5", "Real=0.5", "Seconds=0", "Length=0.25", "Kind=annealing",
                    "Outcome=closed", "Text=abc")
        explicit = Ply(self.path("out.ply"))
        self.assertEqual(implicit.elements, explicit.elements)


class LayersAndPoints(RunnerCase):
    def setUp(self):
        super().setUp()
        write_ply(self.path("cloud.ply"), [(0, 0, 0), (1, 2, 3)], [])
        write_ply(self.path("box.ply"), [(0, 0, 0), (4, 0, 0), (0, 2, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3)])

    def logged(self, *parameters, inputs=("cloud.ply", "box.ply")):
        options = ["-p", *parameters] if parameters else []
        result = self.check(0, "-i", *inputs, "-f", LAYERS, *options, "-o", "out.ply", "--report", "report.json")
        return next(line for line in result.stdout.split("\n") if line.startswith("Other="))

    def wrong(self, *parameters):
        return self.check(2, "-i", "cloud.ply", "box.ply", "-f", LAYERS, "-p", *parameters, "-o", "out.ply").stderr

    def test_layers_by_number_and_name(self):
        for given in ("0", "cloud.ply"):
            self.assertEqual(self.logged("Other=" + given), "Other=cloud.ply Points=2 Views=0 Place=2 1 0.5.")
            self.assertEqual(self.read_report()["filters"][0]["parameters"]["Other"], "cloud.ply")
        self.assertIn("there are 2 layers", self.wrong("Other=2"))
        self.assertIn("there are 2 layers", self.wrong("Other=-1"))
        self.assertIn('Did you mean "cloud.ply"?', self.wrong("Other=clowd.ply"))
        result = self.check(1, "-i", "cloud.ply", "box.ply", "-f", LAYERS, "-p", "Other=1", "-o", "out.ply")
        self.assertIn('names "box.ply", the layer that the filter works on', result.stderr)

    def test_none_is_the_default(self):
        for parameters in ((), ("Other=none",), ("Other=None",)):
            self.assertEqual(self.logged(*parameters), "Other=none Points=0 Views=0 Place=2 1 0.5.")
            self.assertEqual(self.read_report()["filters"][0]["parameters"]["Other"], "None")
        text = " ".join(self.check(0, "--describe", LAYERS).stdout.split())
        self.assertIn("none, or a layer, counted from 0, or its name; default: none", text)
        self.assertIn("3 numbers; default: the centre of the bounding box", text)
        self.assertIn("number; greater than 0; unit: coins; default: 2", text)

    def test_a_camera_in_a_file(self):
        camera = {"view_px": 7.0, "view_py": 0.0, "view_pz": 0.0, "x_axisx": 1.0, "x_axisy": 0.0, "x_axisz": 0.0,
                  "y_axisx": 0.0, "y_axisy": 1.0, "y_axisz": 0.0, "z_axisx": 0.0, "z_axisy": 0.0, "z_axisz": 1.0,
                  "focal": 1.0, "scalex": 0.1, "scaley": 0.1, "centerx": 0.0, "centery": 0.0}
        header = ["ply", "format ascii 1.0", "element camera 1", *(f"property float {name}" for name in camera),
                  "property int viewportx", "property int viewporty", *(f"property float k{i}" for i in range(1, 5)),
                  "element vertex 1", *(f"property float {axis}" for axis in "xyz"), "end_header"]
        with open(self.path("scan.ply"), "w") as file:
            file.write("\n".join(header) + "\n" + " ".join(map(str, camera.values())) + " 640 480 0 0 0 0\n1 1 1\n")
        self.assertIn("Views=1", self.logged(inputs=("scan.ply", "cloud.ply", "box.ply")))

    def test_points(self):
        for text in ("1 -2.5 3e2", "1,-2.5,300", " 1; -2.5; 300 "):
            self.assertIn("Place=1 -2.5 300.", self.logged("Place=" + text))
        self.assertIn("has 2 numbers, not 3", self.wrong("Place=1 2"))
        self.assertIn("is not a number", self.wrong("Place=1 2 z"))

    def test_numbers_above_zero(self):
        self.logged("Price=1e-20")
        self.assertIn("greater than 0", self.wrong("Price=0"))

    def test_layers_and_points_in_scripts(self):
        """As MeshLab writes them: a layer is a choice, with none in front."""
        for value, expected in (("0", "Other=none Points=0"), ("1", "Other=cloud.ply Points=2")):
            with open(self.path("script.mlx"), "w") as file:
                file.write(f'<FilterScript><filter name="Probe: Layers"><Param name="Other" type="RichEnum" value="{value}" '
                           'enum_cardinality="3" enum_val0="None" enum_val1="cloud.ply" enum_val2="box.ply"/>'
                           '<Param name="Place" type="RichPoint3f" x="1" y="0" z="-1"/></filter></FilterScript>')
            result = self.check(0, "-i", "cloud.ply", "box.ply", "-s", "script.mlx", "-o", "out.ply")
            self.assertIn(expected + " Views=0 Place=1 0 -1.", result.stdout)


class Scripts(RunnerCase):
    def script(self, *filters):
        with open(self.path("script.mlx"), "w") as file:
            file.write("<!DOCTYPE FilterScript>\n<FilterScript>\n" + "\n".join(filters) + "\n</FilterScript>\n")
        return self.path("script.mlx")

    def test_parameters_left_out_have_defaults(self):
        self.make_sphere()
        script = self.script('<filter name="Probe: Everything"><Param name="Real" type="RichFloat" value="7"/></filter>')
        result = self.check(0, "-i", "sphere.ply", "-s", script, "-o", "out.ply")
        self.assertIn("Count=5 Real=7 Length=0.25 Kind=1 Text=abc", result.stdout)

    def test_misspelt_parameter_of_ours_and_of_meshlab(self):
        self.make_sphere()
        for name, wrong, right in (("Probe: Everything", "Reel", "Real"), ("Close Holes", "Selectd", "Selected")):
            script = self.script(f'<filter name="{name}"><Param name="{wrong}" value="1"/></filter>')
            result = self.check(2, "-i", "sphere.ply", "-s", script, "-o", "out.ply")
            self.assertIn(f'Did you mean "{right}"?', result.stderr)

    def test_mixing_with_meshlabs_filters(self):
        _, faces = self.make_sphere()
        script = self.script('<filter name="Close Holes"><Param name="MaxHoleSize" value="100" type="RichInt"/></filter>',
                             '<filter name="Probe: Everything"/>')
        self.check(0, "-i", "sphere.ply", "-s", script, "-f", "Compute Geometric Measures", "-o", "out.ply", "--report",
                   "report.json")
        report = self.read_report()
        self.assertEqual([ran["name"] for ran in report["filters"]],
                         ["Close Holes", "Probe: Everything", "Compute Geometric Measures"])
        # The hole of three quads is closed with six triangles, and the probe adds one.
        self.assertEqual(report["outputs"][0]["faces"], len(faces) + 6 + 1)

    def test_colours_and_points_in_scripts(self):
        self.make_sphere()
        script = self.script('<filter name="Vertex Color Filling"><Param name="color1" type="RichColor" r="10" g="20" '
                             'b="30" a="255"/></filter>')
        self.check(0, "-i", "sphere.ply", "-s", script, "-o", "out.ply")
        vertex = Ply(self.path("out.ply")).elements["vertex"][0]
        self.assertEqual([vertex[name] for name in ("red", "green", "blue", "alpha")], [10, 20, 30, 255])

    def test_layers_by_number_and_name(self):
        self.make_sphere("a.ply")
        self.make_sphere("b.ply", hole=False)
        for second in ("1", "b.ply"):
            result = self.check(0, "-i", "a.ply", "b.ply", "-f", "Hausdorff Distance", "-p", "SampledMesh=0",
                                "TargetMesh=" + second)
            self.assertIn("Hausdorff Distance computed", result.stdout)
        result = self.check(2, "-i", "a.ply", "-f", "Hausdorff Distance", "-p", "TargetMesh=3")
        self.assertIn("1 layers", result.stderr)

    def test_filter_that_makes_a_mesh(self):
        self.check(0, "-f", "Sphere", "-p", "subdiv=2", "-o", "out.ply")
        self.assertEqual(len(Ply(self.path("out.ply")).triangles), 320)

    def test_filter_that_needs_opengl(self):
        self.make_sphere()
        self.assertIn("OpenGL", self.check(1, "-i", "sphere.ply", "-f", "Ambient Occlusion", "-o", "out.ply").stderr)

    def test_project_in_and_out(self):
        self.make_sphere("a.ply")
        self.make_sphere("b.ply", hole=False)
        self.check(0, "-i", "a.ply", "b.ply", "-w", "both.mlp")
        self.check(0, "-p", "both.mlp", "-f", PROBE, "-o", "first.ply", "-l", "0", "-o", "last.ply", "-l", "x")
        counts = {name: len(Ply(self.path(name)).triangles) for name in ("a.ply", "b.ply", "first.ply", "last.ply")}
        self.assertEqual(counts["first.ply"], counts["a.ply"])
        self.assertEqual(counts["last.ply"], counts["b.ply"] + 1)


if __name__ == "__main__":
    unittest.main()
