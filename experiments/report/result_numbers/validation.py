"""Published tests of slender rods."""
from .report import rows
from .tables import groups, known, records
from .words import counted, is_number, number, table

# Nobody cares how much less, unless less is accepted.
_LEAST_PCT = 1e-3


def cells(tables):
    """Returns a row for every model and test: the largest error of its judged runs in per cent, and its
    outcome."""
    return rows(tables, "validation_cells")


def tests(tables):
    return cells(tables)["test"].nunique()


def _shown(cell):
    if cell is None or cell["outcome"] == "does not apply":
        return ""
    if cell["outcome"] == "no answer":
        return "**no answer**"
    error, accepted = cell["error_pct"], cell["tolerance_pct"]
    small = error < _LEAST_PCT and is_number(accepted) and accepted >= 10 * _LEAST_PCT
    text = f"< {_LEAST_PCT}" if small else number(error)
    text += " (in part)" if cell["partly"] is True else ""
    if cell["lost"] is True:
        return f"**{text}, a run lost**"
    return f"**{text}**" if cell["outcome"] == "outside" else text


def matrix(tables):
    """Returns tests as rows, models as columns: the largest error of the judged runs in per cent."""
    all_cells = cells(tables)
    names = all_cells["name"].unique()
    lines = []
    for test, members in groups(all_cells, "test"):
        by_name = {cell["name"]: cell for cell in records(members)}
        tolerances = members["tolerance_pct"][known(members["tolerance_pct"])]
        lines.append([test, number(next(iter(tolerances), None)), *(_shown(by_name.get(name)) for name in names)])
    return table(["test", "accepted", *names], lines)


def _scored(tables):
    """Returns, for each model, the tests that it can run and how many of these it meets, the best model
    first."""
    all_cells = cells(tables)
    told = all_cells[~all_cells["outcome"].isin(["does not apply", "not judged"])]
    scored = []
    for name, members in groups(told, "name"):
        met = members[members["outcome"] == "within"]
        partly = [cell["test"] for cell in records(met) if cell["partly"] is True]
        scored.append({"name": name, "all": len(members), "met": len(met), "partly": partly})
    return sorted(scored, key=lambda one: -one["met"] / one["all"])


def scores_table(tables):
    return table(["model", "tests that it can run", "met", "of these, with some parameters refused"],
                 [[one["name"], one["all"], one["met"], ", ".join(one["partly"])] for one in _scored(tables)])


def scores(tables):
    """Returns the best and the last of all models: "super clothoid meets 37 of the 37 tests"."""
    scored = _scored(tables)
    best, last = scored[0], scored[-1]
    models = tables["validation"]["model"].nunique()
    return (f"Of the {counted(models, 'model')} and {counted(len(scored) - models, 'variant')}, the best is {best['name']}. It meets "
            f"{best['met']} of the {best['all']} tests that it can run. The last, {last['name']}, meets {last['met']} of {last['all']}")


def order_points(tables):
    """Returns how many curves of error against elements have enough points for an order."""
    points = groups(rows(tables, "validation_orders"), ["test", "name"])["points"].first()
    few = 2
    two = (points == few).sum()
    return (f"Of {len(points)} curves, {len(points) - two} {'has' if len(points) - two == 1 else 'have'} more than {few} element counts. The other {two} "
            f"are dashed, and their slope is no evidence of an order")
