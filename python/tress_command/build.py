"""./tress build."""

from .command import Command, read_words
from .tree import ALL_PACKS, build_programs


def _run(words, machine):
    names = read_words("build", words, names=True).names
    build_programs(machine, *names, options=(ALL_PACKS,))


COMMAND = Command(
    "build", "[PROGRAM...]",
    "compiles the programs of the experiments, all or those named, into "
    "build/release/experiments. Prints the packages that it installs first.",
    _run,
    example="./tress build simulate cost_of_accuracy",
    time="about 45 processor minutes for all programs in a new clone; seconds if nothing has "
         "changed.")
