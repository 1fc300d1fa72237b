"""Haff's law: a gas of inelastic grains cools as T0/(1 + t/tau)^2 over a decade of temperature, at rest and with a common velocity. A quarter of the bed
of scenarios/granular_gas.yaml at the same density: while two grains touch they meet no others, which takes 1.5 % off the rate of collisions."""
import math
import os
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

CLAST = os.environ["CLAST"]
SCENE = os.path.join(os.environ["CLAST_SOURCE_DIR"], "scenarios", "granular_gas.yaml")
COUNT, RADIUS, FRACTION, RESTITUTION = 1000, 1.0e-3, 0.05, 0.9
LENGTH = (COUNT * 4.0 / 3.0 * math.pi * RADIUS**3 / FRACTION) ** (1.0 / 3.0)


class Haff(unittest.TestCase):
    def temperatures(self, folder, speed):
        """Times, and T = 2 E/(3 N m) of the motion relative to the common one."""
        corner = f"[{LENGTH!r}, {LENGTH!r}, {LENGTH!r}]"
        sets = {"domain.high_m": corner, "particles[gas].region.high_m": corner, "particles[gas].count": COUNT,
                "particles[gas].velocity_m_s": f"[{speed}, 0, 0]", "stages[cool].step_s": 5.0e-6}
        out = os.path.join(folder, f"gas-{speed}.h5")
        words = [CLAST, "run", SCENE, "--out", out, "--quiet"] + [word for key, value in sets.items() for word in ("--set", f"{key}={value}")]
        words += [word for setting in os.environ.get("CLAST_TEST_SET", "").split() for word in ("--set", setting)]
        done = subprocess.run(words, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        with h5py.File(out) as file:
            time, energy = file["observables/kinetic_energy/time"][:], file["observables/kinetic_energy/value"][:]
            momentum, mass = file["observables/momentum/value"][:], file["particles/all/mass"][:]
        common = 0.5 * (momentum**2).sum(axis=1) / mass.sum()
        return time, 2.0 * (energy - common) / (3.0 * mass.sum())

    def check(self, speed):
        with tempfile.TemporaryDirectory() as folder:
            time, seen = self.temperatures(folder, speed)
        chi = (1.0 - 0.5 * FRACTION) / (1.0 - FRACTION) ** 3
        omega = 4.0 * math.sqrt(math.pi * seen[0]) * COUNT / LENGTH**3 * (2.0 * RADIUS) ** 2 * chi
        expected = seen[0] / (1.0 + time * (1.0 - RESTITUTION**2) * omega / 6.0) ** 2
        self.assertLess(expected[-1], 0.105 * seen[0])
        worst = np.abs(seen / expected - 1.0).max()
        print(f"common velocity {speed} m/s: T falls to {seen[-1] / seen[0]:.4f} of T0, {100 * worst:.2f} % off Haff's law at most")
        self.assertLess(worst, 0.05)

    def test_at_rest(self):
        self.check(0)

    def test_with_a_common_velocity(self):
        self.check(100)


if __name__ == "__main__":
    unittest.main()
