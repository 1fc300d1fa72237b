"""Shipped scenes in mixed precision against double, within the bounds of tools/compare_precision: those that take a moment. The tool does all."""
import os
import subprocess
import unittest

TOOL = os.path.join(os.environ["CLAST_SOURCE_DIR"], "tools", "compare_precision")
SCENES = ["oblique_impact", "bond_pair", "burner_bed", "thermal_base", "friction_heating", "vibrated_layer"]


class MixedPrecision(unittest.TestCase):
    def compare(self, *precisions):
        return subprocess.run([TOOL, "--clast", os.environ["CLAST"], "--precisions", ",".join(precisions)] + SCENES, capture_output=True, text=True)

    def test_scenes(self):
        done = self.compare("double", "mixed")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count("\n"), 2 + len(SCENES))


if __name__ == "__main__":
    unittest.main()
