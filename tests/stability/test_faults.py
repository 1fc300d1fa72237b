"""Faults: a device call that fails ends a run with one message and exit code 3; a kill or a full disk at any write leaves results that read and a
checkpoint from which the run goes on bit for bit. CLAST_LONG=1 takes every call and every write in turn, CLAST_LONG=N at most N of each kind, else
some of them, chosen by a seed."""
import concurrent.futures
import os
import random
import shutil
import subprocess
import tempfile
import time
import unittest

import h5py

CLAST, FAULTS = os.environ["CLAST"], os.environ["CLAST_FAULTS"]
LONG = int(os.environ.get("CLAST_LONG", "0"))
OK, ERROR, BAD_INPUT, DEVICE = 0, 1, 2, 3

SCENE = """
gravity_m_s2: [2, 0, -30]
effects: [{slot: normal, law: hertz}, {slot: tangential, law: mindlin}, {slot: rolling, law: elastic_plastic}]
materials: [{name: glass, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3}]
interactions: [{between: default, restitution: 0.5, friction_static: 0.4, rolling_friction: 0.02}]
particles:
  - {name: bed, material: glass, generator: random, count: 60, radius_m: {distribution: uniform, low: 8.0e-4, high: 1.2e-3},
     region: {low_m: [0, 0, 0.001], high_m: [0.009, 0.009, 0.009]}, velocity_m_s: [0.3, 0.2, -0.8]}
walls: [{name: box, shape: box, low_m: [0, 0, 0], high_m: [0.009, 0.009, 0.03], open: [z_high]}]
stages: [{name: go, until: {time_s: 0.01}, step_s: 1.0e-5}, {name: on, until: {steps: 200}, step_s: 1.0e-5}]
output: {every_s: 0.001, fields: [position, velocity, spin], observables: [kinetic_energy, contacts], observables_every_s: 5.0e-4, contacts: true, checkpoint_every_s: 0.0023}
"""
CALLS = ["clCreateBuffer", "clCreateContext", "clCreateCommandQueue", "clCreateKernel", "clBuildProgram", "clSetKernelArg", "clEnqueueNDRangeKernel",
         "clEnqueueReadBuffer", "clEnqueueWriteBuffer", "clEnqueueFillBuffer", "clEnqueueCopyBuffer"]
SELDOM = ("clEnqueueCopyBuffer",)  # a run may do without
FIELDS = ("position", "velocity", "spin")


def frames(path):
    """Times, and of every frame the bits of its fields."""
    with h5py.File(path, "r") as file:
        group = file["particles/all"]
        times = group["position/time"][...]
        for name in file["observables"]:
            if "value" in file["observables"][name]:
                file["observables"][name]["value"][...]
        return times, [b"".join(group[field]["value"][n].tobytes() for field in FIELDS) for n in range(len(times))]


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = cls.temporary.name
        cls.scene = os.path.join(cls.folder, "scene.yaml")
        with open(cls.scene, "w") as file:
            file.write(SCENE)
        whole = os.path.join(cls.folder, "whole")
        os.mkdir(whole)
        done = subprocess.run([CLAST, "run", cls.scene, "--quiet", "--out", os.path.join(whole, "r.h5")], capture_output=True, text=True)
        assert done.returncode == OK, done.stderr
        cls.times, cls.bits = frames(os.path.join(whole, "r.h5"))
        assert len(cls.times) >= 11

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def faulty(self, command, folder, call, at=0, action="fail"):
        """Returns what was done, and the number of calls."""
        count = folder + ".count"
        environment = dict(os.environ, LD_PRELOAD=FAULTS, CLAST_FAULT_CALL=call, CLAST_FAULT_AT=str(at), CLAST_FAULT_ACTION=action,
                           CLAST_FAULT_FOLDER=folder + "/", CLAST_FAULT_COUNT=count)
        done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=600, cwd=folder)
        calls = 0
        if os.path.exists(count):
            with open(count) as file:
                calls = int(file.read())
        return done, calls

    def fresh(self, name):
        folder = os.path.join(self.folder, name)
        shutil.rmtree(folder, ignore_errors=True)
        os.mkdir(folder)
        return folder, [CLAST, "run", self.scene, "--quiet", "--out", "r.h5"]

    def some(self, calls, most, always=()):
        """All of them; or the first, the last, those of `always` and some between."""
        most = {0: most, 1: calls}.get(LONG, LONG)
        if calls <= most:
            return list(range(1, calls + 1))
        return sorted({1, calls, *always} | set(random.Random(calls).sample(range(2, calls), most - 2)))

    def for_each(self, work, items):
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            for problem in pool.map(work, items):
                if problem:
                    self.fail(problem)

    def test_device(self):
        for call in CALLS:
            folder, command = self.fresh("count")
            done, calls = self.faulty(command, folder, call)
            self.assertEqual(done.returncode, OK, done.stderr)
            if call not in SELDOM:
                self.assertGreater(calls, 0, call)

            def one(at):
                folder, command = self.fresh(f"{call}.{at}")
                done, made = self.faulty(command, folder, call, at)
                if done.returncode == OK and made < at:  # how often the last good state is kept depends on the clock
                    return None
                what = f"{call} fails, {at} of {calls}: exit code {done.returncode}, says {done.stderr!r}"
                result = os.path.join(folder, "r.h5")
                lines = len(done.stderr.splitlines())  # a build also shows what the driver says
                if done.returncode != DEVICE or (lines != 1 and call != "clBuildProgram") or not done.stderr.startswith("clast: "):
                    return what
                if os.path.exists(result) and not self.is_beginning(result):
                    return what + "; the results are not those of the run so far"
                shutil.rmtree(folder)
                return None

            self.for_each(one, self.some(calls, 8 if call == "clCreateBuffer" else 3))

    def test_lesser_device(self):
        """Without fp64 a scene that leaves its precision open runs in mixed precision, and one that does not is told so; what does not fit is refused
        with the numbers, before anything is written."""
        def on(memory, buffer, *more):
            folder, command = self.fresh("less")
            environment = dict(os.environ, LD_PRELOAD=FAULTS, CLAST_FAULT_DEVICE=f"{memory},{buffer}")
            done = subprocess.run(command + list(more), capture_output=True, text=True, env=environment, timeout=600, cwd=folder)
            return os.path.join(folder, "r.h5"), done

        short = ["--set", "stages[go].until={steps: 20}", "--set", "stages[on].until={steps: 20}"]
        result, done = on(10**9, 10**9, *short)
        self.assertEqual(done.returncode, OK, done.stderr)
        with h5py.File(result) as file:
            self.assertIn("mixed", file["clast/plan"][()].decode())
        for memory, buffer, more, pieces in ((10**9, 10**9, ["--precision", "double"], ["has no fp64", "precision: mixed"]),
                                             (20000, 10**9, [], ["does not hold this scene", "on top of", "20.0 kB can be used", "fewer grains"]),
                                             (10**9, 1000, [], ["does not allow buffers of more than 1.0 kB", "needs "])):
            result, done = on(memory, buffer, *more)
            self.assertEqual(done.returncode, DEVICE, done.stderr)
            for piece in pieces:
                self.assertIn(piece, done.stderr)
            self.assertFalse(os.path.exists(result))

    def is_beginning(self, result):
        try:
            times, bits = frames(result)
        except (KeyError, IndexError):
            return False
        return list(times) == list(self.times[: len(times)]) and bits == self.bits[: len(bits)]

    @staticmethod
    def never_finished(result):
        """Killed while the file was made: it is no results file yet, begins with a hole, and the next run may have its name."""
        with open(result, "rb") as file:
            start = file.read(48)
        return not any(start)

    def goes_on(self, folder):
        """None, or what is wrong with what a fault has left."""
        result, checkpoint = os.path.join(folder, "r.h5"), os.path.join(folder, "r.checkpoint.h5")
        if os.path.exists(result) and self.never_finished(result):
            if os.path.exists(checkpoint):
                return "there is a checkpoint, but no results"
            done = subprocess.run([CLAST, "run", self.scene, "--quiet", "--out", "r.h5"], capture_output=True, text=True, cwd=folder)
            if done.returncode != OK:
                return f"the name is not free again: {done.stderr}"
        if os.path.exists(result):
            try:
                if not self.is_beginning(result):
                    return "the results are not those of the run so far"
            except OSError as error:
                return f"the results cannot be read: {error}"
        if not os.path.exists(checkpoint):
            return None
        done = subprocess.run([CLAST, "resume", "r.checkpoint.h5", "--quiet"], capture_output=True, text=True, cwd=folder)
        if done.returncode != OK:
            return f"cannot be resumed: {done.stderr}"
        times, bits = frames(result)
        return None if list(times) == list(self.times) and bits == self.bits else "goes on, but not bit for bit"

    def writes(self, action, codes, most):
        folder, command = self.fresh("count")
        done, calls = self.faulty(command, folder, "write")
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertGreater(calls, 50)
        resumed = []

        def one(at):
            folder, command = self.fresh(f"{action}.{at}")
            done, _ = self.faulty(command, folder, "write", at, action)
            if done.returncode not in codes or (action == "full" and len(done.stderr.splitlines()) != 1):
                return f"{action} at write {at} of {calls}: exit code {done.returncode}, says {done.stderr!r}"
            resumed.append(os.path.exists(os.path.join(folder, "r.checkpoint.h5")))
            problem = self.goes_on(folder)
            shutil.rmtree(folder)
            return problem and f"{action} at write {at} of {calls}: {problem}"

        self.for_each(one, self.some(calls, most, always=(12,)))  # before the file is finished
        self.assertGreater(sum(resumed), 0)

    def test_killed(self):
        self.writes("kill", (-9,), 10)

    def test_killed_at_any_moment(self):
        """Whatever the clock says: also within calls of the device and between writes."""
        folder, command = self.fresh("clock")
        begin = time.monotonic()
        subprocess.run(command, cwd=folder, check=True)
        whole = time.monotonic() - begin

        def one(at):
            folder, command = self.fresh(f"moment.{at}")
            with subprocess.Popen(command, cwd=folder, stderr=subprocess.DEVNULL) as going:
                time.sleep(random.Random(at).random() * whole)
                going.kill()
            problem = self.goes_on(folder)
            shutil.rmtree(folder)
            return problem and f"killed after a random time, {at}: {problem}"

        self.for_each(one, range({0: 3, 1: 300}.get(LONG, LONG)))

    def test_full_disk(self):
        self.writes("full", (ERROR, BAD_INPUT), 10)

    def test_killed_while_going_on(self):
        """A kill during `resume`, which first cuts the results back to the checkpoint."""
        base, command = self.fresh("base")
        _, calls = self.faulty(command, base, "write")
        base, command = self.fresh("base")
        self.faulty(command, base, "write", calls * 3 // 4, "kill")
        self.assertTrue(os.path.exists(os.path.join(base, "r.checkpoint.h5")))
        command = [CLAST, "resume", "r.checkpoint.h5", "--quiet"]

        def copied(name):
            folder = os.path.join(self.folder, name)
            shutil.copytree(base, folder)
            return folder

        done, calls = self.faulty(command, copied("going"), "write")
        self.assertEqual(done.returncode, OK, done.stderr)

        def one(at):
            folder = copied(f"going.{at}")
            done, _ = self.faulty(command, folder, "write", at, "kill")
            problem = f"exit code {done.returncode}" if done.returncode != -9 else self.goes_on(folder)
            shutil.rmtree(folder)
            return problem and f"killed at write {at} of {calls} of resume: {problem}"

        self.for_each(one, self.some(calls, 8, always=(5, 12, 20, 25)))  # within the cut


if __name__ == "__main__":
    unittest.main()
