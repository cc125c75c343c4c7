import unittest

import numpy as np
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg
import tress
from common import curl, random_state, reference

FIRST_ORDER = ("wheelset", "filament")


class EveryModel(unittest.TestCase):
    """The matrices of all models against differences of their residuals."""

    def test_matrices_are_derivatives_of_the_residual(self):
        rng = np.random.default_rng(1)
        checked = 0
        for id in tress.models():
            options = tress.model_options(id)
            small = {"elements": 4} if "elements" in options else {}
            system = tress.model(id, **small)
            q, v = random_state(system, rng, 1e-3)
            q_typ, v_typ = system.scale()
            # Exact tangents are asked for where a model has a choice; a is of the state.
            a = v_typ**2 / q_typ * 1e-3 * rng.standard_normal(system.n)
            t = 0.01
            for name, weights, at, typ in (
                ("M", dict(acc=1.0), 2, v_typ**2 / q_typ),
                ("D", dict(vel=1.0), 1, v_typ),
                ("K", dict(pos=1.0), 0, q_typ),
            ):
                with self.subTest(model=id, matrix=name):
                    made = system.tangent(t, q, v, a, **weights)
                    self.assertTrue(scipy.sparse.issparse(made))
                    self.assertEqual(made.shape, (system.n, system.n))
                    direction = typ * rng.standard_normal(system.n)
                    # The residual is linear in a and quadratic in v: any step will do. The
                    # velocities of systems of first order are their positions, and stiff.
                    places = name == "D" and id in FIRST_ORDER
                    step = 1e-7 if places else 1e-5 if name == "K" else 1e-1
                    ahead, behind = [q, v, a], [q, v, a]
                    ahead[at] = ahead[at] + step * direction
                    behind[at] = behind[at] - step * direction
                    slope = system.residual(t, *ahead) - system.residual(t, *behind)
                    slope /= 2 * step
                    # Truncation: step^2 = 1e-10 of third derivatives. Rounding: some eps
                    # of the residual's terms over the step.
                    bound = (abs(made) @ abs(direction)).max()
                    terms = abs(system.stiffness(t, q, v, a)) @ q_typ
                    rounding = 64 * np.finfo(float).eps * terms.max() / step
                    np.testing.assert_allclose(
                        made @ direction, slope, rtol=0, atol=1e-6 * bound + rounding
                    )
                    checked += 1
        self.assertGreaterEqual(checked, 3 * 15)

    def test_solve_inverts_the_tangent(self):
        rng = np.random.default_rng(2)
        h = 1e-3
        for id in ("super_helix", "articulated_chain", "der", "corde"):
            with self.subTest(model=id):
                system = curl(id, 6) if id != "corde" else tress.model(id, elements=6)
                q, v = random_state(system, rng, 1e-3)
                a = np.zeros(system.n)
                system.linearize(0, q, v, a, 1, h, h * h)
                s = system.tangent(0, q, v, a, 1, h, h * h)
                b = rng.standard_normal(system.n)
                x = system.solve(b)
                left = np.abs(s @ x - b).max() / (abs(s) @ abs(x)).max()
                # Backward error: of differences, 1e-10 of the largest entry of S.
                self.assertLess(left, 1e-8)

    def test_constraints(self):
        rng = np.random.default_rng(3)
        system = tress.model("inextensible_chain")
        self.assertGreater(system.m, 0)
        q, v = random_state(system, rng)
        g = system.jacobian(0, q)
        self.assertEqual(g.shape, (system.m, system.n))
        dq = rng.standard_normal(system.n)
        e = 1e-6
        slope = system.constraints(0, q + e * dq) - system.constraints(0, q - e * dq)
        np.testing.assert_allclose(g @ dq, slope / (2 * e), atol=1e-8)
        np.testing.assert_allclose(g @ v, system.constraint_rate(0, q, v), atol=1e-12)

    def test_points_and_energy(self):
        system = curl("der", 10)
        q, v = random_state(system, np.random.default_rng(4))
        self.assertEqual(system.points(0, q).shape, (11, 3))
        e = 1e-7
        slope = (system.points(0, q + e * v) - system.points(0, q - e * v)) / (2 * e)
        u = system.point_velocities(0, q, v)
        np.testing.assert_allclose(u, slope, atol=1e-6 * np.abs(u).max())
        kinetic, potential = system.energy(0, q, v)
        self.assertGreater(kinetic, 0)
        self.assertAlmostEqual(v @ (system.mass(0, q, v) @ v) / 2 / kinetic, 1, places=10)


class Curl(unittest.TestCase):
    def test_lowest_six_frequencies_are_those_of_cpp(self):
        for model in ("super_helix", "der", "articulated_chain"):
            with self.subTest(model=model):
                system = curl(model, 20)
                q, _ = system.initial_state()
                m, k = system.mass(0, q), system.stiffness(0, q)
                # K^-1 M: its largest values have small errors, as the lowest frequencies of
                # M^-1 K have not.
                inverse = scipy.linalg.eigh(
                    (m + m.T).toarray() / 2, (k + k.T).toarray() / 2, eigvals_only=True
                )
                ours = 1 / np.sqrt(inverse[::-1][:6])
                theirs = np.array(reference("frequencies", model, 20)[:6])
                print(model, 'largest relative difference', np.abs(ours / theirs - 1).max())
                # Springs of stretch make K of der ill-conditioned: both solutions have
                # rounding of eps times the condition number, in typical sizes.
                rtol = 1e-10
                if model == "der":
                    size = scipy.sparse.diags(system.scale()[0])
                    scaled = (size @ k @ size).toarray()
                    rtol = np.finfo(float).eps * np.linalg.cond(scaled)
                    self.assertLess(rtol, 1e-6)
                np.testing.assert_allclose(ours, theirs, rtol=rtol)


class Errors(unittest.TestCase):
    def test_input_errors_have_place_and_remedy(self):
        with self.assertRaises(tress.InputError) as caught:
            tress.model("derr")
        error = caught.exception
        self.assertIsInstance(error, ValueError)
        self.assertEqual(str(error), f"{error.problem} ({error.place}): {error.remedy}")
        self.assertIn("did you mean 'der'", error.remedy)
        with self.assertRaisesRegex(tress.InputError, "did you mean 'elements'"):
            tress.model("der", element=4)
        with self.assertRaisesRegex(tress.InputError, "step"):
            tress.Integrator("rk4", tress.model("double_pendulum"), stepp=1)
        with self.assertRaisesRegex(tress.InputError, "rattle cannot drive"):
            tress.Integrator("rattle", tress.model("super_helix", elements=4))

    def test_sizes(self):
        system = tress.model("der", elements=4)
        q, v = system.initial_state()
        with self.assertRaisesRegex(tress.InputError, "3 numbers, not 16"):
            system.residual(0, q[:3], v, v)
        with self.assertRaises((TypeError, ValueError)):
            system.residual(0, "q", v, v)

    def test_no_result(self):
        system = tress.model("der", elements=4)
        q, v = system.initial_state()
        with self.assertRaises(tress.InputError):
            tress.model("andrews_squeezer").acceleration(0, q, v)
        method = tress.Integrator("rk4", system, step=0.1).start()
        with self.assertRaises(tress.SolveError):
            method.advance(100.0)


if __name__ == "__main__":
    unittest.main()
