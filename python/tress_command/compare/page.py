"""A comparison as a table and as a page."""

import csv
import io
import math
from html import escape

from ..number_text import rounded, shortest

COLUMNS = ("table", "row", "column", "ratio", "low", "high", "verdict", "change")
# Verdicts, the most important first.
ORDER = ("slower", "changed value", "only before", "faster", "only after", "other machine",
         "same")
STYLE = """:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 80rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; padding: .3rem .8rem .3rem 0; border-bottom: 1px solid #8886;
         vertical-align: top; }
.number { text-align: right; white-space: nowrap; }
td:nth-child(n + 3) { overflow-wrap: anywhere; }
td:first-child { white-space: nowrap; }
:is(.slower, .changed-value, .only-before) td:first-child { font-weight: 600; }
svg line { stroke: currentColor; stroke-opacity: .4; }
svg .interval { stroke-opacity: 1; stroke-width: 2; }
svg circle { fill: currentColor; }
"""


def _field(value):
    if value is None or value == math.inf:
        return ""
    return value if isinstance(value, str) else shortest(value)


def csv_of(rows):
    """Returns the rows as a table."""
    out = io.StringIO()
    lines = csv.writer(out, lineterminator="\n")
    lines.writerow(COLUMNS)
    lines.writerows([_field(row.get(name)) for name in COLUMNS] for row in rows)
    return out.getvalue()


def counts(rows):
    """Returns verdicts that occur, with their number, the most important first."""
    numbers = {one: sum(row["verdict"] == one for row in rows) for one in ORDER}
    return {one: number for one, number in numbers.items() if number}


def summary(rows):
    """Returns the counts as words."""
    return ", ".join(f"{number} {one}" for one, number in counts(rows).items()) or (
        "nothing to compare")


def _number(value):
    """Returns three significant digits, or the sign of infinity."""
    return "∞" if value == math.inf else rounded(value, 3)


def _place(ratio):
    """Returns the place of a ratio: from 1/2 to 2 across 160 units; the line is 1."""
    if ratio in (0, math.inf):
        return 160.0 if ratio else 0.0
    return 80 + 80 * max(-1, min(1, math.log2(ratio)))


def _drawn(row):
    x, left, right = (f"{_place(row[name]):.1f}" for name in ("ratio", "low", "high"))
    return (
        '<svg width="160" height="12" viewBox="0 0 160 12" role="img" '
        'aria-label="ratio and its interval"><line x1="80" x2="80" y2="12"/>'
        f'<line class="interval" x1="{left}" x2="{right}" y1="6" y2="6"/>'
        f'<circle cx="{x}" cy="6" r="3"/></svg>')


def _line(row):
    ratio = interval = drawn = ""
    if "ratio" in row:
        ratio = _number(row["ratio"])
        interval = f"{_number(row['low'])} to {_number(row['high'])}"
        drawn = _drawn(row)
    what = row.get("change", row.get("column", ""))
    words = "".join(f"<td>{escape(text)}</td>"
                    for text in (row["verdict"], row["table"], row["row"], what))
    return (
        f'<tr class="{row["verdict"].replace(" ", "-")}">{words}'
        f'<td class="number">{ratio}</td><td class="number">{interval}</td><td>{drawn}</td></tr>')


def page_of(a, b, rows, how):
    """Returns a page that needs nothing else, sorted by importance."""
    title = escape(f"{b} compared with {a}")
    ordered = sorted(rows, key=lambda row: (ORDER.index(row["verdict"]), -row.get("ratio", 0)))
    lines = "\n".join(map(_line, ordered))
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
{STYLE}</style></head><body><main>
<h1>{title}</h1>
<p>{escape(summary(rows))}. {escape(how)} A ratio above 1: more time after than before.
Drawn from half to twice; the upright line is 1.</p>
<table><thead><tr><th>verdict</th><th>table</th><th>row</th><th>what</th><th class="number">ratio</th>
<th class="number">interval</th><th>drawn</th></tr></thead>
<tbody>{lines}</tbody></table>
</main></body></html>
"""
