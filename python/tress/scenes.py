"""Scenes: read, change, run."""

import html
import tomllib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import _core, display, gradients
from .errors import InputError, SolveError
from .runs import BatchRun, Frames, StrandsRun
from .systems import System
from .toml import text_of

# From this number of strands on, a scene that can be a batch runs as one; as `simulate --as
# auto`.
_MANY = 1000


class Scene:
    """A checked scene.

    Made with ``Scene(tables)`` from nested dicts with the keys of a scene file, with
    ``Scene.parse(text)`` or ``Scene.read(file)``. Raises InputError with file:line:column if
    there is a mistake.
    """

    def __init__(self, tables: Mapping[str, Any], file: str | Path = "scene.toml") -> None:
        self._set(text_of(tables), file)

    def _set(self, text: str, file: str | Path) -> None:
        self._core = _core.Scene(text, str(file))  # says what is wrong, and where
        self._text, self.file = text, str(file)

    @classmethod
    def parse(cls, text: str, file: str | Path = "scene.toml") -> "Scene":
        """Makes a scene from TOML text. Files that it names are relative to the folder of
        ``file``."""
        scene = cls.__new__(cls)
        scene._set(text, file)
        return scene

    @classmethod
    def read(cls, file: str | Path) -> "Scene":
        """Reads a scene file."""
        path = Path(file)
        try:
            text = path.read_text()
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"cannot be read ({file}): {error}") from error
        return cls.parse(text, path)

    def __reduce__(self) -> tuple:
        """Scenes are pickled as text: for processes that share work."""
        return Scene.parse, (self._text, self.file)

    def _repr_html_(self) -> str:
        """What a notebook shows: title, model and method, and the strands at t = 0."""
        text = (f"{self.title}: {self.model}, {self.integrator}, {self.strands} strands, "
                f"{self.duration:g} s")  # fmt: skip
        run = StrandsRun(self) if self.strands < _MANY else None
        drawn = run.gather([run.frame()])._repr_svg_() if run else ""
        return f"<p>{html.escape(text)}</p>{drawn}"

    @property
    def source_text(self) -> str:
        """Text from which the scene was made."""
        return self._text

    @property
    def tables(self) -> dict[str, Any]:
        """Tables of the scene as nested dicts: a copy, without defaults."""
        return tomllib.loads(self._text)

    def changed(self, changes: Mapping[str, Any]) -> "Scene":
        """Returns the scene with other values: {"strand.elements": 40, "effects.wind": {...}}.

        Keys are paths. None removes a key or a table. A number in a path is the index of one of
        several tables, as in "groom.0.count". Raises InputError as read() does.
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
    def _item(tables: list, word: str, path: str) -> Any:
        if word.isdigit() and int(word) < len(tables):
            return tables[int(word)]
        raise InputError(f"there is no table '{word}' ({path}): count from 0 to {len(tables) - 1}")

    def text(self) -> str:
        """Returns the scene as the text of a file, without defaults. Reading it gives the same
        scene."""
        return self._core.text()

    @property
    def name(self) -> str:
        """Name of the scene: that of its file without the ending."""
        return self._core.name

    @property
    def title(self) -> str:
        """Title of the scene."""
        return self._core.title

    @property
    def model(self) -> str:
        """Id of the model."""
        return self._core.model

    @property
    def integrator(self) -> str:
        """Id of the integrator."""
        return self._core.integrator

    @property
    def step(self) -> float:
        """Key dt_s of the scene, s."""
        return self._core.step

    @property
    def duration(self) -> float:
        """Simulated time, s."""
        return self._core.duration

    @property
    def strands(self) -> int:
        """Number of strands; 0 for a mechanism."""
        return self._core.strands

    @property
    def effects(self) -> list[str]:
        """Ids of the effects."""
        return self._core.effects

    def times(self) -> np.ndarray:
        """Returns the times of the frames, s."""
        return self._core.times()

    def system(self, strand: int = 0) -> System:
        """Returns one strand, with the effects that act on it alone, or the mechanism, as a
        System."""
        return System(self._core.system(strand))

    def gradient(
        self,
        of: str = "tip",
        by: str | Sequence[str] | None = None,
        start: str | None = None,
        time_errors: bool = False,
    ) -> gradients.Gradient:
        """Computes exact derivatives of the run by numbers of the scene: Gradient.

        of: "tip" or "points".
        by: names of parameters, as in [gradient] of a scene file (docs/start/gradients.md);
            None: those of the scene's own [gradient].
        start: "auto", "damped" or "as_run", as in [gradient]; None: the scene's own, or
            "auto".
        time_errors: runs again with half the step to estimate ``Gradient.time_error``.

        Where strands have materials of their own, a derivative by a number of the material
        is per unit of the first strand's: all change in the same proportion.

        Raises InputError for an unknown parameter, or with the reason why the run has no
        derivatives. A step without a solution, or an impossible state, raises SolveError as
        ``run`` does.
        """
        return gradients.gradient(self, of, by, start, time_errors)

    def linearized_step(
        self,
        t: float = 0.0,
        dt: float | None = None,
        by: str | Sequence[str] = (),
        strand: int = 0,
    ) -> gradients.LinearizedStep:
        """Computes the matrices of one step: LinearizedStep, or A, B = linearized_step(...).

        A has the derivatives of the state after the step by the state before it, B those by
        the parameters: state-transition matrices for control and estimation.

        t: start of the step, s; the scene runs to it first.
        dt: length of the step, s; None: dt_s of the scene.
        by: names of parameters, as in ``gradient``, which act during the step alone:
            "root_position_m.z", "wind.velocity_m_s.x".

        Raises InputError if the step depends on more than (q, v), as with bdf2 and
        generalized_alpha, or if the model has constraints.
        """
        return gradients.linearized_step(self, t, dt, by, strand)

    def start(self, threads: int = 1, kind: str = "strands") -> StrandsRun | BatchRun:
        """Returns the run at t = 0, for loops of your own: StrandsRun, or BatchRun of a batch.

        kind: "strands" or "batch".
        """
        _check_kind(kind, ("strands", "batch"))
        return (BatchRun if kind == "batch" else StrandsRun)(self, threads)

    def run(
        self,
        threads: int = 1,
        kind: str = "auto",
        progress: bool | Callable[[float, float], None] | None = None,
        every: int = 1,
    ) -> Frames:
        """Runs the scene to its end: Frames.

        kind: "strands" runs the strands one by one, "batch" all together, up to a million.
            "auto" takes a batch if the scene has at least 1000 strands and can run as one.
        progress: True for a bar in a notebook, elsewhere a line on standard error; or a
            function of (time, duration), s.
        every: n keeps every n-th frame, and the last one.

        A step without a solution or an impossible state raises SolveError, whose ``frames``
        are those before it. Ctrl-C raises KeyboardInterrupt after the present frame; in a
        batch, after the present step.
        """
        _check_kind(kind, ("auto", "strands", "batch"))
        run = None
        if kind == "batch" or (kind == "auto" and self.strands >= _MANY):
            try:
                run = BatchRun(self, threads)
            except InputError:
                if kind == "batch":
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


def _check_kind(kind: str, known: Sequence[str]) -> None:
    """Raises InputError if a kind of run is not known; of a former one with the present one."""
    if kind not in known:
        remedy = _core.suggestion(kind, known, f"use one of: {', '.join(known)}")
        raise InputError(f"unknown kind '{kind}' (kind): {remedy}")


def _progress(
    progress: bool | Callable[[float, float], None] | None,
) -> Callable[[float, float], None]:
    if progress is None or progress is False:
        return lambda t, duration: None
    if callable(progress):
        return progress

    return display.progress_line()
