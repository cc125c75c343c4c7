"""Entry of the command: finds the clone, then the command that the first word names."""

import os
import signal
import sys
from pathlib import Path

from .command import command_help, wants_help
from .commands import COMMANDS, everything, overview
from .messages import exit_code, refuse
from .packages import Machine
from .rename import present_name

HELP = ("help", "-h", "--help")


def repository():
    """Returns the clone that this package belongs to, else the clone that holds the working
    folder: an installed package is outside."""
    own = Path(os.path.abspath(__file__)).parents[2]
    for folder in (own, Path.cwd(), *Path.cwd().parents):
        if (folder / "tress").is_file() and (folder / "cmake").is_dir():
            return folder
    return refuse("there is no clone of tress here; work in a clone")


def _help_on(words):
    """Prints the commands, those named, or all of them with their options."""
    if words == ["all"]:
        print(everything())
        return
    for word in words:
        print(command_help(_command(word)))
    if not words:
        print(overview())


def _command(word):
    for command in COMMANDS:
        if command.name == word:
            return command
    if now := present_name(word):
        refuse(f"'{word}' is called '{now}' now: ./tress {now}")
    return refuse(f"unknown command '{word}'; ./tress help shows the commands")


def _dispatch(words):
    os.chdir(repository())
    may_install = words[:1] != ["--no-install"]
    if not may_install:
        words = words[1:]
        if not words:
            refuse("--no-install: give a command, as in ./tress --no-install build")
    if not words or words[0] in HELP:
        return _help_on(words[1:])
    command = _command(words[0])
    if wants_help(words[1:]):
        print(command_help(command))
        return 0
    return command.run(words[1:], Machine(may_install))


def main():
    """Runs the command of the process. Returns its exit code."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # a reader that ends early, as head
    return exit_code(_dispatch, sys.argv[1:])
