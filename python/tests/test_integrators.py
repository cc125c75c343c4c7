import gc
import os
import signal
import threading
import time
import unittest

import numpy as np
import tress
from common import curl


class Pendulum:
    """phi'' = -w^2 sin phi, as a System in Python."""

    w = 5.0

    def initial_state(self):
        return np.array([1.0]), np.array([0.0])

    def residual(self, t, q, v, a):
        return a + self.w**2 * np.sin(q)

    def energy(self, t, q, v):
        return v[0] ** 2 / 2, -(self.w**2) * np.cos(q[0])


class PendulumWithTangent(Pendulum):
    def tangent(self, t, q, v, a, acc, vel, pos):
        return np.array([[acc + pos * self.w**2 * np.cos(q[0])]])


class Stepping(unittest.TestCase):
    def test_every_method_takes_a_python_system(self):
        exact = tress.Integrator("gsl_rk8pd", Pendulum(), rtol=1e-12).start()
        exact.advance(1.0)
        driven = 0
        for id, (order, *_) in tress.integrators().items():
            for kind in (Pendulum, PendulumWithTangent):
                with self.subTest(method=id, kind=kind.__name__):
                    if tress.refusal(id, kind()):
                        continue
                    method = tress.Integrator(id, kind(), step=1e-3, rtol=1e-6).start()
                    self.assertTrue(method.advance(1.0))
                    # A phase error of h w = 5e-3 over the time t w, for first order.
                    bound = 5e-2 if order == 1 else 1e-3
                    self.assertLess(abs(method.q[0] - exact.q[0]), bound)
                    driven += 1
        self.assertGreater(driven, 30)

    def test_python_system_equals_the_same_in_cpp(self):
        """A catalogue model behind Python functions: the same steps."""
        inner = tress.model("double_pendulum")

        class Wrapped:
            initial_state = staticmethod(inner.initial_state)
            residual = staticmethod(inner.residual)
            scale = staticmethod(inner.scale)

            def tangent(self, t, q, v, a, acc, vel, pos):
                return inner.tangent(t, q, v, a, acc, vel, pos)

        ends = []
        for system in (inner, Wrapped()):
            method = tress.Integrator("implicit_midpoint", system, step=1e-3).start()
            method.advance(0.5)
            ends.append(np.array(method.q))
        # Newton's tolerance 1e-10 a step, over 500 steps.
        np.testing.assert_allclose(*ends, atol=1e-7)

    def test_observer_ends_a_run(self):
        seen = []

        def observer(t, q, v):
            seen.append((t, q, v))
            return len(seen) < 7

        method = tress.Integrator("backward_euler", curl("der", 5), step=1e-3).start()
        self.assertFalse(method.advance(1.0, observer))
        self.assertEqual(len(seen), 7)
        self.assertFalse(np.shares_memory(seen[0][1], seen[1][1]))

    def test_what_python_raises_arrives(self):
        class Bad(Pendulum):
            def residual(self, t, q, v, a):
                if t > 0.5:
                    raise ZeroDivisionError("here")
                return super().residual(t, q, v, a)

        method = tress.Integrator("backward_euler", Bad(), step=1e-2).start()
        with self.assertRaisesRegex(ZeroDivisionError, "here"):
            method.advance(1.0)

        class Short(Pendulum):
            def residual(self, t, q, v, a):
                return np.zeros(2)

        with self.assertRaisesRegex(tress.InputError, "2 numbers, not 1"):
            tress.Integrator("rk4", Short(), step=1e-2).start().advance(1.0)

        def stop(t, q, v):
            raise KeyError("observer")

        with self.assertRaises(KeyError):
            tress.Integrator("rk4", Pendulum(), step=1e-2).start().advance(1.0, stop)

    def test_state_is_not_copied(self):
        method = tress.Integrator("rk4", Pendulum(), step=1e-2).start()
        q = method.q
        self.assertFalse(q.flags.owndata)
        self.assertFalse(q.flags.writeable)
        before = q[0]
        method.advance(0.1)
        self.assertNotEqual(method.q[0], before)
        del method
        gc.collect()
        self.assertTrue(np.isfinite(q[0]))  # the array keeps the method alive

    def test_lock_is_released_and_systems_are_not_shared(self):
        system = curl("der", 40)
        method = tress.Integrator("backward_euler", system, step=1e-4).start()
        refused, count = [], 0

        def other():
            nonlocal count
            while thread.is_alive():
                count += 1
                try:
                    system.energy(0, *system.initial_state())
                except tress.SolveError as error:
                    refused.append(str(error))
                time.sleep(1e-3)

        thread = threading.Thread(target=method.advance, args=(0.2,))
        thread.start()
        other()
        thread.join()
        self.assertGreater(count, 1)
        self.assertTrue(refused and "another thread" in refused[0])

    def test_interrupt(self):
        method = tress.Integrator("backward_euler", curl("der", 40), step=1e-5).start()
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        self.addCleanup(timer.cancel)
        with self.assertRaises(KeyboardInterrupt):
            method.advance(50.0)


def resident():
    """Bytes of this process in memory."""
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")


class Memory(unittest.TestCase):
    def grows(self, call, count):
        """Bytes after `count` calls, warmed up by a tenth of them."""
        for _ in range(count // 10):
            call()
        gc.collect()
        before = resident()
        for _ in range(count):
            call()
        gc.collect()
        return resident() - before

    def test_100_000_calls_leak_nothing(self):
        system = curl("der", 10)
        q, v = system.initial_state()
        method = tress.Integrator("backward_euler", system, step=1e-4).start()
        end = 0.0

        def step():
            nonlocal end
            end += 1e-4
            method.advance(end)
            method.q

        def wrong():
            try:
                system.residual(0, q[:1], v, v)
            except tress.InputError:
                pass

        calls = {
            "residual": lambda: system.residual(0, q, v, v),
            "tangent": lambda: system._core.tangent(0, q, v, v, 1.0, 1e-3, 1e-6),
            "points": lambda: system.points(0, q),
            "error": wrong,
            "step": step,
        }
        for name, call in calls.items():
            with self.subTest(call=name):
                # One leaked object of a call is 16 bytes at least, 1.6 MB in all.
                self.assertLess(self.grows(call, 20_000 if name == "step" else 100_000), 1e6)

    def test_systems_leak_nothing(self):
        def run():
            method = tress.Integrator("backward_euler", Pendulum(), step=1e-2).start()
            method.advance(0.02)

        # One System with its matrices is 1 kB at least: 2 MB in all.
        self.assertLess(self.grows(run, 2000), 1e6)


if __name__ == "__main__":
    unittest.main()
