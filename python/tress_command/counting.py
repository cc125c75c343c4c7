"""Programs whose exit codes are counted: the worst is that of the command."""

from .messages import BAD_INPUT, INTERNAL_ERROR, INTERRUPTED, ROWS_FAILED, Ended, say
from .processes import run

# From harmless to bad; every other code is worse.
SEVERITY = (0, ROWS_FAILED, BAD_INPUT)


def severity(code):
    return SEVERITY.index(code) if code in SEVERITY else len(SEVERITY)


class Worst:
    """The worst exit code of several programs."""

    def __init__(self):
        self.code = 0

    def run(self, what, *command, after_interrupt=""):
        """Runs a program to its exit code; 1 if a signal ended it. An interruption ends all."""
        try:
            code = run(*command)
        except KeyboardInterrupt:
            code = INTERRUPTED
        if code == INTERRUPTED:
            raise Ended(INTERRUPTED, f"interrupted in {what}{after_interrupt}")
        if code >= 128:
            say(f"{what} was ended by signal {code - 128}")
            code = INTERNAL_ERROR
        self.code = max(self.code, code, key=severity)
        return code


def must(*command, **options):
    """Runs a program; ends the command with its exit code if that is not 0."""
    if code := run(*command, **options):
        raise Ended(code)
