"""One strand, or any model of the catalogue, as a mechanical system; methods that step it.

A system has n coordinates q with q' = v, v' = a, and m position constraints g(t, q) = 0
with multipliers lambda:

    r(t, q, v, a) = M(t, q) a - f(t, q, v),     r - G^T lambda = 0,     G = dg/dq
    S(acc, vel, pos) = acc dr/da + vel dr/dv + pos dr/dq

Units are SI. Arrays are numpy's, of float64; others are converted. An array of the wrong
size raises InputError, an evaluation without a finite result SolveError.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import scipy.sparse
from numpy.typing import ArrayLike as Array

from . import _core


def _text(value: Any) -> str:
    """A value as options take it."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, float, np.number)):
        return repr(value.item() if isinstance(value, np.number) else value)
    if isinstance(value, str):
        return value
    rows = [_text(x) for x in value]
    separator = ";" if any("," in row for row in rows) else ","
    return separator.join(rows)


def option_texts(options: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Returns options as pairs of texts, as the compiled part takes them."""
    return [(key, _text(value)) for key, value in options.items()]


def models() -> dict[str, tuple[str, str]]:
    """Returns {id: (summary, source)} of all models."""
    return {id: (summary, source) for id, summary, source in _core.models()}


def model_options(id: str) -> dict[str, list]:
    """Returns {name: (default, choices, help with unit)} of the options of ``model(id, ...)``."""
    return {name: rest for name, *rest in _core.model_options(id)}


def integrators() -> dict[str, tuple]:
    """Returns {id: (order, summary, source)} of all integrators."""
    return {id: (order, summary, source) for id, order, summary, source in _core.integrators()}


def integrator_options() -> dict[str, list]:
    """Returns {name: (default, choices, help with unit, method)} of the options of all
    integrators. The method is empty for options of several methods."""
    return {name: rest for name, *rest in _core.integrator_options()}


def model(id: str, **options: Any) -> "System":
    """Makes a system of a model of the catalogue: System.

    Options are those of the model. A model of a strand also takes geometry, material, root
    and loads: ``model_options(id)``. Raises InputError if an option is unknown or out of
    range.
    """
    return System(_core.model(id, option_texts(options)))


class System:
    """Mechanical system, made with ``model``, ``Scene.system`` or ``System(object)``.

    An object of your own has these functions:

    ``initial_state()``     (q, v), whose length is the number of coordinates n
    ``residual(t, q, v, a)``   r, an array (n)
    ``tangent(t, q, v, a, acc, vel, pos)``   optional: S, an array (n, n) or scipy.sparse;
                            by default, S is computed by central differences of the residual
    ``energy(t, q, v)``     optional: (kinetic, potential), J
    ``power(t, q, v)``      optional: power of the forces without a potential, W
    ``scale()``             optional: typical sizes of q and v, by default 1; tolerances and
                            differences are relative to them
    ``constant_mass``       optional: True if M is constant

    Such a system has no constraints. An exception in one of these functions ends the step
    and is raised again.
    """

    def __init__(self, system: Any) -> None:
        self._core = system if isinstance(system, _core.System) else _core.System(system)
        self._n = self._core.coordinates

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return self._n

    @property
    def m(self) -> int:
        """Number of constraints."""
        return self._core.constraints

    @property
    def traits(self) -> dict[str, bool]:
        """Properties of the mass matrix: {"constant_mass": bool, "regular_mass": bool}."""
        return self._core.traits

    def has(self, form: str) -> bool:
        """Whether the model has a form: "sparse", "explicit", "constraints", "energy",
        "points", "history" or "contact"."""
        return form in self._core.forms()

    def initial_state(self) -> tuple[np.ndarray, np.ndarray]:
        """Returns (q, v), which satisfy the constraints."""
        return self._core.initial_state()

    def scale(self) -> tuple[np.ndarray, np.ndarray]:
        """Returns typical sizes of q and v."""
        return self._core.scale()

    def residual(self, t: float, q: Array, v: Array, a: Array) -> np.ndarray:
        """Returns the residual r (n)."""
        return self._core.residual(t, q, v, a)

    def _rest(self, v: Array | None, a: Array | None) -> tuple[Array, Array]:
        zero = np.zeros(self._n)
        return zero if v is None else v, zero if a is None else a

    def tangent(
        self,
        t: float,
        q: Array,
        v: Array | None = None,
        a: Array | None = None,
        acc: float = 0.0,
        vel: float = 0.0,
        pos: float = 0.0,
    ) -> scipy.sparse.csc_matrix:
        """Returns S = acc dr/da + vel dr/dv + pos dr/dq as scipy.sparse.csc_matrix (n, n).

        By default v and a are 0. For a model without a sparse form, S is computed by central
        differences of the residual (exact in a; error 1e-10 of its largest entries).

        A sparse S has the derivatives of an effect's load on a point by that point alone.
        It leaves out those by other points, which [effects.ring] and [effects.self_contact]
        have. ``linearize`` and ``solve`` use the whole S.
        """
        made = self._core.tangent(t, q, *self._rest(v, a), acc, vel, pos)
        if isinstance(made, tuple):
            values, rows, starts, shape = made
            return scipy.sparse.csc_matrix((values, rows, starts), shape=shape)
        return scipy.sparse.csc_matrix(made)

    def mass(
        self, t: float, q: Array, v: Array | None = None, a: Array | None = None
    ) -> scipy.sparse.csc_matrix:
        """Returns the mass matrix M = dr/da (n, n)."""
        return self.tangent(t, q, v, a, acc=1.0)

    def damping(
        self, t: float, q: Array, v: Array | None = None, a: Array | None = None
    ) -> scipy.sparse.csc_matrix:
        """Returns the damping matrix D = dr/dv (n, n). ``tangent`` names its limits."""
        return self.tangent(t, q, v, a, vel=1.0)

    def stiffness(
        self, t: float, q: Array, v: Array | None = None, a: Array | None = None
    ) -> scipy.sparse.csc_matrix:
        """Returns the stiffness matrix K = dr/dq (n, n). ``tangent`` names its limits."""
        return self.tangent(t, q, v, a, pos=1.0)

    def linearize(
        self, t: float, q: Array, v: Array, a: Array, acc: float, vel: float, pos: float
    ) -> None:
        """Prepares ``solve`` for this S, in the form that the model uses."""
        self._core.linearize(t, q, v, a, acc, vel, pos)

    def solve(self, b: Array) -> np.ndarray:
        """Returns x (n) with S x = b, for the S of the last linearize()."""
        return self._core.solve(b)

    def acceleration(self, t: float, q: Array, v: Array) -> np.ndarray:
        """Returns a (n) with M a = f, for a model without constraints.

        Uses the explicit form of the model if there is one, else a solve with M."""
        if self.has("explicit"):
            return self._core.acceleration(t, q, v)
        zero = np.zeros(self._n)
        self._core.linearize(t, q, v, zero, 1.0, 0.0, 0.0)
        return self._core.solve(-self._core.residual(t, q, v, zero))

    def energy(self, t: float, q: Array, v: Array) -> tuple[float, float]:
        """Returns (kinetic, potential), J. Raises InputError if the model has no energies."""
        return self._core.energy(t, q, v)

    def power(self, t: float, q: Array, v: Array) -> float:
        """Returns the power of all forces without a potential, W: negative for drag."""
        return self._core.power(t, q, v)

    def momentum(self, t: float, q: Array, v: Array) -> tuple[np.ndarray, np.ndarray] | None:
        """Returns (linear, angular about the origin), kg m/s and kg m^2/s, or None if the
        model has no momentum."""
        return self._core.momentum(t, q, v)

    def constraints(self, t: float, q: Array) -> np.ndarray:
        """Returns the constraints g (m), in the units of the model."""
        return self._core.g(t, q) if self.m else np.zeros(0)

    def constraint_rate(self, t: float, q: Array, v: Array) -> np.ndarray:
        """Returns their rates G v + dg/dt (m)."""
        return self._core.g_rate(t, q, v) if self.m else np.zeros(0)

    def jacobian(self, t: float, q: Array) -> scipy.sparse.csr_matrix:
        """Returns the Jacobian of the constraints, G = dg/dq, as scipy.sparse.csr_matrix
        (m, n)."""
        if not self.m:
            return scipy.sparse.csr_matrix((0, self._n))
        values, rows, starts, (n, m) = self._core.jacobian_transposed(t, q)
        return scipy.sparse.csr_matrix((values, rows, starts), shape=(m, n))

    def points(self, t: float, q: Array) -> np.ndarray:
        """Returns the positions of the material points, (points, 3) m. The last one is the
        tip."""
        return self._core.points(t, q)

    def point_velocities(self, t: float, q: Array, v: Array) -> np.ndarray:
        """Returns the velocities of the material points, (points, 3) m/s."""
        return self._core.point_velocities(t, q, v)

    def before(self) -> np.ndarray:
        """Returns for each point the point that it is attached to; -1: none."""
        return self._core.before()

    def accept(self, t: float, q: Array, v: Array) -> tuple[bool, np.ndarray, np.ndarray]:
        """Ends a step of your own: moves frames and contact sets. Returns (changed, q, v), with
        changed = True if the equations have changed."""
        return self._core.accept(t, q, v)

    def reset(self) -> None:
        """Forgets all accepted steps."""
        self._core.reset()

    def memory(self) -> Any:
        """Returns the state that accept() has changed, for ``recall`` of an equal system."""
        return self._core.memory()

    def recall(self, memory: Any) -> None:
        """Restores the state that ``memory`` returned."""
        self._core.recall(memory)

    def next_breakpoint(self, t: float) -> float:
        """Returns the first time after t at which the equations are not smooth; inf: none."""
        return self._core.next_breakpoint(t)


def first_order(system: System) -> tuple[Callable, Callable, np.ndarray]:
    """Returns (fun, jac, y0) of a system without constraints for scipy.integrate.solve_ivp.

    y = (q, v), y' = (v, a), and the Jacobian is [[0, 1], [-M^-1 K, -M^-1 D]] (2n, 2n). K is
    evaluated at the acceleration of the state, so it includes the derivative of M.
    """
    n = system.n

    def fun(t: float, y: np.ndarray) -> np.ndarray:
        q, v = y[:n], y[n:]
        return np.concatenate([v, system.acceleration(t, q, v)])

    def jac(t: float, y: np.ndarray) -> np.ndarray:
        q, v = y[:n], y[n:]
        a = system.acceleration(t, q, v)
        below = np.hstack(
            [system.stiffness(t, q, v, a).toarray(), system.damping(t, q, v, a).toarray()]
        )
        below = -np.linalg.solve(system.mass(t, q, v, a).toarray(), below)
        return np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), below])

    return fun, jac, np.concatenate(system.initial_state())
