"""Tables of two folders of results, compared row by row."""

import re

from ..files import read_csv, read_json
from ..messages import refuse
from ..number_text import rounded
from .intervals import spread, verdict

DIGITS = 5
CONFIDENCE = 0.99
# These follow from timings, or repeat what other columns state.
NOT_COMPARED = ("run_id", "pareto", "rank", "reason")
# Units of time at the end or inside of a name: more of such a column is slower.
TIME = re.compile(r"(^|_)(s|ms|us|ns)(_|$)")
LONGEST_LABEL = 60  # characters of a cell that labels a row
LABELS = 8


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def manifest_of(folder, table):
    """Returns the manifest of a table, {} if it has none."""
    path = folder / f"{table}.meta.json"
    found = read_json(path) if path.exists() else {}
    if not isinstance(found, dict):
        refuse(f"{path}: not a JSON object; write it again or remove it")
    return found


class Table:
    """A table: names of columns, rows, columns of timings, and the machine that made it."""

    def __init__(self, folder, name):
        self.names, self.rows = read_csv(folder / f"{name}.csv")
        self.manifest = manifest_of(folder, name)
        self.timings = self.manifest.get("timings", [])
        machine = self.manifest.get("machine")
        self.machine = machine and f"{machine.get('cpu')}, {machine.get('simd')}"

    @classmethod
    def read(cls, folder, name):
        """Returns None if the folder has no such table."""
        return cls(folder, name) if (folder / f"{name}.csv").exists() else None


def _cell(value):
    return rounded(value, DIGITS) if is_number(value) else str("" if value is None else value)


def keyed(table, shared, words):
    """Returns rows by what identifies them: run_id, or, in tables without, the columns of
    words. Equal keys are told apart by their order."""
    seen, rows = {}, {}
    for row in table.rows:
        if "run_id" in shared:
            key = row["run_id"]
        else:
            key = ", ".join(_cell(row[name]) for name in words)
        count = seen[key] = seen.get(key, 0) + 1
        rows[key if count == 1 else f"{key} #{count}"] = row
    return rows


def label(row, words):
    """Returns what a reader knows a row by."""
    texts = [_cell(row[name]) for name in words]
    return ", ".join([text for text in texts if 0 < len(text) < LONGEST_LABEL][:LABELS])


def _changed(name, row, other, values, words):
    changed = [column for column in values if _cell(row[column]) != _cell(other[column])]
    if not changed:
        return []
    change = "; ".join(f"{c}: {_cell(row[c])} -> {_cell(other[c])}" for c in changed)
    return [{"table": name, "row": label(row, words), "column": " ".join(changed),
             "verdict": "changed value", "change": change}]


def _compare_table(name, before, after, threshold):
    """Returns rows with a verdict, and the number of rows whose values agree."""
    shared = [column for column in before.names if column in after.names]
    timings = list(dict.fromkeys([*before.timings, *after.timings]))
    values = [column for column in shared
              if column not in timings and column not in NOT_COMPARED]
    words = [column for column in values if any(
        row[column] is not None and not is_number(row[column]) for row in before.rows)]
    of_before, of_after = (keyed(table, shared, words) for table in (before, after))
    rows, pairs, changed = [], [], 0
    for key, row in of_before.items():
        if key not in of_after:
            rows.append({"table": name, "row": label(row, words), "verdict": "only before"})
            continue
        pairs.append((row, of_after[key]))
        found = _changed(name, row, of_after[key], values, words)
        changed += len(found)
        rows += found
    rows += [{"table": name, "row": label(row, words), "verdict": "only after"}
             for key, row in of_after.items() if key not in of_before]
    rows += _compare_times(name, before, after, pairs, timings, threshold)
    return rows, len(pairs) - changed


def _judged(verdict_of_all, before, after):
    comparable = before.machine is not None and before.machine == after.machine
    return verdict_of_all if comparable else "other machine"


def _compare_times(name, before, after, pairs, timings, threshold):
    """Returns a row for each column of times. A row is timed once, so its ratio has no
    interval; all rows of a table together have one."""
    rows = []
    for column in filter(TIME.search, timings):
        ratios = [other[column] / row[column] for row, other in pairs if all(
            is_number(one.get(column)) and one[column] > 0 for one in (row, other))]
        if ratios:
            interval = spread(ratios, CONFIDENCE)
            judged = _judged(verdict(interval, threshold), before, after)
            rows.append({"table": name, "row": f"median of {len(ratios)} rows",
                         "column": column, **interval, "verdict": judged})
    return rows


class Benchmarks:
    """Stored benchmarks, as ./tress bench writes them: times of repetitions, and the machine."""

    def __init__(self, file):
        stored = read_json(file)
        self.times = {}
        for one in stored["benchmarks"]:
            if one["run_type"] == "iteration" and not one.get("error_occurred"):
                self.times.setdefault(one["run_name"], []).append(one["cpu_time"])
        self.machine = f"{stored['context'].get('cpu')}, {stored['context'].get('simd')}"


def _compare_stored(name, before, after, threshold):
    """Returns a row for each benchmark, of every pairing of the repetitions. They did not take
    turns, so that only a ratio beyond the threshold in all pairings is a verdict."""
    rows = []
    for row, of_before in before.times.items():
        if row not in after.times:
            rows.append({"table": name, "row": row, "verdict": "only before"})
            continue
        ratios = sorted(b / a for b in after.times[row] for a in of_before)
        low, high = ratios[0], ratios[-1]
        judged = "slower" if low > threshold else "faster" if high < 1 / threshold else "same"
        rows.append({"table": name, "row": row, "column": "cpu_time",
                     "ratio": ratios[len(ratios) // 2], "low": low, "high": high,
                     "verdict": _judged(judged, before, after)})
    return rows


def compare_results(a, b, threshold):
    """Returns rows with a verdict of all tables, and a line for each table."""
    rows, lines = [], []
    for file in sorted(a.glob("*.csv")):
        before, after = (Table.read(folder, file.stem) for folder in (a, b))
        if after is None:
            rows.append({"table": file.stem, "row": "", "verdict": "only before"})
            lines.append(f"{file.stem}: no such table after")
            continue
        found, agree = _compare_table(file.stem, before, after, threshold)
        rows += found
        lines.append(f"{file.stem}: {agree} of {len(before.rows)} rows agree")
    for file in sorted(a.glob("bench_*.json")):
        if not (b / file.name).exists():
            rows.append({"table": file.name, "row": "", "verdict": "only before"})
        else:
            rows += _compare_stored(file.name, Benchmarks(file), Benchmarks(b / file.name),
                                    threshold)
    return rows, lines


def has_tables(folder):
    """True for a folder of results."""
    return any(re.search(r"\.csv$|^bench_\w+\.json$", path.name) for path in folder.iterdir())
