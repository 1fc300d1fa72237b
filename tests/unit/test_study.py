"""clast study accuracy: orders, the Pareto front, the reference and the messages, on collisions whose answers are known."""
import csv
import math
import os
import re
import subprocess
import tempfile
import unittest

import h5py

CLAST = os.environ["CLAST"]
SPEED, RADIUS, DENSITY, MODULUS, POISSON = 10.0, 0.01, 2800.0, 4.8e10, 0.2
MASS = 4 / 3 * math.pi * RADIUS**3 * DENSITY
STIFF = MODULUS / (2 * (1 - POISSON**2)) * math.sqrt(RADIUS / 2)
DURATION = 2.8683 * (MASS**2 / 4 / ((RADIUS / 2) * (MODULUS / (2 * (1 - POISSON**2)))**2 * 2 * SPEED))**0.2

SCENE = f"""
title: Collision
effects: [{{slot: normal, law: hertz}}]
materials: [{{name: glass, density_kg_m3: {DENSITY}, youngs_modulus_pa: {MODULUS}, poissons_ratio: {POISSON}}}]
interactions: [{{between: default, normal_damping_ratio: 0}}]
particles:
  - name: pair
    material: glass
    generator: list
    items:
      - {{position_m: [-{RADIUS}, 0, 0], radius_m: {RADIUS}, velocity_m_s: [{SPEED}, 0, 0]}}
      - {{position_m: [{RADIUS}, 0, 0], radius_m: {RADIUS}, velocity_m_s: [-{SPEED}, 0, 0]}}
stages: [{{name: impact, until: {{time_s: {1.25 * DURATION:.17g}}}, step_s: 2.0e-8}}]
study:
  samples: 5
  answers: ["particles[pair].items[0].position.x", "particles[pair].items[1].velocity.x"]
"""


def study(*arguments, **environment):
    return subprocess.run([CLAST, "study", "accuracy", *arguments], capture_output=True, text=True, env={**os.environ, **environment}, timeout=900)


def number(text):
    return float(text) if text else math.nan


class Study(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.scene = os.path.join(cls.folder.name, "scene.yaml")
        with open(cls.scene, "w") as file:
            file.write(SCENE)

    def run_study(self, *arguments, **environment):
        out = tempfile.mkdtemp(dir=self.folder.name)
        done = study(self.scene, "--out", out, "--quiet", "--repeats", "1", *arguments, **environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(os.path.join(out, "accuracy.csv"), newline="") as file:
            return done, out, list(csv.DictReader(file))

    def check_front(self, rows):
        """No row of the front is beaten in time and error at once, and every other row is."""
        points = [(number(r["time_s"]), max(number(r["error"]), number(r["reference_uncertainty"])), r["pareto"] == "1") for r in rows]
        for k, (time, error, front) in enumerate(points):
            self.assertGreater(time, 0)
            beaten = any(t <= time and e <= error and (t, e) != (time, error) for t, e, _ in points)
            self.assertEqual(front, not beaten, rows[k])

    def test_elastic(self):
        """Leapfrog is of order 2. Under semi-implicit Euler, from a first touch without force, positions are those of leapfrog, and speeds
        are half a step behind: orders 2 and 1. A further answer has a closed form: the spheres fly back with the speed that they came with,
        which no run misses by more than the error of its trajectory."""
        done, out, rows = self.run_study("--choices", "integrator", "--levels", "6", "--tolerance", "1e-3")
        with h5py.File(os.path.join(out, "accuracy.h5")) as file:
            choices = [c.decode() for c in file["curves/choice"][:]]
            order = dict(zip(choices, file["curves/order"][:]))
            self.assertEqual(len(file["points/error"]), len(rows))
            for name in ("time_s", "particle_steps", "error"):
                for value, row in zip(file[f"points/{name}"][:], rows):
                    self.assertAlmostEqual(value / number(row[name]), 1, 6)
        self.assertEqual(choices, ["semi_implicit_euler, double", "velocity_verlet, double"])
        self.assertTrue(0.85 < order[choices[0]] < 1.15, order)
        self.assertTrue(1.8 < order[choices[1]] < 2.2, order)
        self.assertEqual(len(rows), 12)
        euler = [r for r in rows if r["integrator"] == "semi_implicit_euler"]
        for coarse, fine in zip(euler, euler[1:]):
            self.assertAlmostEqual(number(fine["step_s"]) / number(coarse["step_s"]), 0.5, 7)
            self.assertEqual(number(fine["particle_steps"]), 2 * number(coarse["particle_steps"]))
        position = [number(r["error particles[pair].items[0].position.x"]) for r in euler]
        speed = [number(r["error particles[pair].items[1].velocity.x"]) for r in euler]
        self.assertTrue(1.8 < math.log2(position[-3] / position[-1]) / 2 < 2.2, position)
        self.assertTrue(0.85 < math.log2(speed[-3] / speed[-1]) / 2 < 1.15, speed)
        self.check_front(rows)
        # the last line: the quickest of those within the tolerance, as settings that can be used as they stand
        line = done.stdout.strip().splitlines()[-1]
        self.assertRegex(line, r"^cheapest within 0.001: --set ")
        best = min((r for r in rows if number(r["error"]) <= 1e-3), key=lambda r: number(r["time_s"]))
        self.assertIn(best["settings"], line)
        done = subprocess.run([CLAST, "run", self.scene, "--out", os.path.join(out, "r.h5"), *best["settings"].split()], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        for ending in ("png", "svg"):
            self.assertGreater(os.path.getsize(os.path.join(out, f"accuracy.{ending}")), 5000)

    def test_damped_and_mixed(self):
        """The damper goes as d^(1/4): orders from 1 to 1.25, and a little more where the step is still coarse. At coarse steps float makes
        the same errors as double. Without matplotlib there are tables and a word about it."""
        modules = os.path.join(self.folder.name, "modules")
        os.makedirs(modules)
        with open(os.path.join(modules, "matplotlib.py"), "w") as file:
            file.write("raise ImportError('no', name='matplotlib')\n")
        done, out, rows = self.run_study("--choices", "precision", "--levels", "6", "--set", "integrator=velocity_verlet", "--set",
                                         "interactions[default].normal_damping_ratio=0.2", "--tolerance", "1e-9", PYTHONPATH=modules)
        self.assertIn("matplotlib is missing", done.stderr)
        self.assertFalse(os.path.exists(os.path.join(out, "accuracy.png")))
        self.assertIn("1 to 1.25", done.stdout)
        self.assertRegex(done.stdout.strip().splitlines()[-1], r"^cheapest within 1e-09: none of these settings; the least error is \d")
        with h5py.File(os.path.join(out, "accuracy.h5")) as file:
            order = file["curves/order"][0]
        self.assertTrue(0.95 < order < 1.5, order)
        exact = [r for r in rows if r["precision"] == "double"]
        mixed = [r for r in rows if r["precision"] == "mixed"]
        self.assertEqual([len(exact), len(mixed)], [6, 6])
        self.assertAlmostEqual(number(mixed[0]["error"]) / number(exact[0]["error"]), 1, 2)
        self.check_front(rows)

    def test_closed_form(self):
        """What a formula gives takes the place of the reference for its answer: a formula that is off by 0.01 of the change of 2 v makes an
        error of just that, however fine the step. It is left aside once the scene is no longer the one that it holds for."""
        end = 1.25 * DURATION
        form = "study.closed_form=[{answer: \"particles[pair].items[1].velocity.x\", time_s: [%.17g], value: [%g]}]" % (end, SPEED * 1.02)
        _, _, rows = self.run_study("--choices", "law", "--levels", "4", "--set", "integrator=velocity_verlet", "--set", form)
        scale = 2.02 * SPEED
        self.assertAlmostEqual(number(rows[-1]["error particles[pair].items[1].velocity.x"]), 0.02 * SPEED / scale, 3)
        done, _, rows = self.run_study("--choices", "law", "--levels", "3", "--set", form, "--set", "materials[glass].youngs_modulus_pa=5e10")
        self.assertIn("left aside", done.stderr)
        self.assertLess(number(rows[-1]["error particles[pair].items[1].velocity.x"]), number(rows[0]["error particles[pair].items[1].velocity.x"]))

    def refused(self, arguments, *texts):
        done = study(*arguments)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for text in texts:
            self.assertIn(text, done.stderr)

    def test_bad_input(self):
        out = ["--out", os.path.join(self.folder.name, "bad")]
        self.refused([], "SCENE.yaml")
        self.refused([self.scene], "--out")
        self.refused([self.scene, *out, "--tolerance", "0"], "--tolerance", "`0`")
        self.refused([self.scene, *out, "--levels", "2"], "from 3 to")
        self.refused([self.scene, *out, "--choices", "integrator,colour"], "`colour`", "--help")
        self.refused([self.scene, *out, "--set", "study.answers=[]"], "answers")
        self.refused([self.scene, *out, "--set", "study.answers=[kinetic_enrgy]"], "did you mean `kinetic_energy`?")
        self.refused([self.scene, *out, "--set", "study.answers=[\"particles[pear].velocity\"]"], "`pear`")
        self.refused([self.scene, *out, "--set", "study.answers=[\"particles[pair].items[2].velocity\"]"], "2 grains")
        self.refused([self.scene, *out, "--set", "study.answers=[\"particles[pair].items[0].velocity.w\"]"], "`w`")
        self.refused([self.scene, *out, "--set", "study.answers=[\"walls[floor].force\"]"], "name of a wall")
        self.refused([self.scene, *out, "--set", "study.closed_form=[{answer: momentum.x, time_s: [1], value: [0]}]"], "`answers`")
        self.refused([self.scene, *out, "--set", "study.closed_form=[{answer: momentum, time_s: [1], value: [0]}]"], "component")
        self.refused([self.scene, *out, "--set", "study.seeds=3", "--set", "study.average_from_s=1"], "average_from_s", "after the end")
        self.refused([self.scene, *out, "--set", "stages[impact].until={steps: 10}"], "number of steps", "time_s")
        self.assertFalse(os.path.exists(out[1]))
        self.assertIn("integrator", study("--help").stdout)


if __name__ == "__main__":
    unittest.main()
