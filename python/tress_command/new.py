"""./tress new."""

from .command import Command
from .processes import run
from .scripts import NEW


def _run(words, _):
    return run(*NEW, *words)


COMMAND = Command(
    "new", "model|effect|integrator|study NAME",
    "writes one source from a skeleton and its lines in catalogue and CMakeLists.txt. Prints how "
    "to build and test it; docs/extending.md describes what to fill in.",
    _run,
    example="./tress new model my_rod",
    time="less than a second.")
