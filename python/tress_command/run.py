"""./tress run: experiments, their tables and the pages made of them."""

import os
from pathlib import Path

from .command import Command, read_words
from .counting import Worst
from .messages import BAD_INPUT, DONE, ROWS_FAILED, Ended, echo, refuse, say
from .processes import run
from .rename import present_name
from .report import make_report, write_pages
from .tree import ALL_PACKS, PROGRAMS, RELEASE, build, names_in


class Plan:
    """Experiments to run, with their options."""

    def __init__(self, words):
        read = read_words("run", words, flags=("--full", "--resume"), names=True,
                          hint=" (options of the experiments go after --)")
        self.full = "--full" in read.options
        self.more = read.more
        self.flags = ["--full" if self.full else "--quick",
                      *(["--resume"] if "--resume" in read.options else []), *read.more]
        self.names = read.names

    def complete(self):
        """Refuses experiments that cannot run here; takes all that can if none is named."""
        able = names_in(f"{PROGRAMS}/list.txt")
        unable = dict(line.split(": ", 1) for line in names_in(f"{PROGRAMS}/left_out.txt"))
        self.names = self.names or able
        for name in self.names:
            if name in unable:
                echo(f"{name}: {unable[name]}")
                refuse(f"run: {name} cannot run here, for the reason above")
            if name not in able:
                if now := present_name(name):
                    refuse(f"run: '{name}' is called '{now}' now")
                refuse(f"run: no experiment '{name}'; there are: {' '.join(able)}")

    def going_on(self, names):
        """Returns the command that does what is left of a run."""
        full = ["--full"] if self.full else []
        more = ["--", *self.more] if self.more else []
        return " ".join(["./tress run --resume", *full, *names, *more])

    def check(self):
        """Whatever can refuse, an unfinished run or an output that cannot be written, does so
        before anything runs."""
        codes = [run(f"{PROGRAMS}/{name}", *self.flags, "--check") for name in self.names]
        if any(codes):
            raise Ended(BAD_INPUT, "nothing was run, for the reasons above; an earlier run that "
                        f"did not finish is continued by: {self.going_on(self.names)}")


def _run(words, machine):
    plan = Plan(words)
    machine.ensure()
    build(RELEASE, "experiments", options=(ALL_PACKS,))
    plan.complete()
    os.makedirs("results", exist_ok=True)
    plan.check()
    worst, left, failed = Worst(), list(plan.names), []
    for name in plan.names:
        say(" ".join([name, *plan.flags]))
        code = worst.run(name, f"{PROGRAMS}/{name}", *plan.flags, after_interrupt=(
            f"; not finished: {' '.join(left)}; to go on: {plan.going_on(plan.names)}"))
        if code in (DONE, ROWS_FAILED):
            left.remove(name)
        else:
            failed.append(f"{name} (exit code {code})")
    make_report()
    if write_pages() != 0:
        say("README.md and docs/ were left as they are (the reason stands above)")
    _tell_the_rest(plan, left, failed)
    if worst.code:
        say(f"some experiments did not pass; worst exit code {worst.code}")
    return worst.code


def _tell_the_rest(plan, left, failed):
    for line in names_in(Path(PROGRAMS) / "left_out.txt"):
        say(f"left out, its table stays as it is: {line}")
    say("not part of this: ./tress other_simulators, ./tress bench")
    for text in failed:
        say(f"NOT DONE, its table is that of an earlier run: {text}")
    if failed:
        say(f"to go on: {plan.going_on(left)}")


COMMAND = Command(
    "run", "[--full] [--resume] [EXPERIMENT...] [-- ARGUMENTS]",
    "runs experiments, those named or all that can run here, and writes results/*.csv and "
    "results/report.html. Builds them, and checks outputs and unfinished runs first. Prints at "
    "the end the experiments that are not done.",
    _run,
    example="./tress run --resume stability_limit damping -- --jobs 1",
    time="about half an hour on two cores for all experiments; hours for some with --full.",
    options=(("--full", "most rows of each experiment (default: fewest rows, --quick)"),
             ("--resume", "keeps the rows that an earlier run finished"),
             ("-- ARGUMENTS", "options of the experiments, as build/release/experiments/NAME "
              "--help lists them")))
