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
    """{id: (summary, source)} of all models."""
    return {id: (summary, source) for id, summary, source in _core.models()}


def model_options(id):
    """{name: (default, choices, help with unit)} of the options of ``model(id, ...)``."""
    return {name: rest for name, *rest in _core.model_options(id)}


def integrators():
    """{id: (order, summary, source)} of all integrators."""
    return {id: (order, summary, source) for id, order, summary, source in _core.integrators()}


def integrator_options():
    """{name: (default, choices, help with unit, its method or "")} of all integrators."""
    return {name: rest for name, *rest in _core.integrator_options()}


def model(id, **options):
    """A model of the catalogue; InputError where an option is unknown or out of range.

    A strand takes geometry, material, root and loads as well: ``model_options(id)``.
    """
    return System(_core.model(id, _texts(options)))


class System:
    """Built by ``model``, ``Scene.system``, or of an object of your own:

    ``initial_state()``     (q, v), which also say how many coordinates there are
    ``residual(t, q, v, a)``   r, an array (n)
    ``tangent(t, q, v, a, acc, vel, pos)``   optional: S, an array (n, n) or scipy.sparse;
                            without it S is taken by central differences of the residual
    ``energy(t, q, v)``     optional: (kinetic, potential), J
    ``power(t, q, v)``      optional: W of what energy leaves out
    ``scale()``             optional: typical sizes of q and v, else 1; tolerances and
                            differences are relative to them
    ``constant_mass``       optional: True where M is constant

    Such a system has no constraints. What it raises ends the step and is raised again.
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
        """{"constant_mass", "regular_mass"}."""
        return self._core.traits

    def has(self, form):
        """Whether the model has a form: "sparse", "explicit", "constraints", "energy",
        "points", "history" or "contact"."""
        return form in self._core.forms()

    def initial_state(self):
        """(q, v), which satisfy the constraints."""
        return self._core.initial_state()

    def scale(self):
        """Typical sizes of q and v."""
        return self._core.scale()

    def residual(self, t, q, v, a):
        """r (n)."""
        return self._core.residual(t, q, v, a)

    def _rest(self, v, a):
        zero = np.zeros(self._n)
        return zero if v is None else v, zero if a is None else a

    def tangent(self, t, q, v=None, a=None, acc=0.0, vel=0.0, pos=0.0):
        """S = acc dr/da + vel dr/dv + pos dr/dq as scipy.sparse.csc_matrix (n, n).

        v and a are 0 unless given. Of a model without a sparse form by central differences
        of the residual (exact in a; error 1e-10 of its largest entries), converted.
        """
        made = self._core.tangent(t, q, *self._rest(v, a), acc, vel, pos)
        if isinstance(made, tuple):
            values, rows, starts, shape = made
            return scipy.sparse.csc_matrix((values, rows, starts), shape=shape)
        return scipy.sparse.csc_matrix(made)

    def mass(self, t, q, v=None, a=None):
        """M = dr/da (n, n)."""
        return self.tangent(t, q, v, a, acc=1.0)

    def damping(self, t, q, v=None, a=None):
        """D = dr/dv (n, n)."""
        return self.tangent(t, q, v, a, vel=1.0)

    def stiffness(self, t, q, v=None, a=None):
        """K = dr/dq (n, n)."""
        return self.tangent(t, q, v, a, pos=1.0)

    def linearize(self, t, q, v, a, acc, vel, pos):
        """Readies ``solve`` with the model's own form of S."""
        self._core.linearize(t, q, v, a, acc, vel, pos)

    def solve(self, b):
        """x (n) with S x = b, S as linearize() left it."""
        return self._core.solve(b)

    def acceleration(self, t, q, v):
        """a (n) of a model without constraints: M a = f.

        By the model's explicit form, else by one solve with M."""
        if self.has("explicit"):
            return self._core.acceleration(t, q, v)
        zero = np.zeros(self._n)
        self._core.linearize(t, q, v, zero, 1.0, 0.0, 0.0)
        return self._core.solve(-self._core.residual(t, q, v, zero))

    def energy(self, t, q, v):
        """(kinetic, potential), J; InputError where the model does not say."""
        return self._core.energy(t, q, v)

    def power(self, t, q, v):
        """W of all forces that energy() leaves out, negative for drag."""
        return self._core.power(t, q, v)

    def momentum(self, t, q, v):
        """(linear, angular about the origin), kg m/s and kg m^2/s; None: not known."""
        return self._core.momentum(t, q, v)

    def constraints(self, t, q):
        """g (m), in the model's units."""
        return self._core.g(t, q) if self.m else np.zeros(0)

    def constraint_rate(self, t, q, v):
        """G v + dg/dt (m)."""
        return self._core.g_rate(t, q, v) if self.m else np.zeros(0)

    def jacobian(self, t, q):
        """G = dg/dq as scipy.sparse.csr_matrix (m, n)."""
        if not self.m:
            return scipy.sparse.csr_matrix((0, self._n))
        values, rows, starts, (n, m) = self._core.jacobian_transposed(t, q)
        return scipy.sparse.csr_matrix((values, rows, starts), shape=(m, n))

    def points(self, t, q):
        """Places of the material points, (points, 3) m; the last one is the tip."""
        return self._core.points(t, q)

    def point_velocities(self, t, q, v):
        """(points, 3) m/s."""
        return self._core.point_velocities(t, q, v)

    def before(self):
        """For each point the one that it is attached to, -1: none."""
        return self._core.before()

    def accept(self, t, q, v):
        """After a step of your own: (changed, q, v). Moves frames and contact sets; True:
        the equations have changed."""
        return self._core.accept(t, q, v)

    def reset(self):
        """Forgets all accepted steps."""
        self._core.reset()

    def memory(self):
        """Returns the state that accept() has changed, for ``recall`` of an equal system."""
        return self._core.memory()

    def recall(self, memory):
        self._core.recall(memory)

    def next_breakpoint(self, t):
        """The first time after t at which the equations are not smooth; inf: none."""
        return self._core.next_breakpoint(t)


class Integrator:
    """One method on one system: ``Integrator("generalized_alpha", system, step=1e-3)``.

    Options are those of ``--set``: ``integrator_options()``. InputError where the method
    cannot drive the system, with the reason, and on an option of another method. A system
    must not be stepped by two threads at once (SolveError).
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

        ``observer(t, q, v)`` is called after every step with copies; when it returns False
        the run ends there and advance returns False. A step without a solution raises
        SolveError with what happened and when. Ctrl-C raises KeyboardInterrupt within a
        step and 50 ms.
        """
        return self._core.advance(t_end, observer)

    @property
    def time(self):
        """s."""
        return self._core.time

    @property
    def q(self):
        """The coordinates: the method's own memory, for reading, until the next
        advance(). Copy what you keep."""
        return self._core.q

    @property
    def v(self):
        """Their rates, as q."""
        return self._core.v

    @property
    def stats(self):
        """Work since start(): {"steps", "residuals", "newton_iterations", "solver", ...}."""
        return self._core.stats


def refusal(id, system, formulation="parametric"):
    """Why an integrator cannot drive a system; empty: it can."""
    system = system if isinstance(system, System) else System(system)
    return _core.refusal(id, system._core, formulation)


def first_order(system):
    """For scipy.integrate.solve_ivp, of a system without constraints: (fun, jac, y0).

    y = (q, v), y' = (v, a), and the Jacobian [[0, 1], [-M^-1 K, -M^-1 D]] (2n, 2n), in
    which the derivative of M is part of K: it is taken at the acceleration of the state.
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
