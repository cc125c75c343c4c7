"""Lines that commands print for their user, and how commands end."""

import sys
import time

from . import place

DONE, INTERNAL_ERROR, BAD_INPUT, ROWS_FAILED, INTERRUPTED = 0, 1, 2, 3, 130


class Ended(Exception):
    """Ends a command with an exit code, after a line on stderr if there is a text."""

    def __init__(self, code, text=""):
        super().__init__(text)
        self.code = code


def say(text):
    """Prints one line on stderr; what would break the line or the terminal becomes "?"."""
    line = "".join(c if c.isprintable() else "?" for c in place.words(text))
    print(f"tress: {line}", file=sys.stderr, flush=True)


def echo(line):
    """Prints a line of a program's log on stderr, as it is."""
    print(line, file=sys.stderr, flush=True)


class Stopwatch:
    """Prints how long a part took."""

    def __init__(self):
        self.began = time.monotonic()

    def say(self, what):
        say(f"{what}: {int(time.monotonic() - self.began)} s")


def refuse(text):
    """Ends the command because of what its user gave it."""
    raise Ended(BAD_INPUT, text)


def exit_code(run, words):
    """Runs a command to its exit code. Every refusal is one line."""
    try:
        return run(words) or DONE
    except Ended as end:
        if str(end):
            say(str(end))
        return end.code
    except KeyboardInterrupt:
        say("interrupted")
        return INTERRUPTED
    except OSError as error:
        say(f"{error.filename or 'system'}: {error.strerror or error}")
        return BAD_INPUT
