"""./tress ask: what the experiments that take a scene say about one."""

import contextlib
import os
import subprocess

from .command import Command
from .counting import Worst, must
from .messages import BAD_INPUT, Stopwatch, say
from .scene_folder import existing, scene_folder
from .scripts import ANSWERS
from .tree import PROGRAMS, build_programs

ASKED = ("stability_limit", "hard_cases", "effect_audit", "cost_of_accuracy")


def _run(words, machine):
    folder = scene_folder("ask", words)
    scene, *options = (existing(words[0]), *words[1:])
    build_programs(machine, *ASKED)
    os.makedirs(folder, exist_ok=True)
    worst = Worst()
    for program in ASKED:
        watch = Stopwatch()
        flags = ["--scene"]
        if program == "cost_of_accuracy":  # its references, too, are this scene's alone
            flags = ["--set", f"references={folder}/reference", "--advise"]
        say(" ".join([program, *flags, scene]))
        code = worst.run(program, f"{PROGRAMS}/{program}", *flags, scene, "--quick",
                         "--out", f"{folder}/{program}.csv", *options)
        if code == BAD_INPUT:  # the program has printed why
            with contextlib.suppress(OSError):
                os.rmdir(folder)
            return BAD_INPUT
        watch.say(program)
    must(*ANSWERS, folder, stdout=subprocess.DEVNULL)
    say(f"the answers: {os.getcwd()}/{folder}/answers.html; tables and the advised scene are "
        "next to it")
    return worst.code


COMMAND = Command(
    "ask", "SCENE.toml [OPTIONS]",
    "answers the questions about one scene: largest stable step of each method, "
    "models that survive, effects that matter, cheapest configuration. Writes answers.html and tables to "
    "results/ask/<scene>-<checksum of its path>/.",
    _run,
    example="./tress ask my.toml --timeout 30s",
    time="minutes; the time of each program is printed.",
    options=(("OPTIONS", "options that stability_limit, hard_cases, effect_audit and "
              "cost_of_accuracy have in common, as their --help lists them: --plugin, "
              "--jobs, --timeout, --progress"),))
