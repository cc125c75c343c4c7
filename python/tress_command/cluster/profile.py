"""Settings of a user's cluster: a file of lines `key = value`, # begins a comment."""

import re
from pathlib import Path

from ..files import read_text
from ..messages import refuse

KEYS = {
    "partition": "text",  # of Slurm
    "account": "text",
    "qos": "text",
    "options": "text",  # further options of sbatch, as in --constraint=avx512 --exclude=n7
    "setup": "text",  # a line of shell before each part, as in module load gcc/12
    "minutes": "number",  # of a part, instead of the estimate
    "memory_mb": "number",  # of a part, instead of the estimate
    "most_tasks": "number",  # parts of a sweep, at most
}
WANTED = {"text": "a text in quotes", "number": "a whole number above 0"}
DEFAULTS = {"most_tasks": 1000}
LIMIT = 2**16  # bytes
LINE = re.compile(r'(\w+)\s*=\s*("[^"]*"|\S+)\s*(?:#.*)?', re.ASCII)


def _value(text, kind, place):
    if kind == "text" and re.fullmatch(r'"[^"\\]*"', text):
        return text[1:-1]
    if kind == "number" and re.fullmatch(r"[1-9][0-9]*", text):
        return int(text)
    return refuse(f"{place}: {text} is not {WANTED[kind]}; write it so")


def read_profile(file):
    """Returns the settings of a file; the defaults if file is None."""
    given = {}
    for number, line in enumerate(read_text(Path(file), LIMIT).split("\n") if file else (), 1):
        place, line = f"{file}:{number}", line.strip()
        if line == "" or line.startswith("#"):
            continue
        found = LINE.fullmatch(line)
        if not found:
            refuse(f"{place}: not 'key = value'; as in partition = \"short\"")
        key, value = found.groups()
        if key not in KEYS:
            refuse(f"{place}: no key '{key}'; there are {', '.join(KEYS)}")
        if key in given:
            refuse(f"{place}: '{key}' is set twice; set it once")
        given[key] = _value(value, KEYS[key], place)
    return DEFAULTS | given
