"""Errors and cost of gradients of runs."""
import numpy as np

from .tables import first, groups, known, records
from .words import must, number, percent, plain, span, table

_COARSE = 10  # elements of the runs in time
_OTHER_STEPS = 40  # of runs without the damped start, and with the elastic Jacobian
_KINKED = ["mass_spring", "inextensible_strand"]
_DEFAULT = {"part": "time", "start": "damped", "jacobian": "exact"}


def _measured(tables, selected):
    rows = tables.rows("cost_of_gradient", selected)
    return rows[known(rows["gradient_error_rel"])]


def _smooth(tables):
    rows = _measured(tables, _DEFAULT)
    return rows[~rows["model"].isin(_KINKED)]


def _kinked_names():
    return " and ".join(f"`{name}`" for name in _KINKED)


def smooth_models(tables):
    """Returns the models that statements about all models are about."""
    return f"the {_smooth(tables)['model'].nunique()} models other than {_kinked_names()}"


def _work(tables, column):
    """Returns the linearizations for a target: a row for each model, a column for each method."""
    rows = tables.rows("cost_of_gradient", _DEFAULT)
    return rows.pivot_table(index="model", columns="integrator", values=column, aggfunc="first", sort=False, dropna=False)


def _work_table(tables, column):
    work = _work(tables, column).dropna(how="all").dropna(axis=1, how="all")
    lines = [[model, *("" if np.isnan(x) else number(x, 3) for x in line)] for model, line in zip(work.index, work.values)]
    return table(["model", *(f"`{method}`" for method in work.columns)], lines)


def work_1_percent(tables):
    return _work_table(tables, "linearizations_1_percent")


def work_001_percent(tables):
    return _work_table(tables, "linearizations_001_percent")


def _advice(tables, column):
    """Returns the method whose linearizations are never far from the fewest, among those that reach the target on every model."""
    tried = _work(tables, column).dropna(how="all")
    work = tried.dropna(axis=1, how="any") if tried.notna().all().any() else tried
    over = work.div(tried.min(axis=1), axis=0).max()
    best = over.idxmin()
    population = f"of these {len(tried)} models"
    compared = (f"On each {population}, no other method needs fewer" if over[best] == 1 else
                f"On each {population}, that is at most {number(over[best], 3)} times the number of the best method")
    return f"take `{best}`. It needs {span(work[best], lambda x: number(x, 3))} linearizations of the run and its derivatives. {compared}"


def tight_target(tables):
    must(_work(tables, "linearizations_001_percent").notna().any().any(), "some method reaches it")
    return percent(1e-4)


def advice_1_percent(tables):
    return _advice(tables, "linearizations_1_percent")


def advice_001_percent(tables):
    return _advice(tables, "linearizations_001_percent")


def _finest(rows):
    return rows[rows["steps"] == rows["steps"].max()]


def backward_euler(tables):
    rows = _smooth(tables)
    rows = _finest(rows[rows["integrator"] == "backward_euler"])
    tip = rows["tip_error_rel"]
    return (f"with {plain(rows['steps'].iloc[0])} steps, the error of its gradient is {span(rows['gradient_error_rel'], percent)} on these "
            f"{rows['model'].nunique()} models. The error of its tip is {span(tip, percent)} of the length")


def _space(tables):
    return _measured(tables, {"part": "space"})


def _rods(tables):
    """Rows in space of models that converge to the rod with all its strains."""
    rows = _space(tables)
    return rows[~rows["model"].isin(_not_converging(rows))]


def _not_converging(rows):
    """Models whose error does not fall by half with four times the elements."""
    return [model for model, members in groups(rows, "model")
            if not members["gradient_error_rel"].iloc[-1] < 0.5 * members["gradient_error_rel"].iloc[0]]


def space_first(tables):
    rows = _rods(tables)
    rows = rows[(rows["elements"] == _COARSE) & (rows["model"] != "super_clothoid")]
    time = _smooth(tables)
    time = time[(time["integrator"] == "tr_bdf2") & (time["steps"] == _OTHER_STEPS) & time["model"].isin(rows["model"])]
    must(time["gradient_error_rel"].max() < rows["gradient_error_rel"].min(), "space limits the gradient")
    return (f"with {_COARSE} elements, the error in space is {span(rows['gradient_error_rel'], percent)} for {len(rows)} models that "
            f"converge to the rod. `super_clothoid` is left out, because it needs fewer elements. The error in time of these models, "
            f"with `tr_bdf2` and {_OTHER_STEPS} steps, is {span(time['gradient_error_rel'], percent)}")


def reference_gap(tables):
    return percent(_space(tables)["reference_gap"].max())


def kinked(tables):
    rows = _measured(tables, _DEFAULT)
    rows = _finest(rows[rows["model"].isin(_KINKED)])
    must(rows["linearizations_1_percent"].isna().all(), "kinked models do not reach 1 %")
    return (f"{_kinked_names()} reach neither target: with {plain(rows['steps'].iloc[0])} steps, the smallest error of their gradients is "
            f"{percent(rows['gradient_error_rel'].min())}. Every statement about errors in time leaves them out, unless it names them.")


def over_tip(tables):
    rows = _smooth(tables)
    ratio = rows["gradient_error_rel"] / rows["tip_error_rel"]
    return (f"On {smooth_models(tables)}, the relative error of the gradient is {number(ratio.min())} to {number(ratio.max())} times "
            f"the error of the tip over the length. The median over their methods and steps is {number(ratio.median())}.")


def _by_method_and_steps(rows):
    """Returns a row for each method, a column for each number of steps: error of the tip over the length, largest other error."""
    steps = sorted(rows["steps"].unique())
    lines = []
    for method, members in groups(rows, "integrator"):
        cells = {row["steps"]: f"{percent(row['tip_error_rel'])}, {percent(row['gradient_error_rel'])}" for row in records(members)}
        lines.append([f"`{method}`", *(cells.get(one, "") for one in steps)])
    return table(["method", *(f"{plain(one)} steps" for one in steps)], lines)


def by_steps(tables):
    """Errors of `super_helix`: of the tip over the length, and of the gradient."""
    rows = _smooth(tables)
    return _by_method_and_steps(rows[rows["model"] == "super_helix"])


def in_space(tables):
    rows = _space(tables)
    counts = sorted(rows["elements"].unique())
    lines = [[model, *(percent(row["gradient_error_rel"]) for row in records(members.sort_values("elements")))]
             for model, members in groups(rows, "model")]
    return table(["model", *(f"{plain(count)} elements" for count in counts)], lines)


def not_converging(tables):
    names = _not_converging(_space(tables))
    must(names, "some models do not converge to the rod")
    return (f"The gradients of {', '.join(f'`{name}`' for name in names)} do not converge to those of the rod "
            "with more elements.")


def other_steps(tables):
    must(not _measured(tables, {"part": "time", "start": "as_run", "steps": _OTHER_STEPS}).empty, "runs without the damped start")
    return number(_OTHER_STEPS)


def starts(tables):
    """Largest error over the smooth models with the start of the run itself, next to that with a damped start."""
    def at(start):
        rows = _measured(tables, {**_DEFAULT, "start": start, "steps": _OTHER_STEPS})
        return rows[~rows["model"].isin(_KINKED)]

    damped, as_run = at("damped"), at("as_run")
    lines = []
    for method, members in groups(as_run, "integrator"):
        with_start = damped[damped["integrator"] == method]["gradient_error_rel"]
        worst = members.loc[members["gradient_error_rel"].idxmax()]
        lines.append([f"`{method}`", percent(with_start.max()), percent(worst["gradient_error_rel"]), f"`{worst['model']}`"])
    return table(["method", "with the damped start, worst of these models", "without it, worst of these models", "worst model without it"], lines)


def elastic(tables):
    rows = _measured(tables, {"part": "time", "jacobian": "elastic", "steps": _OTHER_STEPS})
    exact = _smooth(tables).set_index(["model", "integrator", "steps"])["gradient_error_rel"]
    ratio = {key: row / exact[key] for key, row in rows.set_index(["model", "integrator", "steps"])["gradient_error_rel"].items()}
    worst = max(ratio, key=ratio.get)
    models = list(dict.fromkeys(key[0] for key in ratio))
    return (f"the error with {_OTHER_STEPS} steps is {number(min(ratio.values()))} to {number(max(ratio.values()))} times that with the "
            f"exact one. The largest ratio is that of `{worst[0]}` with `{worst[1]}`. The compared models are "
            f"{', '.join(f'`{model}`' for model in models)}")


def _contact(tables):
    return _measured(tables, {"part": "contact"})


def contact_models(tables):
    return ", ".join(f"`{model}`" for model in _contact(tables)["model"].unique())


def contact(tables):
    rows = _contact(tables)
    steps = sorted(rows["steps"].unique())
    lines = []
    for (law, method), members in groups(rows, ["law", "integrator"]):
        cells = {row["steps"]: percent(row["gradient_error_rel"]) for row in records(members)}
        lines.append([law, f"`{method}`", *(cells.get(one, "") for one in steps), percent(_finest(members)["tip_error_rel"].iloc[0])])
    return table(["law", "method", *(f"{plain(one)} steps" for one in steps), f"tip, {plain(steps[-1])} steps"], lines)


def _exact(rows):
    euler = rows[rows["integrator"] == "backward_euler"].set_index("law")["gradient_error_rel"]
    exact = euler[euler.index.str.startswith("exact")]
    if exact.empty:
        return ""
    return (f" With `backward_euler`, the error of the gradient is {span(exact, percent)} through exact contact and "
            f"{span(euler[euler.index.str.startswith('regularised')], percent)} through regularised contact.")


def contact_verdict(tables):
    rows = _finest(_contact(tables))
    fine = rows[(rows["integrator"] != "backward_euler") & rows["law"].str.startswith("regularised")]
    ratio = fine["gradient_error_rel"] / fine["tip_error_rel"]
    return (f"The gradient through regularised contact is exact for its run. But in a finer run, contacts open and close at other steps. "
            f"With {plain(rows['steps'].iloc[0])} steps and methods of higher order, its relative error is {span(ratio, lambda x: number(x, 2))} times "
            f"that of the tip. The error depends irregularly on the step: compare runs with different steps.{_exact(rows)}")


_FITTED = {"modulus_error_rel": "Young's modulus", "friction_error_rel": "internal friction", "drag_error_rel": "drag",
           "curvature_error_rel": "natural curvature"}


def _fits(tables):
    return _measured(tables, {"part": "fit"})


def fit_model(tables):
    return ", ".join(f"`{model}`" for model in _fits(tables)["model"].unique())


def fit_by_backward_euler(tables):
    """Returns how far the values that backward Euler fits are off, and how well its tip fits."""
    rows = _fits(tables)
    row = first(rows[(rows["integrator"] == "backward_euler") & (rows["steps"] == 2 * _OTHER_STEPS)])
    worst = max(_FITTED, key=lambda column: row[column])
    return (f"With `backward_euler` and {plain(row['steps'])} steps, the fitted {_FITTED[worst]} is {percent(row[worst])} off, although the tip of the "
            f"fitted run is within {percent(row['tip_error_rel'])} of the length of the record")


def fits(tables):
    """Errors of fits: of the tip over the length, and the largest of the four fitted values."""
    return _by_method_and_steps(_fits(tables))
