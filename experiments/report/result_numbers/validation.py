"""Published tests of slender rods."""
from .report import rows
from .tables import groups, known, records
from .words import coded, counted, is_number, number, table

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
    if cell["outcome"] == "no solution":
        return "**no solution**"
    error, accepted = cell["error_pct"], cell["tolerance_pct"]
    small = error < _LEAST_PCT and is_number(accepted) and accepted >= 10 * _LEAST_PCT
    text = f"< {_LEAST_PCT}" if small else number(error)
    text += " (in part)" if cell["partly"] is True else ""
    if cell["failed"] is True:
        return f"**{text}, a run failed**"
    return f"**{text}**" if cell["outcome"] == "outside" else text


def _coded(cell):
    """Returns a model and its variant: "`der`" or "`der`, inextensible"."""
    return f"`{cell['model']}`" + (f", {cell['variant']}" if cell["variant"] else "")


def _id(cell):
    """Returns the id of a test, as in the table: figures have blanks in place of underscores."""
    return f"`{cell['test'].replace(' ', '_')}`"


def tests_table(tables):
    """Returns what each test loads and measures, and the source of its reference."""
    tests_of = tables.manifest("validation")["glossary"]["test"]
    return table(["test", "strand and load", "quantity", "reference and source"],
                 [[f"`{name}`", *(coded(test[key]).replace("|", "\\|").replace(" beside ", " next to ") for key in ("what", "quantity", "source"))]
                  for name, test in tests_of.items()])


def matrix(tables):
    """Returns tests as rows, models as columns: the largest error of the judged runs in per cent."""
    all_cells = cells(tables)
    names = {cell["name"]: _coded(cell) for cell in records(all_cells)}
    lines = []
    for test, members in groups(all_cells, "test"):
        by_name = {cell["name"]: cell for cell in records(members)}
        tolerances = members["tolerance_pct"][known(members["tolerance_pct"])]
        lines.append([_id({"test": test}), number(next(iter(tolerances), None)), *(_shown(by_name.get(name)) for name in names)])
    return table(["test", "accepted", *names.values()], lines)


def _missed(cell):
    if cell["outcome"] == "no solution":
        return f"{_id(cell)} (no solution)"
    why = "a run failed" if cell["failed"] is True else f"{number(cell['error_pct'])} %"
    return f"{_id(cell)} ({why})"


def _scored(tables):
    """Returns, for each model, the tests that it can run and how many of these it meets, the best model
    first."""
    all_cells = cells(tables)
    judged = all_cells[~all_cells["outcome"].isin(["does not apply", "not judged"])]
    scored = []
    for _, members in groups(judged, "name"):
        met = members[members["outcome"] == "within"]
        partly = [_id(cell) for cell in records(met) if cell["partly"] is True]
        missed = [_missed(cell) for cell in records(members[members["outcome"] != "within"])]
        scored.append({"name": _coded(members.iloc[0]), "all": len(members), "met": len(met), "partly": partly, "missed": missed})
    return sorted(scored, key=lambda one: -one["met"] / one["all"])


def scores_table(tables):
    return table(["model", "tests that it can run", "met", "of these, with some parameters refused", "not met, with the error"],
                 [[one["name"], one["all"], one["met"], "<br>".join(one["partly"]), "<br>".join(one["missed"])]
                  for one in _scored(tables)])


def scores(tables):
    """Returns the best and the last of all models."""
    scored = _scored(tables)
    best, last = scored[0], scored[-1]
    models = tables["validation"]["model"].nunique()
    return (f"Of the {counted(models, 'model')} and {counted(len(scored) - models, 'variant')}, {best['name']} is the best: it meets "
            f"{best['met']} of the {best['all']} tests that it can run. {last['name']} is last and meets {last['met']} of {last['all']}")


def order_points(tables):
    """Returns how many curves of error against elements have enough points for an order."""
    points = groups(rows(tables, "validation_orders"), ["test", "name"])["points"].first()
    few = 2
    two = (points == few).sum()
    return (f"The table is no evidence of an order: of {len(points)} curves of error against elements, "
            f"{len(points) - two} {'has' if len(points) - two == 1 else 'have'} more than {few} element counts")
