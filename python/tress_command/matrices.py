"""./tress matrices."""

from .command import Command
from .scene_program import runs
from .tree import PROGRAMS

PROGRAM = f"{PROGRAMS}/matrices"
EXAMPLE = "./tress matrices scenes/cantilever.toml --time 0.5"

COMMAND = Command(
    "matrices", "SCENE.toml [--time S] [--strand I] [OPTIONS]",
    "writes mass, damping, stiffness, constraints and step matrix of a scene at an instant. "
    "They are MatrixMarket files in results/matrices.<scene>/, with a JSON that describes them.",
    runs("matrices", EXAMPLE),
    example=EXAMPLE,
    time="seconds after the first build.",
    options=(("--time S", "instant of the motion (s)"),
             ("--strand I", "number of the strand of the scene, from 1")),
    program=(PROGRAM,))
