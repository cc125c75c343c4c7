"""Hard cases that each model and integrator survives."""
import re

from . import report
from .tables import groups, records
from .words import code, duration, percent, span, table


def judged(tables):
    """Returns a row for each case, model, integrator and step or tolerance: the best variant counts."""
    return report.rows(tables, "hard_judged")


def counted(tables):
    """Returns every run with the outcome that its error supports. `cut` is the number of steps after which a
    quick run stopped, or 0."""
    return report.rows(tables, "hard_rows")


def cases(tables):
    return tables["hard_cases"]["case"].nunique()


def pairs(tables):
    return len(judged(tables)[["case", "model"]].drop_duplicates())


def pace(row):
    """Returns the step of a row, or its tolerance."""
    return row["pace"] if row["by_tolerance"] else duration(row["dt_s"])


def outcomes_table(tables):
    rows = judged(tables).assign(position_tol_rel=lambda all_rows: all_rows["position_tol_rel"].fillna(0))
    rows = rows.sort_values(["by_tolerance", "position_tol_rel", "dt_s"], kind="stable")
    lines = []
    for _, members in groups(rows, ["pace", "integrator"]):
        count = members["outcome"].value_counts()
        lines.append([pace(members.iloc[0]), f"`{members.iloc[0]['integrator']}`", len(members) - count.get("refused", 0),
                      *(count.get(outcome, 0) for outcome in
                        ("stable and accurate", "stable", "stable, not compared", "unstable", "not finished"))])
    return table(["step or tolerance", "integrator", "pairs that can run", "stable and accurate", "stable, inaccurate",
                  "stable, no reference", "unstable", "not finished"], lines)


def million_steps(tables):
    """Returns the steps at which `million_steps` runs to its end, and how its shorter runs count."""
    rows = counted(tables)
    rows = rows[rows["case"] == "million_steps"]
    cut = rows[rows["cut"] > 0]
    if cut.empty:
        return "All runs of `million_steps` go to its end"
    whole = [duration(dt) for dt in rows[rows["cut"] == 0]["dt_s"].unique()]
    where = f"only at steps of {' and '.join(whole)}" if whole else "at no step"
    return (f"The case `million_steps` runs to its end {where}. All its other runs stop after {cut.iloc[0]['cut']} steps, and count "
            "only if they fail before")


def super_helix(tables):
    """Returns the cases that `super_helix` with `backward_euler` survives at each step."""
    rows = judged(tables)
    rows = rows[(rows["model"] == "super_helix") & (rows["integrator"] == "backward_euler") & (rows["outcome"] != "refused")]
    words = []
    for dt, members in sorted(groups(rows, "dt_s"), reverse=True):
        lost = [f"`{case}`" for case in members["case"][~members["survives"]]]
        words.append(f"At steps of {duration(dt)}, it survives {len(members) - len(lost)} of {len(members)} cases"
                     + (f". It fails in {', '.join(lost)}" if lost else ""))
    return ". ".join(words)


def survivors(tables):
    """Returns the models that survive most cases with `backward_euler` at its longest step, and `super_helix`."""
    rows = judged(tables)
    rows = rows[~rows["by_tolerance"] & (rows["outcome"] != "refused") & (rows["integrator"] == "backward_euler")]
    longest = rows["dt_s"].max()
    counts = [(model, members["survives"].sum(), len(members)) for model, members in groups(rows[rows["dt_s"] == longest], "model")
              if len(members) > _FEW]
    counts.sort(key=lambda one: -one[1] / one[2])
    shown = [one for k, one in enumerate(counts) if k < _BEST or one[0] == "super_helix"]
    return (f"at steps of {duration(longest)}, "
            + ", ".join(f"`{model}` {'survives ' if k == 0 else ''}{kept} of {of}{' cases' if k == 0 else ''}"
                        for k, (model, kept, of) in enumerate(shown)))


def _at_longest_step(tables, integrator):
    rows = judged(tables)
    rows = rows[~rows["by_tolerance"] & (rows["outcome"] != "refused")]
    rows = rows[(rows["integrator"] == integrator) & (rows["dt_s"] == rows["dt_s"].max())]
    return f"`{integrator}` survives {rows['survives'].sum()} of {len(rows)} and is accurate in {(rows['outcome'] == 'stable and accurate').sum()}"


def guarded(tables):
    """Returns what `guarded` and `backward_euler` survive at the longest step, over all models."""
    longest = duration(judged(tables)["dt_s"].max())
    return (f"Of the pairs of case and model that each method can run at steps of {longest}, {_at_longest_step(tables, 'guarded')}. "
            f"{_at_longest_step(tables, 'backward_euler')}")


def longest_step(tables):
    rows = judged(tables)
    return duration(rows[~rows["by_tolerance"]]["dt_s"].max())


def accepted(tables):
    """Returns the largest error of an accurate run."""
    return span(judged(tables)["error_limit"].dropna(), percent)


def criteria_table(tables):
    """Returns the criterion of each case; cases with the same criterion share a row."""
    rows = tables["hard_cases"]
    return table(["cases", "a run passes if"], [[code(members["case"].unique()), criterion]
                                                for criterion, members in groups(rows, "criterion")])


def longest_step_table(tables, cases=None):
    """Returns, for each method at the longest step: survivors, accurate runs, and the errors of survivors. `cases`: those
    counted; all by default."""
    rows = judged(tables)
    rows = rows[~rows["by_tolerance"] & (rows["outcome"] != "refused")]
    if cases:
        rows = rows[rows["case"].isin(cases)]
    lines = []
    for integrator, members in groups(rows[rows["dt_s"] == rows["dt_s"].max()], "integrator"):
        compared = members[members["survives"] & members["outcome"].isin(["stable", "stable and accurate"])]
        low, middle, high = (percent(compared["error_rel"].quantile(share)) for share in (0.1, 0.5, 0.9))
        accurate = (members["outcome"] == "stable and accurate").sum()
        lines.append([f"`{integrator}`", f"{members['survives'].sum()} of {len(members)}", f"{accurate} of {len(compared)}",
                      middle, f"{low} and {high}"])
    return table(["method", "survives, of the pairs that it can run", "accurate, of the survivors with a reference",
                  "median error of these", "lowest and highest decile"], lines)


# Models of fewer cases are not compared. So many are named.
_FEW, _BEST = 10, 3

# Cases of contact by a regularised law, and the same by the exact one: within the step of
# the strand, and by impulses after it.
_CONTACT = {"grazing_contact": ["grazing_exact", "grazing_impulse"],
            "cone": ["cone_exact", "cone_impulse"],
            "coil_contact": ["coil_impulse"]}


def _contact_cases():
    return [name for regularised, exact in _CONTACT.items() for name in (regularised, *exact)]


def contact_cases(_tables):
    return code(_contact_cases())


def longest_step_contact_table(tables):
    """Returns longest_step_table() of the cases with contact."""
    return longest_step_table(tables, _contact_cases())


_OUTCOMES = {"stable": "stable, inaccurate", "stable, not compared": "stable, no reference"}


def friction_table(tables):
    """Returns outcomes of `backward_euler` at its longest step, with the number of Newton iterations."""
    rows = judged(tables)
    rows = rows[(rows["integrator"] == "backward_euler") & ~rows["by_tolerance"]]
    longest = rows["dt_s"].max()
    names = _contact_cases()
    rows = rows[rows["case"].isin(names)]
    models = rows["model"].unique()
    rows = rows[(rows["dt_s"] == longest) & (rows["outcome"] != "refused")]
    shown = {(row["model"], row["case"]): f"{_OUTCOMES.get(row['outcome'], row['outcome'])} ({row['newton_iterations']:.0f})"
             if row["survives"] else row["outcome"] for row in reversed(records(rows))}
    lines = [[f"`{model}`", *(shown.get((model, name), "") for name in names)] for model in models]
    return table(["model", *(f"`{name}`" for name in names)], [line for line in lines if any(line[1:])])


def _fallen(tables):
    """Yields the runs that fail with a regularised law, each with the same run by the exact laws."""
    rows = records(judged(tables))
    by_run = {(row["case"], row["model"], row["integrator"], row["pace"]): row for row in reversed(rows)}
    for regularised, exact in _CONTACT.items():
        for row in rows:
            if row["case"] == regularised and row["outcome"] in ("unstable", "not finished"):
                others = [by_run.get((name, row["model"], row["integrator"], row["pace"])) for name in exact]
                yield row, [other for other in others if other is not None]


def _tried(exact):
    return [row for row in exact if row["outcome"] != "refused"]


def _rises(exact):
    return any(row["survives"] for row in exact)


def rising_count(tables):
    """Returns how many of these survive by an exact law, of those that an exact law can run."""
    able = sum(bool(_tried(exact)) for _, exact in _fallen(tables))
    return f"{tables.count('hard_cases', 'exact_contact_survives')} of {able}"


_WHY_NOT = {
    "its work was done": "not finished within the work limit",
    "speed": "faster than the root can drive it",
    "reach": "tip farther from the root than the strand is long",
    "energy": "gains energy at the impact",
    "penetration_over_bound": "penetrates deeper than allowed",
    "overlap_over_radius": "parts pass through each other",
}


def _unavailable(row, exact):
    """Returns the methods that have an exact law where this one has none, or another reason of
    the refusals."""
    methods = {}
    for one in exact:
        problem, _, remedy = one["why"].partition(": use ")
        if "=" in problem:  # an option of the model
            return f"refused: {problem}"
        methods |= dict.fromkeys(re.findall(r"\w+", remedy.replace(" or ", ", ")))
    return f"not available with `{row['integrator']}`, but with {code(methods)}"


def _ending(row, exact):
    """Returns whether an exact law survives, or why the best of them does not."""
    if _rises(exact):
        return "**survives**"
    if not _tried(exact):
        return _unavailable(row, exact)
    best = min(_tried(exact), key=lambda one: one["rank"])
    what = re.split(r" at t = |: | = ", best["why"])[0]
    return f"`{best['case']}`: {_WHY_NOT.get(what, what)}"


def rising_table(tables):
    """Returns the models that survive by an exact law, and the reasons of the others, by case, method and
    step."""
    models = {}
    for row, exact in _fallen(tables):
        line = (f"`{row['case']}`", f"`{row['integrator']}`", pace(row), _ending(row, exact))
        models.setdefault(line, {})[row["model"]] = None
    return table(["fails by a regularised law", "integrator", "step or tolerance", "by the exact law", "models"],
                 [[*line, code(names)] for line, names in models.items()])


def _broken_at_shorter(tables):
    """Returns the cases that break at a shorter step but hold at a longer one, one for each combination of
    case, model and integrator, and the number of combinations with two steps or more."""
    rows = judged(tables)
    rows = rows[~rows["by_tolerance"] & (rows["outcome"] != "refused")]
    compared = [(case, members.sort_values("dt_s")) for (case, _, _), members in groups(rows, ["case", "model", "integrator"])
                if len(members) > 1]
    broken = []
    for case, members in compared:
        unstable = members["outcome"] == "unstable"
        if unstable.any() and members["survives"][unstable.argmax():].any():
            broken.append(case)
    return broken, len(compared)


def broken_at_shorter_count(tables):
    broken, compared = _broken_at_shorter(tables)
    return f"{len(broken)} of {compared} ({percent(len(broken) / compared)})"


def broken_at_shorter(tables):
    return ", ".join(f"`{case}`" for case in dict.fromkeys(_broken_at_shorter(tables)[0]))
