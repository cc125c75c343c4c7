"""One run of scipy's solve_ivp: with_scipy.py LIBRARY PROBLEM METHOD FORMULATION ORDER TOLERANCE."""
import sys
import time

import numpy as np
import scipy
from definitions import Problem
from scipy.integrate import solve_ivp

library, name, method, formulation, _, tolerance = sys.argv[1:]
problem = Problem(library, name, formulation)


def right_side(t, y):
    dy = np.empty(problem.count)
    problem.call("right_side", t, np.ascontiguousarray(y), dy)
    return dy


begin = time.perf_counter()
done = solve_ivp(right_side, (0, problem.t_end), np.array(problem.y), method=method, rtol=float(tolerance),
                 atol=float(tolerance) * np.array(problem.size))
print("wall_s", time.perf_counter() - begin)
print("version", scipy.__version__)
print("steps", len(done.t) - 1)
print("evaluations", problem.counts()[0])
print("jacobians", done.njev if method != "DOP853" else "")
if done.status == 0:
    print("end", *done.y[:problem.n, -1])
else:
    print("failure", done.message)
