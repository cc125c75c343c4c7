"""The air drag of a swinging hair from a record of its tip, by scipy.optimize."""

import numpy as np
import scipy.optimize
import tress

times = np.linspace(0, 0.3, 31)[1:]


def tip(drag):
    strand = tress.model("super_helix", elements=5, modes="bend_planar", drag_kg_m_s=drag)
    run = tress.Integrator("implicit_midpoint", strand, step=2e-3).start()
    record = []
    for t in times:
        run.advance(t)
        record.append(strand.points(t, run.q)[-1, 2])
    return np.array(record)


true = 2e-5
noise = 1e-5 * np.random.default_rng(1).standard_normal(times.size)
record = tip(true) + noise
# The logarithm: drag is positive.
fit = scipy.optimize.least_squares(
    lambda x: (tip(np.exp(x[0])) - record) / 1e-5, [np.log(1e-5)], diff_step=1e-3
)
found = np.exp(fit.x[0])
spread = found / np.linalg.norm(fit.jac[:, 0])
print(f"drag {found:.4g} +- {spread:.1g} kg/(m s), was {true:g}")
