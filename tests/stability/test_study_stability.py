"""clast study stability: where the edge of stability has a closed form it is found; what it refuses, and what it writes."""
import json
import math
import os
import subprocess
import tempfile
import unittest

CLAST = os.environ["CLAST"]

SPRING = """
gravity_m_s2: [0, 0, -9.81]
effects: [{{slot: normal, law: linear}}]
materials: [{{name: m, density_kg_m3: {density}}}]
interactions: [{{between: default, normal_stiffness_n_m: {stiffness}, normal_damping_ratio: {damping}}}]
walls: [{{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}}]
particles: [{{name: p, material: m, generator: list, items: [{{radius_m: {radius}, position_m: [0, 0, {height!r}]}}]}}]
stages: [{{name: rest, until: {{steps: 10000}}}}]
"""

HEAT = """
effects: [{slot: conduction, law: overlap_area}]
materials: [{name: m, density_kg_m3: 1000, conductivity_w_mk: 1, specific_heat_j_kgk: 1}]
particles:
  - {name: hot, material: m, generator: list, temperature_k: 400, items: [{radius_m: 1.0e-3, position_m: [0, 0, 0]}]}
  - {name: cold, material: m, generator: list, temperature_k: 300, items: [{radius_m: 1.0e-3, position_m: [1.9e-3, 0, 0]}]}
stages: [{name: heat, until: {steps: 300}}, {name: still, until: {time_s: 1}, motion: frozen}]
"""


def study(*arguments):
    return subprocess.run([CLAST, "study", "stability", *arguments], capture_output=True, text=True)


class StudyStability(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def scene(self, text):
        path = os.path.join(self.folder.name, "scene.yaml")
        with open(path, "w") as file:
            file.write(text)
        return path

    def stages(self, text, *arguments):
        done = study(self.scene(text), "--json", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)["stages"]

    def test_spring_and_damper(self):
        """A grain at rest on a spring swings up past w dt = 2 (sqrt(1 + xi^2) - xi), whatever auto takes."""
        radius, density, stiffness = 1.0e-3, 2000.0, 1.0e4
        mass = 4.0 / 3.0 * math.pi * density * radius**3
        omega = math.sqrt(stiffness / mass)
        for damping in 0.0, 0.3:
            text = SPRING.format(density=density, radius=radius, stiffness=stiffness, damping=damping, height=radius - 9.81 * mass / stiffness * (1.0 + 1e-6))
            (stage,) = self.stages(text, "--tolerance", "0.02")
            edge = 2.0 * (math.sqrt(1.0 + damping**2) - damping) / omega / stage["auto_min_s"]
            self.assertLess(stage["safety_factor"], 1.01 * edge)
            self.assertGreater(stage["safety_factor"], 0.95 * edge)
            self.assertGreater(stage["safety_factor"], 1.0)
            self.assertLessEqual(stage["unstable_factor"], stage["safety_factor"] * 1.02 * (1.0 + 1e-9))
            for run in stage["runs"]:
                self.assertEqual(run["stable"], run["factor"] <= stage["safety_factor"])

    def test_conduction(self):
        """Two grains overshoot their mean past dt = C/H, which is the limit; auto takes a tenth of it, for accuracy."""
        moving, frozen = self.stages(HEAT)
        self.assertAlmostEqual(moving["auto_min_s"] / (0.1 * moving["limit_s"]), 1.0, places=6)
        self.assertLess(moving["safety_factor"], 1.02 / 0.1)
        self.assertGreater(moving["safety_factor"], 0.94 / 0.1)
        self.assertTrue(frozen["frozen"])

    def test_files_and_text(self):
        out = os.path.join(self.folder.name, "tables")
        done = study(self.scene(HEAT), "--out", out, "--stage", "heat")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("stage heat: auto takes", done.stdout)
        self.assertRegex(done.stdout, r"safety factor \d")
        with open(os.path.join(out, "stability.json")) as file:
            (stage,) = json.load(file)["stages"]
        with open(os.path.join(out, "stability.csv")) as file:
            keys, row = (line.strip().split(",") for line in file)
        self.assertEqual(row[keys.index("stage")], "heat")
        self.assertAlmostEqual(float(row[keys.index("safety_factor")]), stage["safety_factor"], places=4)

    def test_refuses(self):
        scene = self.scene(HEAT)
        cases = [
            ([], "SCENE.yaml"),
            ([scene, "--tolerance", "0"], "`0`"),
            ([scene, "--tolerance", "x"], "`x`"),
            ([scene, "--steps", "10"], "from 100 to"),
            ([scene, "--stage", "boil"], "`boil`"),
            ([scene, "--precision", "half"], "`half`"),
            ([scene, "--out", scene], "folder"),
            ([scene, "--set", "effects[conduction].wall=up"], "up"),
            (["absent.yaml"], "absent.yaml"),
        ]
        for arguments, text in cases:
            with self.subTest(arguments):
                done = study(*arguments)
                self.assertEqual(done.returncode, 2)
                self.assertIn(text, done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1)


if __name__ == "__main__":
    unittest.main()
