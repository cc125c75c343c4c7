"""./tress cluster: sweeps in parts on a cluster. See docs/cluster.md."""

import json
import os
import re
import shlex
from pathlib import Path

from ..messages import ROWS_FAILED, refuse, say
from ..number_text import precise
from ..processes import last_line, read
from . import slurm, snakemake
from .estimate import write_estimates
from .profile import read_profile
from .sweep import (alone, core_hours, load, missing_parts, needs, parts_of, pilot, refuse_ours,
                    remains, remove, rows_of_part, save, table_of, usual_parts, write_scripts)

TAKES = {"--parts": "whole", "--cores": "whole", "--profile": "text", "--folder": "text",
         "--sbatch": "flag", "--write-only": "flag"}
ESTIMATE = {"--out": "results/full_sweeps.csv", "--timeout": "60s"}


def _here(path):
    """Returns a path as short as it can be given in this folder."""
    short = os.path.relpath(path)
    return str(path) if short.startswith("..") else short


def _option(words, known):
    """Returns the option that stands first and is taken from the words."""
    name = words.pop(0)
    if name not in known:
        refuse(f"cluster: unknown option '{name}'; there are {', '.join(known)}")
    return name


def _value(words, name):
    if not words:
        refuse(f"cluster: {name} without a value; give one")
    return words.pop(0)


def read_words(words):
    """Returns options, experiment and its arguments: all that follows its name."""
    words, options = list(words), {}
    while words and words[0].startswith("-"):
        name = _option(words, TAKES)
        if TAKES[name] == "flag":
            options[name] = True
            continue
        value = _value(words, name)
        if TAKES[name] == "whole":
            if not re.fullmatch(r"[1-9][0-9]{0,5}", value):
                refuse(f"cluster: {name} {value} is not a whole number above 0; as in {name} 4")
            value = int(value)
        options[name] = value
    return options, words[0] if words else "", words[1:]


class Programs:
    """The programs of the experiments, in a folder with a list of them."""

    def __init__(self, folder):
        self.folder = folder

    def names(self):
        return (self.folder / "list.txt").read_text(encoding="utf-8").split()

    def path(self, name):
        """Returns the program of an experiment."""
        if name not in self.names():
            refuse(f"cluster: no experiment '{name}'; there are {' '.join(self.names())}")
        return str(self.folder / name)


def _version(program):
    """Returns version and commit of a program, without the instructions of this machine."""
    return read(program, "--version").stdout.partition("\n")[0]


def refuse_strange(folder):
    """Refuses paths with what Slurm and Snakemake each read in a way of their own (blanks, %,
    {}, $), which no quoting suits."""
    for c in folder:
        if not (c.isalnum() or c in "_@+=:,./-"):
            text, c = (json.dumps(one, ensure_ascii=False) for one in (folder, c))
            refuse(f"{text}: has {c} in its path, which Slurm and Snakemake may take for "
                   "something else; give a --folder of letters, digits and _ @ + = : , . / -")


def _continued(old, fresh, options):
    """Returns the sweep as it is in its folder."""
    for key in ("experiment", "args"):
        if old[key] != fresh[key]:
            said = (one if isinstance(one, str) else ",".join(one)
                    for one in (old[key], fresh[key]))
            refuse("{}: holds another sweep: '{}', not '{}'; give another --folder, or remove it"
                   .format(_here(fresh["folder"]), *said))
    if options.get("--parts", old["parts"]) != old["parts"]:
        refuse(f"{_here(fresh['folder'])}: the sweep has {old['parts']} parts; leave --parts out")
    return old | fresh | {"version": old["version"]}


def _begun(fresh, options, profile):
    """Returns a new sweep, with the pilot's estimate."""
    if strange := remains(fresh["folder"]):
        refuse(f"{_here(fresh['folder'])}: holds '{strange[0]}' and no sweep; "
               "give another --folder")
    known = pilot(fresh, say)
    parts = options.get("--parts") or usual_parts(known, profile["most_tasks"])
    if parts > known["rows"]:
        refuse(f"--parts: {parts} parts of {known['rows']} rows; give fewer")
    return fresh | {"pilot": known, "parts": parts, "submissions": []}


def _prepared(scheduler, options, fresh):
    profile = read_profile(options.get("--profile"))
    if (Path(fresh["folder"]) / "sweep.json").exists():
        sweep = _continued(load(fresh["folder"]), fresh, options)
    else:
        sweep = _begun(fresh, options, profile)
    return sweep | {"scheduler": scheduler, "profile": profile,
                    "needs": needs(sweep["pilot"], sweep["parts"], profile)}


def _tell_estimate(sweep):
    known, parts, need = sweep["pilot"], sweep["parts"], sweep["needs"]
    say(f"{known['rows']} rows of about {precise(known['row_s'], 2)} s "
        f"({known['timed']} were timed): {precise(core_hours(known, parts), 2)} core hours in "
        f"{parts} parts; each asks for {need['minutes']} min and {need['memory_mb']} MB")


def _refuse_while_running(sweep):
    for jobs in sweep["submissions"]:
        for job in jobs.values():
            if slurm.states(job):
                refuse(f"{_here(sweep['folder'])}: job {job} is still at work; wait for it, or: "
                       f"scancel {jobs['array']} {jobs['merge']}")


def _submit(sweep, options):
    _refuse_while_running(sweep)
    folder, version = _here(sweep["folder"]), _version(sweep["program"])
    if sweep["version"] != version:
        refuse(f"{folder}: begun by '{sweep['version']}', but the program is '{version}'; "
               "build that again, or remove the folder")
    missing = missing_parts(sweep)
    write_scripts(sweep)
    save(sweep)
    if len(missing) < sweep["parts"]:
        say(f"{sweep['parts'] - len(missing)} of {sweep['parts']} parts are there")
    if not missing:
        return _merge(sweep)
    again = f"./tress cluster status {folder}"
    if sweep["scheduler"] == "slurm":
        return _submit_to_slurm(sweep, missing, options, again)
    file = snakemake.write(sweep)
    cores = options.get("--cores") or len(os.sched_getaffinity(0))
    words = snakemake.command(sweep, cores, options.get("--sbatch"))
    if options.get("--write-only"):
        say(f"wrote {_here(file)}; start it: {shlex.join(words)}")
        return 0
    if snakemake.make(words):
        return _tell_table(sweep)
    say(f"parts are missing; {again}")
    return ROWS_FAILED


def _submit_to_slurm(sweep, missing, options, again):
    array, merge = slurm.write(sweep, missing)
    if options.get("--write-only"):
        say(f"wrote {_here(array)} and {_here(merge)}")
        return 0
    jobs = slurm.submit(array, merge)
    sweep["submissions"].append(jobs)
    save(sweep)
    say(f"submitted job {jobs['array']} ({len(missing)} parts) and {jobs['merge']}, "
        f"which joins them; {again}")
    return 0


def _tell_table(sweep):
    say(f"the table: {_here(table_of(sweep))}")
    return 0


def _merge(sweep):
    if missing := missing_parts(sweep):
        folder = _here(sweep["folder"])
        refuse(f"{folder}: parts {', '.join(map(str, missing))} of {sweep['parts']} are missing; "
               f"./tress cluster resume {folder}")
    done = read(f"{sweep['folder']}/merge.sh")
    if done.code != 0:
        refuse(last_line(done.stderr) or "merge.sh failed")
    return _tell_table(sweep)


def _status(sweep):
    missing, folder = missing_parts(sweep), _here(sweep["folder"])
    rows = sum(rows_of_part(sweep, i) for i in parts_of(sweep))
    print(" ".join([sweep["experiment"], *sweep["args"]]))
    print(f"parts: {sweep['parts'] - len(missing)} of {sweep['parts']} complete; "
          f"rows: {rows} finished")
    active = False
    for jobs in sweep["submissions"]:
        for what, job in zip(("parts", "join"), (jobs["array"], jobs["merge"])):
            for state, count in slurm.states(job).items():
                active = True
                print(f"job {job} ({what}): {count} {state.lower()}")
    for i in missing:
        log = Path(sweep["folder"]) / "logs" / f"{i}.log"
        last = last_line(log.read_text(errors="replace")) if log.exists() else ""
        print(f"part {i}: {rows_of_part(sweep, i)} rows finished"
              + (f"; log: {last}" if last else ""))
    if table_of(sweep).exists():
        print(f"table: {_here(table_of(sweep))}")
    elif not missing:
        print(f"next: ./tress cluster merge {folder}")
    elif not active:
        print(f"next: ./tress cluster resume {folder}")
    return 0


def _estimate(words, programs):
    """Writes what every sweep of all rows takes, as a table."""
    words, options = list(words), dict(ESTIMATE)
    while words and words[0].startswith("-"):
        name = _option(words, ESTIMATE)
        options[name] = _value(words, name)
    # simulate runs scenes, which are not rows of a sweep.
    names = words or [name for name in programs.names() if name != "simulate"]
    write_estimates(
        [{"experiment": name, "program": programs.path(name), "repository": os.getcwd(),
          "args": ["--full", "--timeout", options["--timeout"]]} for name in names],
        Path(options["--out"]).resolve())


def _sweep(scheduler, words, programs):
    options, experiment, args = read_words(words)
    program = programs.path(experiment)
    refuse_ours(args)
    folder = Path(options.get("--folder", f"results/cluster/{experiment}")).resolve()
    refuse_strange(str(folder))
    fresh = {"experiment": experiment, "args": args, "program": program,
             "repository": os.getcwd(), "folder": str(folder), "version": _version(program)}
    was_there = folder.exists()
    folder.mkdir(parents=True, exist_ok=True)
    try:
        with alone(folder):
            sweep = _prepared(scheduler, options, fresh)
            _tell_estimate(sweep)
            return _submit(sweep, options)
    finally:
        if not was_there and not remains(folder):
            remove(folder)


COMMANDS = ("slurm", "snakemake", "status", "resume", "merge", "estimate")
BUILT = ("slurm", "snakemake", "estimate")


def cluster(words, programs):
    """Runs a command of ./tress cluster with the programs of a folder."""
    command, *words = words or [""]
    programs = Programs(Path(programs).resolve())
    if command in ("slurm", "snakemake"):
        return _sweep(command, words, programs)
    if command == "estimate":
        return _estimate(words, programs)
    if command not in COMMANDS:
        refuse(f"cluster: no command '{command}'; there are {', '.join(COMMANDS)}")
    if len(words) != 1:
        refuse(f"cluster {command}: give the folder of a sweep")
    sweep = load(words[0])
    if command == "status":
        return _status(sweep)
    with alone(sweep["folder"]):
        return _merge(sweep) if command == "merge" else _submit(sweep, {})
