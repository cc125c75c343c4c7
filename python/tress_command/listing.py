"""./tress list."""

from .command import Command, no_words
from .counting import must
from .tree import PROGRAMS, RELEASE, build, names_in


def _run(words, machine):
    no_words("list", words)
    machine.ensure()
    build(RELEASE, "experiments")
    names = names_in(f"{PROGRAMS}/list.txt")
    print(f"experiments: {' '.join(names)}")
    if names:
        must(f"{PROGRAMS}/{names[0]}", "--list")


COMMAND = Command(
    "list", "",
    "prints experiments, models, integrators and what can drive what. Builds the programs first.",
    _run,
    example="./tress list",
    time="seconds once the programs are built.")
