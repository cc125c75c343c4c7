"""Derivatives of runs by numbers of a scene."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from . import _core
from .errors import InputError

if TYPE_CHECKING:
    from .scenes import Scene


@dataclass
class Gradient:
    """Points of a run and their derivatives by K parameters. F frames, P points, strand
    after strand; of="tip" keeps the last point of each strand."""

    times: np.ndarray  # (F) s
    value: np.ndarray  # (F, P, 3) m
    jacobian: np.ndarray  # (F, P, 3, K) m per unit of each parameter
    names: list[str]  # (K) parameters
    units: list[str]  # (K) units of the parameters
    # (K) values of the parameters, of the first strand. Where strands have materials of
    # their own, all change in the same proportion.
    parameters: np.ndarray
    strand: np.ndarray  # (P) the strand of each point
    damped: bool  # the run began with two short steps of backward Euler
    # "ok"; "not_smooth" where a force jumped during the run; "contact_changes" where
    # contact_changes is true of some frame
    status: str = "ok"
    # (F) whether an exact contact opens, closes, comes to rest or begins to slide within a
    # step of the frame
    contact_changes: np.ndarray | None = None
    # Largest distance, over the length of the strand, of the points of a run with a
    # tolerance from those of the run with its accepted steps frozen.
    moved: float = 0.0
    # (F, P, 3, K) estimated error of jacobian in time; None: not asked for
    time_error: np.ndarray | None = None

    def by(self, name: str) -> np.ndarray:
        """Returns the derivatives by one parameter, (F, P, 3). Raises InputError if the
        parameter is unknown."""
        if name not in self.names:
            raise InputError(f"no parameter '{name}' (by): one of {', '.join(self.names)}")
        return self.jacobian[..., self.names.index(name)]

    def relative(self) -> np.ndarray:
        """Returns the derivatives times the parameters, (F, P, 3, K) m. A hundredth of a value
        is the change of the coordinate for a change of the parameter by 1 %."""
        return self.jacobian * self.parameters


@dataclass
class LinearizedStep:
    """One step of a run as a linear map of deviations x = (dq, dv), 2n numbers:

    x at t_next = A x at t + B s, with a change s of the parameters during the step.
    """

    A: np.ndarray  # (2n, 2n)
    B: np.ndarray  # (2n, K) per unit of each parameter
    names: list[str]  # (K) parameters
    units: list[str]  # (K) units of the parameters
    t: float  # s
    t_next: float  # s
    q: np.ndarray  # (n) coordinates at t
    v: np.ndarray  # (n) rates at t
    q_next: np.ndarray  # (n) coordinates at t_next
    v_next: np.ndarray  # (n) rates at t_next

    def __iter__(self) -> Iterator[np.ndarray]:
        return iter((self.A, self.B))


def _one_of(name: str, value: str, words: Sequence[str]) -> None:
    if value not in words:
        raise InputError(f"unknown {name} '{value}' ({name}): one of {', '.join(words)}")


def names_of(by: str | Sequence[str]) -> list[str]:
    """Returns names of parameters as a list. Raises InputError on what is no name."""
    remedy = 'give names of parameters, as by=["youngs_modulus_pa"]'
    if isinstance(by, str):
        return [by]
    if not isinstance(by, Iterable):
        raise InputError(f"{by!r} is no name (by): {remedy}")
    names = list(by)
    for name in names:
        if not isinstance(name, str):
            raise InputError(f"{name!r} is no name (by): {remedy}")
    return names


def _guarded(scene: "Scene") -> bool:
    return scene.tables.get("guard", True) not in (False, "false")


def gradient(
    scene: "Scene",
    of: str,
    by: str | Sequence[str] | None,
    start: str | None,
    time_errors: bool,
) -> Gradient:
    """``Scene.gradient``."""
    _one_of("of", of, ("tip", "points"))
    if start is not None:
        _one_of("start", start, ("auto", "damped", "as_run"))
    names = None if by is None else names_of(by)
    if names == []:
        raise InputError(
            'by names nothing (by): give a parameter, as by=["youngs_modulus_pa"]'
        )
    found = _core.gradient(scene._core, of == "tip", names, start, 1)
    if _guarded(scene):
        scene.run(kind="strands", every=len(scene.times()))
    strands, over_change = found.pop("strands"), found.pop("error_over_change")
    changes = np.any([near for _, _, _, near in strands], axis=0)
    rough = any(reason for _, _, reason, _ in strands)
    result = Gradient(
        value=np.concatenate([s[0] for s in strands], axis=1),
        jacobian=np.concatenate([s[1] for s in strands], axis=1),
        strand=np.repeat(np.arange(len(strands)), [s[0].shape[1] for s in strands]),
        status="not_smooth" if rough else "contact_changes" if changes.any() else "ok",
        contact_changes=changes,
        **found,
    )
    if time_errors:
        finer = _core.gradient(scene._core, of == "tip", names, start, 2)["strands"]
        other = np.concatenate([s[1] for s in finer], axis=1)
        result.time_error = over_change * np.abs(result.jacobian - other)
    return result


def linearized_step(
    scene: "Scene", t: float, dt: float | None, by: str | Sequence[str], strand: int
) -> LinearizedStep:
    """``Scene.linearized_step``."""
    return LinearizedStep(**_core.linearized_step(scene._core, strand, t, dt, names_of(by)))
