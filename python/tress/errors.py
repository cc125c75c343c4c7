"""The exceptions of tress. Their texts are those that the programs print."""

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .runs import Frames

# "what is wrong (where): what to do"; a place has no brackets of its own.
_PARTS = re.compile(r"(.*?) \(([^()]*)\): (.*)", re.DOTALL)


class InputError(ValueError):
    """Bad input. ``str(error)`` is one line: what is wrong (where): what to do.

    Attributes: ``problem``, ``place`` (file:line:column, option, key or argument) and
    ``remedy``. Place and remedy are empty if the text has no such parts.
    """

    def __init__(self, text: str) -> None:
        super().__init__(text)
        parts = _PARTS.fullmatch(text)
        self.problem, self.place, self.remedy = parts.groups() if parts else (text, "", "")


class SolveError(RuntimeError):
    """An evaluation or a step without a result.

    ``frames``: frames of the run of a scene before the failure (tress.Frames), else None.
    """

    frames: "Frames | None" = None


class ProgramError(RuntimeError):
    """An internal error of the program of an experiment. ``code``: its exit code."""

    code = 1
