"""The balance of heat of shipped scenes, by tools/heat_balance: those that take a moment, as they are, and one with every effect of heat added. The
tool does all."""
import os
import subprocess
import unittest

TOOL = os.path.join(os.environ["CLAST_SOURCE_DIR"], "tools", "heat_balance")


class HeatBalance(unittest.TestCase):
    def check(self, paths, *words):
        """`paths`: which columns of each scene are not empty."""
        done = subprocess.run([TOOL, "--clast", os.environ["CLAST"]] + list(words), capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in done.stdout.splitlines()[2:]]
        self.assertEqual({row[0]: [n for n in range(5) if row[2 + n]] for row in rows}, paths)
        return {row[0]: row for row in rows}

    def test_as_shipped(self):
        self.check({"burner_bed": [0], "thermal_base": [3], "friction_heating": [4]}, "burner_bed", "thermal_base", "friction_heating")

    def test_all_effects(self):
        rows = self.check({"thermal_base": [0, 1, 2, 3, 4]}, "--all-effects", "thermal_base")
        self.assertLess(float(rows["thermal_base"][7]), 1e-12)


if __name__ == "__main__":
    unittest.main()
