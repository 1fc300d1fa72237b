"""Guards: what must not go on stops the run with the grain, the value and a remedy, exit code 4 and a checkpoint; leavers can be deleted."""
import os
import subprocess
import tempfile
import unittest

import h5py
import numpy

CLAST = os.environ["CLAST"]
OK, BAD_INPUT, GUARD = 0, 2, 4

SCENE = """
gravity_m_s2: [0, 0, -10]
effects: [{slot: normal, law: hertz}]
materials: [{name: glass, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3}]
interactions: [{between: default, restitution: 0.5}]
particles: [{name: grains, material: glass, generator: list, items: [ITEMS]}]
stages: [{name: go, until: {time_s: 0.02}, step_s: 1.0e-5}]
output: {every_s: 0.005, fields: [position, velocity], observables: [left_count, left_mass, kinetic_energy]}
"""
GRAIN = "{{position_m: [{0}, 0, {1}], radius_m: 1.0e-3, velocity_m_s: [{2}, 0, 0]}}"
RADIUS, DENSITY, GRAVITY = 1e-3, 2500.0, 10.0
MASS = 4.0 / 3.0 * numpy.pi * DENSITY * RADIUS**3


def scene(*grains, more=""):
    return SCENE.replace("ITEMS", ", ".join(GRAIN.format(*grain) for grain in grains)) + more


class Guards(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.result = self.path("result.h5")
        self.checkpoint = self.path("result.checkpoint.h5")

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_scene(self, text, *options):
        with open(self.path("scene.yaml"), "w") as file:
            file.write(text)
        return subprocess.run([CLAST, "run", self.path("scene.yaml"), "--out", self.result, *options], capture_output=True, text=True, timeout=300)

    def stopped(self, text, *pieces, checkpoint=True, options=()):
        done = self.run_scene(text, *options)
        self.assertEqual(done.returncode, GUARD, done.stderr)
        last = done.stderr.splitlines()[-1]
        self.assertIn("stopped by a guard at t = ", last)
        for piece in pieces:
            self.assertIn(piece, last)
        self.assertEqual(os.path.exists(self.checkpoint), checkpoint, last)
        if checkpoint:
            self.assertIn(self.checkpoint, last)
        with h5py.File(self.result, "r") as file:
            self.assertGreater(len(file["particles/all/position/time"]), 0)
        return last

    def observable(self, name):
        with h5py.File(self.result, "r") as file:
            return file["observables"][name]["value"][...].ravel()

    def test_not_a_number(self):
        """A step far past its limit blows a contact up."""
        text = scene((0, 0, 0), (0.0019, 0, 0), more="guards: {every_steps: 10, overlap_max: 2, move_max: 1.0e6}\n")
        text = text.replace("step_s: 1.0e-5", "step_s: 1.0e+160, allow_unstable_step: true").replace("time_s: 0.02", "steps: 1000")
        text = text.replace("output: {every_s: 0.005, ", "output: {")
        self.stopped(text, "grain ", "not a number", "smaller step", checkpoint=False)

    def test_overlap(self):
        fast = scene((0, 0, 30), (0.0025, 0, -30), more="guards: {every_steps: 1, overlap_max: 0.2, move_max: 1.0e6}\n")
        last = self.stopped(fast, "grain 0", "overlap of ", "overlap_max is 0.2", "stiffer")
        self.assertIn("step", last)
        with h5py.File(self.checkpoint, "r") as file:
            self.assertGreater(file["run/step"][...].item(), 0)

    def test_overlap_at_the_start(self):
        """Refused before a step is taken, unless the scene allows it; grains at one place always are."""
        near = scene((0, 0, 0), (0.001, 0, 0))
        done = self.run_scene(near)
        self.assertEqual(done.returncode, BAD_INPUT)
        self.assertIn("overlap by 1 of the smaller radius at the start, guards.overlap_max is 0.3", done.stderr)
        self.assertIn("viscous_damping", done.stderr)
        self.assertEqual(self.run_scene(near, "--set", "guards.overlap_max=1.1").returncode, OK)
        done = self.run_scene(near, "--set", "guards.every_steps=0")
        self.assertEqual(done.returncode, OK)
        self.assertIn("warning: grains 0 and 1 overlap by 1 of", done.stderr.replace("grains 1 and 0", "grains 0 and 1"))
        done = self.run_scene(scene((0, 0, 0), (0, 0, 0)), "--set", "guards.overlap_max=2")
        self.assertEqual(done.returncode, BAD_INPUT)
        self.assertIn("grains 0 and 1 are at the same place", done.stderr)

    def test_grain_in_a_wall_at_the_start(self):
        """The same at walls; one that is held may stand in a wall."""
        floor = "walls: [{name: floor, shape: plane, point_m: [0, 0, -0.5e-3], normal: [0, 0, 1]}]\n"
        done = self.run_scene(scene((0, 0, 0), more=floor))
        self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
        self.assertIn("grain 0 begins 0.5 of its radius deep in the wall `floor`, guards.overlap_max is 0.3", done.stderr)
        self.assertEqual(self.run_scene(scene((0, 0, 0), more=floor), "--set", "guards.overlap_max=0.6").returncode, OK)
        self.assertEqual(self.run_scene(scene((0, 0, 0), more=floor), "--set", "particles[grains].motion=fixed").returncode, OK)

    def test_grain_pressed_through_a_wall(self):
        """Two grains, one of them which ends deep in the floor."""
        floor = "walls: [{name: far, shape: plane, point_m: [-1, 0, 0], normal: [1, 0, 0]}, {name: floor, shape: plane, point_m: [0, 0, -1.2e-3], normal: [0, 0, 1]}]\n"
        text = scene((0, 0, 0), (0.01, 0, 0), more=floor + "guards: {every_steps: 5, move_max: 1.0e6}\n").replace("step_s: 1.0e-5", "step_s: 1.0e-6")
        down = text.replace("position_m: [0.01, 0, 0], radius_m: 1.0e-3, velocity_m_s: [0, 0, 0]", "position_m: [0.01, 0, 0], radius_m: 1.0e-3, velocity_m_s: [0, 0, -30]")
        self.assertNotEqual(text, down)
        last = self.stopped(down, "grain 1: it is 0.3", "of its radius deep in the wall `floor`, overlap_max is 0.3", "stiffer material")
        self.assertIn("t = 2e-05 s", last)  # 0.2 mm to the floor take 6.7 us, 0.3 mm into it 10 us more: 16.7 us, looked at every 5 us
        self.assertEqual(self.run_scene(text).returncode, OK)
        held = down.replace("material: glass, generator", "material: glass, motion: [{type: constant, velocity_m_s: [0, 0, -30]}], generator").replace("time_s: 0.02", "time_s: 5.0e-5")
        self.assertEqual(self.run_scene(held).returncode, OK)  # what is moved as prescribed may go through a wall

    def test_walls_do_not_repeat(self):
        """A wall that acts through a periodic face, on grains that do not see it, is refused, or stops the run where it comes there."""
        domain = "domain: {low_m: [0, 0, 0], high_m: [0.01, 0.01, 0.01], periodic: [x, y, z]}\n"
        disc = domain + "walls: [{name: plate, shape: disc, center_m: [0.005, 0.005, HEIGHT], radius_m: 2.0e-3, normal: [0, 0, 1]MOTION}]\n"
        for wall, code in (("0.0009", BAD_INPUT), ("0.0011", OK), ("0.0091", BAD_INPUT), ("0.0089", OK)):
            done = self.run_scene(scene((0.001, 0.008, 0), (0.008, 0.006, 0), more=disc.replace("HEIGHT", wall).replace("MOTION", "")), "--set", "stages[go].until.time_s=1.0e-5")
            self.assertEqual(done.returncode, code, done.stderr)
            if code == BAD_INPUT:
                self.assertIn("stage go: the wall `plate` is less than a grain's radius away from the domain's periodic face along z", done.stderr)
        moving = disc.replace("HEIGHT", "0.0025").replace("MOTION", ", motion: [{type: constant, velocity_m_s: [0, 0, -0.3]}]")
        moving = moving.replace("0.005, 0.005", "0.005, 0.002").replace("2.0e-3", "0.9e-3")
        last = self.stopped(scene((0.001, 0.008, 0), (0.008, 0.006, 0), more=moving), "the wall `plate` is less than", "face along z", "move less far")
        self.assertIn("t = 0.006 s", last)  # 1.5 mm take 5 ms, looked at every ms
        plane = domain + "walls: [{name: slope, shape: plane, point_m: [0.005, 0.005, 0.005], normal: [1, 0, 5]}]\n"
        self.assertEqual(self.run_scene(scene((0.001, 0.008, 0), more=plane)).returncode, BAD_INPUT)
        spans = domain.replace("[x, y, z]", "[x, y]") + """walls:
  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}
  - {name: shelf, shape: rectangle, corners_m: [[0, 0.005, 0.004], [0.01, 0.005, 0.004], [0, 0.007, 0.004]]}
  - {name: bar, shape: cylinder, side: outside, axis_point_m: [0.005, 0, 0.002], axis: [0, 1, 0], radius_m: 5.0e-4, length_m: 0.01}
"""
        grain = scene((0.001, 0.008, 0), more=spans).replace("time_s: 0.02", "time_s: 1.0e-5")
        self.assertEqual(self.run_scene(grain).returncode, OK)
        done = self.run_scene(grain.replace("[0.01, 0.005, 0.004]", "[0.0099, 0.005, 0.004]"))
        self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
        self.assertIn("wall `shelf`", done.stderr)

    def test_move(self):
        # the wall, far away, holds the frame: without one, moves count against the bed's common velocity
        wall = "walls: [{name: far, shape: plane, point_m: [-5, 0, 0], normal: [1, 0, 0]}]\n"
        text = scene((0, 0, 0), (1, 0, 500), more=wall + "contact_table: {skin_m: 1.0e-3}\nguards: {every_steps: 10, move_max: 0.5}\n")
        self.stopped(text, "grain 1", "0.005 m in a step", "move_max 0.5", "smaller step", checkpoint=False)

    def test_leaving_stops(self):
        text = scene((0, 0.01, 0), (0.0105, 0.01, 1), more="domain: {low_m: [-1, -1, -1], high_m: [0.015, 1, 1]}\nguards: {every_steps: 100}\n")
        last = self.stopped(text, "grain 1", "left the domain", "delete")
        self.assertIn("t = 0.005", last)  # x = 0.0105 + 1 t passes 0.015 at 4.5 ms; looked at every 1 ms
        with h5py.File(self.checkpoint, "r") as file:
            inside = file["particles/position"][...]
        self.assertLessEqual(inside[1, 0], 0.015)

    def test_leaving_deletes(self):
        """Grains fly out one by one: counts, masses, rows of NaN; the one that stays goes on falling."""
        grains = [(0.001 * k, 0.02 + 0.01 * k, 0.5 * k) for k in range(4)]
        text = scene(*grains, more="domain: {low_m: [-1, -1, -1], high_m: [0.006, 1, 1], leaving: delete}\nguards: {every_steps: 50}\n")
        done = self.run_scene(text)
        self.assertEqual(done.returncode, OK, done.stderr)
        count = self.observable("left_count")
        # 0.001 k + 0.5 k t > 0.006 within the 0.02 s: k = 1 at 10 ms, 2 at 4 ms, 3 at 2 ms
        self.assertEqual(list(count), [0, 2, 2, 3, 3])
        self.assertTrue(numpy.allclose(self.observable("left_mass"), count * MASS, rtol=1e-12, atol=0))
        with h5py.File(self.result, "r") as file:
            frames = file["particles/all/position/value"][...]
        self.assertEqual([int(numpy.isnan(frame[:, 0]).sum()) for frame in frames], [0, 2, 2, 3, 3])
        self.assertTrue(numpy.all(numpy.isnan(frames[1, 2:])))
        steps = 2000
        self.assertAlmostEqual(frames[-1, 0, 2], 0.02 - GRAVITY * 1e-10 * steps * (steps + 1) / 2, 12)

    def test_all_leave(self):
        text = scene((0, 0, 3), (0.004, 0, 3), more="domain: {low_m: [-1, -1, -1], high_m: [0.01, 1, 1], leaving: delete}\nguards: {every_steps: 50}\n")
        done = self.run_scene(text)
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertEqual(self.observable("left_count")[-1], 2)
        self.assertEqual(self.observable("kinetic_energy")[-1], 0)

    def test_guards_off(self):
        text = scene((0, 0.01, 0), (0.01, 0.01, 1), more="domain: {low_m: [-1, -1, -1], high_m: [0.015, 1, 1]}\nguards: {every_steps: 0}\n")
        self.assertEqual(self.run_scene(text).returncode, OK)

    def test_step_past_its_limit(self):
        text = scene((0, 0, 0), (0.00199, 0, 0)).replace("step_s: 1.0e-5", "step_s: 1.0e-3")
        done = self.run_scene(text)
        self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
        last = done.stderr.splitlines()[-1]
        for piece in ("scene.yaml:7:", "step_s of 0.001 s is past the stability limit of ", "normal", "recommended is ", "allow_unstable_step"):
            self.assertIn(piece, last)
        self.assertFalse(os.path.exists(self.result))
        limit = float(last.split("stability limit of ")[1].split()[0])
        below = text.replace("step_s: 1.0e-3", f"step_s: {0.99 * limit:.6g}")
        done = self.run_scene(below)
        self.assertIn(done.returncode, (OK, GUARD), done.stderr)
        allowed = self.run_scene(text.replace("step_s: 1.0e-3", "step_s: 1.0e-3, allow_unstable_step: true").replace("time_s: 0.02", "steps: 3"))
        self.assertEqual(allowed.returncode, OK, allowed.stderr)
        self.assertIn("warning: ", allowed.stderr)

    def test_last_good_state_goes_on(self):
        """What a guard leaves behind can be resumed, and stops again."""
        fast = scene((0, 0, 30), (0.0025, 0, -30), more="guards: {every_steps: 1, overlap_max: 0.2, move_max: 1.0e6}\n")
        self.stopped(fast, "overlap of ")
        done = subprocess.run([CLAST, "resume", self.checkpoint], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, GUARD, done.stderr)
        self.assertIn("overlap of ", done.stderr)


if __name__ == "__main__":
    unittest.main()
