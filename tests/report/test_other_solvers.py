"""Other solver packages, without the packages: /usr/bin/python3 tests/report/test_other_solvers.py"""
import csv
import ctypes
import math
import subprocess
import sys
import tempfile
import unittest

from repository import ROOT, Made, Study, Tables, markdown

PLACE = ROOT / "experiments/other_solvers"
sys.path.insert(0, str(PLACE))
import run  # noqa: E402
import solvers  # noqa: E402
from definitions import FORMULATIONS, PROBLEMS, SCALES, Problem, compiled, published_end, reference  # noqa: E402

try:
    from scipy.integrate import solve_ivp
except ImportError:
    solve_ivp = None


class Definitions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.library = compiled(cls.folder.name)

    def residual(self, name, formulation, y, yp):
        problem = Problem(self.library, name, formulation)
        r = (ctypes.c_double * problem.count)()
        problem.call("residual", problem.t_end, (ctypes.c_double * problem.count)(*y), (ctypes.c_double * problem.count)(*yp), r)
        return problem, list(r)

    def test_published_accelerations_and_multipliers_balance(self):
        # Forces are of the size of lambda times lengths of the mechanisms; the printed numbers have 13 digits or more.
        for name, largest_force in (("andrews_squeezer", 1), ("slider_crank", 100)):
            end = published_end(name)
            multipliers = [0.0] * len(end["lambda"])
            problem, r = self.residual(name, "index3", end["q"] + end["v"] + end["lambda"], end["v"] + end["a"] + multipliers)
            self.assertLess(max(map(abs, r)), 1e-9 * largest_force, name)
            self.assertLess(problem.drift(end["q"]), 1e-12, name)

    def test_published_end_of_the_car_axis_keeps_its_multipliers(self):
        end = published_end("car_axis")
        problem = Problem(self.library, "car_axis", "ode")
        dy = (ctypes.c_double * 8)()
        problem.call("right_side", problem.t_end, (ctypes.c_double * 8)(*end["q"], *end["v"]), dy)
        _, r = self.residual("car_axis", "index3", end["q"] + end["v"] + end["lambda"], [*dy, 0, 0])
        self.assertLess(max(map(abs, r)), 1e-13)

    def test_starts_are_consistent_in_every_formulation(self):
        for name in PROBLEMS:
            for formulation in FORMULATIONS[:4]:
                problem = Problem(self.library, name, formulation)
                r = (ctypes.c_double * problem.count)()
                problem.call("residual", 0.0, problem.y, problem.yp, r)
                # Forces on the rod of the slider crank are up to 1e4 N.
                self.assertLess(max(map(abs, r)), 1e-10, (name, formulation))

    @unittest.skipUnless(solve_ivp, "scipy is not installed")
    def test_scipy_reaches_the_published_ends(self):
        for name, tolerance, least in (("andrews_squeezer", 1e-10, 8), ("car_axis", 1e-10, 8), ("beam", 1e-7, 5), ("filament", 1e-9, 8)):
            problem = Problem(self.library, name, "ode")

            def right_side(t, y):
                dy = (ctypes.c_double * problem.count)()
                problem.call("right_side", t, (ctypes.c_double * problem.count)(*y), dy)
                return list(dy)

            done = solve_ivp(right_side, (0, problem.t_end), list(problem.y), method="DOP853", rtol=tolerance,
                             atol=[tolerance * size for size in problem.size])
            self.assertGreater(run.correct_digits(done.y[:problem.n, -1], *reference(name), SCALES.get(name)), least, name)

    def test_the_converged_end_of_the_slider_crank_has_the_published_digits(self):
        end = published_end("slider_crank")
        self.assertGreater(run.correct_digits(end["q"], reference("slider_crank")[0], 16), end["digits_q"])


class Runs(unittest.TestCase):
    def test_the_error_is_that_of_the_worst_entry_and_at_most_the_digits_of_the_reference(self):
        self.assertAlmostEqual(run.correct_digits([1.001, 2], [1, 2], 9), 3)
        self.assertEqual(run.correct_digits([1, 2], [1, 2], 9), 9)
        self.assertEqual(run.correct_digits([math.nan, 2], [1, 2], 9), -math.inf)
        self.assertAlmostEqual(run.correct_digits([.01, 5], [0, 5], 9, 10), 3)

    def test_a_run_without_an_end_is_a_row_with_its_reason(self):
        solver = next(one for one in solvers.SOLVERS if one.package == "scipy")
        fails = [sys.executable, "-c", "import sys; print('version 1'); sys.exit('no memory')"]
        row = run.foreign_row(solver, fails, "problems.so", "beam", "1e-6")
        self.assertEqual((row["status"], row["reason"], row["version"]), ("solver_error", "no memory", "1"))
        self.assertEqual(run.line(row), "beam scipy.Radau ode rtol=1e-6: solver_error: no memory")

    def test_a_missing_package_ends_in_one_line_with_the_remedy(self):
        done = subprocess.run([sys.executable, str(PLACE / "run.py"), "beam", "--solver", "deSolve"], capture_output=True, text=True,
                              env={"PATH": ""})
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"^other_solvers: deSolve cannot be run; install .*packages\.txt\)\n$")

    def test_the_stored_table_has_every_column_and_a_reason_for_each_failure(self):
        path = ROOT / "results/other_solvers.csv"
        with path.open(newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0]), list(run.COLUMNS))
        self.assertEqual({row["problem"] for row in rows}, set(PROBLEMS))
        self.assertGreaterEqual(len({row["package"] for row in rows} - {"tress"}), 4)
        for row in rows:
            self.assertEqual(row["status"] == "ok", row["reason"] == "", row)
            self.assertEqual(row["status"] == "ok", row["digits"] != "", row)


class Page(Made):
    ROW = {"problem": "beam", "package": "P", "version": "1", "solver": "s", "formulation": "ode", "jacobian": "none",
           "max_order": "", "reference_digits": 11, "status": "ok"}

    def rows(self):
        return [{**self.ROW, "rtol": tolerance, "digits": digits, "steps": 10, "evaluations": 20, "jacobians": 1, "wall_s": .5}
                for tolerance, digits in (("1e-4", 3.14), ("1e-6", 5))] + [
                {**self.ROW, "rtol": "1e-8", "status": "timeout", "reason": "not finished"}]

    def test_a_line_has_digits_and_the_cost_at_the_middle_tolerance(self):
        self.say("other_solvers.counts", other_solvers=self.rows())
        said = markdown(Study("other_solvers", Tables(self.root)).problem_table("beam"))
        self.assertIn("| P `s` | ode | 3.1 | 5 | timeout | 10 | 20 | 1 | 500 ms |", said)


if __name__ == "__main__":
    unittest.main()
