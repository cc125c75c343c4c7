"""Plots with matplotlib: motion, energy, work and precision, stable steps.

Each function draws into ``axes`` (by default those of a new figure) and returns them.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from .errors import InputError
from .runs import Frames
from .tables import Table


def _axes(axes: Any) -> Any:
    if axes is not None:
        return axes
    from matplotlib import pyplot

    return pyplot.subplots(layout="constrained")[1]


def _columns(table: Table, *names: str) -> None:
    for name in names:
        if name not in table:
            raise InputError(f"no column '{name}' (plot): there are {', '.join(table)}")


def motion(frames: Frames, count: int = 12, plane: str = "xz", axes: Any = None) -> Any:
    """Draws the strands at equally spaced frames, from dark to light.

    count: number of frames; plane: two of x, y and z.
    """
    if len(plane) != 2 or not set(plane) <= set("xyz"):
        raise InputError(f"unknown plane '{plane}' (plane): give two of x, y and z, as 'xz'")
    axes = _axes(axes)
    from matplotlib import colormaps

    across, up = ("xyz".index(c) for c in plane)
    total = len(frames.times)
    for k in np.unique(np.linspace(0, total - 1, min(count, total)).astype(int)):
        colour = colormaps["viridis"](k / max(1, total - 1))
        for x in frames.polylines(k):
            axes.plot(x[:, across], x[:, up], color=colour, linewidth=1)
    axes.set(xlabel=f"{plane[0]} (m)", ylabel=f"{plane[1]} (m)", aspect="equal")
    return axes


def energy(frames: Frames, names: Sequence[str] | None = None, axes: Any = None) -> Any:
    """Draws the energies of a run over time.

    names: columns of ``frames.series``; by default all that end in _j.
    """
    axes = _axes(axes)
    for name in names or [name for name in frames.series if name.endswith("_j")]:
        axes.plot(frames.times, frames.series[name], label=name.removesuffix("_j"))
    axes.set(xlabel="t (s)", ylabel="energy (J)")
    axes.legend(frameon=False)
    return axes


def work_precision(table: Table, axes: Any = None) -> Any:
    """Draws error against time for each model and integrator of a table of
    ``work_precision``."""
    _columns(table, "model", "integrator", "error_rel", "wall_s_per_sim_s", "status")
    axes = _axes(axes)
    pairs = sorted(set(zip(table["model"], table["integrator"])))
    models = {model for model, _ in pairs}
    for model, integrator in pairs:
        rows = table.where(model=model, integrator=integrator, status="ok")
        order = np.argsort(rows["wall_s_per_sim_s"])
        label = integrator if len(models) == 1 else f"{model}, {integrator}"
        axes.loglog(rows["wall_s_per_sim_s"][order], rows["error_rel"][order], "o-",
                    markersize=3, label=label)  # fmt: skip
    axes.set(xlabel="time per simulated second (s/s)", ylabel="error over the length")
    axes.legend(frameon=False, fontsize="small")
    return axes


def stability_map(table: Table, axes: Any = None) -> Any:
    """Draws the largest stable step of each integrator and model of a table of
    ``stability_limit`` as colours. The smallest value stands where a pair has several rows;
    pairs without a row are blank."""
    _columns(table, "model", "integrator", "dt_max_s", "status")
    axes = _axes(axes)
    rows = table.where(status="ok")
    models = sorted(set(rows["model"]))
    integrators = sorted(set(rows["integrator"]))
    values = np.full((len(integrators), len(models)), np.nan)
    for model, integrator, step in zip(rows["model"], rows["integrator"], rows["dt_max_s"]):
        at = integrators.index(integrator), models.index(model)
        values[at] = np.nanmin([values[at], step]) if np.isfinite(step) else values[at]
    drawn = axes.imshow(np.log10(values), aspect="auto", cmap="viridis")
    axes.set_xticks(range(len(models)), models, rotation=60, ha="right")
    axes.set_yticks(range(len(integrators)), integrators)
    axes.figure.colorbar(drawn, ax=axes, label="log10 of the largest stable step (s)")
    return axes
