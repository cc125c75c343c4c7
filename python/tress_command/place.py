"""Where this command stands: in a clone, in an installed tree, or in a package of Python."""

import importlib.metadata
import json
import os
from pathlib import Path

_OWN = Path(os.path.abspath(__file__)).parents[2]
_MARK = _OWN / "installed.json"  # written by cmake --install
INSTALLED = _MARK.is_file()
_FACTS = json.loads(_MARK.read_text(encoding="utf-8")) if INSTALLED else {}
NAME = "tress" if INSTALLED else "./tress"
PROGRAMS = os.path.normpath(_OWN / _FACTS["programs"]) if INSTALLED else "build/release/experiments"


def shipped(path):
    """Returns a file that tress ships: below the working folder, which is the clone, or in the
    installed tree."""
    return str(_OWN / path) if INSTALLED else path


def words(text):
    """Returns a text with the name that the command has here."""
    return text.replace("./tress", NAME) if INSTALLED else text


def _is_clone(folder):
    return (folder / "tress").is_file() and (folder / "cmake").is_dir()


def clone():
    """Returns the clone that this package belongs to, else the clone that holds the working
    folder; None: there is none."""
    for folder in (_OWN, Path.cwd(), *Path.cwd().parents):
        if _is_clone(folder):
            return folder
    return None


def version():
    """Returns the version of tress and the clone from which the command runs, or None."""
    if INSTALLED:
        return _FACTS["version"], None
    if _is_clone(_OWN):
        return (_OWN / "VERSION").read_text(encoding="utf-8").strip(), _OWN
    return importlib.metadata.version("tress"), None
