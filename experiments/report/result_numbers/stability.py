"""Largest stable steps."""
from decimal import Decimal

from .tables import first, groups, records
from .words import duration, exponential, is_number, must, number, plain, table


def _step(row):
    if row is None:
        return "not searched"
    if row["status"] == "gave_up":
        unstable = row["dt_first_unstable_s"]
        return f"< {duration(unstable)}" if unstable > 0 else "inconclusive"
    if not row["dt_max_s"] > 0:
        return "none found"
    # Nothing unstable was met up to the longest step of the scene.
    return f"{'≥ ' if row['limited_by'] == 'cap' else ''}{duration(row['dt_max_s'])}"


_HELIX = {"study": "grid", "model": "super_helix", "solver": "recursive", "modes": "bend_twist"}
_WAYS = [("linearly_implicit_euler", "elastic"), ("linearly_implicit_euler", "elastic_local"), ("linearly_implicit_euler", "exact"),
         ("backward_euler", "exact")]
_DAMPED = [("none", "none"), ("light", "light"), ("published", "published")]


def super_helix_table(tables):
    """Returns the steps of `super_helix` with 20 elements: a row for each scene and damping, a column for
    each way to step."""
    lines = []
    for scene, members in groups(tables.rows("stability_limit", {**_HELIX, "elements": 20}), "scene"):
        for damping, words in _DAMPED:
            here = members[members["damping"] == damping]
            if not here.empty:
                found = (first(here[(here["integrator"] == integrator) & (here["jacobian"] == jacobian)])
                         for integrator, jacobian in _WAYS)
                lines.append([scene, words, *map(_step, found)])
    return table(["scene", "friction", *(f"`{integrator}`, {jacobian} Jacobian" for integrator, jacobian in _WAYS)], lines)


def shaken_stiff(tables):
    """Returns the largest steps of the shaken undamped hair with the papers' method."""
    rows = tables.ok_rows("stability_limit", {**_HELIX, "scene": "shake", "damping": "none",
                                              "integrator": "linearly_implicit_euler", "jacobian": "elastic"})
    rows = rows.sort_values("elements", kind="stable")
    few, many = rows.iloc[0], rows.iloc[-1]
    must(many["dt_max_s"] >= few["dt_max_s"], "more elements do not shorten the step")
    return (f"{duration(few['dt_max_s'])} with {few['elements']} element{'' if few['elements'] == 1 else 's'} and "
            f"{duration(many['dt_max_s'])} with {many['elements']}")


def _usual(members, scene, integrator):
    """Returns the run of a model that the table shows: all modes, and the elastic Jacobian if there is one."""
    rows = members[(members["scene"] == scene) & (members["integrator"] == integrator) & (members["modes"] != "bend")]
    if integrator == "linearly_implicit_euler" and (members["jacobian"] == "elastic").any():
        rows = rows[rows["jacobian"] != "exact"]
    return first(rows)


def models_table(tables):
    """Returns the largest steps of every strand model with 20 elements."""
    rows = tables.rows("stability_limit", {"study": "grid", "elements": 20, "damping": "none", "scene": ["release", "shake"]})
    rows = rows[~rows["jacobian"].str.contains("elastic_local")]
    return table(
        ["model", "release: linearly implicit", "release: backward Euler", "shake: linearly implicit", "shake: backward Euler"],
        [[f"`{model}`", *(_step(_usual(members, scene, integrator)) for scene in ("release", "shake")
                          for integrator in ("linearly_implicit_euler", "backward_euler"))]
         for model, members in groups(rows, "model")])


_USUAL_TOLERANCE = "1e-3"
_NOT_FOUND = {"gave_up": "inconclusive", "unstable": "none found"}


def tolerance_table(tables):
    """Returns the loosest and the tightest stable tolerance, by scene and model."""
    rows = tables.rows("stability_limit", {"study": "tolerance"})
    if rows.empty:
        return "The table has no such rows yet."

    def asked(tolerance):
        return exponential(Decimal(repr(float(tolerance)))) if is_number(tolerance) and tolerance > 0 else ""

    return table(
        ["scene", "model", "integrator", "elements", "loosest", "tightest", f"steps at {_USUAL_TOLERANCE}",
         f"work at {_USUAL_TOLERANCE}"],
        [[row["scene"], f"`{row['model']}`", f"`{row['integrator']}`", row["elements"],
          _NOT_FOUND.get(row["status"]) or asked(row["tolerance_loosest"]), asked(row["tolerance_tightest"]),
          plain(row["steps_usual"]) if row["steps_usual"] > 0 else "", number(row["work_usual"]) if row["work_usual"] > 0 else ""]
         for row in records(rows)])


def errors_table(tables):
    """Returns the total error of every model on the released hair, at its finest step. A model whose runs
    break off at all of these is not in the table."""
    counts = [10, 20, 40]
    rows = tables.ok_rows("work_precision", {"scene": "strand_release", "error_kind": "total",
                                             "integrator": "implicit_midpoint", "elements": counts})
    finest = rows.sort_values("dt_s", kind="stable").drop_duplicates(["model", "elements"])
    errors = finest.set_index(["model", "elements"])["error_rel"]
    return table(["model", *(f"{count} elements" for count in counts)],
                 [[f"`{model}`", *(number(errors.get((model, count))) for count in counts)] for model in rows["model"].unique()])
