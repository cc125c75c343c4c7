import unittest

import numpy as np
import tress
from common import SCENES

# A curl that swings: 6 elements, steps that no tolerance chooses.
CURL = """
title = "curl"
duration_s = 0.08
frames_per_s = 50
[integrator]
id = "tr_bdf2"
dt_s = 0.004
newton_tolerance = 1e-13
[material]
internal_friction_kg_m3_s = 1e-10
[strand]
elements = 6
shape = "helix"
[root]
motion = "swing"
amplitude_m = 0.01
frequency_hz = 3
[effects.gravity]
[effects.linear_drag]
drag_kg_m_s = 1e-4
"""
BY = ["youngs_modulus_pa", "linear_drag.drag_kg_m_s", "natural_curvature_per_m"]


def curl(changes=None):
    scene = tress.Scene.parse(CURL)
    return scene.changed(changes) if changes else scene


class Gradients(unittest.TestCase):
    def test_is_that_of_differences_of_runs(self):
        found = curl().gradient(of="points", by=["linear_drag.drag_kg_m_s"], start="as_run")
        # Central differences of order 4. Those of the run see Newton's tolerance over the
        # distance and a fifth derivative that the distance makes 1e-12.
        drag, e = 1e-4, 1e-7

        def at(s):
            return curl({"effects.linear_drag.drag_kg_m_s": drag + s}).run().positions

        by_runs = (8 * (at(e) - at(-e)) - (at(2 * e) - at(-2 * e))) / (12 * e)
        size = np.abs(by_runs).max()
        self.assertGreater(size * drag, 1e-4)  # m
        self.assertEqual(found.jacobian.shape, by_runs.shape + (1,))
        np.testing.assert_allclose(
            found.by("linear_drag.drag_kg_m_s"), by_runs, atol=1e-6 * size, rtol=0
        )
        np.testing.assert_array_equal(found.value, curl().run().positions)

    def test_names_units_and_the_tip(self):
        scene = curl()
        found, points = scene.gradient(by=BY, time_errors=True), scene.gradient("points", BY)
        self.assertEqual(found.names, BY)
        self.assertEqual(found.units, ["Pa", "kg/(m s)", "1/m"])
        np.testing.assert_array_equal(found.times, scene.times())
        self.assertEqual(found.value.shape, (len(found.times), 1, 3))
        np.testing.assert_array_equal(found.jacobian, points.jacobian[:, -1:])
        np.testing.assert_array_equal(points.strand, np.zeros(7))
        self.assertTrue(found.damped)
        self.assertEqual(found.status, "ok")
        self.assertEqual(found.parameters[1], 1e-4)
        self.assertGreater(found.time_error.max(), 0)
        self.assertLess(found.time_error[..., 1].max(), 0.1 * abs(found.jacobian[..., 1]).max())
        self.assertAlmostEqual(
            found.relative()[-1, 0, 0, 1], 1e-4 * found.jacobian[-1, 0, 0, 1], places=12
        )

    def test_takes_the_scenes_own_table(self):
        scene = curl({"gradient.by": ["radius_m"], "gradient.start": "damped"})
        found = scene.gradient()
        self.assertEqual(found.names, ["radius_m"])
        self.assertTrue(found.damped)
        self.assertFalse(scene.gradient(start="as_run").damped)

    def test_of_several_strands(self):
        scene = curl({"strand": [{"elements": 4}, {"elements": 6, "length_m": 0.08}]})
        found = scene.gradient(by="density_kg_m3")
        self.assertEqual(found.value.shape[1:], (2, 3))
        np.testing.assert_array_equal(found.strand, [0, 1])

    def test_refusals(self):
        with self.assertRaisesRegex(tress.InputError, "did you mean|use one of"):
            curl().gradient(by=["youngs_moduls_pa"])
        with self.assertRaisesRegex(tress.InputError, "no \\[gradient\\] \\(by\\): give by="):
            curl().gradient()
        with self.assertRaisesRegex(tress.InputError, "of 'middle'"):
            curl().gradient(of="middle", by=BY)
        with self.assertRaisesRegex(tress.InputError, r"\(scene .*\): use backward_euler"):
            curl({"integrator": {"id": "rk4", "dt_s": 1e-5}}).gradient(by=BY)
        with self.assertRaisesRegex(tress.InputError, "one of youngs_modulus_pa"):
            curl().gradient(by=BY[:1]).by("radius_m")
        for nothing in ([], [1], 5):
            with self.assertRaisesRegex(tress.InputError, r"\(by\): give .*by=\[") as caught:
                curl().gradient(by=nothing)
            self.assertNotIn("\n", str(caught.exception))

    def test_ends_as_the_run_does(self):
        """Where the guard finds an impossible state."""
        bent = {"elements": 6, "shape": "along", "initial": "straight",
                "darboux_along": [[0, 0, 200, 0], [1, 0, 200, 0]]}  # fmt: skip
        scene = curl({"model.id": "corde", "strand": bent})
        with self.assertRaises(tress.SolveError) as of_run:
            scene.run()
        with self.assertRaises(tress.SolveError) as of_gradient:
            scene.gradient(by=BY[:1])
        self.assertEqual(str(of_gradient.exception), str(of_run.exception))
        found = scene.changed({"guard": False}).gradient(by=BY[:1])
        self.assertTrue(np.isfinite(found.jacobian).all())


class Steps(unittest.TestCase):
    def test_a_is_that_of_differences_of_the_step(self):
        for model in ("super_helix", "der"):
            with self.subTest(model=model):
                scene = curl({"model.id": model})
                A, B = step = scene.linearized_step(t=0.02)
                n = step.q.size
                self.assertEqual(A.shape, (2 * n, 2 * n))
                self.assertEqual(B.shape, (2 * n, 0))
                self.assertAlmostEqual(step.t_next, 0.024, places=15)
                system = scene.system()
                method = tress.Integrator("tr_bdf2", system, step=0.004, newton_tolerance=1e-13)
                method.start().advance(step.t)
                memory = system.memory()
                q_typ, v_typ = system.scale()
                typical = np.concatenate([q_typ, v_typ])

                def after(x, method=method, system=system, memory=memory, n=n):
                    system.recall(memory)
                    method.start(0.02, x[:n], x[n:]).advance(0.024)
                    return np.concatenate([method.q, method.v])

                start = np.concatenate([step.q, step.v])
                np.testing.assert_allclose(
                    after(start), np.concatenate([step.q_next, step.v_next]), rtol=1e-9,
                    atol=1e-11 * typical.max(),
                )  # fmt: skip
                # Of order 4. In typical sizes, the states before and after are of size 1.
                # At a distance of 1e-6, Newton's tolerance adds 1e-7 to a difference, and
                # the fifth derivative of stretching stays below that. Columns of A see the
                # central difference of the residual, 1e-7.
                for j in range(0, 2 * n, 5):
                    e = np.zeros(2 * n)
                    e[j] = 1e-6 * typical[j]
                    by_steps = 8 * (after(start + e) - after(start - e))
                    by_steps -= after(start + 2 * e) - after(start - 2 * e)
                    by_steps /= 12 * 1e-6 * typical
                    worst = np.abs(A[:, j] * typical[j] / typical - by_steps).max()
                    self.assertLess(worst, 1e-6 * max(1, np.abs(by_steps).max()))

    def test_steps_one_after_another_are_the_gradient_of_the_run(self):
        """x' = A x + B s from x = 0 is the derivative of the run."""
        name = "wind.velocity_m_s.y"
        scene = curl({"effects.wind": {"velocity_m_s": [1, 0.5, 0]}, "frames_per_s": 250,
                      "duration_s": 0.02})  # fmt: skip
        x = 0
        for t in scene.times()[:-1]:
            step = scene.linearized_step(t=t, by=[name])
            x = step.A @ x + step.B[:, 0] if t > 0 else step.B[:, 0]
        self.assertEqual(step.names, [name])
        self.assertEqual(step.units, ["m/s"])
        n = step.q.size
        system, e = scene.system(), 1e-4
        points = (
            system.points(step.t_next, step.q_next + e * x[:n])
            - system.points(step.t_next, step.q_next - e * x[:n])
        ) / (2 * e)
        whole = scene.gradient(of="points", by=[name]).by(name)[-1]
        # The difference of points has an error of e^2; the restarted step takes the
        # acceleration of its own start, equal up to Newton's tolerance.
        np.testing.assert_allclose(points, whole, atol=1e-6 * np.abs(whole).max(), rtol=0)

    def test_refusals(self):
        with self.assertRaisesRegex(tress.InputError, "depends on the steps before.*tr_bdf2"):
            curl({"integrator.id": "bdf2"}).linearized_step()
        with self.assertRaisesRegex(tress.InputError, "the first is 0"):
            curl().linearized_step(strand=3)
        with self.assertRaisesRegex(tress.InputError, r"\(dt\): give dt > 0"):
            curl().linearized_step(dt=0)
        with self.assertRaisesRegex(tress.InputError, r"\(t\): give t >= 0"):
            curl().linearized_step(t=-1)
        bead = tress.Scene.read(SCENES / "bead_on_wire.toml")
        with self.assertRaisesRegex(tress.InputError, "brings its own shape"):
            bead.linearized_step(by=["radius_m"])
        constrained = curl(
            {"model.id": "inextensible_strand", "integrator.formulation": "index3",
             "integrator.id": "backward_euler"}
        )  # fmt: skip
        with self.assertRaisesRegex(tress.InputError, "model with constraints"):
            constrained.linearized_step()


if __name__ == "__main__":
    unittest.main()
