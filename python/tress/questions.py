"""Answers about one scene: cheapest settings, stable steps, errors of a run."""

import contextlib
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import _core
from .scenes import Scene
from .tables import Table, experiment


@dataclass
class Advice:
    """The cheapest run that reaches a target error, and the scene with its settings."""

    scene: Scene  # the scene with the advised model, integrator, elements and step
    table: Table  # all rows of `cost_of_accuracy --advise`, the advised run among them


@dataclass
class StrandError:
    """Estimated error of one strand, over its length, before two runs of it part."""

    largest: float
    rms: float
    largest_at: float  # s
    parts: float | None  # s, when the two runs are no longer one motion; None: never


@dataclass
class ErrorBar:
    """Estimated error of a run in time or in space. F frames, until all strands part."""

    strands: list[StrandError]
    largest: np.ndarray  # (F) largest error of a point over the length of its strand
    rms: np.ndarray  # (F) root mean square over the points
    bound: float  # 90 % of the calibration runs had an error below bound times the estimate
    missing: str  # reason why there is no estimate; "": there is one
    finished: bool  # False: a run did not come to its end


@dataclass
class ErrorBars:
    """Errors of a run: of its steps and of its elements."""

    time: ErrorBar
    space: ErrorBar


@contextlib.contextmanager
def _file_of(scene: Scene) -> Iterator[tuple[Path, Path]]:
    """Yields a file with the text of a scene, and a folder for results. Files that the scene
    names stay relative to its own folder."""
    with tempfile.TemporaryDirectory(prefix="tress-") as folder:
        own = Path(scene.file)
        if own.is_file() and own.read_text() == scene.source_text:
            yield own, Path(folder)
        else:
            file = Path(folder) / "scene.toml"
            file.write_text(scene.source_text)
            yield file, Path(folder)


def advice(scene: Scene, accuracy: float = 0.01, *words: str) -> Advice:
    """Finds the cheapest run of a scene with this error of the tip, over the length: Advice.

    words: further options of `cost_of_accuracy --advise`. Raises InputError as the program
    does, also where nothing reaches the accuracy.
    """
    with _file_of(scene) as (file, folder):
        out = folder / "advice.csv"
        table = experiment("cost_of_accuracy", "--advise", file, "--set",
                           f"accuracy={accuracy}", "--quick", *words, out=out)  # fmt: skip
        advised = folder / f"{file.stem}.advised.toml"
        text = advised.read_text() if advised.is_file() else scene.source_text
        return Advice(Scene.parse(text, scene.file), table)


def stability_limits(scene: Scene, *words: str) -> Table:
    """Returns the largest stable step of each integrator on a scene, as the Table of
    `stability_limit --scene`: column ``dt_max_s``.

    words: further options of the program, as in ``"--integrators", "tr_bdf2,bdf2"``.
    """
    with _file_of(scene) as (file, folder):
        return experiment("stability_limit", "--scene", file, "--quick", *words,
                          out=folder / "limits.csv")  # fmt: skip


def _bar(found: dict, bound: float) -> ErrorBar:
    strands = [StrandError(*one) for one in found.pop("strands")]
    return ErrorBar(strands=strands, bound=bound, **found)


def error_bars(scene: Scene, threads: int = 1) -> ErrorBars:
    """Estimates the errors of a run: ErrorBars, as `simulate --error-bars` does.

    Runs the scene again with half the step, and with twice the elements. Raises InputError
    for methods whose error the step does not govern.
    """
    time = _core.time_error(scene._core, threads)
    space = _core.space_error(scene._core, threads)
    return ErrorBars(_bar(time, _core.time_bound), _bar(space, _core.space_bound))
