"""Rounds of stages: heat while nothing moves and motion with the moduli and radii that it leaves, against the coupled state of a column that both
define; a stage that moves and ends when temperatures stand; rounds that go on from a checkpoint."""
import math
import os
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

CLAST = os.environ["CLAST"]
COUNT, RADIUS, OVERLAP = 5, 2.0e-3, 2.0e-5
YOUNG, NU, CONDUCTIVITY, ALPHA, CRITICAL, RATE = 1.0e8, 0.25, 60.0, 1.0e-5, 350.0, 1.5
HOT, COLD = 700.0, 300.0
LENGTH = COUNT * (2 * RADIUS - OVERLAP)

# a column between two walls, evenly pressed at 300 K
COLUMN = """
effects:
  - {slot: normal, law: hertz}
  - {slot: conduction, law: overlap_area}
  - {slot: body, law: viscous_damping, coefficient: 2.0e4}
LAWS
materials:
  - {name: m, density_kg_m3: 2500, youngs_modulus_pa: %g, poissons_ratio: %g, conductivity_w_mk: %g, specific_heat_j_kgk: 100, expansion_1_k: %g,
     softening_temperature_k: %g, softening_rate: %g}
interactions: [{between: default, normal_damping_ratio: 0.5}]
walls:
  - {name: hot, shape: plane, point_m: [0, 0, 0], normal: [1, 0, 0], temperature_k: %g}
  - {name: cold, shape: plane, point_m: [%.17g, 0, 0], normal: [-1, 0, 0], temperature_k: %g}
particles:
  - {name: column, material: m, generator: list, temperature_k: 300, items: [%s]}
""" % (YOUNG, NU, CONDUCTIVITY, ALPHA, CRITICAL, RATE, HOT, LENGTH, COLD,
       ", ".join("{position_m: [%.17g, 0, 0], radius_m: %g}" % ((k + 0.5) * (2 * RADIUS - OVERLAP), RADIUS) for k in range(COUNT)))
SOFTENING = "  - {slot: modulus, law: exponential_softening}\n"
EXPANSION = "  - {slot: radius, law: linear_expansion}\n"
ROUNDS = """
stages:
  - {name: heat, motion: frozen, until: {steps: 1}, heat: {method: steady}}
  - {name: relax, until: {time_s: 3.0e-3}, step_s: 1.0e-6, effects_off: [conduction], repeat: {from: heat, until_change: CHANGE, rounds: 60}}
output: {fields: [position, temperature], observables: [temperature_mean], contacts: true, EVERY}
"""


def modulus(t, softens):
    return YOUNG * (min(1.0, math.exp(RATE * (1.0 - t / CRITICAL))) if softens else 1.0)


def overlaps(force, radii, moduli):
    """Of the contacts from wall to wall (mirror images and rigid walls), by Hertz."""
    found = []
    for k in range(COUNT + 1):
        if k in (0, COUNT):
            g = 0 if k == 0 else COUNT - 1
            e, r = moduli[g] / (1 - NU**2), radii[g]
        else:
            e = 1.0 / ((1 - NU**2) / moduli[k - 1] + (1 - NU**2) / moduli[k])
            r = radii[k - 1] * radii[k] / (radii[k - 1] + radii[k])
        found.append((3.0 * force / (4.0 * e * math.sqrt(r))) ** (2.0 / 3.0))
    return found


def conductance(ri, rj, d):
    distance = ri + rj - d
    length = 0.5 * (distance - (rj**2 - ri**2) / distance)
    return CONDUCTIVITY * math.pi * (ri**2 - length**2) / distance


def coupled_state(softens, grows):
    """Temperatures and force of the column at rest and at steady heat: one force through all contacts, one flow through all of them."""
    t = np.full(COUNT, 300.0)
    for _ in range(400):
        radii = [RADIUS * (1 + (ALPHA * (x - 300.0) if grows else 0.0)) for x in t]
        moduli = [modulus(x, softens) for x in t]
        total = 2.0 * sum(radii) - LENGTH
        low, high = 0.0, 1e4
        for _ in range(200):
            force = 0.5 * (low + high)
            low, high = (low, force) if sum(overlaps(force, radii, moduli)) > total else (force, high)
        d = overlaps(low, radii, moduli)
        h = [conductance(radii[0], radii[0], 2 * d[0])] + [conductance(radii[k], radii[k + 1], d[k + 1]) for k in range(COUNT - 1)] + \
            [conductance(radii[-1], radii[-1], 2 * d[-1])]
        flow = (HOT - COLD) / sum(1.0 / x for x in h)
        t = HOT - flow * np.cumsum([1.0 / x for x in h])[:COUNT]
    return t, low


def run(folder, scene, *more):
    path, out = os.path.join(folder, "case.yaml"), os.path.join(folder, "case.h5")
    with open(path, "w") as file:
        file.write(scene)
    words = [word for setting in os.environ.get("CLAST_TEST_SET", "").split() for word in ("--set", setting)]
    done = subprocess.run([CLAST, "run", path, "--out", out, *words, *more], capture_output=True, text=True)
    return out, done


class Rounds(unittest.TestCase):
    def column(self, laws, change, every=""):
        return COLUMN.replace("LAWS\n", laws) + ROUNDS.replace("CHANGE", change).replace("EVERY", every)

    def check(self, softens, grows):
        expected, force = coupled_state(softens, grows)
        with tempfile.TemporaryDirectory() as folder:
            out, done = run(folder, self.column((SOFTENING if softens else "") + (EXPANSION if grows else ""), "1.0e-6"))
            self.assertEqual(done.returncode, 0, done.stderr)
            with h5py.File(out) as file:
                t, first = file["particles/all/temperature/value"][-1], file["particles/all/temperature/value"][1]
                pushes = np.abs(file["contacts/force"][file["contacts/offset"][-1]:, 0])
        self.assertGreater(np.abs(first - expected).max(), 0.01 * (HOT - COLD))  # the first round is not there yet
        self.assertLess(np.abs(t - expected).max(), 1e-5 * (HOT - COLD))
        self.assertEqual(len(pushes), COUNT + 1)
        self.assertLess(np.abs(pushes / force - 1.0).max(), 1e-4)
        return done.stderr.count("end of round")

    def test_expansion(self):
        self.assertGreater(self.check(False, True), 3)

    def test_both(self):
        self.assertGreater(self.check(True, True), 3)

    def test_loose_criterion_ends_earlier(self):
        with tempfile.TemporaryDirectory() as folder:
            _, done = run(folder, self.column(SOFTENING + EXPANSION, "1.0e-3"))
        self.assertLess(done.stderr.count("end of round"), 8)
        with tempfile.TemporaryDirectory() as folder:
            _, done = run(folder, self.column(SOFTENING + EXPANSION, "1.0e-9"), "--set", "stages[relax].repeat.rounds=2")
        self.assertIn("warning: stage relax: in the last of 2 rounds", done.stderr)

    def test_goes_on_from_a_checkpoint(self):
        """The last checkpoint is in the second round's stage that moves."""
        scene = self.column(SOFTENING + EXPANSION, "1.0e-9", "checkpoint_every_s: 4.1e-3")
        with tempfile.TemporaryDirectory() as folder:
            out, done = run(folder, scene, "--set", "stages[relax].repeat.rounds=3")
            self.assertEqual(done.returncode, 0, done.stderr)
            other = os.path.join(folder, "other.h5")
            done = subprocess.run([CLAST, "resume", os.path.join(folder, "case.checkpoint.h5"), "--out", other], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            with h5py.File(out) as a, h5py.File(other) as b:
                for field in ("position", "temperature"):
                    self.assertEqual(a[f"particles/all/{field}/value"][-1].tobytes(), b[f"particles/all/{field}/value"][-1].tobytes())
                self.assertEqual(a["particles/all/temperature/time"][-1], b["particles/all/temperature/time"][-1])
            self.assertIn("in the last of 3 rounds", done.stderr)

    def refused(self, scene, message):
        with tempfile.TemporaryDirectory() as folder:
            _, done = run(folder, scene)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(message, done.stderr)

    def test_refused(self):
        good = self.column(SOFTENING, "1.0e-3")
        self.refused(good.replace("from: heat", "from: relax"), "no such stage is called `relax`")
        self.refused(good.replace("until_change: 1.0e-3", "until_change: 2"), "until_change")
        self.refused(good.replace("effects_off: [conduction],", "change: {walls: [{name: hot, motion: []}]},"), "in the first of them alone, `heat`")


class Steady(unittest.TestCase):
    def test_a_stage_that_moves(self):
        """A grain that falls and cools by Newton's law: its rate (T - Te)/tau falls to the given one after tau ln of their ratio."""
        tau = 2500 * 100 * RADIUS / (3 * 50.0)  # rho c r/(3 h)
        scene = """
gravity_m_s2: [0, 0, -9.81]
environment: {temperature_k: 300}
effects: [{slot: convection, law: newton, coefficient_w_m2k: 50}]
materials: [{name: m, density_kg_m3: 2500, specific_heat_j_kgk: 100}]
particles: [{name: g, material: m, generator: list, temperature_k: 500, items: [{position_m: [0, 0, 0], radius_m: %g}]}]
stages: [{name: cool, until: {steady_k_s: 0.5, time_s: 1000}, step_s: 1.0e-3}]
""" % RADIUS
        with tempfile.TemporaryDirectory() as folder:
            out, done = run(folder, scene)
            self.assertEqual(done.returncode, 0, done.stderr)
            with h5py.File(out) as file:
                end = file["particles/all/position/time"][-1]
        due = tau * math.log(200.0 / tau / 0.5)
        self.assertGreater(end, due)
        self.assertLess(end, due + 0.2)  # looked at every 100 steps, in the mean over them


if __name__ == "__main__":
    unittest.main()
