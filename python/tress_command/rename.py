"""./tress rename, and the present names of former commands and experiments."""

import re
from pathlib import Path

from .command import Command
from .processes import run
from .scripts import RENAME


def present_name(word):
    """Returns the present name of what was called `word`, or ''."""
    names = Path("contract/renamed.h")
    text = names.read_text(encoding="utf-8") if names.is_file() else ""
    found = re.search(rf'^ +\{{"{re.escape(word)}", "(\w+)"\}},', text, re.MULTILINE)
    return found[1] if found else ""


def _run(words, _):
    return run(*RENAME, *words)


COMMAND = Command(
    "rename", "FILE...",
    "converts scenes, tables and manifests with names of earlier versions to the present ones, "
    "which contract/renamed.h lists.",
    _run,
    example="./tress rename my_scene.toml",
    time="less than a second.")
