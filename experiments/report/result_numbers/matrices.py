"""Matrices of systems at an instant."""
from .tables import positive, records
from .words import number, span, table

_COLUMNS = ["model", "matrix", "rows", "entries", "derivatives", "asymmetry", "condition"]


def _strands(tables):
    rows = tables["matrices"]
    return rows[rows["elements"] > 0]


def _lines(rows):
    return [[f"`{row['model']}`", row["matrix"], number(row["rows"]), number(row["nonzeros"]), row["derivatives"],
             *([number(row["asymmetry_rel"]), number(row["condition"])] if row["rows"] == row["cols"] else ["", ""])]
            for row in records(rows)]


def strands_table(tables):
    return table(_COLUMNS, _lines(_strands(tables)))


def others_table(tables):
    return table(_COLUMNS, _lines(tables.rows("matrices", {"elements": 0})))


def _stiffness(tables):
    rows = _strands(tables)
    return rows[(rows["matrix"] == "K") & positive(rows["frequency_least_hz"])]


def frequencies_table(tables):
    return table(["model", "lowest frequency (Hz)", "highest (Hz)"],
                 [[f"`{row['model']}`", number(row["frequency_least_hz"]), number(row["frequency_largest_hz"])]
                  for row in records(_stiffness(tables))])


def lowest_frequencies(tables):
    """Returns the range of the lowest frequencies in the table above."""
    found = _stiffness(tables)["frequency_least_hz"]
    return f"{span(found)} Hz over {len(found)} models, a factor of {number(found.max() / found.min())}"
