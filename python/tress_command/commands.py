"""All commands, in the order of the help."""

from . import (ask, bench, build, check, docs, lint, listing, matrices, new, other_simulators,
               package, packages, python_module, rename, report, run, simulate, statics, sweeps,
               testing)
from .command import command_help, paragraph, usage_of
from .play.command import COMMAND as PLAY
from .reproduce.archive import ARCHIVE
from .reproduce.command import REPRODUCE
from .reproduce.rerun import RERUN

COMMANDS = (build.COMMAND, simulate.COMMAND, PLAY, run.COMMAND, ask.COMMAND, check.COMMAND,
            statics.COMMAND, matrices.COMMAND, testing.COMMAND, sweeps.CLUSTER, bench.COMMAND,
            other_simulators.COMMAND, sweeps.COMPARE, REPRODUCE, RERUN, ARCHIVE,
            python_module.COMMAND, package.COMMAND, report.COMMAND, docs.COMMAND, report.FILM,
            new.COMMAND, rename.COMMAND, listing.COMMAND, lint.COMMAND, packages.COMMAND)
HEAD = "tress: testbed for rod and elastic-strand solvers"
FOOT = (
    "./tress COMMAND --help prints the options of a command, with an example and its time. "
    "'./tress help all' prints the options of all commands.",
    "./tress --no-install COMMAND ... installs nothing: if packages are missing, it prints them "
    "and ends with exit code 2.",
    "Paths are relative to the repository. Arguments after -- go to each experiment, ctest, "
    "unittest or benchmark.",
    "Exit codes: 0 done, 1 internal error, 2 usage or input error, 3 some rows or checks failed "
    "(tables are complete), 130 interrupted (--resume continues).",
)


def _first_sentence(text):
    return text.partition(". ")[0].rstrip(".")


def overview():
    """Returns the list of all commands."""
    lines = [line for command in COMMANDS for line in (
        *(f"  {usage}" for usage in usage_of(command)),
        paragraph(_first_sentence(command.text), " " * 6))]
    return "\n\n".join([HEAD, "\n".join(lines), *map(paragraph, FOOT)])


def everything():
    """Returns the list and the help of every command, for a page: without options of programs."""
    own = (command_help(command._replace(program=())) for command in COMMANDS)
    rule = f"\n\n{'-' * 72}\n\n"
    return rule.join([overview(), *own])
