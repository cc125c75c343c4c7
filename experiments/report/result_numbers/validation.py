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
    if cell["outcome"] == "left out":
        return "left out"
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


def _in_words(cell):
    """Returns a model and its variant in a sentence: "`der`" or "inextensible `der`"."""
    return " ".join(part for part in (cell["variant"], f"`{cell['model']}`") if part)


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


def _part(scored):
    """Returns the share of its tests that a model meets. A test that was left out is not met."""
    return scored["met"] / (scored["ran"] + len(scored["left"]))


def _scored(tables):
    """Returns, for each model, the tests that ran, how many of these it meets and those left out, the best
    model first."""
    scored = []
    for _, members in groups(cells(tables), "name"):
        ran = members[~members["outcome"].isin(["does not apply", "left out", "not judged"])]
        met = ran[ran["outcome"] == "within"]
        scored.append({"name": _coded(members.iloc[0]), "in_words": _in_words(members.iloc[0]), "ran": len(ran), "met": len(met),
                       "partly": [_id(cell) for cell in records(met) if cell["partly"] is True],
                       "left": [_id(cell) for cell in records(members[members["outcome"] == "left out"])],
                       "missed": [_missed(cell) for cell in records(ran[ran["outcome"] != "within"])]})
    return sorted((one for one in scored if one["ran"] > 0), key=lambda one: -_part(one))


def scores_table(tables):
    return table(["model", "tests that ran", "met", "of these, with some parameters refused", "not met, with the error",
                  "left out by `--quick`"],
                 [[one["name"], one["ran"], one["met"], "<br>".join(one["partly"]), "<br>".join(one["missed"]), "<br>".join(one["left"])]
                  for one in _scored(tables)])


def _joined(names):
    return " and ".join(part for part in (", ".join(names[:-1]), names[-1]) if part)


def _tests(one):
    """Returns "38 of 38 (3 slow tests left out)"."""
    return f"{one['met']} of {one['ran']}" + (f" ({counted(len(one['left']), 'slow test')} left out)" if one["left"] else "")


def scores(tables):
    """Returns the best models, those that meet every test that ran although some were left out, and the last."""
    scored = _scored(tables)
    last = scored[-1]
    best = [one for one in scored if (one["met"], one["ran"], len(one["left"])) == (scored[0]["met"], scored[0]["ran"], len(scored[0]["left"]))]
    whole = [one for one in scored if one not in best and one["met"] == one["ran"]]
    models = tables["validation"]["model"].nunique()
    return " ".join([
        f"Of the {counted(models, 'model')} and {counted(len(scored) - models, 'variant')}, {_joined([one['in_words'] for one in best])} "
        f"{'meets' if len(best) == 1 else 'meet'} the most: {_tests(best[0])}.",
        *(f"{one['in_words']} meets {_tests(one)}." for one in whole),
        f"{last['in_words']} is last and meets {_tests(last)}"])


def left_out(tables):
    """Returns how many pairs of model and test `--quick` leaves out, and of which tests."""
    left = [cell for cell in records(cells(tables)) if cell["outcome"] == "left out"]
    names = list(dict.fromkeys(_id(cell) for cell in left))
    return f"{counted(len(left), 'pair')} of model and test" + (f", of {_joined(names)}" if names else "")


def order_points(tables):
    """Returns how many curves of error against elements have enough points for an order."""
    points = groups(rows(tables, "validation_orders"), ["test", "name"])["points"].first()
    few = 2
    two = (points == few).sum()
    return (f"The table is no evidence of an order: of {len(points)} curves of error against elements, "
            f"{len(points) - two} {'has' if len(points) - two == 1 else 'have'} more than {few} element counts")
