import os
import signal
import tempfile
import threading
import tomllib
import unittest
from pathlib import Path

import numpy as np
import tress
from common import ROOT, SCENES


class Reading(unittest.TestCase):
    def test_every_shipped_scene_survives_dicts(self):
        files = sorted(SCENES.glob("*.toml"))
        self.assertGreater(len(files), 20)
        for file in files:
            with self.subTest(scene=file.name):
                if file.stem == "full_head":  # a million strands are not held at once
                    continue
                scene = tress.Scene.read(file)
                again = tress.Scene(scene.tables, file)
                self.assertEqual(again.tables, tomllib.loads(file.read_text()))
                self.assertEqual(again.text(), scene.text())

    def test_errors_say_where(self):
        with self.assertRaisesRegex(tress.InputError, "did you mean 'length_m'") as caught:
            tress.Scene.parse('title = "x"\n[strand]\nlenght_m = 0.1\n', "my.toml")
        self.assertRegex(caught.exception.place, r"my\.toml:3:\d+")
        with self.assertRaises(tress.InputError):
            tress.Scene.read("none.toml")
        with self.assertRaisesRegex(tress.InputError, "strand.x"):
            tress.Scene({"strand": {"x": object()}})

    def test_changes(self):
        scene = tress.Scene.read(SCENES / "cantilever.toml")
        other = scene.changed({"strand.elements": np.int64(7), "effects.linear_drag": None})
        self.assertEqual(other.tables["strand"]["elements"], 7)
        self.assertEqual(scene.tables["strand"]["elements"], 20)
        self.assertEqual(other.effects, ["gravity"])
        self.assertEqual(other.changed({"duration_s": 1}).duration, 1)
        with self.assertRaisesRegex(tress.InputError, "changed.toml"):
            scene.changed({"strand.elements": -1})


class Running(unittest.TestCase):
    def test_frames(self):
        scene = tress.Scene.read(SCENES / "cantilever.toml").changed({"duration_s": 0.1})
        frames = scene.run()
        count = len(scene.times())
        self.assertEqual(frames.positions.shape, (count, 21, 3))
        self.assertEqual(frames.velocities.shape, frames.positions.shape)
        np.testing.assert_array_equal(frames.strand, np.zeros(21))
        np.testing.assert_array_equal(frames.before, np.arange(-1, 20))
        np.testing.assert_allclose(frames.radii, 50e-6)
        np.testing.assert_array_equal(frames.times, scene.times())
        np.testing.assert_array_equal(frames.series["tip_z_m"], frames.positions[:, -1, 2])
        self.assertEqual(frames.channels["load gravity"].shape, (count, 21))
        # rho S g
        weight = 1300 * np.pi * 50e-6**2 * 9.81
        np.testing.assert_allclose(frames.channels["load gravity"], weight, rtol=1e-3)
        self.assertLess(frames.positions[-1, -1, 2], 0)

    def test_contacts_are_forces(self):
        scene = tress.Scene.read(SCENES / "strand_on_slope.toml").changed({"duration_s": 0.05})
        frames = scene.run()
        self.assertTrue(any(len(contacts) for contacts in frames.contacts))

    def test_same_as_system_and_integrator(self):
        """One strand stepped by hand: the bits of the run."""
        scene = tress.Scene.read(SCENES / "cantilever.toml").changed({"duration_s": 0.1})
        frames = scene.run()
        system = scene.system()
        method = tress.Integrator(scene.integrator, system, step=scene.step).start()
        for t in scene.times()[1:]:
            method.advance(t)
        np.testing.assert_array_equal(system.points(0.1, method.q), frames.positions[-1])

    def test_threads_and_own_loop(self):
        scene = tress.Scene.read(SCENES / "hair_on_hair.toml").changed({"duration_s": 0.04})
        one, two = scene.run(), scene.run(threads=2)
        np.testing.assert_array_equal(one.positions, two.positions)
        run = scene.start()
        for t in scene.times()[1:]:
            run.advance(t)
        np.testing.assert_array_equal(run.positions, one.positions[-1])
        self.assertFalse(run.positions.flags.owndata)

    def test_mechanisms_and_trees(self):
        for name in ("bead_on_wire", "willow"):
            with self.subTest(scene=name):
                scene = tress.Scene.read(SCENES / f"{name}.toml").changed({"duration_s": 0.05})
                frames = scene.run()
                self.assertEqual(frames.positions.shape[1], frames.strand.size)
                self.assertEqual(frames.radii.size, frames.strand.size)

    def test_batches(self):
        scene = tress.Scene.read(SCENES / "head_moving_vertical.toml")
        batch = scene.changed({"duration_s": 0.02, "integrator.id": "linearly_implicit_euler"})
        try:
            frames = batch.run(kind="batch")
        except tress.InputError as error:
            self.fail(f"not a batch: {error}")
        self.assertEqual(frames.positions.shape[1], frames.strand.size)
        self.assertEqual(frames.failed, [])
        with self.assertRaises(tress.InputError):
            tress.Scene.read(SCENES / "bead_on_wire.toml").run(kind="batch")

    def test_former_names_are_refused_with_the_present_ones(self):
        scene = tress.Scene.read(SCENES / "head_moving_vertical.toml").changed({"duration_s": 0.02})
        for run in (scene.run, scene.start):
            with self.assertRaisesRegex(tress.InputError, "'head'.*it is called 'batch' now"):
                run(kind="head")
            with self.assertRaisesRegex(tress.InputError, r"'x' \(kind\): use one of: .*strands"):
                run(kind="x")
        batch = scene.start(kind="batch")
        for holder in (batch, batch.gather([batch.frame()])):
            self.assertEqual(holder.failed, [])
            with self.assertRaisesRegex(AttributeError, "'lost'; it is called 'failed' now"):
                holder.lost
            self.assertFalse(hasattr(holder, "nothing"))
        with self.assertRaisesRegex(tress.InputError, "'HeadRun'.*it is called 'BatchRun' now"):
            from tress import HeadRun  # noqa: F401
        self.assertFalse(hasattr(tress, "nothing"))

    def test_precision_of_a_batch(self):
        scene = tress.Scene.read(SCENES / "head_moving_vertical.toml")
        batch = scene.changed({"duration_s": 0.02, "integrator.id": "linearly_implicit_euler"})
        ends = []
        for precision in (64, 32):
            run = tress.BatchRun(batch, precision=precision)
            run.advance(0.02)
            ends.append(run.positions)
        # Rounding of single precision, 6e-8 of places of some 0.1 m, in few steps.
        self.assertGreater(np.abs(ends[1] - ends[0]).max(), 0)
        np.testing.assert_allclose(ends[1], ends[0], atol=1e-5)
        with self.assertRaisesRegex(tress.InputError, "'bits'.*it is called 'precision' now"):
            tress.BatchRun(batch, bits=32)
        with self.assertRaisesRegex(tress.InputError, "did you mean 'precision'"):
            tress.BatchRun(batch, precison=32)
        with self.assertRaisesRegex(tress.InputError, r"\(precision\): give 64 or 32"):
            tress.BatchRun(batch, precision=16)

    def test_failure_keeps_frames(self):
        scene = tress.Scene.read(SCENES / "cantilever.toml").changed(
            {"model": {"id": "der"}, "integrator": {"id": "rk4", "dt_s": 2e-3}}
        )
        with self.assertRaises(tress.SolveError) as caught:
            scene.run()
        self.assertGreaterEqual(len(caught.exception.frames.times), 1)

    def test_interrupt_and_progress(self):
        seen = []

        def progress(t, duration):
            seen.append(t)
            os.kill(os.getpid(), signal.SIGINT)

        scene = tress.Scene.read(SCENES / "cantilever.toml")
        with self.assertRaises(KeyboardInterrupt):
            scene.run(progress=progress)
        self.assertEqual(len(seen), 1)


class Tables(unittest.TestCase):
    def test_every_table_of_results(self):
        files = sorted((ROOT / "results").glob("*.csv"))
        self.assertGreater(len(files), 8)
        for file in files:
            with self.subTest(table=file.name):
                table = tress.read_table(file)
                self.assertGreater(table.rows, 0)
                self.assertEqual({len(column) for column in table.values()}, {table.rows})
        table = tress.read_table(ROOT / "results" / "stability_limit.csv")
        self.assertEqual(table["dt_max_s"].dtype, np.float64)
        self.assertEqual(table.units["dt_max_s"], "s")
        self.assertIn("dt_max_s", table.help)
        self.assertEqual(table.manifest["experiment"], "stability_limit")
        some = table.where(model="der")
        self.assertTrue(0 < some.rows < table.rows)

    def test_pandas(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("python3-pandas is not installed")
        table = tress.read_table(ROOT / "results" / "stability_limit.csv")
        self.assertEqual(table.pandas().shape, (table.rows, len(table)))

    def test_experiment(self):
        words = "--quick", "--models", "bead_on_wire", "--integrators", "rk4"
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "drift.csv"
            table = tress.experiment("constraint_drift", *words, out=out)
            self.assertTrue(out.exists())
        self.assertEqual(set(table["integrator"]), {"rk4"})
        self.assertEqual(table.manifest["experiment"], "constraint_drift")
        with self.assertRaisesRegex(tress.InputError, "did you mean 'rk4'|rk4"):
            tress.experiment("constraint_drift", "--integrators", "rk44")
        with self.assertRaisesRegex(tress.InputError, "no experiment 'drift'"):
            tress.experiment("drift")

    def test_bad_tables(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "bad.csv"
            file.write_text("a,b\n1,2\n3\n")
            with self.assertRaisesRegex(tress.InputError, "bad.csv:3"):
                tress.read_table(file)
            file.write_text("")
            with self.assertRaises(tress.InputError):
                tress.read_table(file)


if __name__ == "__main__":
    unittest.main()
