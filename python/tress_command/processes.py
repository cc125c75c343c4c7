"""Programs that commands start. A signal that ends the command ends the program first."""

import contextlib
import os
import signal
import subprocess
import sys
from typing import NamedTuple

STOPS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
# A terminal shows the last line of a log this often (s).
REFRESH_S = 0.5


class Finished(NamedTuple):
    """What a program left: its exit code, as a shell counts it, and what it printed."""

    code: int
    stdout: str
    stderr: str


@contextlib.contextmanager
def started(command, **options):
    """Starts a program. While it runs, signals that end programs are passed on to it; after
    it has ended, they are raised as KeyboardInterrupt."""
    stopped = []

    def pass_on(number, _):
        stopped.append(number)
        process.send_signal(number)

    sys.stdout.flush()
    with subprocess.Popen([str(word) for word in command], **options) as process:
        heard = [stop for stop in STOPS if signal.getsignal(stop) != signal.SIG_IGN]
        before = {stop: signal.signal(stop, pass_on) for stop in heard}
        try:
            yield process
            process.wait()
        finally:
            for stop, handler in before.items():
                signal.signal(stop, handler)
    if stopped:
        raise KeyboardInterrupt


def _shell_code(process):
    return process.returncode if process.returncode >= 0 else 128 - process.returncode


def run(*command, **options):
    """Runs a program with the command's own input and output. Returns its exit code, 128 and
    the signal's number if a signal ended it."""
    with started(command, **options) as process:
        pass
    return _shell_code(process)


def read(*command, **options):
    """Runs a program and returns what it printed; its input is empty."""
    with started(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                 stderr=subprocess.PIPE, text=True, errors="replace", **options) as process:
        stdout, stderr = process.communicate()
    return Finished(_shell_code(process), stdout, stderr)


def last_line(text):
    """Returns the last line that is not blank, "" if there is none."""
    return text.strip().rpartition("\n")[2]


def _show_end(log):
    with open(log, "rb") as file:
        file.seek(max(0, os.path.getsize(log) - 4096))
        line = last_line(file.read().decode(errors="replace"))
    width = os.get_terminal_size(sys.stderr.fileno()).columns
    sys.stderr.write(f"\r\x1b[K  {line[:max(0, width - 4)]}")
    sys.stderr.flush()


def quietly(log, *command, **options):
    """Runs a program whose output goes to the end of a log. A terminal shows the last line.
    Returns the exit code."""
    with open(log, "ab") as out, started(command, stdin=subprocess.DEVNULL, stdout=out,
                                         stderr=subprocess.STDOUT, **options) as process:
        if sys.stderr.isatty():
            while process.poll() is None:
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(REFRESH_S)
                _show_end(log)
            sys.stderr.write("\r\x1b[K")
    return _shell_code(process)
