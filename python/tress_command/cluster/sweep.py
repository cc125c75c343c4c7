"""A sweep: one experiment with its arguments, divided into parts, in a folder of its own.

sweep.json records the sweep. A part is complete when its table is there, which a program
writes last, after the manifest.
"""

import contextlib
import json
import math
import os
import resource
import shlex
import shutil
import socket
from pathlib import Path

from ..files import read_json
from ..messages import INTERRUPTED, Ended, refuse
from ..processes import last_line, read

OURS = ("--shard", "--out", "--merge", "--resume", "--jobs", "--dry-run", "--list", "--help")
PART_S = 900  # what a part should take
LARGEST = 2**20  # bytes of sweep.json


def refuse_ours(args):
    """Refuses options of the experiment that the sweep itself gives."""
    for option in (arg.partition("=")[0] for arg in args):
        if option in OURS:
            refuse(f"{option}: the sweep gives this itself; leave it out")


def table_of(sweep):
    """Returns the path of the joined table."""
    return Path(sweep["folder"]) / f"{sweep['experiment']}.csv"


def table_of_part(sweep, i):
    """Returns the path of the table of part i."""
    return Path(sweep["folder"]) / f"{sweep['experiment']}.{i}-of-{sweep['parts']}.csv"


def _manifest_of(table):
    return table.with_suffix(".meta.json")


def parts_of(sweep):
    """Returns the numbers of the parts, from 1."""
    return range(1, sweep["parts"] + 1)


def missing_parts(sweep):
    """Returns the numbers of the parts without a table."""
    return [i for i in parts_of(sweep) if not table_of_part(sweep, i).exists()]


def rows_of_part(sweep, i):
    """Returns the number of rows that a part has finished, of its table or its journal."""
    table = table_of_part(sweep, i)
    if table.exists():
        return read_json(_manifest_of(table))["rows"]["total"]
    journal = table.with_name(f"{table.name}.journal")
    if not journal.exists():
        return 0
    return max(0, journal.read_text(encoding="utf-8", errors="replace").count("\n") - 1)


def save(sweep):
    """Writes sweep.json: whole, or not at all."""
    file = Path(sweep["folder"]) / "sweep.json"
    part = file.with_name("sweep.json.part")
    part.write_text(json.dumps(sweep, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    part.rename(file)


def load(folder):
    """Returns the sweep of a folder."""
    file = Path(folder) / "sweep.json"
    if not file.exists():
        refuse(f"{folder}: no sweep there; begin one: ./tress cluster slurm EXPERIMENT")
    sweep = read_json(file, LARGEST)
    if not (isinstance(sweep, dict) and isinstance(sweep.get("experiment"), str)
            and isinstance(sweep.get("parts"), int)):
        refuse(f"{file}: not of a sweep; remove the folder and begin again")
    return sweep | {"folder": str(Path(folder).resolve())}


@contextlib.contextmanager
def alone(folder):
    """Holds the folder's lock. Refuses if another process works on the folder."""
    lock, host = Path(folder) / "lock", socket.gethostname()
    while True:
        try:
            with lock.open("x", encoding="utf-8") as file:
                file.write(f"{os.getpid()} {host}")
            break
        except FileExistsError:
            pid, _, other = lock.read_text(encoding="utf-8").partition(" ")
            if other != host or Path(f"/proc/{pid}").exists():
                refuse(f"{lock}: process {pid} on {other} works on this sweep; wait for it")
            lock.unlink(missing_ok=True)
    try:
        yield
    finally:
        lock.unlink(missing_ok=True)


def _processor_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _run(sweep, *args):
    """Runs the experiment's program here. Returns its output and the time that it used of
    processors (s). The last line of a failing program is the refusal."""
    before = _processor_s()
    done = read(sweep["program"], *sweep["args"], *args, cwd=sweep["repository"])
    if done.code == INTERRUPTED or done.code > 128:
        raise Ended(INTERRUPTED, "interrupted; give the same command again")
    if done.code not in (0, 3):
        refuse(last_line(done.stderr) or f"{sweep['program']} ended with {done.code}")
    return done.stdout, _processor_s() - before


def pilot(sweep, say):
    """Counts the rows and runs some of them, spread over all. Returns what a row takes, and
    what every part takes to plan the rows."""
    plan, plan_s = _run(sweep, "--dry-run")
    rows = plan.count("\n")
    if rows < 2:
        refuse(f"{sweep['experiment']}: {rows} row, nothing to share; ./tress run")
    sample = max(2, math.ceil(rows / 6))
    say(f"{rows} rows; some of them are timed first")
    folder = Path(sweep["folder"])
    for left in folder.glob("pilot.*"):
        left.unlink()
    _run(sweep, "--shard", f"1/{sample}", "--out", folder / "pilot.csv", "--jobs", "1",
         "--progress", "none")
    table = folder / f"pilot.1-of-{sample}.csv"
    manifest = read_json(_manifest_of(table))
    table.unlink()
    _manifest_of(table).unlink()
    timed = math.ceil(rows / sample)
    spent = manifest["spent"]
    return {
        "rows": rows,
        "timed": timed,
        "plan_s": plan_s,
        "row_s": max(0, spent["processor_s"] - plan_s) / timed,
        "cut_off": manifest["rows"]["by_status"].get("timeout", 0),
        "largest_mb": spent["largest_mb"],
        "timeout_s": manifest["timeout_s"],
    }


def core_hours(known, parts):
    """Returns the core hours of the whole sweep in so many parts."""
    return (known["rows"] * known["row_s"] + parts * known.get("plan_s", 0)) / 3600


def needs(known, parts, profile):
    """Returns minutes and memory of a part: twice what the pilot's rows took, and one row that
    runs into its timeout; half more memory than its largest process, twice (two processes)."""
    rows = math.ceil(known["rows"] / parts)
    seconds = 2 * (rows * known["row_s"] + known.get("plan_s", 0)) + known["timeout_s"]
    memory_mb = max(256, 64 * math.ceil(3 * known["largest_mb"] / 64))
    return {
        "minutes": profile.get("minutes", math.ceil(seconds / 60)),
        "memory_mb": profile.get("memory_mb", memory_mb),
    }


def usual_parts(known, most_tasks):
    """Returns the number of parts of about PART_S."""
    wanted = math.ceil(known["rows"] * known["row_s"] / PART_S)
    return max(2, min(wanted, known["rows"], most_tasks))


def write_scripts(sweep):
    """Writes the script that runs part $1 to its end, and the one that joins the parts. A table
    with failed rows is complete: they are rows with a reason."""
    command = shlex.join([sweep["program"], *sweep["args"]])
    setup = sweep["profile"].get("setup")
    head = f"""#!/usr/bin/env bash
# Made by ./tress cluster.
set -euo pipefail
cd {shlex.quote(sweep["repository"])}
{setup + chr(10) if setup else ""}{command} \\
"""
    end = """ || {
  code=$?
  ((code == 3)) || exit "$code"
}
"""
    out = f"--out {shlex.quote(str(table_of(sweep)))}"
    tables = " \\\n  ".join(shlex.quote(str(table_of_part(sweep, i))) for i in parts_of(sweep))
    folder = Path(sweep["folder"])
    (folder / "logs").mkdir(parents=True, exist_ok=True)
    write_script(folder / "part.sh", f'{head}  --shard "$1/{sweep["parts"]}" {out} '
                 f"--jobs 1 --resume --progress none{end}")
    write_script(folder / "merge.sh", f"{head}  {out} --merge \\\n  {tables}{end}")


def write_script(path, text):
    """Writes a file that can be executed."""
    path.write_text(text, encoding="utf-8")
    path.chmod(0o755)


def remains(folder):
    """Returns what lies in the folder besides what an interrupted pilot left."""
    return sorted(path.name for path in Path(folder).iterdir()
                  if path.name != "lock" and not path.name.startswith("pilot."))


def remove(folder):
    """Removes a folder that holds nothing of a sweep."""
    shutil.rmtree(folder)
