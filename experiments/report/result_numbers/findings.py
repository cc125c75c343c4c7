"""Sentences of the report page, as lists."""
from .report import quoted, told
from .words import bullets, counted, table

_MOST = 12  # the report page has the rest


def _listed(name, most=_MOST):
    def query(tables):
        sentences = told(tables, name)
        rest = len(sentences) - most
        more = f"{counted(rest, 'more sentence')} {'is' if rest == 1 else 'are'} on the report page."
        return bullets(sentences[:most] + ([more] if rest > 0 else []))

    return query


bdf = _listed("bdf")
boundary = _listed("boundary")
descent = _listed("descent")
drift = _listed("drift")
hard = _listed("hard")
cosserat_map = _listed("map")
models = _listed("models")
nodal = _listed("nodal")
recovery = _listed("recovery")
scaling = _listed("scaling")
stability = _listed("stability")
swing = _listed("swing")
transport = _listed("transport")
# Sorted by success: without its end the list would leave out the models that fail.
validation = _listed("validation", most=1000)
work = _listed("work")


def control(tables):
    """Returns the sentences and their figure, if the table has adaptive runs."""
    found = quoted(tables, "control")
    if not found:
        return "The table has no adaptive run yet."
    return f"![Error over tolerance](../../results/tolerance.svg)\n\n{bullets(found)}"


def fields(tables):
    return table(["problem", "error", "integrators", "runs"], told(tables, "fields"))


def orders(tables):
    return table(["integrator", "problems", "median order", "lowest", "highest"], told(tables, "orders"))
