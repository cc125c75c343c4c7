"""Change that each effect of a scene makes."""
from .tables import groups, records
from .words import number, percent, spaced, table

_ACCURACY = 0.01
_LEFT_OUT = {"body": "contact with the head"}


def _judged(tables):
    rows = tables["effect_audit"]
    return rows[(rows["effect"] != "none") & (rows["verdict"] != "")]


def _change(x):
    """Returns a change in per cent, with a digit more where it would be printed as the accuracy."""
    return percent(x) if percent(x) != percent(_ACCURACY) else percent(x, 3)


def audit_table(tables):
    return table(
        ["scene", "left out", "change", "discretisation", "load / weight", "verdict"],
        [[row["scene"], _LEFT_OUT.get(row["effect"], spaced(row["effect"].removeprefix("mode "))),
          _change(row["error_without_rel"]) if row["status"] == "ok" else "does not run without it",
          percent(row["discretisation_rel"]), number(row["load_over_weight"]), row["verdict"]]
         for row in records(_judged(tables))])


def scenes(tables):
    return tables["effect_audit"]["scene"].nunique()


def verdicts(tables):
    """Returns the number of verdicts of each kind: "15 keep, 5 drop"."""
    kinds = _judged(tables)["verdict"].str.split(":").str[0]
    return ", ".join(f"{len(members)} {verdict}" for verdict, members in groups(kinds, kinds))
