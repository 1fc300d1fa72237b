"""tools/plot draws from a results file alone, and says in one line what it cannot draw."""
import contextlib
import importlib.machinery
import importlib.util
import io
import os
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

ROOT = os.environ.get("CLAST_SOURCE_DIR", os.path.join(os.path.dirname(__file__), "..", ".."))
PLOT = os.path.join(ROOT, "tools", "plot")
sys.dont_write_bytecode = True
plot = importlib.util.module_from_spec(importlib.util.spec_from_loader("plot", importlib.machinery.SourceFileLoader("plot", PLOT)))
plot.__spec__.loader.exec_module(plot)


def series(group, name, value, unit, time):
    element = group.create_group(name)
    element["value"] = value
    element["value"].attrs["unit"] = unit
    element["time"] = time
    element["step"] = np.arange(len(time))


def results(path, dimensions=3):
    """Two grains apart along x: the left one is seen from -y only where the right one is not in front."""
    time = np.array([0.0, 0.5, 1.0])
    x = np.zeros((3, 3, 3))
    x[:, 1] = [4, 0, 0]
    x[:, 2] = [4, -3, 0]  # hides grain 1 from -y
    x[2, 0] = np.nan      # left
    with h5py.File(path, "w") as f:
        particles = f.create_group("particles/all")
        series(particles, "position", x, "m", time)
        series(particles, "velocity", np.arange(27.0).reshape(3, 3, 3), "m/s", time)
        particles["radius"] = np.array([1.0, 1.0, 1.0])
        particles["group"] = np.array([0, 1, 2], np.int32)
        series(f.create_group("observables"), "kinetic_energy", np.array([3.0, 2.0, 1.0]), "J", time)
        series(f["observables"], "walls/floor/force", np.ones((3, 3)), "N", time)
        f["clast/scene"] = f"dimensions: {dimensions}\n"


class TestPlot(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = os.path.join(self.folder.name, "a.h5")
        self.out = os.path.join(self.folder.name, "a.png")
        results(self.file)

    def test_study(self):
        """A study's points as two panels; a results file is none."""
        study = os.path.join(self.folder.name, "accuracy.h5")
        with h5py.File(study, "w") as f:
            points, curves = f.create_group("points"), f.create_group("curves")
            error = np.array([1e-2, 1e-4, np.nan, 1e-3])
            for name, value in (("error", error), ("error_bar", [np.nan, np.nan, np.nan, 2e-4]), ("time_s", [1, 2, 3, 1]),
                                ("particle_steps", [10, 20, 30, 10]), ("reference_uncertainty", [1e-6] * 4), ("pareto", [0, 1, 0, 1])):
                points[name] = np.array(value, float)
            points["choice"] = ["a", "a", "a", "b"]
            curves["choice"], curves["along"], curves["order"] = ["a", "b"], ["share of the recommended step", "modulus factor"], [2.0, np.nan]
        for ending in ("png", "svg"):
            picture = os.path.join(self.folder.name, "study." + ending)
            self.assertEqual(self.plot("study", study, "--out", picture), (0, ""))
            self.assertGreater(os.path.getsize(picture), 5000)
        with open(picture) as drawn:
            self.assertIn("order 2.00", drawn.read())
        code, said = self.plot("study", self.file, "--out", picture)
        self.assertEqual((code, len(said.splitlines())), (2, 1))
        self.assertIn("no study", said)

    def plot(self, *arguments):
        """In this process: importing matplotlib takes longer than drawing."""
        with contextlib.redirect_stderr(io.StringIO()) as said:
            return plot.main(arguments), said.getvalue()

    def draws(self, *arguments):
        self.assertEqual(self.plot(*arguments), (0, ""))
        self.assertGreater(os.path.getsize(arguments[arguments.index("--out") + 1]), 1000)

    def refuses(self, words, *arguments):
        code, said = self.plot(*arguments)
        self.assertEqual((code, said.count("\n")), (2, 1), said)
        self.assertIn(words, said)

    def test_command(self):
        done = subprocess.run([PLOT, "bed", self.file + "x", "--out", self.out], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        done = subprocess.run([PLOT, "bed", "--help"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0)
        self.assertIn("--film", done.stdout)

    def test_draws_beds(self):
        self.draws("bed", self.file, "--out", self.out)
        self.draws("bed", self.file, "--out", self.out, "--film", "3", "--field", "velocity_z", "--view", "-y", "--range", "-1", "9")
        self.draws("bed", self.file, "--out", self.out, "--frames", "0,-1", "--field", "group", "--cut", "y=-1", "--view", "30,40")
        self.draws("bed", self.file, "--out", os.path.join(self.folder.name, "a.svg"), "--time", "0.4")
        results(self.file, dimensions=2)
        self.draws("bed", self.file, "--out", self.out)

    def with_contacts(self):
        """A bond of grains 1 and 2 in the first two frames, a mere contact in the last."""
        with h5py.File(self.file, "a") as f:
            contacts = f.create_group("contacts")
            contacts["offset"] = np.array([0, 1, 2], np.int64)
            for name, value in (("i", [1, 1, 1]), ("j", [2, 2, 2]), ("wall", [-1, -1, -1]), ("bonded", [1, 1, 0])):
                contacts[name] = np.array(value, np.int32)

    def test_bonds_and_clusters(self):
        self.refuses("contacts: true", "bed", self.file, "--out", self.out, "--bonds")
        self.with_contacts()
        self.draws("bed", self.file, "--out", self.out, "--bonds", "--field", "cluster")
        found = plot.Results(self.file)
        self.assertEqual(found.clusters(0).tolist(), [0, 1, 1])
        self.assertEqual(found.clusters(2).tolist(), [0, 1, 2])
        rank, names = plot.ranks(found, [0, 1])
        self.assertEqual((rank[0].tolist(), names), ([0, 2, 2], ["single", "others", "2 grains"]))
        found.file.close()
        self.assertTrue(self.orange_sticks("--bonds"))
        self.assertFalse(self.orange_sticks())
        with h5py.File(self.file, "a") as f:  # as stored, where it is
            series(f["particles/all"], "cluster", np.array([[0, 0, 0]] * 3, np.int32), "1", np.array([0.0, 0.5, 1.0]))
        self.assertEqual(plot.Results(self.file).clusters(2).tolist(), [0, 0, 0])

    def orange_sticks(self, *arguments):
        import matplotlib.image
        self.draws("bed", self.file, "--out", self.out, "--field", "cluster", "--frame", "0", "--view", "z", *arguments)
        rgb = matplotlib.image.imread(self.out)[:, :-126, :3]
        return (rgb[..., 0] > rgb[..., 2] + 0.5).sum() > 100

    def test_draws_observables(self):
        self.draws("observables", self.file, "--out", self.out)
        self.draws("observables", self.file, "--out", self.out, "--names", "walls/floor/force", "--log")

    def colours(self, *arguments):
        """Which of the three colours of the groups are in the picture, the colour bar left out."""
        import matplotlib.image
        self.draws("bed", self.file, "--out", self.out, "--field", "group", *arguments)
        rgb = matplotlib.image.imread(self.out)[:, :-126, :3]
        blue = (rgb[..., 2] > rgb[..., 1] + 0.1).sum()
        green = ((rgb[..., 1] > rgb[..., 0] + 0.2) & (rgb[..., 1] > rgb[..., 2] + 0.05)).sum()
        orange = (rgb[..., 0] > rgb[..., 2] + 0.4).sum()
        return blue > 500, orange > 500, green > 500

    def test_near_grains_hide_far_ones(self):
        self.assertEqual(self.colours("--view", "-y", "--frame", "0"), (True, False, True))
        self.assertEqual(self.colours("--view", "y", "--frame", "0"), (True, True, False))
        self.assertEqual(self.colours("--view", "-y", "--frame", "0", "--cut", "y=-1"), (True, True, False))
        self.assertEqual(self.colours("--view", "-y", "--frame", "2"), (False, False, True))  # grain 0 has left

    def test_refuses_in_one_line(self):
        self.refuses("no such file", "bed", self.file + "x", "--out", self.out)
        self.refuses("velocity_z", "bed", self.file, "--out", self.out, "--field", "colour")
        self.refuses("0 to 2", "bed", self.file, "--out", self.out, "--frame", "3")
        self.refuses("kinetic_energy", "observables", self.file, "--out", self.out, "--names", "heat")
        self.refuses(".png", "bed", self.file, "--out", self.out + ".jpg")
        self.refuses("y=0.05", "bed", self.file, "--out", self.out, "--cut", "w=1")
        self.refuses("cannot be written", "bed", self.file, "--out", os.path.join(self.folder.name, "no", "a.png"))
        self.refuses("cannot be read", "bed", PLOT, "--out", self.out)


if __name__ == "__main__":
    unittest.main()
