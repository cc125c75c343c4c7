"""Type hints, pickling, displays, plots and versions of the module."""

import ast
import multiprocessing
import pickle
import unittest

import numpy as np
import tress
from common import ROOT, SCENES

PACKAGE = ROOT / "python/tress"


def tip_of(scene):
    return scene.run().positions[-1, -1]


def short(name="cantilever"):
    return tress.Scene.read(SCENES / f"{name}.toml").changed({"duration_s": 0.06})


class Versions(unittest.TestCase):
    def test_one_version(self):
        self.assertEqual(tress.__version__, (ROOT / "VERSION").read_text().strip())
        text = tress.version_text()
        self.assertTrue(text.startswith(f"tress {tress.__version__} ("), text)
        self.assertIn("instructions: ", text)


class Hints(unittest.TestCase):
    def test_every_function_has_types_and_public_ones_have_docstrings(self):
        self.assertTrue((PACKAGE / "py.typed").exists())
        for file in PACKAGE.glob("*.py"):
            for node in ast.walk(ast.parse(file.read_text())):
                if not isinstance(node, ast.FunctionDef):
                    continue
                where = f"{file.name}:{node.lineno}: {node.name}"
                arguments = [a for a in node.args.args if a.arg not in ("self", "cls")]
                self.assertIsNotNone(node.returns, where)
                self.assertTrue(all(a.annotation for a in arguments), where)

    def test_public_names_have_docstrings(self):
        for name in tress.__all__:
            self.assertTrue(getattr(tress, name).__doc__, name)


class Pickles(unittest.TestCase):
    def test_other_processes_run_scenes(self):
        scene = short()
        again = pickle.loads(pickle.dumps(scene))
        self.assertEqual((again.text(), again.file), (scene.text(), scene.file))
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            np.testing.assert_array_equal(pool.map(tip_of, [scene])[0], tip_of(scene))


class Displays(unittest.TestCase):
    def test_strands_are_drawn(self):
        scene = short()
        self.assertIn("<polyline", scene._repr_html_())
        frames = scene.run()
        # Eight frames at most, of one strand each.
        self.assertEqual(frames._repr_svg_().count("<polyline"), min(8, len(frames.times)))

    def test_branches_of_a_tree_are_lines(self):
        frames = short("willow").run()
        lines = frames.polylines(0)
        starts = np.count_nonzero(frames.before != np.arange(-1, frames.before.size - 1))
        self.assertEqual(len(lines), starts + 1)
        pieces = sum(len(line) - 1 for line in lines)
        self.assertEqual(pieces, np.count_nonzero(frames.before >= 0))

    def test_tables_are_tables(self):
        table = tress.read_table(ROOT / "results/stability_limit.csv")
        text = table._repr_html_()
        self.assertIn("<th>dt_max_s</th>", text)
        self.assertIn(f"{table.rows} rows", text)
        self.assertEqual(len(table.pandas()), table.rows)


class Plots(unittest.TestCase):
    def setUp(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("python3-matplotlib is not installed")
        matplotlib.use("Agg")

    def test_motion_and_energy(self):
        frames = short().run()
        axes = tress.plot.motion(frames, count=3)
        self.assertEqual(len(axes.lines), 3)
        np.testing.assert_array_equal(axes.lines[-1].get_xdata(), frames.positions[-1, :, 0])
        with self.assertRaisesRegex(tress.InputError, "unknown plane"):
            tress.plot.motion(frames, plane="xw")
        energies = tress.plot.energy(frames, names=["kinetic_j"])
        np.testing.assert_array_equal(energies.lines[0].get_ydata(), frames.series["kinetic_j"])

    def test_tables(self):
        limits = tress.read_table(ROOT / "results/stability_limit.csv").where(study="grid")
        image = tress.plot.stability_map(limits).images[0].get_array()
        good = limits.where(status="ok")
        self.assertEqual(image.shape, (len(set(good["integrator"])), len(set(good["model"]))))
        self.assertAlmostEqual(10 ** np.nanmin(image), np.nanmin(good["dt_max_s"]))
        with self.assertRaisesRegex(tress.InputError, "no column 'error_rel'"):
            tress.plot.work_precision(limits)
        runs = tress.read_table(ROOT / "results/work_precision.csv").where(scene="beam")
        axes = tress.plot.work_precision(runs)
        points = sum(len(line.get_xdata()) for line in axes.lines)
        self.assertEqual(points, runs.where(status="ok").rows)


class Errors(unittest.TestCase):
    def test_half_the_step_has_a_smaller_error(self):
        scene = short().changed({"integrator.id": "tr_bdf2", "integrator.dt_s": 0.01})
        coarse = tress.error_bars(scene)
        fine = tress.error_bars(scene.changed({"integrator.dt_s": 0.005}))
        self.assertLess(fine.time.strands[0].largest, coarse.time.strands[0].largest)
        self.assertEqual(coarse.space.missing, "")
        self.assertEqual(coarse.time.largest.max(), coarse.time.strands[0].largest)
        self.assertGreater(coarse.time.bound, 1)


if __name__ == "__main__":
    unittest.main()
