"""Claims about the tables: a query returns its sentence only while the condition holds."""
import numpy as np

from . import hard, validation
from .tables import first, records
from .words import duration, must, number, percent


def _outcome(tables, test, model):
    cells = validation.cells(tables)
    cell = first(cells[(cells["test"] == test) & (cells["model"] == model)])
    return None if cell is None else cell["outcome"]


def transport_hangs(tables):
    return must(
        _outcome(tables, "cantilever", "force_transport") == "within"
        and _outcome(tables, "beam modes", "force_transport") == "outside",
        "`force_transport` has the right equilibrium and wrong frequencies")


def equal_elements(tables):
    cells = validation.cells(tables)
    return must(
        ((cells["test"] == "cantilever uniform") & (cells["outcome"] == "outside")).sum() > 1,
        "Equal elements do not resolve a heavy hair, which bends close to the clamp: `cantilever` grades its elements "
        "there, `cantilever_uniform` does not")


def stable_not_accurate(tables):
    """Returns how many stable runs of backward Euler at its longest step are accurate, of those with a
    reference."""
    rows = hard.judged(tables)
    rows = rows[(rows["integrator"] == "backward_euler") & ~rows["by_tolerance"] & rows["survives"]]
    longest = rows["dt_s"].max()
    compared = rows[(rows["dt_s"] == longest) & rows["compared"]]
    accurate = (compared["outcome"] == "stable and accurate").sum()
    damped = ". Numerical damping keeps inaccurate runs stable" if accurate < len(compared) / 2 else ""
    return (f"At {duration(longest)}, {accurate} of the {len(compared)} stable runs of backward Euler that have a reference are "
            f"accurate ({percent(accurate / len(compared))}){damped}")


def _nodal(tables, integrator, jacobian):
    rows = tables.rows("stability_limit",
                       {"study": "nodal", "integrator": integrator, "jacobian": jacobian, "start": "space"})
    return rows.loc[rows["elements"].idxmax()]


def _held(tables, name, *keys):
    return all(tables.check(name, key)["held"] for key in keys)


def nodal_verdict(tables):
    newton = _nodal(tables, "backward_euler", "exact")["dt_max_s"]
    explicit = _nodal(tables, "velocity_verlet", "exact")["dt_max_s"]
    must(
        _held(tables, "stability_limit", "nodal_order_2_unstable", "nodal_order_1_stable") and newton > explicit,
        "the claim is true for the undamped splitting of second order only")
    return ("The claim is true for the undamped splitting of second order. The splitting of first order is stable there. Full "
            f"Newton allows steps that are {number(newton / explicit)} times longer than those of `velocity_verlet`")


def _springs(tables, integrator, block, sweeps):
    """Returns the distance of the swinging mass-spring strand from the direct step, for one block size and
    number of sweeps."""
    rows = tables.rows("block_descent", {"part": "sweeps", "model": "mass_spring", "integrator": integrator,
                                         "block": block, "sweeps": sweeps})
    plain = ~(rows["chebyshev"] > 0)
    if "anderson" in rows:  # tables of earlier versions do not have it
        plain &= ~(rows["anderson"] > 0)
    return rows[plain].iloc[0]["direct_distance_rel"]


def descent_locks(tables):
    return must(
        _held(tables, "block_descent", "nodes_lock", "whole_strand_converges")
        and _springs(tables, "vbd", 16, 20) >= 0.1,
        "Descent node by node locks: springs of a hair are so stiff that bending cannot pass through held neighbours. Blocks "
        "of several nodes lock as well. With the whole strand as a block, a step converges in a small number of sweeps")


def _penalties(tables, dt_s):
    """Returns, for each row about penalties, the penalty times the square of the step, and the distance from
    the direct step."""
    rows = tables.rows("block_descent", {"part": "penalty", "dt_s": dt_s, "primal_sweeps": 1})
    return rows["penalty_per_s2"] * rows["dt_s"]**2, rows["direct_distance_rel"].where(rows["status"] == "ok", np.inf)


def multipliers_free(tables):
    def has_window(dt_s):
        scaled, distance = _penalties(tables, dt_s)
        return ((distance <= 0.01) == ((scaled > 3) & (scaled < 15))).all()

    return must(
        _held(tables, "block_descent", "multipliers_free") and has_window(1 / 300) and has_window(1e-3)
        and (_penalties(tables, 1 / 60)[1] > 0.01).all(),
        "Multipliers that carry the stress from step to step remove the locking, if the penalty is within its window. With "
        "a smaller penalty, multipliers converge too slowly. With a larger one, nodes lock again. The window is inversely "
        "proportional to the square of the step, and closes at the longest step tried")


def map_unreached(tables):
    rows = tables.rows("block_descent", {"part": "rods", "scene": "swing"})
    return must(
        len(rows) >= 40 and ((rows["status"] == "ok") & (rows["error_rel"] > 0.01)).all(),
        "On the hair, no point of the map reaches the target error. With its real stiffness, the hair locks at every tested "
        "number of sweeps. A hair that is softened until sweeps converge is another rod. All tested points are stable")


def transport_wrong(tables):
    rows = tables.rows("force_transport", {"comparison": "modes", "scene": "weightless", "model": "force_transport"})
    ratios = rows.sort_values("elements")["slowest_ratio"]
    return must(
        (ratios > 1).all() and (ratios.diff().dropna() > 0).all(),
        "Its slowest oscillation is too fast, and refinement makes it faster: the model does not converge to the rod")


def midpoint_keeps(tables):
    rows = tables.ok_rows("validation", {"test": "free_flight", "integrator": "implicit_midpoint"})
    worst = rows.groupby("model")["angular_error_rel"].max()
    return must(
        worst["mass_spring"] < 1e-9 and worst["der"] < 1e-5 and worst["super_helix"] > 1e-9,
        "The midpoint rule keeps the angular momentum of particles to rounding, because it is bilinear in q and v. For the "
        "curvatures of a super-helix, it keeps angular momentum to second order. Models whose sections turn by an angle of their own "
        "(`der`, `dynamic_spline`) drift by the spin that their kinetic energy leaves out, whatever the step")


def small_load(tables):
    rows = tables["effect_audit"]
    return must(
        ((rows["load_over_weight"] < 0.1) & (rows["error_without_rel"] > 0.05)).any(),
        "A small load can have a large effect, because it acts all the time")


def springs_and_correction(tables):
    """Returns the length errors at the longest step with springs, with a correction, and with both."""
    strands = tables.rows("constraint_drift", {"study": "strands"})
    longest = strands["dt_s"].max()
    at = strands[strands["dt_s"] == longest]
    springs = at[(at["system"] == "mass_spring") & (at["integrator"] == "linearly_implicit_euler")].iloc[0]
    corrected = at[(at["system"] == "inextensible_strand") & (at["integrator"] == "predictor_corrector")]
    alone = corrected[corrected["variant"] == ""].iloc[0]
    both = corrected[corrected["variant"] == "stretch_springs=linear"].iloc[0]
    must(
        springs["length_error_rel"] > 0.01 and alone["status"] != "ok" and both["length_error_rel"] < 1e-6,
        "springs and a correction together hold lengths where neither does alone")
    return ("`inextensible_strand` with stretch springs and `predictor_corrector` solves implicitly with springs, then corrects the "
            f"lengths. At {duration(longest)}, this pair keeps lengths to {number(both['length_error_rel'])}. Springs alone stretch by "
            f"{percent(springs['length_error_rel'])}, and the correction alone finds no solution")


def springs_ring(tables):
    rows = tables.ok_rows("cost_of_accuracy", {"kind": "method", "scene": "release", "model": "mass_spring"})
    errors = {row["integrator"]: row["length_error_rel"] for row in reversed(records(rows))}
    midpoint, damped = errors["implicit_midpoint"], errors["generalized_alpha"]
    must(midpoint > 10 * damped, "stretch springs ring on under the midpoint rule")
    return ("With the midpoint rule, stretch springs oscillate undamped, which the tip does not show. The lengths of the falling "
            f"`mass_spring` have a relative error of {number(midpoint)}. With `generalized_alpha`, which damps, it is {number(damped)}")
