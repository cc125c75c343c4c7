"""Scenes: read, change, run."""

import sys
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from . import _core
from .errors import InputError, SolveError
from .systems import System
from .toml import text_of

# As many strands run as one head, where the scene can be one; as `simulate --as auto`.
_MANY = 1000


class Scene:
    """A scene as a value: what a scene file says, checked and complete.

    ``Scene(tables)`` of nested dicts with the keys of a scene file, ``Scene.parse(text)``,
    ``Scene.read(file)``. InputError with file:line:column where it is not one.
    """

    def __init__(self, tables, file="scene.toml"):
        self._set(text_of(tables), file)

    def _set(self, text, file):
        self._core = _core.Scene(text, str(file))  # says what is wrong, and where
        self._text, self.file = text, str(file)

    @classmethod
    def parse(cls, text, file="scene.toml"):
        """Of TOML text; files that it names are relative to the folder of ``file``."""
        scene = cls.__new__(cls)
        scene._set(text, file)
        return scene

    @classmethod
    def read(cls, file):
        path = Path(file)
        try:
            text = path.read_text()
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"cannot be read ({file}): {error}") from error
        return cls.parse(text, path)

    @property
    def tables(self):
        """What the scene gives, as nested dicts: a copy."""
        return tomllib.loads(self._text)

    def changed(self, changes):
        """The scene with other values: {"strand.elements": 40, "effects.wind": {...}}.

        Keys are paths; None removes what is there; a number in a path is the index of one of
        several tables, as in "groom.0.strands". InputError as when reading.
        """
        tables = self.tables
        for path, value in changes.items():
            *way, last = path.split(".")
            table = tables
            for word in way:
                if isinstance(table, list):
                    table = self._item(table, word, path)
                else:
                    table = table.setdefault(word, {})
            if value is None and isinstance(table, dict):
                table.pop(last, None)
            elif isinstance(table, dict):
                table[last] = value
            else:
                raise InputError(f"no table is there ({path}): name a key of a table")
        path = Path(self.file)
        name = self.file if path.stem.endswith(" changed") else (
            path.with_name(path.stem + " changed" + path.suffix)
        )
        return Scene(tables, name)

    @staticmethod
    def _item(tables, word, path):
        if word.isdigit() and int(word) < len(tables):
            return tables[int(word)]
        raise InputError(f"there is no table '{word}' ({path}): count from 0 to {len(tables) - 1}")

    def text(self):
        """The scene as a file, without what is default; reading it gives the same scene."""
        return self._core.text()

    @property
    def name(self):
        return self._core.name

    @property
    def title(self):
        return self._core.title

    @property
    def model(self):
        return self._core.model

    @property
    def integrator(self):
        return self._core.integrator

    @property
    def step(self):
        """dt_s, s."""
        return self._core.step

    @property
    def duration(self):
        """s."""
        return self._core.duration

    @property
    def strands(self):
        """Number of strands; 0: a mechanism."""
        return self._core.strands

    @property
    def effects(self):
        """Ids of its effects."""
        return self._core.effects

    def times(self):
        """Of its frames, s."""
        return self._core.times()

    def system(self, strand=0):
        """One strand with the effects on it alone, or the mechanism, as a System."""
        return System(self._core.system(strand))

    def start(self, threads=1, kind="strands"):
        """The run at t = 0, for loops of your own: StrandsRun, or HeadRun of a head."""
        if kind == "head":
            return HeadRun(self, threads)
        return StrandsRun(self, threads)

    def run(self, threads=1, kind="auto", progress=None, every=1):
        """Runs the scene to its end: Frames.

        kind: "strands" one by one; "head": side by side, up to a million; "auto": a head,
            where the scene can be one and has 1000 strands.
        progress: True for a line on standard error, or a function of (time, duration), s.
        every: keep each frame, each second one ...

        A step without a solution or an impossible state raises SolveError, whose ``frames``
        are those before. Ctrl-C raises KeyboardInterrupt after the present frame, of a head
        after the present step.
        """
        if kind not in ("auto", "strands", "head"):
            raise InputError(f"unknown kind '{kind}' (kind): one of auto, strands, head")
        run = None
        if kind == "head" or (kind == "auto" and self.strands >= _MANY):
            try:
                run = HeadRun(self, threads)
            except InputError:
                if kind == "head":
                    raise
        run = run or StrandsRun(self, threads)
        times = self.times()
        show = _progress(progress)
        frames = [run.frame()]
        failure = None
        for k, t in enumerate(times[1:], 1):
            try:
                run.advance(t)
            except SolveError as error:
                failure = error
                break
            if k % every == 0 or k == len(times) - 1:
                frames.append(run.frame())
            show(t, self.duration)
        all_frames = run.gather(frames)
        if failure is not None:
            failure.frames = all_frames
            raise failure
        return all_frames


def _progress(progress):
    if progress is None or progress is False:
        return lambda t, duration: None
    if callable(progress):
        return progress

    def line(t, duration):
        end = "\n" if t >= duration else ""
        print(f"\r{t:.3f} of {duration:g} s", end=end, file=sys.stderr, flush=True)

    return line


@dataclass
class Frames:
    """Frames of a run. F frames, P points, strand after strand from root to tip."""

    times: np.ndarray  # (F) s
    positions: np.ndarray  # (F, P, 3) m
    strand: np.ndarray  # (P) the strand of each point
    before: np.ndarray  # (P) the point that it is attached to, -1: none
    radii: np.ndarray  # (P) m, of a circle of the section's area; nan: a mechanism
    velocities: np.ndarray = None  # (F, P, 3) m/s; None: of a head, which keeps none
    series: dict = field(default_factory=dict)  # {column: (F)}, units in the names
    # {name: (F, Q)}: curvature, speed, and the load of each effect, N/m; Q = P, but for
    # trees, whose branches begin with the point that they are attached to (``lines``).
    channels: dict = field(default_factory=dict)
    channel_units: dict = field(default_factory=dict)
    lines: np.ndarray = None  # points of each line of the channels
    # Of each frame (contacts, 6): place, m, and force on the strand, N.
    contacts: list = field(default_factory=list)
    lost: list = field(default_factory=list)  # strands of a head without a solution

    def of_strand(self, k):
        """(F, points, 3) m: the points of one strand."""
        return self.positions[:, self.strand == k]


class StrandsRun:
    """A run of a scene, strands one by one. ``advance(t)``, then read."""

    def __init__(self, scene, threads=1):
        self._core = _core.StrandsRun(scene._core, threads)

    def advance(self, t):
        """Runs to t (s) without the interpreter's lock; SolveError gives the reason."""
        self._core.advance(t)

    @property
    def time(self):
        return self._core.time

    @property
    def positions(self):
        """(P, 3) m: the run's own memory, for reading, until the next advance()."""
        return self._core.positions

    @property
    def velocities(self):
        """(P, 3) m/s, as positions."""
        return self._core.velocities

    @property
    def strand(self):
        return self._core.strand

    @property
    def energies(self):
        """(kinetic, elastic, [of each effect]), J."""
        return self._core.energies

    def frame(self):
        """Everything of this instant, as copies."""
        return self._core.frame()

    def gather(self, frames):
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


class HeadRun:
    """A run of all strands of a scene side by side. InputError says why a scene is none."""

    def __init__(self, scene, threads=1, bits=64):
        self._core = _core.HeadRun(scene._text, scene.file, bits, threads)

    def advance(self, t):
        """To t (s) in equal steps of at most the scene's, or as its tolerance asks."""
        self._core.advance(t)

    @property
    def time(self):
        return self._core.time

    @property
    def positions(self):
        """(P, 3) m."""
        return self._core.positions()

    @property
    def energies(self):
        """(kinetic, elastic, gravity), J, of all strands."""
        return self._core.energy()

    @property
    def lost(self):
        """Strands that have no solution, or do what physics rules out."""
        return self._core.lost()

    def frame(self):
        return {"t": self.time, "positions": self.positions, "energies": self.energies}

    def gather(self, frames):
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
            lost=self.lost,
        )
