"""A small scene with everything in it under oclgrind: no access outside a buffer, and no data race but the one that is meant."""
import os
import re
import shutil
import subprocess
import tempfile
import unittest

CLAST = os.environ["CLAST"]
SOURCE = os.environ["CLAST_SOURCE_DIR"]

SCENE = """
gravity_m_s2: [1, 0, -9.81]
effects:
  - {slot: normal, law: hertz}
  - {slot: tangential, law: mindlin}
  - {slot: rolling, law: elastic_plastic}
  - {slot: body, law: local_damping}
materials:
  - {name: glass, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3}
  - {name: steel, density_kg_m3: 7800, youngs_modulus_pa: 7.0e6, poissons_ratio: 0.3}
interactions:
  - {between: default, restitution: 0.5, friction_static: 0.4, friction_dynamic: 0.3, rolling_friction: 0.02}
domain: {low_m: [0, 0, -1], high_m: [0.008, 0.0075, 1], periodic: [x], leaving: delete}
particles:
  - {name: grains, material: glass, generator: lattice, lattice: simple_cubic, counts: [2, 2, 1], spacing_m: 1.99e-3, radius_m: 1.0e-3,
     origin_m: [0.003, 0.003, 0.000999], velocity_m_s: [0.1, 0.2, -0.1]}
  - {name: tops, material: steel, generator: lattice, lattice: simple_cubic, counts: [2, 1, 1], spacing_m: 1.99e-3, radius_m: 0.8e-3,
     origin_m: [0.003, 0.003, 0.00279], velocity_m_s: [0.1, 0.2, -0.1]}
  - {name: driven, material: steel, generator: list, motion: [{type: constant, velocity_m_s: [1, 0, 0]}],
     items: [{position_m: [0.0011, 0.003, 0.001], radius_m: 1.0e-3}]}
  - {name: leaver, material: steel, generator: list, items: [{position_m: [0.001, 0.0074, 0.005], radius_m: 1.0e-3, velocity_m_s: [0, 2, 0]}]}
walls:
  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], motion: [{type: constant, velocity_m_s: [0.1, 0, 0]}]}
  - {name: shelf, shape: rectangle, corners_m: [[0, 0.004, 0], [0.01, 0.004, 0], [0, 0.004, 0.01]]}
stages:
  - {name: go, until: {steps: GO}, step_s: 1.0e-5}
  - {name: slide, until: {steps: SLIDE}, step_s: auto, effects_off: [rolling]}
guards: {every_steps: 5}
contact_table: {batch_steps: 5, skin_m: SKIN, FORM}
output: {fields: [position, velocity, spin, orientation, force, torque], observables: [kinetic_energy, elastic_energy, stress, left_count],
         contacts: true}
"""


class Oclgrind(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """The wrapper puts its own OpenCL 1.2 device before the program."""
        if not shutil.which("oclgrind"):
            raise unittest.SkipTest("there is no oclgrind")
        devices = subprocess.run(["oclgrind", CLAST, "devices"], capture_output=True, text=True, timeout=100)
        if "Oclgrind" not in devices.stdout:
            raise unittest.SkipTest(f"oclgrind shows no device of its own: {devices.stdout}{devices.stderr}")

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def changed_kernels(self, file, old, new):
        """A copy of the kernels with a change in one of them."""
        folder = tempfile.mkdtemp(dir=self.folder)
        for name in ("kernels", "include"):
            shutil.copytree(os.path.join(SOURCE, name), os.path.join(folder, name))
        path = os.path.join(folder, "kernels", file)
        with open(path) as f:
            text = f.read()
        self.assertIn(old, text)
        with open(path, "w") as f:
            f.write(text.replace(old, new))
        return os.path.join(folder, "kernels")

    def run_scene(self, *options, form="kernel_form: items", kernels=None, precision="double", steps=(8, 4), skin="2.0e-5"):
        """What oclgrind reports. Its interpreter knows few of LLVM's intrinsics, so the kernels are not optimised."""
        with open(self.path("scene.yaml"), "w") as file:
            file.write(SCENE.replace("FORM", form).replace("SKIN", skin).replace("GO", str(steps[0])).replace("SLIDE", str(steps[1])))
        command = ["oclgrind", "--build-options", "-disable-llvm-passes", "--max-errors", "10000", "--log", self.path("log"), *options]
        command += [CLAST, "run", self.path("scene.yaml"), "--out", self.path("result.h5"), "--quiet", "--precision", precision]
        done = subprocess.run(command + (["--kernels", kernels] if kernels else []), capture_output=True, text=True, timeout=300,
                              env={**os.environ, "XDG_CACHE_HOME": self.folder})
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.path("log")) as file:
            text = file.read()
        return [entry for entry in re.split(r"\n\n(?=\S)", "\n" + text) if entry.strip()]

    def check_memory_and_races(self, **how):
        """The particle stage of every grain may tell the batch to halt while another reads whether it has to: all write the same value,
        and it never means the step under way."""
        entries = self.run_scene("--data-races", "--check-api", **how)
        halting = [entry for entry in entries if "data race" in entry and ("Kernel: particle_stage" in entry or "Kernel: step_loop" in entry) and "halt_step" in entry]
        others = [entry for entry in entries if entry not in halting]
        self.assertFalse(others, "\n".join(others[:10]))

    def without_prefetch(self):
        """Oclgrind does not know that instruction, which changes nothing."""
        return self.changed_kernels("stage/rows.cl", "__builtin_prefetch((const void *)(size_t)(address), to_change, near)", "")

    def test_two_kernels(self):
        self.check_memory_and_races(form="kernel_form: items, step_form: two_kernels")

    def test_one_group_in_mixed_precision(self):
        self.check_memory_and_races(form="kernel_form: items, step_form: one_group", precision="mixed")

    def test_blocks(self):
        self.check_memory_and_races(form="kernel_form: blocks", kernels=self.without_prefetch())

    def test_loose_blocks_in_mixed_precision(self):
        """A skin of more than a quarter of a radius: who touches is looked for and marked."""
        self.check_memory_and_races(form="kernel_form: blocks", precision="mixed", kernels=self.without_prefetch(), skin="3.0e-4")

    def test_phases_in_mixed_precision(self):
        self.check_memory_and_races(form="kernel_form: blocks, step_form: phases, chunk_records: 64", kernels=self.without_prefetch(), precision="mixed")

    def test_broken_kernel(self):
        """An access outside a buffer does not go unseen."""
        kernels = self.changed_kernels("stage/table.cl", "where[id[i]] = i;", "{ where[id[i]] = i; where[id[i] + 100000000] = i; }")
        entries = self.run_scene(kernels=kernels, steps=(1, 1))
        self.assertTrue(any("Invalid write" in entry and "table_where" in entry for entry in entries), entries[:3])


if __name__ == "__main__":
    unittest.main()
