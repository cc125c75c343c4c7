"""The solvers of the comparison, and how a run of each is started."""
import csv
import glob
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from definitions import FORMULATIONS, HERE, PROBLEMS, REPOSITORY, UNCONSTRAINED, InputError

TOLERANCES = ["1e-4", "1e-6", "1e-8"]
LIMIT_S = 30
INSTALL = f"sudo apt-get install $(grep -v '^#' {(HERE / 'packages.txt').relative_to(REPOSITORY)})"
DIFFERENCES = "differences, internal"
NONE = "none"


@dataclass(frozen=True)
class Solver:
    """A method of a package. `order` is the largest order of a multistep method, "" where there is no such choice.
    `only_beam` and `only_constrained` restrict a row to the problems for which it says something."""

    package: str
    method: str
    formulation: str
    jacobian: str
    order: str = ""
    only_beam: bool = False
    only_constrained: bool = False

    @property
    def name(self):
        return f"{self.package}.{self.method}"

    def formulation_of(self, problem):
        """The Beam and the Filament have no constraints: every formulation is the ODE."""
        return "ode" if problem in UNCONSTRAINED else self.formulation

    def runs(self, problem, tolerance):
        """Higher indices than the package supports run at the middle tolerance only."""
        if self.formulation in ("index2", "index3") and tolerance in TOLERANCES and tolerance != TOLERANCES[1]:
            return False
        if problem == "filament" and self.method == "alpha2":  # for equations of second order
            return False
        return not (self.only_beam and problem != "beam") and not (self.only_constrained and problem in UNCONSTRAINED)


SOLVERS = [
    Solver("scipy", "Radau", "ode", DIFFERENCES),
    Solver("scipy", "BDF", "ode", DIFFERENCES, "5"),
    Solver("scipy", "DOP853", "ode", NONE),
    Solver("deSolve", "radau", "mass", DIFFERENCES),
    Solver("deSolve", "radau", "ode", DIFFERENCES, only_constrained=True),
    Solver("deSolve", "daspk", "index1", DIFFERENCES, "5"),
    Solver("deSolve", "daspk", "index1", DIFFERENCES, "2", only_beam=True),
    Solver("deSolve", "daspk", "index2", DIFFERENCES, "5", only_constrained=True),
    Solver("deSolve", "daspk", "index3", DIFFERENCES, "5", only_constrained=True),
    Solver("Octave", "ode15s", "ode", DIFFERENCES, "5"),
    Solver("Octave", "ode15s", "ode", DIFFERENCES, "2", only_beam=True),
    Solver("Octave", "ode15i", "index1", DIFFERENCES, "5"),
    Solver("Octave", "ode15i", "index2", DIFFERENCES, "5", only_constrained=True),
    Solver("Octave", "ode15i", "index3", DIFFERENCES, "5", only_constrained=True),
    Solver("PETSc", "alpha2", "ode", "differences, ours"),
    Solver("PETSc", "bdf", "index1", "differences, ours", "5"),
    Solver("PETSc", "bdf", "index1", "differences, ours", "2", only_beam=True),
    Solver("PETSc", "rosw", "ode", "differences, ours"),
    Solver("PETSc", "arkimex", "ode", "differences, ours"),
]
TRESS = ["radau5", "esdirk43", "rodas5p", "ida", "tr_bdf2", "generalized_alpha", "cvode_bdf"]
NAMES = [*dict.fromkeys(solver.name for solver in SOLVERS), *(f"tress.{one}" for one in TRESS)]
PACKAGES = list(dict.fromkeys(name.split(".")[0] for name in NAMES))


def _petsc():
    """Debian installs petsc4py next to PETSc, which it finds by PETSC_DIR."""
    found = sorted(glob.glob("/usr/lib/petscdir/petsc*/*-real"))
    return {"PETSC_DIR": found[-1]} if found and "PETSC_DIR" not in os.environ else {}


def environment():
    return {**os.environ, **_petsc(), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def _starts(*command):
    try:
        return subprocess.run(command, env=environment(), capture_output=True).returncode == 0
    except FileNotFoundError:
        return False


def _python_with(module):
    """Returns an interpreter that has the module: Debian's is not always the first one."""
    each = (python for python in (sys.executable, "/usr/bin/python3") if _starts(python, "-c", f"import numpy, {module}"))
    return next(each, None)


def commands(wanted):
    """Returns the beginning of the command of each wanted package of other people; an error names what is missing."""
    there = {}
    if "scipy" in wanted:
        there["scipy"] = [_python_with("scipy"), HERE / "with_scipy.py"]
    if "PETSc" in wanted:
        there["PETSc"] = [_python_with("petsc4py.PETSc"), HERE / "with_petsc.py"]
    if "deSolve" in wanted:
        there["deSolve"] = ["Rscript" if _starts("Rscript", "-e", "library(deSolve)") else None, HERE / "with_desolve.R"]
    if "Octave" in wanted:
        octave = ["octave", "--no-gui", "--norc", "--quiet"]
        there["Octave"] = [*octave, HERE / "with_octave.m"] if _starts(*octave, "--eval", "1;") else [None]
    missing = [package for package, command in there.items() if None in command]
    if missing:
        raise InputError(f"{', '.join(missing)} cannot be run; install the packages with: {INSTALL}")
    return there


def run(solver, command, library, problem, tolerance):
    """Returns what one run printed: `end`, or `failure`; counts and wall time where they are known."""
    formulation = solver.formulation_of(problem)
    by_number = solver.package in ("deSolve", "Octave")
    place = str(Path(library).parent) if solver.package == "Octave" else str(library)
    words = [str(PROBLEMS.index(problem)), solver.method, str(FORMULATIONS.index(formulation))] if by_number else \
        [problem, solver.method, formulation]
    try:
        done = subprocess.run([*map(str, command), place, *words, solver.order, tolerance], env=environment(),
                              capture_output=True, text=True, timeout=LIMIT_S)
    except subprocess.TimeoutExpired:
        return {"failure": f"not finished after {LIMIT_S} s", "status": "timeout"}
    lines = (line.partition(" ") for line in done.stdout.splitlines())
    found = {key: text.strip() for key, _, text in lines if key in
             ("wall_s", "version", "steps", "evaluations", "jacobians", "end", "failure")}
    if "end" in found:
        found["end"] = [float(entry) for entry in found["end"].split()]
    else:
        found["failure"] = found.get("failure") or (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
        detail = [text.strip() for text in done.stderr.splitlines() if text.strip().startswith("At t = ")]
        found["failure"] += f" ({detail[0].rstrip('.')})" if detail else ""
    return found


def tress_rows(program, problem, methods, folder):
    """Returns rows of work_precision for the problem: three tolerances of ida, two of the methods that control
    the error of a point, and two fixed steps."""
    out = Path(folder) / f"{problem}.csv"
    command = [str(program), "--set", f"scene={problem}", "--integrators", ",".join(methods), "--jobs", "1",
               "--repeat", "1", "--progress", "none", "--out", str(out)]
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except FileNotFoundError:
        raise InputError(f"{program} is missing; build it with ./tress build, or pass --programs FOLDER") from None
    if done.returncode not in (0, 3) or not out.exists():
        raise InputError(f"work_precision ended with exit code {done.returncode}: {done.stderr.strip()}")
    with out.open() as file:
        return [row for row in csv.DictReader(file) if _kept(row)]


def _kept(row):
    if row["rtol"]:
        return float(row["rtol"]) in map(float, TOLERANCES)
    if row["position_tol_rel"]:
        return float(row["position_tol_rel"]) in (1e-3, 1e-4)
    return _level(row) in (3, 6)


COARSE_STEP_S = {"andrews_squeezer": 2e-4, "slider_crank": 1e-3, "car_axis": 1e-2, "beam": 1e-2, "filament": 5e-4}


def _level(row):
    """Returns how often the coarsest step of work_precision was halved."""
    return (round(COARSE_STEP_S[row["scene"]] / float(row["dt_s"]))).bit_length() - 1
