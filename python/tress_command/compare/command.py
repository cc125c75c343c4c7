"""./tress compare A B: two folders of results, two builds or two commits."""

import math
import re
from pathlib import Path
from typing import NamedTuple

from ..messages import ROWS_FAILED, refuse, say
from .benchmarks import FEWEST_ROUNDS, MORE_ROUNDS, compare_benchmarks
from .page import counts, csv_of, page_of, summary
from .sides import built, side_of
from .tables import compare_results

DEFAULTS = {"--threshold": "1.05", "--rounds": "10", "--filter": ".", "--min-time": "0.01",
            "--out": ""}
BAD = ("slower", "changed value", "only before")


class Options(NamedTuple):
    """Options of a comparison; min_time in s."""

    threshold: float
    rounds: int
    filter: str
    min_time: float
    out: str


def _number(given, name, least, most):
    text = given[name]
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not least <= value <= most:
        refuse(f"compare: {name} {text}: give a number from {least} to {most}")
    return value


def _read_words(words):
    """Returns the two sides and the options."""
    sides, given, words = [], dict(DEFAULTS), list(words)
    while words:
        word = words.pop(0)
        if not word.startswith("-"):
            sides.append(word)
            continue
        if word not in DEFAULTS:
            refuse(f"compare: unknown option '{word}'; there are {', '.join(DEFAULTS)}")
        if not words:
            refuse(f"compare: {word} without a value; give one")
        given[word] = words.pop(0)
    if len(sides) != 2:
        refuse("compare: give two: results, builds or commits, as in "
               "./tress compare HEAD~1 HEAD")
    return sides, Options(
        threshold=_number(given, "--threshold", 1.001, 100),
        rounds=round(_number(given, "--rounds", FEWEST_ROUNDS, 1000)),
        filter=given["--filter"],
        min_time=_number(given, "--min-time", 0.0001, 100),
        out=given["--out"])


def _compared(sides, options, sundials):
    """Returns rows with verdicts, and how they were found."""
    a, b = sides
    if (a.kind == "results") != (b.kind == "results"):
        refuse(f"compare: {a.name} and {b.name}: one is a folder of results, the other is built "
               "and timed; give two of one kind")
    if a.kind == "results":
        rows, lines = compare_results(a.folder, b.folder, options.threshold)
        for line in lines:
            print(line)
        return rows, (
            "Values agree to five digits. Times are of single rows: their median over a table is "
            "judged, where both are of one kind of processor.")
    a, b = (built(side, sundials()) if side.kind == "commit" else side for side in sides)
    rows = compare_benchmarks(a.folder, b.folder, options, say)
    return rows, (
        f"Processor time of {options.rounds} rounds in turns; median ratio and an interval that "
        "encloses it with 99 %, whatever the noise. What was off by half of "
        f"{options.threshold:g} was timed again, in {MORE_ROUNDS} times the rounds, and the "
        "second time counts.")


def _short(name):
    """Returns a name for files: without folders and signs."""
    return re.sub(r"[^\w.-]+", "_", Path(name).resolve().name, flags=re.ASCII) or "results"


def compare(words, sundials):
    """Compares, writes table and page, and prints what is slower. sundials(): the copy of
    SUNDIALS to build commits with."""
    texts, options = _read_words(words)
    sides = [side_of(text) for text in texts]
    rows, how = _compared(sides, options, sundials)
    stem = options.out or f"{Path('results/compare').resolve()}/{'--'.join(map(_short, texts))}"
    Path(stem).parent.mkdir(parents=True, exist_ok=True)
    Path(f"{stem}.csv").write_text(csv_of(rows), encoding="utf-8")
    Path(f"{stem}.html").write_text(page_of(*texts, rows, how), encoding="utf-8")
    for row in rows:
        if row["verdict"] == "slower":
            print(f"slower: {row['table']} {row['row']} {row['column']}: {row['ratio']:.3f} "
                  f"times ({row['low']:.3f} to {row['high']:.3f})")
    print(f"{summary(rows)} -> {stem}.html")
    return ROWS_FAILED if any(one in BAD for one in counts(rows)) else 0
