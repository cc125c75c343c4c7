"""./tress lint."""

from .command import Command, no_words
from .counting import must
from .tree import configure

SCRIPT = "cmake/lint.sh"


def _run(words, machine):
    no_words("lint", words)
    machine.ensure()
    configure("lint")
    must(SCRIPT, "format")
    must(SCRIPT, "shellcheck")
    must(SCRIPT, "tidy", "build/lint")


COMMAND = Command(
    "lint", "",
    "runs clang-format, shellcheck and clang-tidy over the sources. cmake/lint.sh fix formats "
    "them.",
    _run,
    example="./tress lint",
    time="tens of minutes: clang-tidy reads every source.")
