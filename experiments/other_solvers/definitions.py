"""The five problems for Python: the compiled definition, and the published end states of models/published."""
import ctypes
import re
import subprocess
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
PROBLEMS = ["andrews_squeezer", "slider_crank", "car_axis", "beam", "filament"]
UNCONSTRAINED = ["beam", "filament"]
FORMULATIONS = ["ode", "index1", "index2", "index3", "mass"]
SOURCES = ["andrews_squeezer.c", "slider_crank.c", "car_axis.c", "beam.c", "filament.c", "formulations.c"]


class InputError(Exception):
    """One line: what is wrong and what to do."""


def compiled(folder, extra=(), name="problems.so"):
    """Compiles the definitions and returns the path of the shared library."""
    library = Path(folder) / name
    sources = [str(HERE / source) for source in (*SOURCES, *extra)]
    try:
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", str(library), *sources, "-lm"], check=True)
    except FileNotFoundError:
        raise InputError("cc is missing; install the package gcc") from None
    return library


def published_end(name):
    """Returns the published end state of a problem from models/published/references.cpp: a dict with `q`, `v`,
    `a`, `lambda` (lists, empty where not printed), `digits_q` and `digits_v`."""
    text = (REPOSITORY / "models/published/references.cpp").read_text()
    arrays = {found[0]: [float(entry) for entry in found[1].replace("\n", " ").strip(" ,").split(",")]
              for found in re.findall(r"std::array<double, \d+> (\w+) = \{(.*?)\};", text, re.S)}
    entry = re.search(r'\{"' + name + r'",(.*?)\}(?:,\n    \{"|\};)', text, re.S)[1]
    fields = [field.strip() for field in entry.replace("{}", "none").split('"')[0].split(",")]
    t, *names, digits_q, digits_v = [field for field in fields if field]
    ends = [arrays.get(one, []) for one in names]
    return {"t": float(t), **dict(zip(["q", "v", "a", "lambda"], ends)), "digits_q": int(digits_q), "digits_v": int(digits_v)}


# The printed end state of the slider crank has five digits. Two converged runs agree to the digits given here:
# DOP853 of scipy at a tolerance of 1e-13, whose numbers these are, and RADAU5 of deSolve at 1e-12.
CONVERGED = {"slider_crank": ([15.000000000000048, -.3311734988257267, .16973733263991728, 1.8931924676562776e-4,
                               2.3757514877700574e-5, -5.323896807381511e-6, -8.363313337834673e-6], 9)}

# SciMLBenchmarks prints no end state of the Filament. DOP853 of scipy at a tolerance of 1e-13 gives these numbers for the first
# ten joints; Radau of scipy is 3e-13 away, and gsl_rk8pd of tress 3e-15. Opposite forces at the ends leave the middle at rest
# and the second half symmetric to the first.
_HALF = [0.42794439279867, -0.492768346917475, 0.428321692489762, -0.44276977048831, 0.429677366877764,
         -0.392788152397717, 0.432613749551629, -0.342874450303076, 0.43743751016389, -0.293107680932786,
         0.444223111936541, -0.243570264684228, 0.452865919714327, -0.194322910707429, 0.463127687901656,
         -0.145387278355638, 0.474675017699813, -0.0967389569608279, 0.487110902905785, -0.0483101560346874]
CONVERGED["filament"] = ([*_HALF, .5, 0, *(other for k in range(18, -1, -2) for other in (1 - _HALF[k], -_HALF[k + 1]))], 12)

# Errors of the Filament are relative to its length, those of the other problems to each entry.
SCALES = {"filament": 1}


def reference(name):
    """Returns (positions at the end, number of their correct digits)."""
    if name in CONVERGED:
        return CONVERGED[name]
    end = published_end(name)
    return end["q"], end["digits_q"]


class Problem:
    """A problem in a formulation. `y`, `yp` and `size` are start, its derivative, and the size of each entry."""

    def __init__(self, library, name, formulation):
        self.library = ctypes.CDLL(str(library))
        self._array = ctypes.POINTER(ctypes.c_double)
        self.library.drift.restype = ctypes.c_double
        self.library.choose(ctypes.byref(ctypes.c_int(PROBLEMS.index(name))),
                            ctypes.byref(ctypes.c_int(FORMULATIONS.index(formulation))))
        three, t_end = (ctypes.c_int * 3)(), ctypes.c_double()
        self.library.sizes(three, ctypes.byref(t_end))
        self.n, self.m, self.count = three
        self.t_end = t_end.value
        self.y, self.yp, self.size = ((ctypes.c_double * self.count)() for _ in range(3))
        self.library.start(self.y, self.yp, self.size)

    def pointer(self, array):
        """Returns the address of the numbers of a numpy array or ctypes array."""
        return array.ctypes.data_as(self._array) if hasattr(array, "ctypes") else array

    def call(self, name, t, *arguments):
        """Calls a function of time, arrays and numbers of formulations.c."""
        words = [ctypes.c_double(one) if isinstance(one, float) else self.pointer(one) for one in arguments]
        getattr(self.library, name)(ctypes.c_double(t), *words)

    def counts(self):
        """Returns the numbers of evaluations and of Jacobians since the problem was chosen."""
        both = (ctypes.c_double * 2)()
        self.library.counts(both)
        return int(both[0]), int(both[1])

    def drift(self, q):
        """Returns the largest constraint at the end time."""
        return self.library.drift(ctypes.c_double(self.t_end), (ctypes.c_double * self.n)(*q))
