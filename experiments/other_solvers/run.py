#!/usr/bin/env python3
"""Solves the five published problems with other solver packages and with tress, and prints one line per run.

Without arguments, all runs also become results/other_solvers.csv. With --update, the runs replace those of this table."""
import argparse
import csv
import json
import math
import os
import platform
import subprocess
import sys
import tempfile
from datetime import datetime, timezone
from pathlib import Path

from definitions import PROBLEMS, REPOSITORY, SCALES, UNCONSTRAINED, InputError, Problem, compiled, reference
from solvers import INSTALL, NAMES, PACKAGES, SOLVERS, TOLERANCES, TRESS, commands, run, tress_rows

COLUMNS = {
    "problem": "catalogue id of the published problem",
    "package": "package that solves it",
    "version": "version of the package",
    "solver": "method of the package",
    "max_order": "largest order of a multistep method",
    "formulation": "formulation of the constraints",
    "jacobian": "source of the Jacobian",
    "rtol": "relative tolerance; absolute tolerance over the size of each entry",
    "position_tol_rel": "error of a point over the length for which tress controls the step",
    "dt_s": "fixed step",
    "digits": "correct digits of the positions at the end, the worst entry, of the Filament over its length; at most those of the reference",
    "reference_digits": "correct digits of the reference",
    "drift": "largest constraint at the end",
    "steps": "number of accepted steps",
    "evaluations": "evaluations of the residual or right side, with those of internal differences",
    "jacobians": "number of Jacobians",
    "wall_s": "wall time of the run, callbacks to Python or Octave included",
    "status": "ok, or how the row ended",
    "reason": "reason for a status that is not ok",
}


def correct_digits(end, wanted, limit, scale=None):
    """Returns the digits of the worst entry, at most `limit`: relative to the entry, or to the scale of all entries."""
    worst = max(abs(x - y) / scale if scale else abs(x / y - 1) for x, y in zip(end, wanted))
    return limit if worst == 0 else min(limit, -math.log10(worst)) if math.isfinite(worst) else -math.inf


def identity(problem, package, solver, formulation, jacobian):
    return {**dict.fromkeys(COLUMNS, ""), "problem": problem, "package": package, "solver": solver, "formulation": formulation,
            "jacobian": jacobian, "reference_digits": reference(problem)[1]}


def ended(row, end, problem, drift):
    """Fills in the error of a run that reached the end."""
    digits = correct_digits(end, *reference(problem), SCALES.get(problem))
    if digits < 0:
        return {**row, "status": "diverged", "reason": "no correct digit at the end"}
    return {**row, "digits": f"{digits:.3g}", "drift": f"{drift:.2e}" if drift is not None else "", "status": "ok"}


def foreign_row(solver, command, library, problem, tolerance):
    row = identity(problem, solver.package, solver.method, solver.formulation_of(problem), solver.jacobian)
    found = run(solver, command, library, problem, tolerance)
    row.update(max_order=solver.order, rtol=tolerance)
    row.update({key: found.get(key, "") for key in ("version", "steps", "evaluations", "jacobians", "wall_s")})
    if "end" not in found:
        return {**row, "status": found.get("status", "solver_error"), "reason": found["failure"]}
    return ended(row, found["end"], problem, Problem(library, problem, "ode").drift(found["end"]))


def tress_row(found, version):
    row = identity(found["scene"], "tress", found["integrator"], found["formulation"], "exact")
    row.update(version=version, max_order=found["max_order"], rtol=found["rtol"], position_tol_rel=found["position_tol_rel"],
               dt_s=found["dt_s"], steps=found["steps"], evaluations=found["residuals"], jacobians=found["linearizations"],
               wall_s=found["wall_s"], status=found["status"], reason=found["reason"])
    if found["scd"]:
        row.update(status="ok", reason="", digits=f"{min(float(found['scd']), row['reference_digits']):.3g}")
        if float(row["digits"]) < 0:
            row.update(digits="", status="diverged", reason="no correct digit at the end")
    return row


def line(row):
    """One run as a line."""
    drive = next(f"{key}={row[key]}" for key in ("rtol", "position_tol_rel", "dt_s") if row[key])
    order = f" max_order={row['max_order']}" if row["max_order"] else ""
    end = f"{row['digits']} digits, {row['steps']} steps, {row['evaluations']} evaluations" if row["status"] == "ok" else \
        f"{row['status']}: {row['reason']}"
    return f"{row['problem']} {row['package']}.{row['solver']}{order} {row['formulation']} {drive}: {end}"


def rows_of(options):
    names = [name for name in NAMES if not options.solver or name in options.solver or name.split(".")[0] in options.solver]
    tolerances = [options.tolerance] if options.tolerance else TOLERANCES
    foreign = [solver for solver in SOLVERS if solver.name in names]
    with tempfile.TemporaryDirectory() as folder:
        start = commands({solver.package for solver in foreign})
        library = compiled(folder)
        if "Octave" in start:
            compiled(folder, ["octave_gateway.c"], "gateway.mex")
        own = [name.split(".")[1] for name in names if name.startswith("tress.")]
        version = _output(str(options.programs / "work_precision"), "--version").partition("\n")[0] if own else ""
        for problem in options.problem or PROBLEMS:
            for solver in foreign:
                for tolerance in (one for one in tolerances if solver.runs(problem, one)):
                    yield foreign_row(solver, start[solver.package], library, problem, tolerance)
            # Rosenbrock methods of tress have no constraints; cvode_bdf shows the orders on the Beam.
            usable = [one for one in own if problem in UNCONSTRAINED or one not in ("rodas5p", "cvode_bdf")]
            for found in tress_rows(options.programs / "work_precision", problem, usable, folder) if usable else []:
                yield tress_row(found, version.split()[-1])


def _output(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True, cwd=REPOSITORY).stdout.strip()
    except FileNotFoundError:
        raise InputError(f"{command[0]} is missing; build it with ./tress build, or pass --programs FOLDER") from None


def _cpu():
    names = [text.partition(":")[2].strip() for text in Path("/proc/cpuinfo").read_text().splitlines() if text.startswith("model name")]
    return names[0] if names else platform.machine()


def _sources():
    return {"commit": _output("git", "rev-parse", "HEAD"), "dirty": bool(_output("git", "status", "--porcelain", "-uno"))}


def _key(row):
    return tuple(str(row[key]) for key in ("problem", "package", "solver", "max_order", "formulation", "rtol",
                                           "position_tol_rel", "dt_s"))


def updated(path, rows, record):
    """Returns the rows of an existing table with these in place of the same runs, and its record, which keeps commit,
    machine and times of the first run and lists this one."""
    with path.open(newline="") as file:
        fresh = {_key(row): row for row in rows}
        merged = [fresh.pop(_key(row), row) for row in csv.DictReader(file)]
    first = json.loads(path.with_suffix(".meta.json").read_text())
    kept = {key: first[key] for key in ("git", "machine", "start", "end", "build")}
    git = record["git"]
    this = f"{len(rows)} runs replaced at commit {git['commit'][:7]}{' with uncommitted changes' if git['dirty'] else ''}"
    merged += fresh.values()
    return merged, {**record, **kept, "rows": tallied(merged), "libraries": {**first["libraries"], **record["libraries"]},
                    "merged_from": [*first.get("merged_from", []), this]}


def tallied(rows):
    return {"total": len(rows), "by_status": {status: sum(row["status"] == status for row in rows)
                                              for status in sorted({row["status"] for row in rows})}}


def manifest(rows, git, begin, load_before):
    """The record of a run in the form that the experiments write."""
    return {
        "experiment": "other_solvers", "question": "what do other solver packages reach on published problems?", "schema": 1,
        "argv": ["experiments/other_solvers/run.py"], "settings": "", "quick": False, "full": False, "checks": [],
        "start": begin, "end": datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "git": git,
        "build": {"compiler": _output("cc", "--version").split("\n")[0], "flags": "-O2", "type": ""},
        "machine": {"cpu": _cpu(), "cpus": os.cpu_count(), "kernel": platform.platform(), "load_before": load_before,
                    "load_after": list(os.getloadavg())},
        "libraries": {row["package"]: row["version"] for row in rows if row["version"]},
        "rows": tallied(rows), "columns": COLUMNS, "timings": ["wall_s"], "glossary": {}}


def parsed():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     epilog=f"Exit codes: 0 done, 2 input error or a missing package. Install with: {INSTALL}")
    parser.add_argument("problem", metavar="PROBLEM", nargs="*", help=f"problems to solve: {', '.join(PROBLEMS)} (default: all)")
    parser.add_argument("--solver", metavar="NAME", action="append", choices=[*PACKAGES, *NAMES],
                        help=f"package or method, again for another: {', '.join(NAMES)}")
    parser.add_argument("--tolerance", metavar="X", help=f"one tolerance of other packages (default: {', '.join(TOLERANCES)})")
    parser.add_argument("--programs", metavar="FOLDER", type=Path, default=REPOSITORY / "build/release/experiments",
                        help="folder of work_precision (default: build/release/experiments)")
    parser.add_argument("--out", metavar="FILE", type=Path, help="table (default, for all runs: results/other_solvers.csv)")
    parser.add_argument("--update", action="store_true", help="replace the same runs of the existing table")
    options = parser.parse_args()
    unknown = [one for one in options.problem if one not in PROBLEMS]
    if unknown:
        parser.error(f"unknown problem '{unknown[0]}'; there are: {', '.join(PROBLEMS)}")
    if not options.out and (options.update or not (options.problem or options.solver or options.tolerance)):
        options.out = REPOSITORY / "results/other_solvers.csv"
    return options


def main():
    options = parsed()
    git = _sources() if options.out else None
    begin, load = datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"), list(os.getloadavg())
    rows = []
    for row in rows_of(options):
        print(line(row), flush=True)
        rows.append(row)
    if options.out:
        record = manifest(rows, git, begin, load)
        if options.update:
            rows, record = updated(options.out, rows, record)
        with options.out.open("w", newline="") as file:
            table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            table.writeheader()
            table.writerows(rows)
        options.out.with_suffix(".meta.json").write_text(json.dumps(record, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except InputError as error:
        print(f"other_solvers: {error}", file=sys.stderr)
        sys.exit(2)
