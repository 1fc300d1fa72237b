"""Runs that go on from a checkpoint: bit for bit what the uninterrupted run gives; signals, kills and damaged checkpoints."""
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import h5py
import numpy

CLAST = os.environ["CLAST"]
OK, BAD_INPUT, INTERRUPTED = 0, 2, 130

BED = """
gravity_m_s2: [2, 0, -30]
effects: [{slot: normal, law: hertz}, {slot: tangential, law: mindlin}, {slot: rolling, law: elastic_plastic}]
materials: [{name: glass, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3}]
interactions:
  - {between: default, restitution: 0.5, friction_static: 0.4, friction_dynamic: 0.3, rolling_friction: 0.02}
particles:
  - {name: bed, material: glass, generator: random, count: 60, radius_m: {distribution: uniform, low: 8.0e-4, high: 1.2e-3},
     region: {low_m: [0, 0, 0.001], high_m: [0.009, 0.009, 0.009]}, velocity_m_s: [0.3, 0.2, -0.8]}
walls:
  - {name: box, shape: box, low_m: [0, 0, -0.01], high_m: [0.009, 0.009, 0.03], open: [z_low, z_high]}
  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1],
     motion: [{type: sinusoid, direction: [0.6, 0, 0.8], amplitude_m: 2.0e-4, frequency_hz: 90}]}
"""
OUTPUT = "output: {{every_s: {0}, fields: [position, velocity, spin], observables: [time_step, kinetic_energy, left_count, left_mass, " \
         "dissipated_normal, dissipated_tangential, dissipated_rolling, work_walls, work_stiffness, work_gravity], "
FIXED = BED + """
stages: [{name: go, until: {time_s: 0.02}, step_s: 1.0e-5}]
""" + OUTPUT.format(0.004).replace("{{", "{") + "checkpoint_every_s: 0.0123}\n"
AUTOMATIC = FIXED.replace("step_s: 1.0e-5", "step_s: auto")
STAGES = BED + """
stages:
  - {name: one, until: {time_s: 0.012}, step_s: 1.0e-5}
  - {name: two, until: {steps: 500}, step_s: 9.0e-6, effects_off: [rolling],
     change: {gravity_m_s2: [-3, 0, -20], walls: [{name: floor, friction_static: 0.1, friction_dynamic: 0.05,
              motion: [{type: constant, velocity_m_s: [0.1, 0, 0.05]}]}]}}
  - {name: three, until: {time_s: 0.003}, step_s: auto, change: {walls: [{name: floor, motion: []}]}}
""" + OUTPUT.format(0.004).replace("{{", "{") + "checkpoint_every_s: CHECKPOINT}\n"
LEAVING = BED.replace("open: [z_low, z_high]", "open: [z_low, z_high, x_high]") + """
domain: {low_m: [-1, -1, -1], high_m: [0.0095, 1, 1], leaving: delete}
guards: {every_steps: 20}
stages: [{name: go, until: {time_s: 0.02}, step_s: 1.0e-5}]
""" + OUTPUT.format(0.004).replace("{{", "{") + "checkpoint_every_s: 0.0123}\n"
HOT = FIXED.replace("elastic_plastic}]", "elastic_plastic}, {slot: conduction, law: overlap_area}, {slot: heat_generation, law: volumetric}, "
                    "{slot: radius, law: linear_expansion}, {slot: modulus, law: exponential_softening}]") \
    .replace("poissons_ratio: 0.3", "poissons_ratio: 0.3, conductivity_w_mk: 10, specific_heat_j_kgk: 100, expansion_1_k: 5.0e-4, "
             "softening_temperature_k: 320, heat_generation_w_m3: 1.0e9") \
    .replace("velocity_m_s: [0.3", "temperature_k: 300, velocity_m_s: [0.3") \
    .replace("step_s: 1.0e-5}", "step_s: 1.0e-5, heat: {every_steps: 3}}") \
    .replace("spin]", "spin, temperature]").replace("work_gravity]", "work_gravity, work_expansion, temperature_max]")
LONG = BED + """
stages: [{name: go, until: {time_s: 60}, step_s: STEP}]
output: {every_s: 0.005, fields: [position, velocity, spin], observables: [kinetic_energy], observables_every_s: 0.001}
"""
FIELDS = ("position", "velocity", "spin")


def clast(*arguments):
    return subprocess.run([CLAST, *arguments], capture_output=True, text=True, timeout=300)


def tables_told(done):
    """Contact tables, by the last line of a run."""
    return int(re.search(r"(\d+) tables,", done.stderr).group(1))


def frames(path):
    """Times, and of every frame the bits of its fields."""
    with h5py.File(path, "r") as file:
        group = file["particles/all"]
        times = group["position/time"][...]
        return times, [b"".join(group[field]["value"][n].tobytes() for field in FIELDS) for n in range(len(times))]


def observables(path):
    with h5py.File(path, "r") as file:
        return {name: file["observables"][name]["value"][...] for name in file["observables"] if "value" in file["observables"][name]}


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, text, name="scene.yaml"):
        with open(self.path(name), "w") as file:
            file.write(text)
        return self.path(name)

    def succeed(self, *arguments):
        done = clast(*arguments)
        self.assertEqual(done.returncode, OK, f"{arguments}: {done.stderr}")
        return done

    def run_scene(self, text, result):
        self.tables = tables_told(self.succeed("run", self.write(text), "--out", self.path(result)))
        return self.path(result)


class Resume(Case):
    def check(self, text, in_slip=True):
        """Goes on from the checkpoint of a whole run, in a new file and in the same one."""
        whole = self.run_scene(text, "whole.h5")
        checkpoint = self.path("whole.checkpoint.h5")
        with h5py.File(checkpoint, "r") as file:
            history = file["contacts/history"][...]
            at = file["run/time"][...].item()
            tables = file["run/rebuilds"][...].item()
        if in_slip:
            self.assertGreater(numpy.count_nonzero(numpy.any(history != 0, axis=1)), 5)
        times, bits = frames(whole)
        seen = observables(whole)
        self.assertGreater(at, 0)
        self.assertLess(at, times[-1])
        resumed = self.succeed("resume", checkpoint, "--out", self.path("new.h5"))
        self.assertGreater(tables, 1)
        self.assertLessEqual(tables_told(resumed), self.tables - tables + 1, "tables of the resumed run alone")
        new_times, new_bits = frames(self.path("new.h5"))
        self.assertEqual(new_times[-1], times[-1])
        self.assertTrue(new_bits[-1] == bits[-1], "the last frames differ")
        self.assertEqual(list(new_times[1:]), [t for t in times if t > at])
        self.assertTrue(new_bits[1:] == bits[len(times) - len(new_times) + 1:])
        self.succeed("resume", checkpoint)
        again_times, again_bits = frames(whole)
        self.assertEqual(list(again_times), list(times))
        self.assertTrue(again_bits == bits, "the file that was continued differs")
        for name, values in observables(whole).items():
            self.assertTrue(values.tobytes() == seen[name].tobytes(), name)
        return at, whole

    def test_in_mid_slip(self):
        self.check(FIXED)

    def test_automatic_step(self):
        self.check(AUTOMATIC)

    def test_stages(self):
        for every, stage in (("0.0119", 0), ("0.0121", 1), ("0.0123", 1), ("0.0171", 2)):
            with self.subTest(every):
                self.check(STAGES.replace("CHECKPOINT", every))
                with h5py.File(self.path("whole.checkpoint.h5"), "r") as file:
                    self.assertEqual(file["run/stage"][...].item(), stage)

    def test_end_of_a_stage(self):
        """A checkpoint on the last step of a stage."""
        at, _ = self.check(STAGES.replace("CHECKPOINT", "0.012"))
        self.assertAlmostEqual(at, 0.012, 9)

    def test_velocity_verlet(self):
        """The half-step velocities go along; steps that change start from the same bits."""
        self.check(FIXED + "integrator: velocity_verlet\n")
        self.check(AUTOMATIC + "integrator: velocity_verlet\n")

    def test_mixed(self):
        """Pairs of floats are kept whole; stages start from the same bits under velocity Verlet too."""
        mixed = "precision: mixed\nintegrator: velocity_verlet\n"
        self.check(FIXED + mixed)
        for every in ("0.012", "0.0171"):
            self.check(STAGES.replace("CHECKPOINT", every) + mixed)

    def test_growing_grains(self):
        """Temperatures, radii, moduli, and the work of their growth."""
        self.assertIn("linear_expansion", HOT)
        _, whole = self.check(HOT)
        with h5py.File(whole, "r") as file:
            radius = file["particles/all/radius/value"][...]
        self.assertTrue(numpy.all(radius[-1] > 1.01 * radius[0]))
        self.assertGreater(observables(whole)["work_expansion"][-1], 0)
        self.check(HOT + "precision: mixed\nintegrator: velocity_verlet\n")

    def test_grains_that_left(self):
        _, whole = self.check(LEAVING)
        left = observables(whole)["left_count"].ravel()
        self.assertGreater(left[-1], left[len(left) // 2])
        with h5py.File(self.path("whole.checkpoint.h5"), "r") as file:
            self.assertGreater(file["run/left_count"][...].item(), 0)

    def test_new_file_leaves_the_old_one(self):
        whole = self.run_scene(FIXED, "whole.h5")
        with open(whole, "rb") as file:
            before = file.read()
        self.succeed("resume", self.path("whole.checkpoint.h5"), "--out", self.path("new.h5"))
        with open(whole, "rb") as file:
            self.assertEqual(file.read(), before)

    def test_end_of_the_run(self):
        """Nothing is left to do after a checkpoint on the last step."""
        whole = self.run_scene(FIXED.replace("0.0123", "0.02"), "whole.h5")
        times, bits = frames(whole)
        self.succeed("resume", self.path("whole.checkpoint.h5"))
        again_times, again_bits = frames(whole)
        self.assertEqual(list(again_times), list(times))
        self.assertTrue(again_bits == bits)


class Signals(Case):
    def start(self, text, result="result.h5"):
        """A run that has written its third frame."""
        scene = self.write(text)
        run = subprocess.Popen([CLAST, "run", scene, "--out", self.path(result), "--quiet"], stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        begun = time.monotonic()
        while time.monotonic() - begun < 120 and run.poll() is None:
            try:
                with h5py.File(self.path(result), "r") as file:
                    if len(file["particles/all/position/time"]) > 2:
                        return run
            except (OSError, KeyError):
                pass
            time.sleep(0.02)
        self.fail(f"no frames; {run.stderr.read() if run.poll() is not None else 'still running'}")

    def check_signal(self, number, step):
        text = LONG.replace("STEP", step)
        run = self.start(text)
        run.send_signal(number)
        _, message = run.communicate(timeout=60)
        self.assertEqual(run.returncode, INTERRUPTED, message)
        self.assertIn("result.checkpoint.h5", message)
        with h5py.File(self.path("result.checkpoint.h5"), "r") as file:
            at = file["run/time"][...].item()
        end = at + 0.011
        # the uninterrupted run, and the interrupted one, both to the same end
        whole = self.run_scene(text.replace("time_s: 60", f"time_s: {end!r}"), "whole.h5")
        times, bits = frames(whole)
        resumed = self.start_again()
        resumed_times, resumed_bits = frames(self.path("result.h5"))
        common = min(len(times) - 1, len(resumed_times))
        self.assertGreater(resumed_times[common - 1], at)
        self.assertEqual(list(resumed_times[:common]), list(times[:common]))
        self.assertTrue(resumed_bits[:common] == bits[:common], "frames differ")
        resumed.kill()

    def start_again(self):
        """Goes on until there are two frames more."""
        before = len(frames(self.path("result.h5"))[0])
        run = subprocess.Popen([CLAST, "resume", self.path("result.checkpoint.h5"), "--quiet"], stderr=subprocess.DEVNULL)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        begun = time.monotonic()
        while time.monotonic() - begun < 120 and run.poll() is None:
            try:
                if len(frames(self.path("result.h5"))[0]) >= before + 2:
                    break
            except (OSError, KeyError, IndexError):
                pass
            time.sleep(0.02)
        run.kill()
        run.wait()
        return run

    def test_interrupt(self):
        self.check_signal(signal.SIGINT, "1.0e-5")

    def test_terminate(self):
        self.check_signal(signal.SIGTERM, "auto")

    def test_kill(self):
        run = self.start(LONG.replace("STEP", "1.0e-5"))
        run.kill()
        run.wait()
        times, bits = frames(self.path("result.h5"))
        self.assertGreater(len(times), 2)
        for frame in bits:
            self.assertTrue(numpy.all(numpy.isfinite(numpy.frombuffer(frame))))


class Damage(Case):
    def refused(self, path, *texts):
        done = clast("resume", path)
        self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for text in (path, *texts):
            self.assertIn(text, done.stderr)

    def test_damaged(self):
        self.run_scene(FIXED, "whole.h5")
        good = self.path("whole.checkpoint.h5")
        size = os.path.getsize(good)
        for part in (0, 7, size // 3, size - 1):
            with self.subTest(part):
                shutil.copy(good, self.path("cut.h5"))
                os.truncate(self.path("cut.h5"), part)
                self.refused(self.path("cut.h5"))

    def test_foreign(self):
        with h5py.File(self.path("foreign.h5"), "w") as file:
            file["numbers"] = [1, 2, 3]
        self.refused(self.path("foreign.h5"))
        self.refused(self.write("not HDF5 at all", "text.h5"))
        self.refused(self.path("missing.h5"))
        self.refused(self.run_scene(FIXED, "result.h5"))


if __name__ == "__main__":
    unittest.main()
