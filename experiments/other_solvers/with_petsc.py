"""One run of PETSc TS: with_petsc.py LIBRARY PROBLEM METHOD FORMULATION ORDER TOLERANCE."""
import sys
import time

import numpy as np
import petsc4py

# PETSc prints its own errors with a stack trace; the exception is enough.
petsc4py.init(["with_petsc", "-on_error_abort", "0"])
from definitions import Problem  # noqa: E402
from petsc4py import PETSc  # noqa: E402

library, name, method, formulation, order, tolerance = sys.argv[1:]
problem = Problem(library, name, formulation)
second_order = method == "alpha2"
count = problem.n if second_order else problem.count
start = np.array(problem.y)[:count]
size = np.array(problem.size)[:count]
options = PETSc.Options()
for key, value in {"ts_adapt_type": "basic", "ksp_type": "preonly", "pc_type": "lu", "ts_max_snes_failures": "-1",
                   "ts_max_reject": "1000", "ts_arkimex_fully_implicit": "", "ts_arkimex_type": "4",
                   "ts_bdf_order": order or "2"}.items():
    options[key] = value
F, J = PETSc.Vec().createSeq(count), PETSc.Mat().createDense([count, count], comm=PETSc.COMM_SELF)
J.setUp()
matrix = np.empty((count, count))


def put():
    J.getDenseArray()[:] = matrix
    J.assemble()


def residual(ts, t, u, u_dot, r):
    out = np.empty(count)
    problem.call("residual", t, u.array_r.copy(), u_dot.array_r.copy(), out)
    r.array[:] = out


def jacobian(ts, t, u, u_dot, shift, A, B):
    problem.call("jacobian", t, u.array_r.copy(), u_dot.array_r.copy(), float(shift), matrix)
    put()


def residual_2(ts, t, u, v, a, r):
    out = np.empty(count)
    problem.call("second_order", t, u.array_r.copy(), v.array_r.copy(), a.array_r.copy(), out)
    r.array[:] = out


def jacobian_2(ts, t, u, v, a, shift_v, shift_a, A, B):
    problem.call("second_order_jacobian", t, u.array_r.copy(), v.array_r.copy(), a.array_r.copy(), float(shift_v),
                 float(shift_a), matrix)
    put()


ts = PETSc.TS().create(comm=PETSc.COMM_SELF)
ts.setType(method)
u = PETSc.Vec().createWithArray(start.copy(), comm=PETSc.COMM_SELF)
if second_order:
    v = PETSc.Vec().createWithArray(np.array(problem.y)[problem.n:2 * problem.n], comm=PETSc.COMM_SELF)
    ts.setI2Function(residual_2, F)
    ts.setI2Jacobian(jacobian_2, J)
else:
    ts.setIFunction(residual, F)
    ts.setIJacobian(jacobian, J)
ts.setMaxTime(problem.t_end)
ts.setMaxSteps(10**7)
ts.setTimeStep(1e-5 * problem.t_end)
ts.setExactFinalTime(PETSc.TS.ExactFinalTime.MATCHSTEP)
ts.setTolerances(rtol=float(tolerance), atol=PETSc.Vec().createWithArray(float(tolerance) * size, comm=PETSc.COMM_SELF))
ts.setFromOptions()
begin = time.perf_counter()
failure = ""
try:
    if second_order:
        ts.setSolution2(u, v)
        ts.solve(u)
    else:
        ts.solve(u)
    if ts.getConvergedReason() < 0:
        failure = f"TS converged reason {ts.getConvergedReason()} at t = {ts.getTime():.3g} s"
except PETSc.Error as error:
    failure = f"PETSc error {error.ierr} at t = {ts.getTime():.3g} s"
print("wall_s", time.perf_counter() - begin)
print("version", ".".join(map(str, PETSc.Sys.getVersion())))
print("steps", ts.getStepNumber())
evaluations, jacobians = problem.counts()
print("evaluations", evaluations)
print("jacobians", jacobians)
if failure:
    print("failure", failure)
else:
    print("end", *u.array_r[:problem.n])
