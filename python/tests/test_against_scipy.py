"""Gradients against equations of motion that are written down here and solved by scipy."""

import unittest

import numpy as np
import tress
from scipy.integrate import solve_ivp

LENGTH, RADIUS, DENSITY, GRAVITY = 0.1, 1e-3, 1300.0, 9.81  # m, m, kg/m^3, m/s^2
MODULUS, FRICTION, DRAG = 1e6, 1e-8, 2e-3  # Pa, kg m^3/s, kg/(m s)
DURATION = 0.1  # s

SCENE = f"""
title = "two circular arcs in a plane"
duration_s = {DURATION}
[model]
id = "super_helix"
[integrator]
id = "esdirk43"
dt_s = 2e-4
newton_tolerance = 1e-13
[material]
name = "custom"
radius_m = {RADIUS}
ellipticity = 1
youngs_modulus_pa = {MODULUS}
poisson_ratio = 0.5
density_kg_m3 = {DENSITY}
internal_friction_kg_m3_s = {FRICTION}
[strand]
length_m = {LENGTH}
elements = 2
[root]
[effects.gravity]
[effects.linear_drag]
drag_kg_m_s = {DRAG}
"""

# Of both arcs: curvature is constant along an arc. 20 Gauss points are exact to rounding.
NODES, WEIGHTS = np.polynomial.legendre.leggauss(20)
HALF = LENGTH / 2
IN_ARC, WEIGHT = HALF * (NODES + 1) / 2, HALF * WEIGHTS / 2


def arc(angle, curvature, s):
    """(x, z) along an arc from the origin, by quadrature: also of complex curvatures."""
    at = s[..., None] * (NODES + 1) / 2
    turned = angle + curvature * at
    return np.stack([(np.cos(turned) * WEIGHTS).sum(-1), (np.sin(turned) * WEIGHTS).sum(-1)]) * (
        s / 2
    )


def points(k):
    """(2, 40) points where the integrals along the strand are taken, then (2) the tip."""
    end = np.array([HALF])
    middle, angle = arc(0, k[0], end), HALF * k[0]
    all_points = np.hstack([arc(0, k[0], IN_ARC), middle + arc(angle, k[1], IN_ARC)])
    return all_points, (middle + arc(angle, k[1], end))[:, 0]


def slopes(k):
    """Derivatives of the points by both curvatures, (2, 2, 40): complex steps."""
    tiny = 1e-30
    return np.stack([points(k + 1j * tiny * e)[0].imag / tiny for e in np.eye(2)])


def equations(modulus, drag):
    """y' of y = (k, k'), from Lagrange's equations M k'' + (dM/dt k') - ... = Q."""
    area, second = np.pi * RADIUS**2, np.pi * RADIUS**4 / 4
    weight = np.tile(WEIGHT, 2)

    def products(j, other):
        return np.einsum("icp,jcp,p->ij", j, other, weight)

    def rate(_, y):
        k, speed = y[:2], y[2:]
        j = slopes(k)
        # Acceleration of the points at k'' = 0: the derivative of J k' along k'. Its error,
        # e^2 times a third derivative, is 1e-10 of it.
        e = 1e-4 / max(1.0, np.abs(speed).max())
        forth, back = slopes(k + e * speed), slopes(k - e * speed)
        turning = np.einsum("icp,i->cp", (forth - back) / (2 * e), speed)
        force = -DENSITY * area * (np.einsum("icp,cp,p->i", j, turning, weight))
        force -= DENSITY * area * GRAVITY * np.einsum("ip,p->i", j[:, 1], weight)
        force -= drag * products(j, j) @ speed
        force -= HALF * (modulus * second * k + FRICTION * speed)
        return np.concatenate([speed, np.linalg.solve(DENSITY * area * products(j, j), force)])

    return rate


def tip(modulus, drag):
    done = solve_ivp(equations(modulus, drag), (0, DURATION), np.zeros(4), method="DOP853",
                     rtol=1e-12, atol=1e-12)  # fmt: skip
    return points(done.y[:2, -1])[1]


class AgainstScipy(unittest.TestCase):
    def test_two_arcs(self):
        by = ["youngs_modulus_pa", "linear_drag.drag_kg_m_s"]
        found = tress.Scene.parse(SCENE).gradient(of="tip", by=by)
        value = found.value[-1, 0, [0, 2]]
        # Errors of the run: of order 3 at least, with 500 steps. Those of the differences
        # here: 1e-6 squared of a relative change of 1e-3, and 1e-12 of solve_ivp over it.
        np.testing.assert_allclose(tip(MODULUS, DRAG), value, atol=1e-7 * LENGTH)
        for k, (name, typical) in enumerate(zip(by, (MODULUS, DRAG))):

            def at(s, k=k):
                return np.array([MODULUS, DRAG]) * (1 + s * np.eye(2)[k])

            e = 1e-3
            by_scipy = 8 * (tip(*at(e)) - tip(*at(-e))) - (tip(*at(2 * e)) - tip(*at(-2 * e)))
            by_scipy /= 12 * e
            with self.subTest(name):
                size = np.abs(by_scipy).max()
                self.assertGreater(size, 5e-3 * LENGTH)
                mine = typical * found.by(name)[-1, 0, [0, 2]]
                np.testing.assert_allclose(mine, by_scipy, atol=1e-5 * size, rtol=0)


if __name__ == "__main__":
    unittest.main()
