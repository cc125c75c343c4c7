"""./tress simulate."""

import contextlib
import os
import shutil
import subprocess

from .command import Command
from .counting import must
from .messages import BAD_INPUT, DONE, ROWS_FAILED, Ended, Stopwatch, refuse, say
from .processes import run
from .scene_folder import existing, scene_folder
from .scripts import REPORT
from .tree import PROGRAMS, first_program

PROGRAM = f"{PROGRAMS}/simulate"
DEFAULTS = ["--print-defaults"]


@contextlib.contextmanager
def _in_place_of(folder):
    """Moves the folder of an earlier run aside. It comes back if the new run refuses its input."""
    earlier = f"{folder}.earlier"
    shutil.rmtree(earlier, ignore_errors=True)
    with contextlib.suppress(FileNotFoundError):
        os.rename(folder, earlier)
    try:
        yield
    except Ended as end:
        if end.code == BAD_INPUT and os.path.isdir(earlier):
            shutil.rmtree(folder, ignore_errors=True)
            os.rename(earlier, folder)
        raise
    finally:
        shutil.rmtree(earlier, ignore_errors=True)


def _run(words, machine):
    if words == DEFAULTS:
        return run(first_program(machine, "simulate"), *words)
    folder = scene_folder("simulate", words)
    scene, *options = (existing(words[0]), *words[1:])
    if options and not options[0].startswith("-"):
        refuse(f"simulate: '{options[0]}' after the scene file; give one scene, then options")
    if any(word.partition("=")[0] == "--out" for word in options):
        refuse(f"simulate: --out is {folder} here; {PROGRAM} takes another")
    program = first_program(machine, "simulate")
    if "--check" in options:  # writes nothing
        return run(program, scene, *options)
    watch = Stopwatch()
    with contextlib.nullcontext() if "--resume" in options else _in_place_of(folder):
        code = run(program, scene, "--out", f"{folder}/scenes", *options)
        if code not in (DONE, ROWS_FAILED):  # a run that fails has a page all the same
            raise Ended(code)
    watch.say("simulation")
    watch = Stopwatch()
    must(*REPORT, folder, stdout=subprocess.DEVNULL)
    watch.say("page")
    say(f"open in a browser: file://{os.getcwd()}/{folder}/report.html#tab-scenes")
    return code


COMMAND = Command(
    "simulate", "SCENE.toml [OPTIONS]\n--print-defaults",
    "simulates one scene and writes its time series and a page with its motion. They are in "
    "results/simulate/<scene>-<checksum of its path>/. Builds the program first: in a new clone "
    "a version in build/first, which compiles sooner and runs slower.",
    _run,
    example="./tress simulate scenes/cantilever.toml --error-bars",
    time="seconds for most shipped scenes; a first build takes about a quarter of an hour of "
         "processor time.",
    options=(("--resume", "continues an interrupted run from its last saved state"),
             ("--print-defaults", "prints a complete scene of one hair instead"),
             ("--help", "this text; OPTIONS are those of the program, without --out")),
    program=(PROGRAM,))
