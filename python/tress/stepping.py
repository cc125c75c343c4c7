"""Methods that step systems."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike as Array

from . import _core
from .systems import System, option_texts


class Integrator:
    """One method on one system: ``Integrator("generalized_alpha", system, step=1e-3)``.

    Options are those of ``--set``: ``integrator_options()``. Raises InputError with the
    reason if the method cannot drive the system, and for an option of another method. Two
    threads that step one system at once raise SolveError.
    """

    def __init__(self, id: str, system: Any, **options: Any) -> None:
        self.system = system if isinstance(system, System) else System(system)
        self._core = _core.Integrator(id, self.system._core, option_texts(options))

    def start(
        self, t: float = 0.0, q: Array | None = None, v: Array | None = None
    ) -> "Integrator":
        """Sets the state, by default the system's initial one. Returns self."""
        if q is None or v is None:
            q0, v0 = self.system.initial_state()
            q, v = (q0 if q is None else q), (v0 if v is None else v)
        self._core.start(t, q, v)
        return self

    def advance(
        self,
        t_end: float,
        observer: Callable[[float, np.ndarray, np.ndarray], Any] | None = None,
    ) -> bool:
        """Steps to t_end exactly, without the interpreter's lock.

        ``observer(t, q, v)`` is called after every step with copies. If it returns False,
        the run ends there and advance returns False. A step without a solution raises
        SolveError with the time and the reason. Ctrl-C raises KeyboardInterrupt within a
        step and 50 ms.
        """
        return self._core.advance(t_end, observer)

    @property
    def time(self) -> float:
        """Present time, s."""
        return self._core.time

    @property
    def q(self) -> np.ndarray:
        """Coordinates: a view of the memory of the method, valid until the next advance().
        Copy what you keep."""
        return self._core.q

    @property
    def v(self) -> np.ndarray:
        """Rates of the coordinates, a view as q."""
        return self._core.v

    @property
    def stats(self) -> dict[str, Any]:
        """Work since start(): {"steps", "residuals", "newton_iterations", "solver", ...}."""
        return self._core.stats


def refusal(id: str, system: Any, formulation: str = "parametric") -> str:
    """Returns the reason why an integrator cannot drive a system; empty if it can."""
    system = system if isinstance(system, System) else System(system)
    return _core.refusal(id, system._core, formulation)
