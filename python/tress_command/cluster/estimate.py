"""Cost of sweeps with all rows: core hours from some of their rows, as a table."""

import math
import tempfile

from ..files import read_text
from ..messages import say
from ..number_text import precise
from .profile import DEFAULTS
from .sweep import core_hours, pilot, usual_parts

COLUMNS = (
    "experiment",
    "rows",
    "timed_rows",  # spread over all
    "cut_off_rows",  # timed rows that ran into the timeout: they take longer
    "row_s",
    "plan_s",  # of every part
    "parts",  # of about a quarter of an hour
    "core_hours",
    "memory_mb",
)
DIGITS = 3
LARGEST = 2**20  # bytes of the table


def _measured(sweep):
    with tempfile.TemporaryDirectory(prefix="tress-estimate-") as folder:
        known = pilot(sweep | {"folder": folder},
                      lambda text: say(f"{sweep['experiment']}: {text}"))
    parts = usual_parts(known, DEFAULTS["most_tasks"])
    return {
        "experiment": sweep["experiment"],
        "rows": known["rows"],
        "timed_rows": known["timed"],
        "cut_off_rows": known["cut_off"],
        "row_s": precise(known["row_s"], DIGITS),
        "plan_s": precise(known["plan_s"], DIGITS),
        "parts": parts,
        "core_hours": precise(core_hours(known, parts), DIGITS),
        "memory_mb": math.ceil(known["largest_mb"]),
    }


def _known_lines(file):
    """Returns the lines of an earlier table, by experiment."""
    if not file.exists():
        return {}
    header, *lines = read_text(file, LARGEST).strip().split("\n")
    return {line.partition(",")[0]: line for line in lines} if header == ",".join(COLUMNS) else {}


def write_estimates(sweeps, file):
    """Estimates sweeps of experiment, args, program and repository, prints each, and writes the
    table, in which other experiments keep their lines."""
    lines = _known_lines(file)
    for sweep in sweeps:
        row = _measured(sweep)
        more = "more than " if row["cut_off_rows"] else ""
        say(f"{row['experiment']}: {row['rows']} rows, {more}{row['core_hours']} core hours")
        lines[row["experiment"]] = ",".join(str(row[name]) for name in COLUMNS)
    part = file.with_name(f"{file.name}.part")
    part.write_text("\n".join([",".join(COLUMNS), *lines.values()]) + "\n", encoding="utf-8")
    part.rename(file)
    say(f"wrote {file}")
