"""A reproduction as a table of differences and as a page."""

import csv
import io
import math

from ..number_text import rounded, shortest
from .judge import EQUAL, NEAR, ORDER, ROUNDING

COLUMNS = ("table", "run_id", "row", "column", "verdict", "before", "after", "difference_rel",
           "rows", "ratio", "quartile_1", "quartile_3")
MOST_LINES = 40  # differences on the page


def _field(value):
    if value is None or value == math.inf:
        return ""
    return value if isinstance(value, str) else shortest(value)


def _times(one):
    first, middle, third = one["ratio"]
    return {"column": one["column"], "verdict": "time", "rows": one["rows"], "ratio": middle,
            "quartile_1": first, "quartile_3": third}


def csv_of(judged):
    """Returns a row for each difference, and one for each column of times."""
    out = io.StringIO()
    lines = csv.writer(out, lineterminator="\n")
    lines.writerow(COLUMNS)
    for table in judged:
        for one in (*table.found, *map(_times, table.times)):
            row = {"table": table.table} | one
            lines.writerow(_field(row.get(name)) for name in COLUMNS)
    return out.getvalue()


def counts(judged):
    """Returns the numbers of rows of each verdict that occurs, as words."""
    numbers = {verdict: sum(table.count(verdict) for table in judged) for verdict in ORDER}
    return ", ".join(f"{number} {verdict}" for verdict, number in numbers.items() if number)


def ratio_text(judged):
    """Returns the median of a table's ratios with its quartiles; of its first column of times."""
    times = [table.times[0] for table in judged if table.times]
    if len(times) != 1:
        return ""
    first, middle, third = (rounded(value, 3) for value in times[0]["ratio"])
    return f"{middle} ({first} to {third})"


def line_of(name, judged, uncertain):
    """Returns what the terminal shows of the tables of a recipe."""
    rows, agree = (sum(getattr(table, of) for table in judged) for of in ("rows", "agree"))
    other = counts(judged)
    times = ratio_text(judged)
    return (f"{name}: {agree} of {rows} rows agree" + (f", {other}" if other else "")
            + (f"; times {times}{', uncertain' if uncertain else ''}" if times else ""))


def _cell(text):
    return str(text).replace("|", "\\|").replace("\n", " ")


def table_of(head, rows):
    """Returns a table of Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(map(_cell, line))} |" for line in lines)


def _differences(judged):
    found = [(table.table, one) for table in judged for one in table.found]
    found.sort(key=lambda pair: ORDER.index(pair[1]["verdict"]))
    shown = [(name, one.get("row", ""), one.get("run_id", ""), one["verdict"], one["column"],
              _field(one.get("before")), _field(one.get("after")))
             for name, one in found if one["verdict"] != NEAR][:MOST_LINES]
    if not shown:
        return []
    left = len(found) - len(shown)
    return ["## Differences", table_of(
        ("table", "row", "run_id", "verdict", "column", "release", "here"), shown),
        *([f"`comparison.csv` has {left} more."] if left else [])]


def page_of(title, facts, groups, without):
    """Returns the page. facts: (name, of the release, here); groups: (name, judged tables, why
    their times are uncertain)."""
    rows = [(name, sum(table.rows for table in judged), sum(table.agree for table in judged),
             counts(judged), ratio_text(judged), doubts) for name, judged, doubts in groups]
    all_judged = [table for _, judged, _ in groups for table in judged]
    parts = [
        f"# {title}",
        table_of(("", "release", "here"), facts),
        "## Tables",
        table_of(("table", "rows", "agree", "others", "times here / release", "uncertain times"),
                 rows),
        f"A row agrees if its numbers differ by at most {shortest(EQUAL)} of their size and its "
        "counts and texts are equal. Times are not part of it: the table has the median ratio, "
        "with quartiles. `rounding`: where compiler, instructions or libraries differ, "
        f"{shortest(ROUNDING)} of the size, or an iteration more or less.",
        *_differences(all_judged)]
    if without:
        parts += ["## Not made again", table_of(("table", "reason"), sorted(without.items()))]
    return "\n\n".join(parts) + "\n"
