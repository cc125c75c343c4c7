"""Commands that run one program on one scene."""

import os

from .counting import must
from .messages import refuse
from .tree import PROGRAMS, RELEASE, build


def runs(name, example):
    """Returns the action of a command: builds a program and runs it on the scene of the first word."""
    def _run(words, machine):
        if not words or words[0].startswith("-"):
            refuse(f"{name}: give a scene file, as in {example}")
        machine.ensure()
        build(RELEASE, name)
        os.makedirs("results", exist_ok=True)
        must(f"{PROGRAMS}/{name}", "--scene", *words)
    return _run
