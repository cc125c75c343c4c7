"""./tress statics."""

import os

from .command import Command
from .counting import must
from .messages import refuse
from .tree import PROGRAMS, RELEASE, build

PROGRAM = f"{PROGRAMS}/statics"


def _run(words, machine):
    if not words or words[0].startswith("-"):
        refuse("statics: give a scene file, as in ./tress statics scenes/cantilever.toml "
               "--over gravity=0..2")
    machine.ensure()
    build(RELEASE, "statics")
    os.makedirs("results", exist_ok=True)
    must(PROGRAM, "--scene", *words)


COMMAND = Command(
    "statics", "SCENE.toml [--over KEY=FROM..TO] [OPTIONS]",
    "finds the equilibria of a strand along one parameter, with limit points, bifurcations and "
    "stability. The table is results/statics.<scene>.csv, pictures are in "
    "results/statics.<scene>/.",
    _run,
    example="./tress statics scenes/cantilever.toml --over gravity=0..2",
    time="seconds after the first build.",
    options=(("--over KEY=FROM..TO", "parameter and its range: gravity, point_force, supports, or a "
              "number of the scene"),
             ("--strand I", "number of the strand of the scene, from 1"),
             ("--branch K", "takes the other branch at the K-th bifurcation")),
    program=(PROGRAM,))
