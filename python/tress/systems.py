"""One strand, or any model of the catalogue, as a mechanical system; methods that step it.

A system has n coordinates q with q' = v, v' = a, and m position constraints g(t, q) = 0
with multipliers lambda:

    r(t, q, v, a) = M(t, q) a - f(t, q, v),     r - G^T lambda = 0,     G = dg/dq
    S(acc, vel, pos) = acc dr/da + vel dr/dv + pos dr/dq

Units are SI. Arrays are numpy's, of float64; others are converted. An array of the wrong
size raises InputError, an evaluation without a finite result SolveError.
"""

import numpy as np
import scipy.sparse

from . import _core


def _text(value):
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


def _texts(options):
    return [(key, _text(value)) for key, value in options.items()]


def models():
    """Returns {id: (summary, source)} of all models."""
    return {id: (summary, source) for id, summary, source in _core.models()}


def model_options(id):
    """Returns {name: (default, choices, help with unit)} of the options of ``model(id, ...)``."""
    return {name: rest for name, *rest in _core.model_options(id)}


def integrators():
    """Returns {id: (order, summary, source)} of all integrators."""
    return {id: (order, summary, source) for id, order, summary, source in _core.integrators()}


def integrator_options():
    """Returns {name: (default, choices, help with unit, method)} of the options of all
    integrators. The method is empty for options of several methods."""
    return {name: rest for name, *rest in _core.integrator_options()}


def model(id, **options):
    """Makes a system of a model of the catalogue: System.

    Options are those of the model. A model of a strand also takes geometry, material, root
    and loads: ``model_options(id)``. Raises InputError if an option is unknown or out of
    range.
    """
    return System(_core.model(id, _texts(options)))


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

    def __init__(self, system):
        self._core = system if isinstance(system, _core.System) else _core.System(system)
        self._n = self._core.coordinates

    @property
    def n(self):
        """Number of coordinates."""
        return self._n

    @property
    def m(self):
        """Number of constraints."""
        return self._core.constraints

    @property
    def traits(self):
        """Properties of the mass matrix: {"constant_mass": bool, "regular_mass": bool}."""
        return self._core.traits

    def has(self, form):
        """Whether the model has a form: "sparse", "explicit", "constraints", "energy",
        "points", "history" or "contact"."""
        return form in self._core.forms()

    def initial_state(self):
        """Returns (q, v), which satisfy the constraints."""
        return self._core.initial_state()

    def scale(self):
        """Returns typical sizes of q and v."""
        return self._core.scale()

    def residual(self, t, q, v, a):
        """Returns the residual r (n)."""
        return self._core.residual(t, q, v, a)

    def _rest(self, v, a):
        zero = np.zeros(self._n)
        return zero if v is None else v, zero if a is None else a

    def tangent(self, t, q, v=None, a=None, acc=0.0, vel=0.0, pos=0.0):
        """Returns S = acc dr/da + vel dr/dv + pos dr/dq as scipy.sparse.csc_matrix (n, n).

        By default v and a are 0. For a model without a sparse form, S is computed by central
        differences of the residual (exact in a; error 1e-10 of its largest entries).
        """
        made = self._core.tangent(t, q, *self._rest(v, a), acc, vel, pos)
        if isinstance(made, tuple):
            values, rows, starts, shape = made
            return scipy.sparse.csc_matrix((values, rows, starts), shape=shape)
        return scipy.sparse.csc_matrix(made)

    def mass(self, t, q, v=None, a=None):
        """Returns the mass matrix M = dr/da (n, n)."""
        return self.tangent(t, q, v, a, acc=1.0)

    def damping(self, t, q, v=None, a=None):
        """Returns the damping matrix D = dr/dv (n, n)."""
        return self.tangent(t, q, v, a, vel=1.0)

    def stiffness(self, t, q, v=None, a=None):
        """Returns the stiffness matrix K = dr/dq (n, n)."""
        return self.tangent(t, q, v, a, pos=1.0)

    def linearize(self, t, q, v, a, acc, vel, pos):
        """Prepares ``solve`` for this S, in the form that the model uses."""
        self._core.linearize(t, q, v, a, acc, vel, pos)

    def solve(self, b):
        """Returns x (n) with S x = b, for the S of the last linearize()."""
        return self._core.solve(b)

    def acceleration(self, t, q, v):
        """Returns a (n) with M a = f, for a model without constraints.

        Uses the explicit form of the model if there is one, else a solve with M."""
        if self.has("explicit"):
            return self._core.acceleration(t, q, v)
        zero = np.zeros(self._n)
        self._core.linearize(t, q, v, zero, 1.0, 0.0, 0.0)
        return self._core.solve(-self._core.residual(t, q, v, zero))

    def energy(self, t, q, v):
        """Returns (kinetic, potential), J. Raises InputError if the model has no energies."""
        return self._core.energy(t, q, v)

    def power(self, t, q, v):
        """Returns the power of all forces without a potential, W: negative for drag."""
        return self._core.power(t, q, v)

    def momentum(self, t, q, v):
        """Returns (linear, angular about the origin), kg m/s and kg m^2/s, or None if the
        model has no momentum."""
        return self._core.momentum(t, q, v)

    def constraints(self, t, q):
        """Returns the constraints g (m), in the units of the model."""
        return self._core.g(t, q) if self.m else np.zeros(0)

    def constraint_rate(self, t, q, v):
        """Returns their rates G v + dg/dt (m)."""
        return self._core.g_rate(t, q, v) if self.m else np.zeros(0)

    def jacobian(self, t, q):
        """Returns the Jacobian of the constraints, G = dg/dq, as scipy.sparse.csr_matrix
        (m, n)."""
        if not self.m:
            return scipy.sparse.csr_matrix((0, self._n))
        values, rows, starts, (n, m) = self._core.jacobian_transposed(t, q)
        return scipy.sparse.csr_matrix((values, rows, starts), shape=(m, n))

    def points(self, t, q):
        """Returns the positions of the material points, (points, 3) m. The last one is the
        tip."""
        return self._core.points(t, q)

    def point_velocities(self, t, q, v):
        """Returns the velocities of the material points, (points, 3) m/s."""
        return self._core.point_velocities(t, q, v)

    def before(self):
        """Returns for each point the point that it is attached to; -1: none."""
        return self._core.before()

    def accept(self, t, q, v):
        """Ends a step of your own: moves frames and contact sets. Returns (changed, q, v), with
        changed = True if the equations have changed."""
        return self._core.accept(t, q, v)

    def reset(self):
        """Forgets all accepted steps."""
        self._core.reset()

    def memory(self):
        """Returns the state that accept() has changed, for ``recall`` of an equal system."""
        return self._core.memory()

    def recall(self, memory):
        """Restores the state that ``memory`` returned."""
        self._core.recall(memory)

    def next_breakpoint(self, t):
        """Returns the first time after t at which the equations are not smooth; inf: none."""
        return self._core.next_breakpoint(t)


class Integrator:
    """One method on one system: ``Integrator("generalized_alpha", system, step=1e-3)``.

    Options are those of ``--set``: ``integrator_options()``. Raises InputError with the
    reason if the method cannot drive the system, and for an option of another method. Two
    threads that step one system at once raise SolveError.
    """

    def __init__(self, id, system, **options):
        self.system = system if isinstance(system, System) else System(system)
        self._core = _core.Integrator(id, self.system._core, _texts(options))

    def start(self, t=0.0, q=None, v=None):
        """Sets the state, by default the system's initial one. Returns self."""
        if q is None or v is None:
            q0, v0 = self.system.initial_state()
            q, v = (q0 if q is None else q), (v0 if v is None else v)
        self._core.start(t, q, v)
        return self

    def advance(self, t_end, observer=None):
        """Steps to t_end exactly, without the interpreter's lock.

        ``observer(t, q, v)`` is called after every step with copies. If it returns False,
        the run ends there and advance returns False. A step without a solution raises
        SolveError with the time and the reason. Ctrl-C raises KeyboardInterrupt within a
        step and 50 ms.
        """
        return self._core.advance(t_end, observer)

    @property
    def time(self):
        """Present time, s."""
        return self._core.time

    @property
    def q(self):
        """Coordinates: a view of the memory of the method, valid until the next advance().
        Copy what you keep."""
        return self._core.q

    @property
    def v(self):
        """Rates of the coordinates, a view as q."""
        return self._core.v

    @property
    def stats(self):
        """Work since start(): {"steps", "residuals", "newton_iterations", "solver", ...}."""
        return self._core.stats


def refusal(id, system, formulation="parametric"):
    """Returns the reason why an integrator cannot drive a system; empty if it can."""
    system = system if isinstance(system, System) else System(system)
    return _core.refusal(id, system._core, formulation)


def first_order(system):
    """Returns (fun, jac, y0) of a system without constraints for scipy.integrate.solve_ivp.

    y = (q, v), y' = (v, a), and the Jacobian is [[0, 1], [-M^-1 K, -M^-1 D]] (2n, 2n). K is
    evaluated at the acceleration of the state, so it includes the derivative of M.
    """
    n = system.n

    def fun(t, y):
        q, v = y[:n], y[n:]
        return np.concatenate([v, system.acceleration(t, q, v)])

    def jac(t, y):
        q, v = y[:n], y[n:]
        a = system.acceleration(t, q, v)
        below = np.hstack(
            [system.stiffness(t, q, v, a).toarray(), system.damping(t, q, v, a).toarray()]
        )
        below = -np.linalg.solve(system.mass(t, q, v, a).toarray(), below)
        return np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), below])

    return fun, jac, np.concatenate(system.initial_state())
