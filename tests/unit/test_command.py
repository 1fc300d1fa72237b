"""The command line: help, messages and exit codes."""
import csv
import json
import math
import os
import re
import subprocess
import tempfile
import unittest

import h5py

CLAST = os.environ["CLAST"]
COMMANDS = ["run", "resume", "check", "devices", "bench", "study", "reference"]
OK, ERROR, BAD_INPUT, DEVICE = 0, 1, 2, 3

SCENE = """
title: One grain
gravity_m_s2: [0, 0, -9.81]
effects: [{slot: normal, law: hertz}]
materials: [{name: glass, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3}]
interactions: [{between: default, restitution: 0.5, friction_static: 0.5}]
particles:
  - {name: one, material: glass, generator: list, items: [{position_m: [0, 0, 0.01], radius_m: 1.0e-3}]}
walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]
stages: [{name: fall, until: {time_s: 0.001}}]
"""


def clast(*arguments, **environment):
    return subprocess.run([CLAST, *arguments], capture_output=True, text=True, env={**os.environ, **environment}, timeout=300)


class Command(unittest.TestCase):
    def refused(self, arguments, *texts, code=BAD_INPUT, **environment):
        done = clast(*arguments, **environment)
        self.assertEqual(done.returncode, code, f"{arguments}: {done.stderr}")
        self.assertEqual(done.stdout, "")
        for text in texts:
            self.assertIn(text, done.stderr)
        return done.stderr

    def test_help(self):
        done = clast("--help")
        self.assertEqual(done.returncode, OK)
        for command in COMMANDS:
            self.assertRegex(done.stdout, rf"(?m)^  {command} +\w")
            own = clast(command, "--help")
            self.assertEqual(own.returncode, OK)
            self.assertIn(f"Usage: clast {command}", own.stdout)
            self.assertEqual(own.stderr, "")

    def test_version(self):
        for arguments in (["--version"], ["run", "--version"]):
            done = clast(*arguments)
            self.assertEqual(done.returncode, OK)
            self.assertRegex(done.stdout, r"^clast \d+\.\d+\.\d+\n$")

    def test_unknown_command(self):
        self.refused([], "clast --help")
        self.refused(["chek", "scene.yaml"], "`chek`", "did you mean `check`?")
        self.refused(["device"], "did you mean `devices`?")
        self.refused(["xyzzy"], "`xyzzy`", "clast --help")
        self.refused(["--xyzzy"], "--xyzzy")

    def test_sweep(self):
        """Every combination is run, the last key changing fastest; each has its result, and the table what it ends with: a grain falls free
        for t from rest, E = m (g t)^2/2 whatever else it is made of. A run that fails leaves the others alone."""
        with tempfile.TemporaryDirectory() as folder:
            scene, out = os.path.join(folder, "scene.yaml"), os.path.join(folder, "runs")
            with open(scene, "w") as file:
                file.write(SCENE + "output: {observables: [kinetic_energy, momentum]}\nguards: {every_steps: 1}\n")
            done = clast("run", scene, "--out", out, "--sweep", "gravity_m_s2=[0, 0, -9.81],[0, 0, -5]", "--sweep",
                         "materials[glass].density_kg_m3=2500,5000")
            self.assertEqual(done.returncode, OK, done.stderr)
            self.assertEqual(len(re.findall(r"\[\d/4\]", done.stderr)), 4)
            with open(os.path.join(out, "sweep.csv"), newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual([row["gravity_m_s2"] for row in rows], ["[0, 0, -9.81]"] * 2 + ["[0, 0, -5]"] * 2)
            self.assertEqual([row["materials[glass].density_kg_m3"] for row in rows], ["2500", "5000"] * 2)
            for row in rows:
                mass = 4 / 3 * math.pi * 1e-9 * float(row["materials[glass].density_kg_m3"])
                speed = (9.81 if "9.81" in row["gravity_m_s2"] else 5) * 1e-3
                self.assertAlmostEqual(float(row["kinetic_energy"]) / (mass * speed**2 / 2), 1, 9)
                self.assertAlmostEqual(float(row["momentum.z"]) / (-mass * speed), 1, 9)
                self.assertEqual(row["exit_code"], "0")
                self.assertTrue(os.path.exists(os.path.join(out, row["result"])))
            # a grain that leaves the domain: a guard ends that run, and the sweep has its exit code
            done = clast("run", scene, "--out", out, "--set", "domain={low_m: [-1, -1, -1], high_m: [1, 1, 0.0101]}", "--sweep",
                         "particles[one].items[0].velocity_m_s=[0, 0, 0],[0, 0, 1]", "--quiet")
            self.assertEqual(done.returncode, 4, done.stderr)
            self.assertIn("[0, 0, 1]: failed", done.stderr)
            with open(os.path.join(out, "sweep.csv"), newline="") as file:
                self.assertEqual([row["exit_code"] for row in csv.DictReader(file)], ["0", "4"])
            # nothing is run where a scene is wrong, or the folder is none
            self.refused(["run", scene, "--out", os.path.join(folder, "other"), "--sweep", "dimensions=3,4"], "`dimensions`")
            self.assertFalse(os.path.exists(os.path.join(folder, "other")))
            self.refused(["run", scene, "--out", scene, "--sweep", "seed=1,2"], scene, "folder")
            self.refused(["run", scene, "--out", out, "--sweep", "seed=1,,2"], "value 2 is empty")

    def test_bad_options(self):
        one_line = [
            (["run"], "SCENE.yaml"),
            (["run", "a.yaml"], "--out"),
            (["run", "a.yaml", "b.yaml", "--out", "c.h5"], "`b.yaml`"),
            (["run", "a.yaml", "--out", "c.h5", "--precision", "half"], "`half`"),
            (["run", "a.yaml", "--out", "c", "--sweep", "seed"], "PATH=A,B,C"),
            (["run", "a.yaml", "--out", "c", "--jobs", "2"], "--sweep"),
            (["run", "a.yaml", "--out", "c.h5", "--set", "seed"], "PATH=VALUE"),
            (["resume"], "CHECKPOINT.h5"),
            (["check"], "SCENE.yaml"),
            (["bench"], "`bed`"),
            (["bench", "bad"], "`bad`"),
            (["bench", "effects", "--seconds", "0"], "`0`"),
            (["bench", "bed", "--particles", "many"], "`many`"),
            (["bench", "bed", "--particles", "99"], "from 100 to"),
            (["bench", "bed", "--particles", "1.5"], "`1.5`"),
            (["bench", "bed", "--steps", "1e99"], "`1e99`"),
            (["study", "accuracy", "a.yaml"], "--out"),
            (["study"], "no study given"),
            (["study", "speed", "a.yaml"], "`speed`"),
        ]
        for arguments, text in one_line:
            with self.subTest(arguments):
                self.assertEqual(len(self.refused(arguments, text).splitlines()), 1)
        for command in COMMANDS:
            self.refused([command, "--xyzzy"], f"clast {command}: ", "--xyzzy")
        self.refused(["run", "--out"], "--out")
        self.refused(["devices", "extra"], "clast devices: ")

    def test_devices(self):
        done = clast("devices", "--json")
        if done.returncode == DEVICE:
            self.skipTest(done.stderr)
        self.assertEqual(done.returncode, OK)
        devices = json.loads(done.stdout)
        self.assertGreater(len(devices), 0)
        for index, device in enumerate(devices):
            self.assertEqual(device["index"], index)
            self.assertIn(device["type"], ("cpu", "gpu", "accelerator"))
            for key in ("memory_bytes", "usable_bytes", "largest_buffer_bytes", "compute_units"):
                self.assertGreater(device[key], 0)
        used = [device for device in devices if device["used"]]
        self.assertEqual(len(used), 1)
        self.assertEqual(used[0]["fp64"], any(device["fp64"] for device in devices))
        table = clast("devices").stdout
        for device in devices:
            self.assertRegex(table, rf"(?m)^[* ] {device['index']} +{re.escape(device['name'])} ")

    def test_no_platform(self):
        """Both kinds of loader are pointed at a folder without drivers."""
        with tempfile.TemporaryDirectory() as empty:
            nowhere = {"OCL_ICD_VENDORS": empty, "OPENCL_VENDOR_PATH": empty, "OCL_ICD_FILENAMES": ""}
            self.refused(["devices"], "pocl-opencl-icd", code=DEVICE, **nowhere)
            self.refused(["devices", "--json"], "pocl-opencl-icd", code=DEVICE, **nowhere)

    def test_reference(self):
        done = clast("reference")
        self.assertEqual(done.returncode, OK)
        for key in ("youngs_modulus_pa", "gravity_m_s2", "restitution"):
            self.assertIn(key, done.stdout)

    def test_full_pipe(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([CLAST, "reference"], stdout=full, stderr=subprocess.PIPE, text=True, timeout=300)
        self.assertEqual(done.returncode, ERROR)
        self.assertIn("standard output", done.stderr)


class SceneFile(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.scene = os.path.join(self.folder.name, "scene.yaml")
        self.result = os.path.join(self.folder.name, "result.h5")
        with open(self.scene, "w") as file:
            file.write(SCENE)

    def refused(self, *arguments, code=BAD_INPUT):
        done = clast(*arguments)
        self.assertEqual(done.returncode, code, f"{arguments}: {done.stderr}")
        return done.stderr

    def test_missing_scene(self):
        missing = os.path.join(self.folder.name, "missing.yaml")
        self.assertIn(missing, self.refused("check", missing))
        self.assertIn(missing, self.refused("run", missing, "--out", self.result))
        self.assertFalse(os.path.exists(self.result))

    def test_bad_scene_begins_with_the_place(self):
        self.assertTrue(self.refused("check", self.scene, "--set", "seed=-1").startswith("clast: --set seed=-1: "))
        with open(self.scene, "a") as file:
            file.write("gravty: 1\n")
        line = SCENE.count("\n") + 1
        for arguments in (["check", self.scene], ["run", self.scene, "--out", self.result]):
            message = self.refused(*arguments)
            self.assertTrue(message.startswith(f"{self.scene}:{line}:1: "), message)

    def test_answers_of_a_study(self):
        """`check` looks at the names that only studies ask for, under the settings of the study."""
        with open(self.scene, "a") as file:
            file.write('study: {answers: [kinetic_energy, kinetic_enrgy], set: ["title=studied"]}\n')
        self.assertIn(f"{self.scene}: study.answers[1]: ", self.refused("check", self.scene))
        self.assertIn("did you mean `kinetic_energy`?", self.refused("check", self.scene))

    def test_what_turns_out_later_has_its_place_too(self):
        """A results file that is not there, and a period too short for the grains, which their radii and the skin say."""
        one = next(k for k, line in enumerate(SCENE.split("\n"), 1) if "name: one" in line)
        with open(self.scene, "w") as file:
            file.write(SCENE.replace("generator: list", "generator: result, file: none.h5").replace("items: [{position_m: [0, 0, 0.01], radius_m: 1.0e-3}]",
                                                                                                    "frame: 0"))
        message = self.refused("check", self.scene)
        self.assertTrue(message.startswith(f"{self.scene}:{one}:5: particles[one]: "), message)
        self.assertIn("none.h5", message)
        with open(self.scene, "w") as file:
            file.write(SCENE + "domain: {low_m: [-1, -0.002, -1], high_m: [1, 0.002, 1], periodic: [y]}\n")
        message = self.refused("check", self.scene)
        self.assertTrue(message.startswith(f"{self.scene}:{SCENE.count(chr(10)) + 1}:9: domain: the periodic length along y"), message)

    def test_whole_steps_to_the_end_of_a_stage(self):
        """100 steps of 1e-5 s are 0.001 s, though a float of 1e-5 falls short of it: no sliver of a step, and no frame twice."""
        for precision in ("double", "mixed"):
            done = clast("run", self.scene, "--out", self.result, "--precision", precision, "--set", "stages[fall].step_s=1e-5", "--set",
                         "output={every_s: 0.0002}")
            self.assertEqual(done.returncode, OK, done.stderr)
            with h5py.File(self.result) as file:
                self.assertEqual(list(file["particles/all/position/step"]), [0, 20, 40, 60, 80, 100], precision)
                self.assertAlmostEqual(file["particles/all/position/time"][-1], 0.001, 12)

    def test_bad_device(self):
        self.assertIn("`no such`", self.refused("check", self.scene, "--device", "no such", code=DEVICE))

    def test_check(self):
        done = clast("check", self.scene)
        self.assertEqual(done.returncode, OK, done.stderr)
        for text in ("hertz", "interactions[default].friction_static", "limit", "recommended", "bytes", "pair_stage", "particle_stage"):
            self.assertIn(text, done.stdout)

    def plan(self, *arguments):
        done = clast("check", self.scene, "--json", *arguments)
        self.assertEqual(done.returncode, OK, done.stderr)
        return json.loads(done.stdout)

    def test_beam_that_misses(self):
        """A beam that meets no grain in the whole run is named in a warning; one that does is not."""
        scene = """
effects: [{slot: source, law: laser, name: spot, profile: top_hat, diameter_m: 0.01, direction: [0, 0, -1], attenuation_1_m: 2000,
           path: {time_s: [0], position_m: [[PLACE, 0, 0]], power_w: [10]}}]
materials: [{name: m, density_kg_m3: 1000, specific_heat_j_kgk: 100, absorptance: 1}]
particles: [{name: g, material: m, generator: list, temperature_k: 300, items: [{position_m: [0, 0, 0], radius_m: 1.0e-3}]}]
stages: [{until: {steps: 10}, step_s: 1.0e-3}]
"""
        with tempfile.TemporaryDirectory() as folder:
            for place, missed in (("0.1", True), ("0", False)):
                path = os.path.join(folder, "beam.yaml")
                with open(path, "w") as file:
                    file.write(scene.replace("PLACE", place))
                done = subprocess.run([CLAST, "run", path, "--out", os.path.join(folder, "beam.h5")], capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual("warning: the source `spot` has met no grain" in done.stderr, missed, done.stderr)

    def test_plan(self):
        plan = self.plan("--probe")
        self.assertEqual(plan["particles"], 1)
        self.assertEqual(plan["unused"], ["interactions[default].friction_static"])
        stage = plan["stages"][0]
        self.assertEqual(stage["laws"]["normal"], "hertz")
        self.assertNotIn("tangential", stage["laws"])
        self.assertLess(stage["recommended_s"], stage["limit_s"])
        self.assertEqual(stage["step_s"], stage["recommended_s"])
        self.assertGreaterEqual(stage["steps"] * stage["step_s"], 0.001 * (1 - 1e-9))
        memory = plan["memory"]
        parts = sum(field["bytes"] for field in memory["fields"]) + memory["contact_table_bytes"] + memory["other_bytes"]
        self.assertEqual(parts, memory["bytes"])
        self.assertLess(memory["bytes"], memory["usable_bytes"])
        for stage_arguments in (plan["pair_stage_arguments"], plan["particle_stage_arguments"]):
            self.assertIn("position", stage_arguments["names"])
            self.assertLess(stage_arguments["bytes"], stage_arguments["bytes_max"])
        self.assertGreater(plan["probe"]["particle_steps_per_s"], 0)

    def test_plan_of_walls(self):
        """Walls, groups of them and servos, as the text shows them."""
        lid = "{name: lid, shape: disc, center_m: [0, 0, 1], normal: [0, 0, 1], radius_m: 0.1, servo: {direction: [0, 0, -1], force_n: 2, speed_max_m_s: 0.1}}"
        blade = "{name: blade, group: rotor, shape: cylinder, side: outside, axis_point_m: [1, 0, 0], axis: [0, 0, 1], radius_m: 0.1, length_m: 1}"
        rotor = "[{name: rotor, motion: [{type: constant, velocity_m_s: [1, 0, 0]}]}]"
        plan = self.plan("--set", f"wall_groups={rotor}", "--set", f"walls=[{lid}, {blade}]")
        first, second = plan["walls"]
        self.assertEqual((first["name"], first["shape"], first["side"], first["group"], first["moves"]), ("lid", "disc", None, None, False))
        self.assertEqual((first["servo"]["force_n"], first["servo"]["pressure_pa"], first["servo"]["direction"]), (2, None, [0, 0, -1]))
        self.assertEqual((second["shape"], second["side"], second["group"], second["servo"]), ("cylinder", "outside", "rotor", None))
        self.assertEqual(plan["wall_groups"], [{"name": "rotor", "moves": True, "servo": None}])

    def test_unused_properties(self):
        """A law that needs a property makes it used; a pair's own value hides the default."""
        friction = ["--set", "effects=[{slot: normal, law: hertz}, {slot: tangential, law: mindlin}]"]
        self.assertEqual(self.plan(*friction)["unused"], [])
        heat = ["--set", "materials[glass].conductivity_w_mk=0.1"]
        self.assertIn("materials[glass].conductivity_w_mk", self.plan(*heat)["unused"])
        pair = "{between: [glass, %s], restitution: 0.5, friction_static: 0.1}"
        pairs = ", ".join(pair % name for name in ("glass", "floor"))
        hidden = ["--set", f"interactions=[{{between: default, restitution: 0.1}}, {pairs}]"]
        self.assertEqual(self.plan(*friction, *hidden)["unused"], ["interactions[default].restitution"])

    def test_unstable_step_is_refused(self):
        limit = self.plan()["stages"][0]["limit_s"]
        fixed = f"stages[fall].step_s={1.1 * limit}"
        message = self.refused("check", self.scene, "--set", fixed)
        self.assertIn("stages[fall]", message)
        self.assertIn("allow_unstable_step", message)
        self.plan("--set", fixed, "--set", "stages[fall].allow_unstable_step=true")
        self.plan("--set", f"stages[fall].step_s={0.9 * limit}")


if __name__ == "__main__":
    unittest.main()
