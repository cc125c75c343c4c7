"""What a command is, its help, and how its words are read."""

import os
import shutil
import subprocess
import textwrap
from typing import Callable, NamedTuple

from .messages import refuse

WIDTH = 96


class Command(NamedTuple):
    """A command of ./tress. run(words, machine) returns an exit code or None for 0."""

    name: str
    usage: str  # the words after the name; a line for each way to use it
    text: str  # the first sentence stands in the list of all commands
    run: Callable
    example: str
    time: str
    options: tuple = ()  # (option, description)
    program: tuple = ()  # whose options are options of the command too


def usage_of(command):
    """Returns a line for each way to use a command."""
    return [f"./tress {command.name} {words}".rstrip() for words in command.usage.split("\n")]


def paragraph(text, indent=""):
    """Returns a text in lines of at most WIDTH characters."""
    return textwrap.fill(text, WIDTH, initial_indent=indent, subsequent_indent=indent,
                         break_long_words=False, break_on_hyphens=False)


def entries(rows):
    """Returns names with their descriptions beside them, or below where a name is long."""
    column = 4 + max((len(name) for name, _ in rows if len(name) <= 24), default=0)
    lines = []
    for name, text in rows:
        block = paragraph(text, " " * column).lstrip()
        gap = column - 2 - len(name)
        lines.append(f"  {name}{' ' * gap if gap > 1 else chr(10) + ' ' * column}{block}")
    return "\n".join(lines)


def _help_of_program(program):
    """Returns what a program itself prints for --help, or how to get it."""
    if not all(shutil.which(word) or os.path.exists(word) for word in program):
        return f"More options: those of {' '.join(program)} --help, once it is built."
    done = subprocess.run([*program, "--help"], stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, check=False)
    return f"More options, of {program[-1]}:\n\n{done.stdout.rstrip()}"


def command_help(command):
    """Returns usage, description, options, an example and an estimate of the time."""
    usage = "\n       ".join(usage_of(command))
    parts = [f"usage: {usage}", paragraph(command.text)]
    if command.options:
        parts.append(f"Options:\n{entries(command.options)}")
    parts += [f"Example:\n  {command.example}", paragraph(f"Time: {command.time}")]
    if command.program:
        parts.append(_help_of_program(command.program))
    return "\n\n".join(parts)


def wants_help(words):
    """True if the words before -- ask for help."""
    own = words[:words.index("--")] if "--" in words else words
    return "--help" in own or "-h" in own


class Words(NamedTuple):
    """Words of a command: options with their values (True for flags), names, and what stands
    after --."""

    options: dict
    names: list
    more: list


def read_words(command, words, *, flags=(), valued=(), names=False, hint=""):
    """Reads the words of a command. Refuses what it does not know; the hint ends the line."""
    options, found, words = {}, [], list(words)
    while words:
        word = words.pop(0)
        if word == "--":
            return Words(options, found, words)
        if word in flags:
            options[word] = True
        elif word in valued:
            if not words:
                refuse(f"{command}: {word} without a value; give one")
            options[word] = words.pop(0)
        elif names and not word.startswith("-"):
            found.append(word)
        else:
            refuse(f"{command}: unknown option '{word}'{hint}")
    return Words(options, found, [])


def no_words(command, words):
    """Refuses words after a command that takes none."""
    if words:
        refuse(f"{command}: unknown option '{words[0]}'; it takes none")
