"""Runs of scenes, and their frames."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from . import _core, display
from .errors import InputError

if TYPE_CHECKING:
    from .scenes import Scene


def _refuse_former(value: object, name: str) -> NoReturn:
    """Raises AttributeError, with the present name where `name` is a former one. Called for
    names that `value` does not have."""
    kind = type(value).__name__
    now = "failed" if name == "lost" else None
    hint = f"; it is called '{now}' now" if now else ""
    raise AttributeError(f"'{kind}' has no attribute '{name}'{hint}", name=name, obj=value)


@dataclass
class Frames:
    """Frames of a run: F frames of P points, strand after strand from root to tip."""

    times: np.ndarray  # (F) s
    positions: np.ndarray  # (F, P, 3) m
    strand: np.ndarray  # (P) the strand of each point
    before: np.ndarray  # (P) the point that it is attached to, -1: none
    radii: np.ndarray  # (P) m, of a circle of the section's area; nan: a mechanism
    velocities: np.ndarray | None = None  # (F, P, 3) m/s; None: of a batch, which keeps none
    series: dict[str, np.ndarray] = field(default_factory=dict)  # {column: (F)}, units in the names
    # {name: (F, Q)}: curvature, speed, and the load of each effect, N/m; Q = P, but for
    # trees, whose branches begin with the point that they are attached to (``lines``).
    channels: dict[str, np.ndarray] = field(default_factory=dict)
    channel_units: dict[str, str] = field(default_factory=dict)
    lines: np.ndarray | None = None  # points of each line of the channels
    # Of each frame (contacts, 6): place, m, and force on the strand, N.
    contacts: list[np.ndarray] = field(default_factory=list)
    failed: list[int] = field(default_factory=list)  # strands of a batch without a solution

    def __getattr__(self, name: str) -> NoReturn:
        return _refuse_former(self, name)

    def polylines(self, frame: int) -> list[np.ndarray]:
        """Returns the lines of one frame from root to tip, each (points, 3) m. The branches of
        a tree are lines of their own."""
        lines, points = [], self.positions[frame]
        for k, before in enumerate(self.before):
            if k and before == k - 1:
                lines[-1].append(points[k])
            else:
                lines.append(([points[before]] if before >= 0 else []) + [points[k]])
        return [np.array(line) for line in lines]

    def _repr_svg_(self) -> str:
        """What a notebook shows: the strands at equally spaced frames, the last one darkest."""
        last = len(self.times) - 1
        chosen = np.unique(np.linspace(0, last, 8).astype(int)) if last else [0]
        poses = ((k / last if last else 1.0, self.polylines(k)) for k in chosen)
        return display.drawing(poses, f"{len(self.times)} frames until {self.times[-1]:g} s")

    def of_strand(self, k: int) -> np.ndarray:
        """Returns the positions of the points of one strand, (F, points, 3) m."""
        return self.positions[:, self.strand == k]


class StrandsRun:
    """A run of a scene, strands one by one: call ``advance(t)``, then read its values."""

    def __init__(self, scene: "Scene", threads: int = 1) -> None:
        self._core = _core.StrandsRun(scene._core, threads)

    def advance(self, t: float) -> None:
        """Runs to t (s) without the interpreter's lock. Raises SolveError with the reason if
        a step has no solution."""
        self._core.advance(t)

    @property
    def time(self) -> float:
        """Present time, s."""
        return self._core.time

    @property
    def positions(self) -> np.ndarray:
        """Positions (P, 3), m: a view of the memory of the run, valid until the next
        advance()."""
        return self._core.positions

    @property
    def velocities(self) -> np.ndarray:
        """Velocities (P, 3), m/s: a view as positions."""
        return self._core.velocities

    @property
    def strand(self) -> np.ndarray:
        """Number of the strand of each point (P)."""
        return self._core.strand

    @property
    def energies(self) -> tuple:
        """Energies (kinetic, elastic, [of each effect]), J."""
        return self._core.energies

    def frame(self) -> dict[str, Any]:
        """Returns all values of this instant, as copies."""
        return self._core.frame()

    def gather(self, frames: list[dict[str, Any]]) -> Frames:
        """Returns the Frames of a list of frame()."""
        core = self._core
        series = np.array([frame["series"] for frame in frames])
        channels = np.array([frame["channels"] for frame in frames])
        columns = dict(zip(core.series, series.T))
        return Frames(
            times=columns["t_s"],
            positions=np.array([frame["positions"] for frame in frames]),
            velocities=np.array([frame["velocities"] for frame in frames]),
            strand=core.strand,
            before=core.before,
            radii=core.radii,
            series=columns,
            channels={name: channels[:, c] for c, name in enumerate(core.channels)},
            channel_units=core.units,
            lines=core.lines,
            contacts=[frame["contacts"] for frame in frames],
        )


class BatchRun:
    """A run of all strands of a scene as one batch. Raises InputError with the reason if the
    scene cannot run as a batch.

    threads: number of threads; precision: floating-point precision, 64 or 32 bits."""

    def __init__(
        self, scene: "Scene", threads: int = 1, precision: int = 64, **unknown: Any
    ) -> None:
        known = ("threads", "precision")
        for name in unknown:
            remedy = _core.suggestion(name, known, f"use one of: {', '.join(known)}")
            raise InputError(f"unknown argument '{name}' (BatchRun): {remedy}")
        self._core = _core.BatchRun(scene._text, scene.file, precision, threads)

    def advance(self, t: float) -> None:
        """Runs to t (s) in equal steps of at most dt_s of the scene, or in steps that the error
        control chooses."""
        self._core.advance(t)

    def __getattr__(self, name: str) -> NoReturn:
        return _refuse_former(self, name)

    @property
    def time(self) -> float:
        """Present time, s."""
        return self._core.time

    @property
    def positions(self) -> np.ndarray:
        """Positions (P, 3), m."""
        return self._core.positions()

    @property
    def energies(self) -> tuple:
        """Energies (kinetic, elastic, gravity) of all strands, J."""
        return self._core.energy()

    @property
    def failed(self) -> list[int]:
        """Numbers of the strands without a solution, or in a state that physics rules out."""
        return self._core.failed()

    def frame(self) -> dict[str, Any]:
        """Returns time, positions and energies of this instant."""
        return {"t": self.time, "positions": self.positions, "energies": self.energies}

    def gather(self, frames: list[dict[str, Any]]) -> Frames:
        """Returns the Frames of a list of frame()."""
        core = self._core
        points = core.points
        strand = np.repeat(np.arange(core.strands, dtype=np.int32), points)
        before = np.arange(-1, strand.size - 1, dtype=np.int32)
        before[::points] = -1
        times = np.array([frame["t"] for frame in frames])
        energies = np.array([frame["energies"] for frame in frames])
        names = ("kinetic_j", "elastic_j", "gravity_j")
        return Frames(
            times=times,
            positions=np.array([frame["positions"] for frame in frames]),
            strand=strand,
            before=before,
            radii=core.radii(),
            series={"t_s": times, **dict(zip(names, energies.T))},
            failed=self.failed,
        )
