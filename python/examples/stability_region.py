"""Where explicit methods are stable on x'' + 2 z w x' + w^2 x = 0: the largest w h by z."""

import numpy as np
import tress


class Oscillator:
    def __init__(self, damping):
        self.damping = damping

    def initial_state(self):
        return np.array([1.0]), np.array([0.0])

    def residual(self, t, q, v, a):
        return a + 2 * self.damping * v + q  # w = 1


def is_stable(method, damping, h):
    run = tress.Integrator(method, Oscillator(damping), step=h).start()
    try:
        run.advance(2000 * h)
    except tress.SolveError:
        return False
    return abs(run.q[0]) < 1000


for method in ("symplectic_euler", "rk4"):
    for damping in (0.0, 0.5, 1.0):
        low, high = 0.01, 4.0
        while high - low > 0.01:
            middle = (low + high) / 2
            if is_stable(method, damping, middle):
                low = middle
            else:
                high = middle
        print(f"{method}: z = {damping}: stable up to w h = {low:.2f}")
