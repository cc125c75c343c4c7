"""The exceptions of tress. Their text is that which the programs print."""

import re

# "what is wrong (where): what to do"; a place has no brackets of its own.
_PARTS = re.compile(r"(.*?) \(([^()]*)\): (.*)", re.DOTALL)


class InputError(ValueError):
    """Bad input. ``str(error)`` is one line: what is wrong (where): what to do.

    Attributes: ``problem``, ``place`` (file:line:column, option, key or argument) and
    ``remedy``; place and remedy are empty where the text has no such parts.
    """

    def __init__(self, text):
        super().__init__(text)
        parts = _PARTS.fullmatch(text)
        self.problem, self.place, self.remedy = parts.groups() if parts else (text, "", "")


class SolveError(RuntimeError):
    """An evaluation or a step without a result.

    ``frames``: those of a run of a scene up to there (tress.Frames), else None.
    """

    frames = None


class ProgramError(RuntimeError):
    """An experiment's program has ended by an internal error. ``code``: its exit code."""

    code = 1
