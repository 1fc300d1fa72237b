"""The pair stage is vector code on an x86 CPU under pocl: its square roots and divisions take several pairs at a time. (A law that ends
vectorisation, by a call or a branch that cannot be flattened, costs several times the whole effect.)"""
import importlib.machinery
import importlib.util
import os
import platform
import shutil
import subprocess
import tempfile
import unittest

CLAST = os.environ["CLAST"]


def load_tool(name):
    loader = importlib.machinery.SourceFileLoader(name, os.path.join(os.environ["CLAST_SOURCE_DIR"], "tools", name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


VECTOR = load_tool("vector_code")

SCENE = """
gravity_m_s2: [0, 0, -9.81]
effects: [EFFECTS]
materials: [{name: glass, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3, conductivity_w_mk: 1, specific_heat_j_kgk: 800}]
interactions: [{between: default, restitution: 0.5, friction_static: 0.4, friction_dynamic: DYNAMIC, rolling_friction: 0.02,
                 bond_equilibrium_strain: 0.01, bond_threshold: 1000, bond_exponent: EXPONENT, bond_youngs_modulus_pa: 1.0e6, surface_energy_j_m2: 1,
                 boundary_diffusion_m3_s: 1.0e-15, atomic_volume_m3: 1.0e-29, activation_energy_j_mol: 1.0e5, repulsion_stiffness: 1.0e5, normal_stiffness_n_m: 1000, tangential_stiffness_n_m: 500}]
particles:
  - {name: bed, material: glass, generator: lattice, lattice: simple_cubic, counts: [5, 5, 5], spacing_m: 2.0e-3, radius_m: 1.0e-3, temperature_k: 300}
WALLS
stages: [{name: go, until: {steps: 2}, step_s: 1.0e-5}]
contact_table: {step_form: two_kernels}
"""
HERTZ = "{slot: normal, law: hertz}"
MINDLIN = HERTZ + ", {slot: tangential, law: mindlin}"
LINEAR = "{slot: normal, law: linear}, {slot: tangential, law: coulomb_linear}"
ROLLING = ", {slot: rolling, law: elastic_plastic}"
ADHESION = ", {slot: bond, law: adhesion}"
CONDUCTION = ", {slot: conduction, law: overlap_area}"
PLANE = "walls: [{name: floor, shape: plane, point_m: [0, 0, -0.001], normal: [0, 0, 1]}]"
HOT = "walls: [{name: floor, shape: plane, point_m: [0, 0, -0.001], normal: [0, 0, 1], temperature_k: 400}]"
BOX = "walls: [{name: box, shape: box, low_m: [-0.001, -0.001, -0.001], high_m: [0.01, 0.01, 0.1]}]"
PERIODIC = "domain: {low_m: [0, 0, -1], high_m: [0.01, 0.01, 1], periodic: [x, y]}"


class Vectorised(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if platform.machine() != "x86_64":
            raise unittest.SkipTest(f"{platform.machine()} is no x86 CPU")
        with open("/proc/cpuinfo") as file:
            if " avx2 " not in file.read():
                raise unittest.SkipTest("this CPU has no AVX2")
        if not shutil.which("objdump"):
            raise unittest.SkipTest("there is no objdump")
        devices = subprocess.run([CLAST, "devices"], capture_output=True, text=True, timeout=100)
        if "pthread" not in devices.stdout and "cpu" not in devices.stdout:
            raise unittest.SkipTest(f"there is no pocl device: {devices.stdout}{devices.stderr}")
        cls.caches = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.caches.cleanup)

    def check(self, effects, walls, dynamic="0.4", exponent="1", scene=SCENE):
        text = scene.replace("EFFECTS", effects).replace("WALLS", walls).replace("DYNAMIC", dynamic).replace("EXPONENT", exponent)
        code = VECTOR.machine_code(CLAST, text, caches=self.caches.name)
        if code is None:
            self.skipTest("this pocl leaves no pair_stage in its cache")
        found = VECTOR.counts(code)
        self.assertGreater(found["vector roots"], 0 if effects == HERTZ else 1, f"{effects}: {found}")
        self.assertGreater(found["vector divisions"], 1, f"{effects}: {found}")
        self.assertEqual(found["calls"], [], f"{effects}: {found}")
        return found

    def test_contact(self):
        self.check(HERTZ, PLANE)

    def test_conduction_alone(self):
        self.check(HERTZ + CONDUCTION, PLANE)

    def test_friction_and_plane(self):
        """Records of walls without borders are vector code beside those of pairs; those of a box are not."""
        self.assertGreater(self.check(MINDLIN, PLANE)["vector roots"], self.check(MINDLIN, BOX)["vector roots"])

    def test_many_steps_in_one_launch(self):
        """The kernel that CPUs take by themselves is made of the same bodies."""
        text = SCENE.replace("EFFECTS", MINDLIN + ROLLING).replace("WALLS", BOX).replace("DYNAMIC", "0.4").replace("EXPONENT", "1")
        pairs = VECTOR.machine_code(CLAST, text, "pair_stage")
        code = VECTOR.machine_code(CLAST, text.replace("two_kernels", "one_group"), "step_loop")
        if code is None or pairs is None:
            self.skipTest("this pocl leaves no kernels in its cache")
        found, least = VECTOR.counts(code), VECTOR.counts(pairs)
        self.assertGreaterEqual(found["vector roots"], least["vector roots"], f"{found}, alone {least}")
        self.assertGreater(found["vector divisions"], least["vector divisions"], f"{found}, alone {least}")  # those of the particle stage too
        self.assertEqual(found["calls"], [])

    def test_two_dimensions(self):
        flat = SCENE.replace("[0, 0, -9.81]", "[0, -9.81, 0]\ndimensions: 2").replace("[5, 5, 5]", "[5, 5, 1]")
        floor = PLANE.replace("0, 0, -0.001", "0, -0.001, 0").replace("0, 0, 1]", "0, 1, 0]")
        self.check(MINDLIN + ROLLING, floor, scene=flat)
        self.check(MINDLIN + ROLLING, floor + "\nprecision: mixed", scene=flat)

    def test_mixed(self):
        self.check(MINDLIN + ROLLING, PLANE + "\nprecision: mixed")

    def test_rolling_and_box_with_two_frictions(self):
        self.check(MINDLIN + ROLLING, BOX, "0.3")

    def test_conduction_and_hot_plane(self):
        self.check(MINDLIN + ROLLING + CONDUCTION, HOT)

    def test_rolling_and_what_is_dissipated(self):
        self.check(MINDLIN + ROLLING + CONDUCTION + ", {slot: dissipation_heat, law: fraction}", PLANE)

    def test_linear_periodic(self):
        self.check(LINEAR, PERIODIC)

    def test_parallel(self):
        self.check(MINDLIN + ", {slot: bond, law: parallel, criterion: at_time}", PLANE)

    def test_sintering(self):
        self.check(MINDLIN + ", {slot: bond, law: sintering}", PLANE)

    def test_liquid(self):
        self.check(MINDLIN + ", {slot: bond, law: parallel, criterion: both_above, while_met: liquid}", PLANE)

    def test_adhesion(self):
        self.check(MINDLIN + ROLLING + ADHESION, PLANE)

    def test_powers(self):
        bond = ", {slot: bond, law: adhesion, criterion: at_time, while_met: liquid}"
        self.check("{slot: normal, law: power}, {slot: tangential, law: mindlin}" + bond, PLANE, exponent="1.1")


if __name__ == "__main__":
    unittest.main()
