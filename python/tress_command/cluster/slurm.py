"""A sweep as a job array of Slurm, and a job that joins its parts when all have ended."""

import collections
import shlex
from pathlib import Path

from ..messages import refuse
from ..processes import last_line, read
from .sweep import write_script

JOB = "#SBATCH --ntasks=1 --cpus-per-task=1 --open-mode=append"
MERGE_MINUTES = 10


def _slurm(*command):
    try:
        done = read(*command)
    except FileNotFoundError:
        refuse(f"{command[0]}: not found; install Slurm's commands, or: ./tress cluster snakemake")
    if done.code != 0:
        refuse(f"{command[0]}: {last_line(done.stderr)}")
    return done.stdout.strip()


def ranges(parts):
    """Returns 1,2,3,7 as "1-3,7"."""
    pairs = []
    for i in parts:
        if pairs and pairs[-1][1] == i - 1:
            pairs[-1][1] = i
        else:
            pairs.append([i, i])
    return ",".join(f"{a}" if a == b else f"{a}-{b}" for a, b in pairs)


def flags(profile):
    """Returns the options of sbatch that a profile has."""
    named = [f"--{key}={profile[key]}" for key in ("partition", "account", "qos")
             if profile.get(key)]
    return named + profile.get("options", "").split()


def _write_job(sweep, name, lines, log, command):
    folder = Path(sweep["folder"])
    log = f"#SBATCH --output={folder / 'logs' / log}"
    of_user = [f"#SBATCH {flag}" for flag in flags(sweep["profile"])]
    text = ["#!/usr/bin/env bash", *lines, log, *of_user, f"exec {command}", ""]
    write_script(folder / name, "\n".join(text))
    return folder / name


def write(sweep, parts):
    """Writes both jobs. Returns their files."""
    job, memory = f"tress-{sweep['experiment']}", f"--mem={sweep['needs']['memory_mb']}M"
    part, merge = (shlex.quote(f"{sweep['folder']}/{name}") for name in ("part.sh", "merge.sh"))
    array = _write_job(
        sweep, "array.sbatch",
        [f"#SBATCH --job-name={job}", f"#SBATCH --array={ranges(parts)}", JOB,
         f"#SBATCH --time={sweep['needs']['minutes']} {memory}"],
        "%a.log", f'{part} "$SLURM_ARRAY_TASK_ID"')
    return array, _write_job(
        sweep, "merge.sbatch",
        [f"#SBATCH --job-name={job}-merge", JOB, f"#SBATCH --time={MERGE_MINUTES} {memory}"],
        "merge.log", merge)


def submit(array_file, merge_file):
    """Submits both jobs. Returns their numbers."""
    array = _slurm("sbatch", "--parsable", array_file).partition(";")[0]
    merge = _slurm("sbatch", "--parsable", f"--dependency=afterok:{array}",
                   "--kill-on-invalid-dep=yes", merge_file).partition(";")[0]
    return {"array": array, "merge": merge}


def states(job):
    """Returns the states of a job's tasks, as in {"RUNNING": 2, "PENDING": 1}; empty: the job
    has ended."""
    try:
        done = read("squeue", "-h", "-r", "-o", "%T", "-j", job)
    except FileNotFoundError:
        refuse("squeue: not found; ask where the sweep was submitted")
    # A job that Slurm no longer knows has ended.
    return collections.Counter(done.stdout.split() if done.code == 0 else ())
