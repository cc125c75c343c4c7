"""./tress other_simulators: other simulators on one strand."""

import os

from .command import Command
from .counting import must
from .messages import say
from .packages import npm_packages
from .tree import build


def _run(words, machine):
    machine.ensure("cmake/other_simulators_packages.txt")
    # Without a network the engines that are npm packages are left out, and named.
    if not npm_packages("experiments/other_simulators"):
        say("npm's engines are left out")
    build("other_simulators", "other_simulators")
    os.makedirs("results", exist_ok=True)
    must("build/other_simulators/experiments/other_simulators/other_simulators", *words)
    if not words:  # what sticks has no options
        must("build/other_simulators/experiments/other_simulators/rubbing")


COMMAND = Command(
    "other_simulators", "[ARGUMENTS]",
    "runs Simbody, Bullet, MuJoCo, ODE and npm's MuJoCo 3 and Jolt on one strand and writes "
    "results/other_simulators.csv. Without arguments it also measures friction in them, "
    "results/other_simulators_rubbing.csv. Installs cmake/other_simulators_packages.txt.",
    _run,
    example="./tress other_simulators --elements 5,20",
    time="about five minutes after the build.",
    program=("build/other_simulators/experiments/other_simulators/other_simulators",))
