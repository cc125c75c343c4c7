"""./tress build."""

from .command import Command, read_words
from .tree import build_programs


def _run(words, machine):
    build_programs(machine, *read_words("build", words, names=True).names)


COMMAND = Command(
    "build", "[PROGRAM...]",
    "compiles the programs of the experiments, all or those named, into "
    "build/release/experiments. Prints the packages that it installs first.",
    _run,
    example="./tress build simulate cost_of_accuracy",
    time="about 45 processor minutes for all programs in a new clone; seconds if nothing has "
         "changed.")
