"""Fits of scenes to records of points."""

import csv
import io
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from .errors import InputError
from .gradients import names_of
from .scenes import Scene
from .tables import Table


@dataclass
class Fit:
    """K fitted parameters of scenes, and the limits of their accuracy."""

    names: list[str]  # (K)
    units: list[str]  # (K)
    values: np.ndarray  # (K) of the first strand; others change in the same proportion
    low: np.ndarray  # (K) lower ends of the intervals; nan: not determined
    high: np.ndarray  # (K)
    # (K) intervals by profiles; nan: not asked for, or no end
    profile_low: np.ndarray
    profile_high: np.ndarray
    # (K) changes with half the step and with twice the elements, in half intervals; nan
    # where they were not asked for
    step_shift: np.ndarray
    elements_shift: np.ndarray
    statuses: list[str]  # (K) of each parameter: ok, at_bound, not_identified, time_error, ...
    reasons: list[str]  # (K) in words
    status: str  # the first of these that is not ok
    reason: str
    undetermined: str  # combinations that the records do not determine, in words
    singular_values: np.ndarray  # of the weighted derivatives by the unknowns, descending
    rms: float  # m, of measured less fitted
    reduced_chi2: float  # nan without sigma_m
    autocorrelation: float  # of successive residuals of a coordinate
    degrees: int  # of freedom
    evaluations: int  # runs of all records with their derivatives
    measured: list[np.ndarray]  # of each record: its coordinates, m, row after row
    fitted: list[np.ndarray]  # of each record: the same of the fitted scene, m

    def __getitem__(self, name: str) -> tuple[float, float, float]:
        """Returns (value, low, high) of one parameter."""
        if name not in self.names:
            raise InputError(f"no parameter '{name}' (fit): one of {', '.join(self.names)}")
        k = self.names.index(name)
        return self.values[k], self.low[k], self.high[k]


def _text(record: Any, number: int) -> tuple[str, str]:
    """(text, file) of a record: the name of a CSV, a Table, or a dict of columns."""
    if isinstance(record, (str, Path)):
        try:
            return Path(record).read_text(), str(record)
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"cannot be read ({record}): {error}") from error
    if not isinstance(record, (Mapping, Table)):
        raise InputError(
            f"{type(record).__name__} is no record (record): give a CSV file, a dict of "
            "columns, or a list of these"
        )
    columns = {name: np.atleast_1d(column) for name, column in dict(record).items()}
    if not columns:
        raise InputError(f"no columns (record {number}): give time_s, x_m, y_m, z_m")
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    lengths = {column.size for column in columns.values()}
    if len(lengths) > 1:
        raise InputError(
            f"columns of {min(lengths)} and {max(lengths)} rows (record): give equal lengths"
        )
    for row in zip(*columns.values()):
        writer.writerow([_cell(x) for x in row])
    return text.getvalue(), f"record {number}"


def _cell(x: Any) -> str:
    """nan: not measured."""
    return "" if isinstance(x, (float, np.floating)) and np.isnan(x) else str(x)


def _list(one_or_more: Any) -> list:
    return list(one_or_more) if isinstance(one_or_more, (list, tuple)) else [one_or_more]


def _pairs(
    given: Mapping[str, tuple[float, float]] | None, where: str, two: str
) -> dict[str, tuple[float, float]]:
    """Pairs of numbers by name."""
    remedy = f"give {{name: ({two})}}"
    if given is not None and not isinstance(given, Mapping):
        raise InputError(f"{given!r} is no dict ({where}): {remedy}")
    pairs = {}
    for name, values in (given or {}).items():
        try:
            first, second = map(float, values)
        except (TypeError, ValueError):
            raise InputError(
                f"{values!r} of {name} are no two numbers ({where}): {remedy}"
            ) from None
        pairs[name] = (first, second)
    return pairs


def fit(
    scene: Scene | Sequence[Scene],
    record: Any,
    by: str | Sequence[str] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    priors: Mapping[str, tuple[float, float]] | None = None,
    confidence: float = 0.95,
    shifts: bool = True,
    profile: bool = False,
    progress: Callable[[int, float], Any] | None = None,
) -> Fit:
    """Fits parameters of a scene to points of its strands: Fit.

    scene: a Scene, whose values the fit starts from; a list with one for each record.
    record: a CSV file with the columns time_s, x_m, y_m, z_m, and optionally strand, point
        (default: the tip) and sigma_m; or a dict of such columns; or a list of records, which
        share the parameters. nan is a coordinate that was not measured.
    by: names of parameters, as in ``Scene.gradient``; None: those of [gradient].
    bounds: {name: (low, high)} in the units of the parameters.
    priors: {name: (value, sigma)}, known without the records.
    confidence: confidence level of the intervals.
    shifts: runs again with half the step and with twice the elements, for ``step_shift``,
        ``elements_shift`` and the statuses time_error and space_error.
    profile: also finds ``profile_low`` and ``profile_high``. There the sum of squares, with
        the other values fitted again, has risen by the amount of the confidence level.
    progress: function of (evaluations, rms in m), called after each run.

    Least squares by Gauss-Newton steps within a trust region, with the exact derivatives of
    the runs; `calibrate` does the same. Raises InputError with the place and the remedy.
    """
    texts = [_text(one, number) for number, one in enumerate(_list(record))]
    scenes = []
    for one in _list(scene):
        if not isinstance(one, Scene):
            raise InputError(
                f"{type(one).__name__} is no scene (scene): give a Scene, or a list of them"
            )
        scenes.append(one._core)
    names = None if by is None else names_of(by)
    pairs = (_pairs(bounds, "bounds", "low, high"), _pairs(priors, "priors", "value, sigma"))
    return Fit(**_core.fit(scenes, texts, names, *pairs, confidence, shifts, profile, progress))
