"""Entry of the command: finds the clone, then the command that the first word names."""

import os
import signal
import sys

from . import place
from .command import command_help, wants_help
from .commands import COMMANDS, everything, overview
from .messages import exit_code, refuse
from .packages import Machine
from .processes import run
from .rename import present_name
from .tree import PROGRAMS, names_in
from .version import describe

HELP = ("help", "-h", "--help")
VERSION = ("version", "--version")
# Commands of an installed tree. The others build, test or write the sources.
WITHOUT_SOURCES = ("simulate", "play", "run", "ask", "matrices", "cluster", "compare", "report",
                   "film", "rename", "list")


def _help_on(words):
    """Prints the commands, those named, or all of them with their options."""
    if words == ["all"]:
        print(place.words(everything()))
        return
    for word in words:
        print(place.words(command_help(_command(word))))
    if not words:
        print(place.words(overview()))


def _command(word):
    for command in COMMANDS:
        if command.name == word:
            return command
    if now := present_name(word):
        refuse(f"'{word}' is called '{now}' now: ./tress {now}")
    return refuse(f"unknown command '{word}'; ./tress help shows the commands")


def _installed_program(words):
    """Returns the command line of a program of an installed tree that the first word names."""
    there = place.INSTALLED and words[0] in names_in(f"{PROGRAMS}/list.txt")
    return [f"{PROGRAMS}/{words[0]}", *words[1:]] if there and words[0] not in WITHOUT_SOURCES else []


def _dispatch(words):
    if words[:1] and words[0] in VERSION:
        print(describe())
        return 0
    if not place.INSTALLED:
        os.chdir(place.clone() or refuse("there is no clone of tress here; work in a clone"))
    may_install = words[:1] != ["--no-install"]
    if not may_install:
        words = words[1:]
        if not words:
            refuse("--no-install: give a command, as in ./tress --no-install build")
    if not words or words[0] in HELP:
        return _help_on(words[1:])
    if program := _installed_program(words):
        return run(*program)
    command = _command(words[0])
    if wants_help(words[1:]):
        print(place.words(command_help(command)))
        return 0
    if place.INSTALLED and command.name not in WITHOUT_SOURCES:
        refuse(f"{command.name}: needs the sources of tress; work in a clone")
    return command.run(words[1:], Machine(may_install))


def main():
    """Runs the command of the process. Returns its exit code."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # a reader that ends early, as head
    return exit_code(_dispatch, sys.argv[1:])
