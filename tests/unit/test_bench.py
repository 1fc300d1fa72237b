"""clast bench effects and clast bench kernels on a bed of a few hundred grains: what they write, and that their tables belong together. No test
looks at a time."""
import csv
import json
import os
import subprocess
import tempfile
import unittest

CLAST = os.environ["CLAST"]
SOURCE = os.environ["CLAST_SOURCE_DIR"]


def bench(*words):
    done = subprocess.run([CLAST, "bench", *words, "--particles", "500", "--device", "cpu"], capture_output=True, text=True, timeout=900)
    if done.returncode:
        raise AssertionError(done.stderr)
    return done.stdout


def table(path):
    with open(path) as file:
        assert file.readline().startswith("# device: ")
        return list(csv.DictReader(file))


class Bench(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = lambda name: os.path.join(folder.name, name)

    def draw(self, name):
        try:
            import matplotlib  # noqa: F401
        except ImportError:
            return
        subprocess.run([os.path.join(SOURCE, "tools", "plot_bench"), self.path(name), "--out", self.path("p.png")], check=True, timeout=300)
        self.assertGreater(os.path.getsize(self.path("p.png")), 10000)

    def test_effects(self):
        text = bench("effects", "--seconds", "1", "--only", "constant_torque,pipe_network,+ tangential,mixed", "--csv", self.path("e.csv"), "--json", self.path("e.json"))
        rows = {(r["series"], r["name"]): r for r in table(self.path("e.csv"))}
        self.assertEqual(set(rows), {("alone", "rolling constant_torque"), ("one by one", "+ tangential mindlin"), ("setting", "mixed precision")})
        friction = rows["one by one", "+ tangential mindlin"]
        self.assertEqual(friction["reference"], "normal hertz")
        self.assertLessEqual(float(friction["difference_ns_low"]), float(friction["difference_ns_high"]))
        # spring and torques of a record, see test_traffic.c; mixed precision halves what a record holds, but for its two places
        self.assertEqual(float(friction["bytes_record"]) - 32, 48 + 24)
        # spring, force and torque in float; the array of torques has room for what records keep side by side
        self.assertEqual(float(rows["setting", "mixed precision"]["bytes_record"]), 8 + (24 + 64 + 24) / 2)
        self.assertIn("for discs", text)  # a case that may not be is named
        with open(self.path("e.json")) as file:
            kept = json.load(file)
        self.assertEqual(kept["particles"], 500)
        refused = [c for c in kept["cases"] if "refused" in c]
        self.assertEqual([c["name"] for c in refused], ["conduction pipe_network"])
        self.draw("e.csv")

    def test_scenes(self):
        bench("effects", "--scenes", self.path(""))
        names = sorted(os.listdir(self.path("")))
        self.assertGreater(len(names), 30)
        friction = next(name for name in names if name.endswith("one_by_one___tangential_mindlin.yaml"))
        subprocess.run([CLAST, "check", self.path(friction)], check=True, capture_output=True, timeout=300)

    def test_scene_of_the_validation(self):
        subprocess.run([CLAST, "check", os.path.join(SOURCE, "scenarios", "validation", "silo.yaml")], check=True, capture_output=True, timeout=300)

    def test_kernels(self):
        bench("kernels", "--steps", "5", "--effects", "conduction", "--csv", self.path("k.csv"), "--json", self.path("k.json"))
        rows = table(self.path("k.csv"))
        step = [r for r in rows if r["phase"] == "step"]
        self.assertEqual({r["kernel"] for r in step}, {"pair_stage", "particle_stage"})
        self.assertEqual([float(r["launches"]) for r in step], [1.0, 1.0])
        for phase in ("step", "table", "between steps"):
            self.assertAlmostEqual(sum(float(r["share"]) for r in rows if r["phase"] == phase), 1.0, places=2)
        self.assertIn("table_fill", {r["kernel"] for r in rows})
        with open(self.path("k.json")) as file:
            kept = json.load(file)
        moved = sum(k["bytes"] for k in kept["kernels"] if k["phase"] == "step")
        self.assertAlmostEqual(moved / kept["step_bytes"], 1.0, places=6)
        self.draw("k.csv")


if __name__ == "__main__":
    unittest.main()
