"""tress, a testbed for rod and elastic-strand solvers, from Python. See docs/python.md."""

import importlib
from typing import Any

from .errors import InputError, ProgramError, SolveError
from ._core import (
    load_plugin,
    scene_defaults,
    scene_schema,
    version as __version__,
    version_text,
)
from .fits import Fit, fit
from .gradients import Gradient, LinearizedStep
from .questions import (
    Advice,
    ErrorBar,
    ErrorBars,
    StrandError,
    advice,
    error_bars,
    stability_limits,
)
from .runs import BatchRun, Frames, StrandsRun
from .scenes import Scene
from .stepping import Integrator, refusal
from .systems import (
    System,
    first_order,
    integrator_options,
    integrators,
    model,
    model_options,
    models,
)
from .tables import Table, experiment, programs_folder, read_table, unit_of

__all__ = [
    "Advice",
    "BatchRun",
    "ErrorBar",
    "ErrorBars",
    "Fit",
    "Frames",
    "Gradient",
    "InputError",
    "Integrator",
    "LinearizedStep",
    "ProgramError",
    "Scene",
    "SolveError",
    "StrandError",
    "StrandsRun",
    "System",
    "Table",
    "advice",
    "error_bars",
    "experiment",
    "first_order",
    "fit",
    "integrator_options",
    "integrators",
    "load_plugin",
    "model",
    "model_options",
    "models",
    "programs_folder",
    "read_table",
    "refusal",
    "scene_defaults",
    "scene_schema",
    "stability_limits",
    "unit_of",
    "version_text",
]


def __getattr__(name: str) -> Any:
    """Loads tress.plot when it is first used, which needs matplotlib. Refuses a former name with
    the present one, also in `from tress import ...`."""
    if name == "plot":
        return importlib.import_module("tress.plot")
    if name == "HeadRun":
        raise InputError("'HeadRun' does not exist (tress): it is called 'BatchRun' now")
    raise AttributeError(f"module 'tress' has no attribute '{name}'")
