"""./tress --version."""

import os
from pathlib import Path

from . import place
from .processes import read


def commit_of(root):
    """Returns the commit of a clone, or of the archive that the sources came from."""
    done = read("git", "-C", root, "rev-parse", "HEAD")
    if done.code == 0 and (Path(root) / ".git").exists():
        changed = read("git", "-C", root, "status", "--porcelain", "-uno").stdout
        return done.stdout.strip() + (" with changes" if changed else "")
    archived = Path(root) / "cmake/commit.txt"
    text = archived.read_text(encoding="utf-8").strip() if archived.is_file() else "$"
    return "unknown" if text.startswith("$") else text


def describe():
    """Returns version and commit, then commit, build and instructions of the programs."""
    version, root = place.version()
    program = os.path.join(root or "", place.PROGRAMS, "simulate")
    lines = [f"tress {version}" + (f" ({commit_of(root)})" if root else "")]
    done = read(program, "--version") if os.access(program, os.X_OK) else None
    if done is None:
        lines.append("programs: none built here")
    elif done.code != 0:
        lines.append("programs: older than this command; build them again")
    else:
        lines.append("programs: " + done.stdout.strip().replace("\n", "\n  "))
    return "\n".join(lines)
