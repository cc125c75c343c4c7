"""Build trees: build/<preset>, configured and compiled with their output in a log."""

import os
import re
from pathlib import Path

from . import place, sundials
from .messages import INTERNAL_ERROR, Ended, Stopwatch, echo, say
from .packages import BUILD_LIST
from .processes import quietly

RELEASE = "release"
FIRST = "first"  # compiles sooner; its programs are slower
PROGRAMS = place.PROGRAMS
# The SIMD packs of batches. Without either option a tree keeps those that it has.
ALL_PACKS = "-DTRESS_PACKS=all"
SHORT_PACKS = "-DTRESS_PACKS=short"  # compile sooner
COMPLAINT = re.compile("FAILED:|error:|CMake Error")
AFTER, MOST = 8, 60  # lines shown of a log


def names_in(file):
    """Returns the lines of a list that the build writes."""
    return Path(file).read_text(encoding="utf-8").splitlines()


def _complaints(log):
    """Returns the lines of a log that begin with a complaint, and some after each."""
    shown, left = [], 0
    for line in Path(log).read_text(errors="replace").splitlines():
        left = AFTER + 1 if COMPLAINT.search(line) else left - 1
        if left > 0:
            shown.append(line)
    return shown[:MOST]


def working(preset, *command):
    """Runs a command of a build; ends with the complaints of its log if it fails."""
    log = f"build/{preset}/build.log"
    if quietly(log, *command) != 0:
        for line in _complaints(log):
            echo(line)
        raise Ended(INTERNAL_ERROR, f"the build failed; full log: {log}")


def configure(preset, *options):
    """Configures a tree. One that was copied or moved here is begun again."""
    tree = Path(f"build/{preset}")
    tree.mkdir(parents=True, exist_ok=True)
    cached = tree / "CMakeCache.txt"
    home = f"CMAKE_HOME_DIRECTORY:INTERNAL={os.getcwd()}"
    fresh = () if cached.exists() and home in names_in(cached) else ("--fresh",)
    say(f"building {tree} (log: {tree}/build.log)")
    (tree / "build.log").write_bytes(b"")
    working(preset, "cmake", "--preset", preset,
            f"-DTRESS_SUNDIALS_ROOT={sundials.root() or ''}", *options, *fresh)


def compile_targets(preset, *targets):
    """Compiles targets of a configured tree; all if none is named."""
    working(preset, "cmake", "--build", "--preset", preset,
            *(("--target", *targets) if targets else ()))


def build(preset, *targets, options=()):
    """Configures a tree and compiles targets. An installed tree has its programs."""
    if not place.INSTALLED:
        configure(preset, *options)
        compile_targets(preset, *targets)


def build_programs(machine, *names, options=()):
    """Builds programs of the experiments, all or those named, and prints how long that took."""
    if place.INSTALLED:
        return
    machine.ensure()
    watch = Stopwatch()
    build(RELEASE, *(names or ("experiments",)), options=options)
    watch.say("build")


def first_program(machine, name):
    """Builds a program where that takes the least time: in build/release if it is there, else
    in build/first, with the packages of builds alone. Returns its path."""
    if os.path.exists(f"{PROGRAMS}/{name}"):
        build_programs(machine, name)
        return f"{PROGRAMS}/{name}"
    machine.ensure(base=(BUILD_LIST,))
    watch = Stopwatch()
    say(f"a first build, which is quick to compile; ./tress build {name} makes the fast program")
    build(FIRST, name)
    watch.say("build")
    return f"build/{FIRST}/experiments/{name}"
