"""Scripts of python/examples; first_run is the one of docs/python.md."""
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import tress
from common import ROOT

EXAMPLES = ROOT / "python" / "examples"


class Examples(unittest.TestCase):
    def run_example(self, name, *words):
        done = subprocess.run(
            [sys.executable, EXAMPLES / f"{name}.py", *map(str, words)],
            capture_output=True, text=True, env=os.environ, timeout=120,
        )  # fmt: skip
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_first_run(self):
        # From 10 to 20 elements the tip moves less than from 5 to 10.
        tips = [
            (float(words[4]), float(words[8]))
            for words in map(str.split, self.run_example("first_run").splitlines())
        ]
        self.assertEqual(len(tips), 3)
        first, second = (math.dist(*pair) for pair in zip(tips, tips[1:]))
        self.assertLess(second, first)

    def test_curl_frequencies(self):
        lines = self.run_example("curl_frequencies").splitlines()
        self.assertEqual(len(lines), 2)

    def test_stability_region(self):
        said = self.run_example("stability_region")
        # w h = 2 without damping; Runge-Kutta's 2 sqrt 2: found to 0.01.
        self.assertRegex(said, r"symplectic_euler: z = 0.0: .* = (1.99|2.00)\n")
        self.assertRegex(said, r"rk4: z = 0.0: .* = 2.8[23]\n")

    def test_fit_drag(self):
        said = self.run_example("fit_drag").split()
        found, spread = float(said[1]), float(said[3])
        self.assertLess(abs(found - 2e-5), 4 * spread)

    def test_paper_figure(self):
        try:
            import matplotlib  # noqa: F401
        except ImportError:
            self.skipTest("python3-matplotlib is not installed")
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "figure.pdf"
            self.run_example("paper_figure", file)
            self.assertTrue(file.read_bytes().startswith(b"%PDF"))

    def test_solve_ivp(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "solve_ivp.csv"
            self.run_example("solve_ivp", file)
            table = tress.read_table(file)
        self.assertEqual(set(table["status"]), {"ok"})
        with_columns = tress.read_table(ROOT / "results" / "work_precision.csv")
        self.assertLessEqual(set(table), set(with_columns))
        for method in ("scipy_radau", "scipy_bdf"):
            self.assertEqual(table.where(integrator=method).rows, 2)
            # Tolerances bound errors of a step; a hundred times as much over the run.
            for row in range(2):
                one = table.where(integrator=method)
                self.assertLess(one["error_rel"][row], 100 * one["rtol"][row])


if __name__ == "__main__":
    unittest.main()
