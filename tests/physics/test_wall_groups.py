"""Force on a group of walls that move together, as results hold it: two plates are a trough that shakes up and down with a grain in it. The grain
follows, so that the group feels m (g + a) and every plate its share along its normal; a wall that is in no group does not count."""
import math
import os
import subprocess
import tempfile
import unittest

import h5py
import numpy

CLAST = os.environ["CLAST"]
GRAVITY, DENSITY, RADIUS, AMPLITUDE, FREQUENCY = 9.81, 2500.0, 1.0e-3, 1.0e-3, 10.0
OMEGA = 2.0 * math.pi * FREQUENCY
SCENE = f"""
gravity_m_s2: [0, 0, -{GRAVITY}]
effects: [{{slot: normal, law: hertz}}]
materials: [{{name: glass, density_kg_m3: {DENSITY}, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3}}]
interactions: [{{between: default, restitution: 0.1}}]
wall_groups: [{{name: trough, motion: [{{type: sinusoid, direction: [0, 0, 1], amplitude_m: {AMPLITUDE}, frequency_hz: {FREQUENCY}}}]}}]
walls:
  - {{name: left, group: trough, shape: rectangle, corners_m: [[0, -0.01, 0], [-0.02, -0.01, 0.02], [0, 0.01, 0]]}}
  - {{name: shelf, shape: rectangle, corners_m: [[0.04, -0.01, 0], [0.06, -0.01, 0], [0.04, 0.01, 0]]}}
  - {{name: right, group: trough, shape: rectangle, corners_m: [[0, -0.01, 0], [0.02, -0.01, 0.02], [0, 0.01, 0]]}}
particles:
  - name: both
    material: glass
    generator: list
    items:
      - {{radius_m: {RADIUS}, position_m: [0, 0, {math.sqrt(2.0) * RADIUS}], velocity_m_s: [0, 0, {AMPLITUDE * OMEGA}]}}
      - {{radius_m: {RADIUS}, position_m: [0.05, 0, {RADIUS}]}}
stages: [{{name: shake, until: {{time_s: 0.15}}, step_s: auto}}]
output: {{every_s: 0.05, observables_every_s: 0.005}}
"""


class WallGroups(unittest.TestCase):
    def check(self, *settings):
        with tempfile.TemporaryDirectory() as folder:
            scene, result = os.path.join(folder, "scene.yaml"), os.path.join(folder, "r.h5")
            with open(scene, "w") as file:
                file.write(SCENE)
            words = [w for s in settings for w in ("--set", s)]
            done = subprocess.run([CLAST, "run", scene, "--out", result, "--quiet", *words], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            with h5py.File(result, "r") as file:
                group = file["observables"]
                time = group["wall_groups/trough/force/time"][...]
                trough, left, right, shelf = (group[f"{name}/force/value"][...] for name in ("wall_groups/trough", "walls/left", "walls/right", "walls/shelf"))
        settled = time > 0.05
        self.assertGreater(numpy.count_nonzero(settled), 15)
        mass = DENSITY * 4.0 / 3.0 * math.pi * RADIUS**3
        expected = -mass * (GRAVITY - AMPLITUDE * OMEGA**2 * numpy.sin(OMEGA * time))
        self.assertGreater(numpy.ptp(expected[settled]), 0.5 * mass * GRAVITY)
        # the contact's frequency is a hundred times the trough's
        bound = 1e-3 * mass * GRAVITY
        zero = numpy.zeros_like(time)
        for name, force, wanted in (("group", trough, (zero, zero, expected)), ("left", left, (0.5 * expected, zero, 0.5 * expected)),
                                    ("right", right, (-0.5 * expected, zero, 0.5 * expected)), ("shelf", shelf, (zero, zero, zero - mass * GRAVITY))):
            for c in range(3):
                worst = numpy.max(numpy.abs(force[settled, c] - wanted[c][settled]))
                self.assertLess(worst, bound, f"{settings}: {name}.{'xyz'[c]} is off by {worst / (mass * GRAVITY):.2e} of the weight")
        self.assertTrue(numpy.array_equal(trough, left + right))

    def test_double(self):
        self.check()

    def test_mixed_velocity_verlet(self):
        self.check("precision=mixed", "integrator=velocity_verlet")


if __name__ == "__main__":
    unittest.main()
