"""./tress check: what a plug-in brings, through the contract suites."""

import os

from .command import Command
from .counting import Worst
from .messages import BAD_INPUT, refuse, say
from .tree import RELEASE, compile_targets, configure, names_in


def _run(words, machine):
    if not words:
        refuse("check: give a plug-in, as in ./tress check libmine.so")
    for library in words:
        if not os.path.isfile(library):
            refuse(f"check: no file '{library}'; paths are relative to {os.getcwd()}")
    machine.ensure()
    configure(RELEASE)
    programs = names_in("build/release/tests/checks.txt")
    compile_targets(RELEASE, *programs)
    worst = Worst()
    for name in programs:
        code = worst.run(name, f"build/release/tests/{name}",
                         *(f"--plugin={library}" for library in words))
        if code == BAD_INPUT:
            return code
    say("a contract does not hold" if worst.code else "every contract holds")
    return worst.code


COMMAND = Command(
    "check", "LIBRARY...",
    "runs the contract suites on the models, effects and integrators of plug-ins: Jacobians against "
    "differences, purity, no allocation, orders, energies. docs/plugins.md describes plug-ins.",
    _run,
    example="./tress check build/plugin/libexample.so",
    time="minutes to compile the suites the first time, then about a minute.")
