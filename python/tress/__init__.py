"""tress, a testbed for rod and elastic-strand solvers, from Python. See docs/python.md."""

from .errors import InputError, ProgramError, SolveError
from ._core import load_plugin, scene_defaults, scene_schema, version as __version__
from .fits import Fit, fit
from .gradients import Gradient, LinearizedStep
from .runs import BatchRun, Frames, StrandsRun
from .scenes import Scene
from .systems import (
    Integrator,
    System,
    first_order,
    integrator_options,
    integrators,
    model,
    model_options,
    models,
    refusal,
)
from .tables import Table, experiment, programs_folder, read_table, unit_of

__all__ = [
    "BatchRun",
    "Fit",
    "Frames",
    "Gradient",
    "InputError",
    "Integrator",
    "LinearizedStep",
    "ProgramError",
    "Scene",
    "SolveError",
    "StrandsRun",
    "System",
    "Table",
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
    "unit_of",
]


def __getattr__(name):
    """Refuses a former name with the present one, also in `from tress import ...`."""
    if name == "HeadRun":
        raise InputError("'HeadRun' does not exist (tress): it is called 'BatchRun' now")
    raise AttributeError(f"module 'tress' has no attribute '{name}'")
