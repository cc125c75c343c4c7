"""Sentences of the report page, as lists."""
import re

from . import catalogue
from .report import quoted, told
from .words import bullets, coded, counted, markdown, number, spaced, table

_MOST = 12  # the report page has the rest


def _told(tables, name):
    """Returns the sentences with ids as code, also those of models in words: "articulated chain"."""
    sentences = told(tables, name)
    models = {spaced(model): f"`{model}`" for model in catalogue.models(tables) if "_" in model}
    named = re.compile("|".join(sorted(models, key=len, reverse=True)))
    return [coded(named.sub(lambda found: models[found[0]], one)) for one in sentences]


def _listed(name, without=(), most=_MOST):
    """Returns a query that lists the sentences, except those with a text of `without`: the page has them as a table."""
    def query(tables):
        sentences = [one for one in _told(tables, name) if not any(text in one for text in without)]
        rest = len(sentences) - most
        more = f"The report page has {counted(rest, 'further finding')}."
        return bullets(sentences[:most] + ([more] if rest > 0 else []))

    return query


def _with_table(name, start, head, value=r"(.*?),? (\d.*)$"):
    """Returns a query whose sentences are a list, except the one that begins with `start`: "start: a 1; b 2." is a
    table with the columns `head`, a row for each part and its last words: from the first digit on, or by `value`."""
    def query(tables):
        sentences = _told(tables, name)
        long = [one for one in sentences if one.startswith(start)]
        shown = bullets([one for one in sentences if one not in long])
        for one in long:
            what, _, parts = one.rstrip(".").partition(": ")
            rows = (re.match(value, part).groups() for part in parts.split("; "))
            shown += f"\n\n{what}:\n\n{markdown(table(head, rows))}"
        return shown

    return query


bdf = _listed("bdf", without=["Steps at maximum order"])
boundary = _listed("boundary")
descent = _with_table("descent", "Distance of the tip", ["method", "distance"], r"(.*) (\S+)$")
drift = _listed("drift")
hard = _listed("hard")
cosserat_map = _listed("map")
nodal = _listed("nodal")
recovery = _listed("recovery")
scaling = _with_table("scaling", "Cost of one step on a straight strand", ["method", "exponent"])
stability = _with_table("stability", "Stable at 33 ms", ["method", "stable cases"])
swing = _listed("swing")
work = _listed("work", without=["cheapest per simulated second", "fitted order"])


def transport(tables):
    """Returns a row for each sentence "quantity: 0.1 at 5, 0.2 at 10 elements.", a column for each number of elements."""
    rows = {}
    for sentence in _told(tables, "transport"):
        quantity, parts = re.fullmatch(r"(.*): (.*) elements\.", sentence).groups()
        rows[quantity] = {int(elements): value for value, elements in (part.split(" at ") for part in parts.split(", "))}
    counts = sorted({elements for values in rows.values() for elements in values})
    return table(["quantity", *(f"{count} elements" for count in counts)],
                 [[quantity, *(values.get(count, "") for count in counts)] for quantity, values in rows.items()])


def control(tables):
    """Returns the sentences and their figure, if the table has adaptive runs."""
    found = quoted(tables, "control")
    if not found:
        return "The table has no adaptive run yet."
    return f"![Error over tolerance](../../results/tolerance.svg)\n\n{bullets(found)}"


def fields(tables):
    return table(["problem", "error", "integrators", "runs"], told(tables, "fields"))


def cheapest(tables):
    levels = (f"error {number(level)}" for level in told(tables, "work_levels"))
    return table(["problem", "integrators with a finished run", *levels], told(tables, "cheapest"))


def bdf_steps(tables):
    return table(["relative tolerance", "order 2", "order 3", "order 4", "order 5"], told(tables, "bdf_steps"))


def orders(tables):
    return table(["integrator", "problems", "median order", "lowest", "highest"],
                 [[f"`{integrator}`", *rest] for integrator, *rest in told(tables, "orders")])
