"""./tress matrices."""

import os

from .command import Command
from .counting import must
from .messages import refuse
from .tree import PROGRAMS, RELEASE, build

PROGRAM = f"{PROGRAMS}/matrices"


def _run(words, machine):
    if not words or words[0].startswith("-"):
        refuse("matrices: give a scene file, as in ./tress matrices scenes/cantilever.toml "
               "--time 0.5")
    machine.ensure()
    build(RELEASE, "matrices")
    os.makedirs("results", exist_ok=True)
    must(PROGRAM, "--scene", *words)


COMMAND = Command(
    "matrices", "SCENE.toml [--time S] [--strand I] [OPTIONS]",
    "writes mass, damping, stiffness, constraints and step matrix of a scene at an instant. "
    "They are MatrixMarket files in results/matrices.<scene>/, with a JSON that describes them.",
    _run,
    example="./tress matrices scenes/cantilever.toml --time 0.5",
    time="seconds after the first build.",
    options=(("--time S", "instant of the motion (s)"),
             ("--strand I", "number of the strand of the scene, from 1")),
    program=(PROGRAM,))
