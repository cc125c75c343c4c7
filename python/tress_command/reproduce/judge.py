"""A reproduced table against that of the release, row by row.

Values: relative difference of at most EQUAL. A count or a text must be equal. Where the
arithmetic differs (compiler, flags, instructions, libraries), a difference that rounding explains
is "rounding" and not a change. Times: ratios, without a verdict."""

import math
import re
from statistics import quantiles
from typing import NamedTuple

from ..compare.tables import DIGITS, NOT_COMPARED, TIME, Table, is_number, keyed, label

# Numbers of tables have all their digits. The same instructions give the same bits; the room is
# for libraries of the system that choose instructions by the processor.
EQUAL = 1e-9
# Of a column with _rel in its name, whatever the size of the number: fifty roundings (2e-16
# each) of the scale to which it is relative.
NOISE = 1e-14
# Of other arithmetic: the digits that ./tress compare compares.
ROUNDING = 10.0**-DIGITS
OUTCOMES = ("status", "outcome", "passed", "verdict", "holds", "failure")
# Rows that are the best of several by measured time, and the columns that name the choice.
CHOSEN_BY_TIME = {
    "cost_of_accuracy": ("model", "integrator", "formulation", "modes", "jacobian", "solver",
                         "options", "refresh", "elements", "mesh", "extrapolated", "dt_s",
                         "position_tol_rel"),
    "head_accuracy": ("guides", "elements", "dt_s", "precision"),
}
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")

OUTCOME, VALUE, MISSING, CLAIM = "changed outcome", "changed value", "missing", "changed claim"
CHOICE, FRESH, NEAR = "other choice", "new", "rounding"
BAD = (OUTCOME, VALUE, MISSING, CLAIM)
ORDER = (CLAIM, OUTCOME, VALUE, MISSING, CHOICE, NEAR, FRESH)


class Judged(NamedTuple):
    """A compared table: differences and times as dictionaries, and numbers of rows."""

    table: str
    rows: int
    agree: int
    found: list
    times: list

    def count(self, verdict):
        """Returns the number of rows with a verdict."""
        return len({one["key"] for one in self.found if one["verdict"] == verdict})

    def bad(self):
        """True if something of the release was not reproduced."""
        return any(one["verdict"] in BAD for one in self.found)


def arithmetic(manifest):
    """Returns what decides the last digits of a table, by name."""
    build, machine = manifest.get("build") or {}, manifest.get("machine") or {}
    facts = {name: " ".join(str(build.get(name)).split()) for name in ("compiler", "flags")}
    facts |= {"widest instructions": machine.get("simd"), "kernels": machine.get("kernels")}
    return facts | {f"library {name}": version
                    for name, version in (manifest.get("libraries") or {}).items()}


def other_arithmetic(before, after):
    """Returns a text for each part of the arithmetic that differs."""
    a, b = arithmetic(before), arithmetic(after)
    return [f"{name}: {a.get(name)} -> {b.get(name)}"
            for name in {**a, **b} if a.get(name) != b.get(name)]


def difference(a, b):
    """Returns the relative difference of two cells; infinity if they have none."""
    if a == b:
        return 0.0
    if is_number(a) and is_number(b):
        return abs(a - b) / max(abs(a), abs(b))
    return math.inf


def _equal(name, a, b, whole):
    """True if two cells are equal up to the last digits."""
    if whole or not (is_number(a) and is_number(b)):
        return a == b
    return difference(a, b) <= EQUAL or ("_rel" in name and abs(a - b) <= NOISE)


def _near(name, a, b, whole):
    """True if rounding of other arithmetic explains a difference."""
    if is_number(a) and is_number(b):
        # An iteration more or less. A relative error has the scale of the problem.
        small = abs(a - b) <= (1 if whole else EQUAL if "_rel" in name else 0)
        return small or (not whole and difference(a, b) <= ROUNDING)
    return isinstance(a, str) and isinstance(b, str) and NUMBER.sub("#", a) == NUMBER.sub("#", b)


def judge_cell(name, a, b, whole, same):
    """Returns the verdict on a cell, "" if it agrees. whole: the column holds whole numbers;
    same: so is the arithmetic."""
    if _equal(name, a, b, whole):
        return ""
    if not same and name not in OUTCOMES and _near(name, a, b, whole):
        return NEAR
    return OUTCOME if name in OUTCOMES else VALUE


def whole_columns(names, *tables):
    """Returns the columns all of whose numbers are whole."""
    rows = [row for table in tables for row in table.rows]
    return {name for name in names if all(
        not is_number(row.get(name)) or row[name] == int(row[name]) for row in rows)}


def compared_columns(before, after):
    """Returns the columns whose values are compared, and those of times."""
    timings = list(dict.fromkeys([*before.timings, *after.timings]))
    values = [name for name in before.names
              if name in after.names and name not in timings and name not in NOT_COMPARED]
    times = [name for name in timings if TIME.search(name)
             and name in before.names and name in after.names]
    return values, times


def ratios(row, other, columns):
    """Returns the ratios of the times of two rows, by column."""
    return {name: other[name] / row[name] for name in columns if all(
        is_number(one.get(name)) and one[name] > 0 for one in (row, other))}


def quartiles(values):
    """Returns the first quartile, the median and the third quartile."""
    return tuple(values * 3) if len(values) == 1 else tuple(
        quantiles(values, n=4, method="inclusive"))


def _explained(found, chosen):
    """Returns the differences of a row; another choice by time explains the others."""
    other = any(one["column"] in chosen for one in found)
    if other and not any(one["verdict"] == OUTCOME for one in found):
        return [one | {"verdict": CHOICE} for one in found]
    return found


def _absent(table, key):
    """Returns the verdict on a row that only the release has. A search by time finds more rows
    or fewer, which follow that of their case."""
    return CHOICE if table in CHOSEN_BY_TIME and "." in key else MISSING


def _claims(before, after):
    """Returns the claims whose state changed, as differences. A claim that now holds is none."""
    def states(manifest):
        return {one.get("key") or one["claim"]: one for one in manifest.get("checks", ())}

    now, found = states(after.manifest), []
    for key, one in states(before.manifest).items():
        a, b = one.get("state"), now.get(key, {}).get("state")
        if b != a and "figure" not in (a, b) and b != "held":
            found.append({"key": f"claim {key}", "row": one["claim"], "column": "claim",
                          "verdict": CLAIM, "before": a, "after": b})
    return found


def judge_table(name, before, after):
    """Compares a table of the release with the reproduced one."""
    values, times = compared_columns(before, after)
    same = not other_arithmetic(before.manifest, after.manifest)
    whole = whole_columns(values, before, after)
    words = [column for column in values if any(
        row[column] is not None and not is_number(row[column]) for row in before.rows)]
    shared = [column for column in before.names if column in after.names]
    old, new = (keyed(table, shared, words) for table in (before, after))
    found, paired, agree = _claims(before, after), {column: [] for column in times}, 0
    for key, row in old.items():
        title = {"key": key, "run_id": row.get("run_id") or "", "row": label(row, words)}
        if key not in new:
            found.append(title | {"column": "", "verdict": _absent(name, key)})
            continue
        cells = [title | {"column": column, "verdict": verdict, "before": row[column],
                          "after": new[key][column],
                          "difference_rel": difference(row[column], new[key][column])}
                 for column in values if (verdict := judge_cell(
                     column, row[column], new[key][column], column in whole, same))]
        agree += not cells
        found += _explained(cells, CHOSEN_BY_TIME.get(name, ()))
        for column, ratio in ratios(row, new[key], times).items():
            paired[column].append(ratio)
    found += [{"key": key, "run_id": row.get("run_id") or "", "row": label(row, words),
               "column": "", "verdict": FRESH} for key, row in new.items() if key not in old]
    return Judged(name, len(old), agree, found,
                  [{"column": column, "rows": len(ratio), "ratio": quartiles(ratio)}
                   for column, ratio in paired.items() if ratio])


def judge(name, release, reproduced):
    """Compares the tables of two folders; a table that is not there has no rows."""
    before, after = Table.read(release, name), Table.read(reproduced, name)
    if after is None:
        return Judged(name, len(before.rows), 0, [
            {"key": "", "row": "the whole table", "column": "", "verdict": MISSING}], [])
    return judge_table(name, before, after)
