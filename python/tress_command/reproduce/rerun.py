"""./tress rerun: one row of a table again."""

import re
import shutil
from pathlib import Path

from ..command import Command, read_words
from ..compare.tables import Table
from ..files import read_text
from ..messages import (BAD_INPUT, DONE, INTERNAL_ERROR, INTERRUPTED, ROWS_FAILED, Ended, refuse,
                        say)
from ..number_text import rounded, shortest
from ..processes import run
from ..tree import RELEASE, configure
from ..version import commit_of
from .command import alone, release_of
from .judge import (NEAR, compared_columns, difference, judge_cell, other_arithmetic, ratios,
                    whole_columns)
from .recipes import compile_programs, recipe_of, tables_of, workplace

FOLDER = Path("build/rerun")
RUN_ID = re.compile(r"[0-9a-f]{16}(\.\d{3,})?")
WIDEST = 40  # characters of a cell


def row_of(table, run_id):
    """Returns the row of a table with a run_id, or None."""
    return next((row for row in table.rows if row.get("run_id") == run_id), None)


def tables_with(folder, run_id):
    """Returns the tables that have a row."""
    return [name for name in tables_of(folder)
            if run_id in read_text(folder / f"{name}.csv") and row_of(
                Table.read(folder, name), run_id)]


def _text(value):
    text = "" if value is None else value if isinstance(value, str) else shortest(value)
    return text if len(text) <= WIDEST else text[:WIDEST - 3] + "..."


def notes_of(before, after, run_id):
    """Returns column, old value, new value and a note for each cell, and whether all agree."""
    old, new = row_of(before, run_id), row_of(after, run_id)
    values, times = compared_columns(before, after)
    whole = whole_columns(values, before, after)
    same = not other_arithmetic(before.manifest, after.manifest)
    ratio, lines, agree = ratios(old, new, times), [], True
    for name in before.names:
        a, b, note = old[name], new.get(name), ""
        if name in values:
            verdict = judge_cell(name, a, b, name in whole, same)
            if verdict and b in (None, ""):
                note = "needs the whole table"
            elif verdict:
                apart = difference(a, b)
                note = verdict + (f", {rounded(apart, 2)} of its size" if 0 < apart < 2 else "")
                agree &= verdict == NEAR
        elif name in ratio:
            note = f"time, {rounded(ratio[name], 3)} times"
        if _text(a) or _text(b):
            lines.append((name, _text(a), _text(b), note))
    return lines, agree


def print_columns(lines):
    """Prints lines of cells, aligned."""
    widths = [max(len(line[k]) for line in lines) for k in range(3)]
    for line in lines:
        print("  ".join([*(cell.ljust(width) for cell, width in zip(line, widths)),
                         line[3]]).rstrip())


def _work(release):
    """Returns an empty workplace that keeps the references of the release."""
    shutil.rmtree(FOLDER / "results", ignore_errors=True)
    work, results = workplace(FOLDER)
    if (release / "reference").is_dir():
        shutil.copytree(release / "reference", results / "reference")
    return work, results


def _read(words):
    """Returns the run_id and the place of its table."""
    given = read_words("rerun", words, valued=("--in",), names=True)
    if len(given.names) != 1:
        refuse("rerun: give one run_id, as in ./tress rerun d7ff59fbcddbcdc9")
    (run_id,) = given.names
    if not RUN_ID.fullmatch(run_id):
        refuse(f"rerun: '{run_id}' is no run_id; give the 16 hexadecimal digits of that column")
    return run_id, given.options.get("--in", "results")


def _again(release, table, run_id):
    """Runs the row again. Returns the table that has it."""
    recipe, why = recipe_of(release, table)
    if recipe is None:
        refuse(f"rerun: {table} cannot be made here: {why}")
    compile_programs([recipe])
    work, results = _work(release)
    words = (*recipe.words, "--run-id", run_id, "--progress", "none")
    code = run(recipe.program, *words, cwd=work)
    if code not in (DONE, ROWS_FAILED):
        raise Ended(code if code in (BAD_INPUT, INTERRUPTED) else INTERNAL_ERROR,
                    f"rerun: exit code {code} of: {recipe.program} {' '.join(words)}")
    after = Table.read(results, table)
    if after is None or row_of(after, run_id) is None:
        raise Ended(ROWS_FAILED, f"rerun: {recipe.program} did not write the row {run_id}")
    return after


def _rerun(run_id, where, machine):
    release = release_of(where, FOLDER / "release", "rerun: --in")
    tables = tables_with(release, run_id)
    if not tables:
        refuse(f"rerun: no row of {where} has the run_id {run_id}")
    if len(tables) > 1:
        say(f"rerun: also in {' '.join(tables[1:])}")
    before = Table.read(release, tables[0])
    machine.ensure()
    configure(RELEASE)
    there, here = (before.manifest.get("git") or {}).get("commit", ""), commit_of(Path.cwd())
    if there != here:
        say(f"rerun: the row is of commit {there[:8]}, this is {here[:8] + here[40:]}; results "
            "may differ")
    after = _again(release, tables[0], run_id)
    lines, agree = notes_of(before, after, run_id)
    print_columns([(tables[0], "release", "here", ""), *lines])
    print("the row agrees" if agree else "THE ROW DIFFERS")
    return DONE if agree else ROWS_FAILED


def _run(words, machine):
    run_id, where = _read(words)
    with alone(FOLDER):
        return _rerun(run_id, where, machine)


RERUN = Command(
    "rerun", "[--in RELEASE] RUN_ID",
    "computes one row of a table again, and prints its old and new values. RUN_ID is the "
    "column run_id of the row. Exit code 3 if they differ. docs/reproduce.md describes it.",
    _run,
    example="./tress rerun d7ff59fbcddbcdc9",
    time="seconds for most rows after the build; minutes where references are computed first.",
    options=(("--in RELEASE", "folder or archive with the table (default: results)"),))
