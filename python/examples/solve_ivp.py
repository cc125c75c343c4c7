"""solve_ivp.py [table.csv]: scipy's Radau and BDF beside tress' methods on one strand.

The columns are those of work_precision.csv. The strand: 5 super-helices of a hair of 10 cm
that falls from the horizontal, 0.2 s. error_rel: root mean square over 20 instants of the
tip's distance from the reference, over the length. The reference: gsl_rk8pd at rtol 1e-11;
its gap from gsl_msadams is reference_gap.
"""

import csv
import sys
import time

import numpy as np
import scipy.integrate
import tress

LENGTH, ELEMENTS = 0.1, 5
times = np.linspace(0, 0.2, 21)
COLUMNS = (
    "scene", "model", "modes", "integrator", "formulation", "dt_s", "rtol", "elements",
    "solver", "error_kind", "error_rel", "reference_gap", "wall_s", "wall_s_per_sim_s",
    "steps", "residuals", "linearizations", "solves", "status", "reason",
)  # fmt: skip


def strand():
    return tress.model("super_helix", elements=ELEMENTS, modes="bend")


def by_tress(method, **options):
    system = strand()
    run = tress.Integrator(method, system, **options).start()
    tips = []
    begin = time.perf_counter()
    for t in times[1:]:
        run.advance(t)
        tips.append(system.points(t, run.q)[-1])
    return np.array(tips), time.perf_counter() - begin, run.stats


def by_scipy(method, rtol):
    system = strand()
    fun, jac, y0 = tress.first_order(system)
    q_typ, v_typ = system.scale()
    begin = time.perf_counter()
    run = scipy.integrate.solve_ivp(
        fun, (0, times[-1]), y0, method, times[1:], rtol=rtol, jac=jac,
        atol=rtol / 100 * np.concatenate([q_typ, v_typ]),
    )  # fmt: skip
    wall = time.perf_counter() - begin
    if not run.success:
        raise tress.SolveError(run.message)
    tips = np.array([system.points(t, y[: system.n])[-1] for t, y in zip(run.t, run.y.T)])
    return tips, wall, {"residuals": run.nfev, "linearizations": run.njev, "solves": run.nlu}


def error(tips, reference):
    return np.sqrt(np.mean(np.sum((tips - reference) ** 2, axis=1))) / LENGTH


reference, *_ = by_tress("gsl_rk8pd", rtol=1e-11, atol=1e-13)
other, *_ = by_tress("gsl_msadams", rtol=1e-10, atol=1e-12)
gap = error(other, reference)
rows = []


def add(integrator, made, rtol=None):
    row = {
        "scene": "release_0.2s", "model": "super_helix", "modes": "bend",
        "integrator": integrator, "formulation": "parametric", "rtol": rtol,
        "elements": ELEMENTS, "error_kind": "time", "reference_gap": gap,
    }  # fmt: skip
    try:
        tips, wall, stats = made()
        row |= {key: stats[key] for key in stats if key in COLUMNS}
        row |= {"error_rel": error(tips, reference), "wall_s": wall, "status": "ok"}
        row["wall_s_per_sim_s"] = wall / times[-1]
    except tress.SolveError as failure:
        row |= {"status": "solver_error", "reason": str(failure)}
    rows.append(row)


for rtol in (1e-3, 1e-5):
    for method in ("Radau", "BDF"):
        add(f"scipy_{method.lower()}", lambda: by_scipy(method, rtol), rtol)
    for method in ("ida", "cvode_bdf", "arkode_dirk"):
        add(method, lambda: by_tress(method, rtol=rtol, atol=rtol / 100), rtol)
out = sys.argv[1] if len(sys.argv) > 1 else "solve_ivp.csv"
with open(out, "w", newline="") as file:
    table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
for row in rows:
    print(f"{row['integrator']:12} {row['rtol']:g} {row.get('error_rel', np.nan):.2e} "
          f"{row.get('wall_s', np.nan):.4f} s {row['status']}")  # fmt: skip
