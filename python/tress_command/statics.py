"""./tress statics."""

from .command import Command
from .scene_program import runs
from .tree import PROGRAMS

PROGRAM = f"{PROGRAMS}/statics"
EXAMPLE = "./tress statics scenes/cantilever.toml --over gravity=0..2"

COMMAND = Command(
    "statics", "SCENE.toml [--over KEY=FROM..TO] [OPTIONS]",
    "finds the equilibria of a strand along one parameter, with limit points, bifurcations and "
    "stability. The table is results/statics.<scene>.csv, pictures are in "
    "results/statics.<scene>/.",
    runs("statics", EXAMPLE),
    example=EXAMPLE,
    time="seconds after the first build.",
    options=(("--over KEY=FROM..TO", "parameter and its range: gravity, point_force, supports, or a "
              "number of the scene"),
             ("--strand I", "number of the strand of the scene, from 1"),
             ("--branch K", "takes the other branch at the K-th bifurcation")),
    program=(PROGRAM,))
