"""What is compared: a folder of results, a build, or a commit, which is built."""

import os
import subprocess
from pathlib import Path
from typing import NamedTuple

from ..messages import refuse, say
from ..processes import read, run
from .tables import has_tables

BENCHMARKS = "experiments/benchmarks"
KINDS = "give results, a build such as build/bench, or a commit"


class Side(NamedTuple):
    """One of the two sides. kind: "results" or "programs" in a folder, or "commit"."""

    kind: str
    name: str
    folder: Path = None
    sha: str = ""


def side_of(text):
    """Returns the side that a word of the command line names."""
    folder = Path(text)
    if folder.is_dir():
        if (folder / BENCHMARKS).exists():
            return Side("programs", text, (folder / BENCHMARKS).resolve())
        if has_tables(folder):
            return Side("results", text, folder)
        refuse(f"compare: {text}: holds neither tables nor {BENCHMARKS}; {KINDS}")
    found = read("git", "rev-parse", "--verify", "--quiet", "--end-of-options",
                 f"{text}^{{commit}}")
    if found.code != 0:
        refuse(f"compare: {text}: neither a folder nor a commit; {KINDS}")
    return Side("commit", text, sha=found.stdout.strip())


def built(side, sundials):
    """Builds the benchmarks of a commit in build/compare/<commit>, once."""
    tree = Path("build/compare").resolve() / side.sha[:12]
    log = tree.with_suffix(".log")
    log.parent.mkdir(parents=True, exist_ok=True)

    def must(folder, *command):
        with log.open("ab") as out:
            code = run(*command, cwd=folder, stdin=subprocess.DEVNULL, stdout=out,
                       stderr=subprocess.STDOUT)
        if code != 0:
            refuse(f"compare: {side.name}: {command[0]} {command[1]} failed; log: {log}")

    log.write_bytes(b"")
    if not tree.exists():
        must(os.getcwd(), "git", "worktree", "prune")
        must(os.getcwd(), "git", "worktree", "add", "--detach", tree, side.sha)
    say(f"building {side.name} ({tree}, log: {log})")
    must(tree, "cmake", "--preset", "bench", f"-DTRESS_SUNDIALS_ROOT={sundials}")
    must(tree, "cmake", "--build", "--preset", "bench", "--target", "benchmarks")
    return side._replace(kind="programs", folder=tree / "build/bench" / BENCHMARKS)
