"""Benchmarks of two builds, timed in turns, so that both see the same machine."""

import json
import math
import re
import subprocess
import tempfile
from pathlib import Path

from ..messages import refuse
from ..processes import run
from .intervals import fewest, spread, verdict

CONFIDENCE = 0.99
# Rounds of what is timed again, alone, over those of the first look: there are few such rows.
MORE_ROUNDS = 3
FEWEST_ROUNDS = fewest(CONFIDENCE)


def _literal(name):
    """Returns a regular expression that matches this name only."""
    return re.sub(r"[.*+?^${}()|\[\]\\]", r"\\\g<0>", name)


def _programs_in(folder):
    return sorted(path.name for path in folder.iterdir() if re.fullmatch(r"bench_\w+", path.name))


def _times(program, pattern, min_time):
    """Returns the processor time of each benchmark, by name, of one run of a program: the
    shortest of three, for other work of the machine only adds time, and not often."""
    with tempfile.TemporaryDirectory(prefix="tress-compare-") as folder:
        out = Path(folder) / "out.json"
        try:
            why = run(program, f"--benchmark_filter={pattern}",
                      f"--benchmark_min_time={min_time}", "--benchmark_repetitions=3",
                      f"--benchmark_out={out}", "--benchmark_out_format=json",
                      stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                      stderr=subprocess.DEVNULL)
        except OSError as error:
            why = error.strerror
        if not out.exists():
            why = f"exit code {why}" if isinstance(why, int) else why
            refuse(f"compare: {program}: wrote no timings ({why}); run it by hand")
        # The file is empty if nothing matches the filter.
        text = out.read_text()
        times = {}
        for one in json.loads(text)["benchmarks"] if text else ():
            if one["run_type"] == "iteration" and not one.get("error_occurred"):
                name = one["name"]
                times[name] = min(one["cpu_time"], times.get(name, math.inf))
        return times


def _ratios(a, b, pattern, rounds, min_time, say):
    """Returns ratios b/a by benchmark, and the benchmarks that one side lacks. The two take
    turns, and who begins alternates."""
    found, only_a, only_b = {}, {}, {}
    for k in range(rounds):
        say(k)
        times = {}
        for side in (b, a) if k % 2 else (a, b):
            times[side] = _times(side, pattern, min_time)
        for name, time in times[b].items():
            if name in times[a]:
                found.setdefault(name, []).append(time / times[a][name])
            else:
                only_b[name] = True
        only_a.update(dict.fromkeys(name for name in times[a] if name not in times[b]))
    return found, only_a, only_b


def _judged(a, b, options, say):
    """Returns the verdict of each benchmark of two programs, and the benchmarks that one lacks.

    The first rounds only look: of ten ratios the interval goes from the least to the largest,
    so that a single disturbed round would hide what is slower. Whatever is off by half the
    threshold is measured once more, alone and in more rounds, and the second measurement
    counts: of hundreds of rows some are off by chance.
    """
    def measure(what, pattern, rounds):
        return _ratios(a, b, pattern, rounds, options.min_time, lambda k: say(
            f"{a.name}, {what}: round {k + 1} of {rounds}"))

    found, only_a, only_b = measure("timings", options.filter, options.rounds)
    judged = {row: spread(values, CONFIDENCE) | {"verdict": "same"}
              for row, values in found.items()}
    half = math.sqrt(options.threshold)
    suspected = [row for row, one in judged.items() if not 1 / half <= one["ratio"] <= half]
    if suspected:
        exactly = f"^({'|'.join(map(_literal, suspected))})$"
        again, *_ = measure(f"{len(suspected)} again", exactly, MORE_ROUNDS * options.rounds)
        for row in suspected:
            interval = spread(again[row], CONFIDENCE)
            judged[row] = interval | {"verdict": verdict(interval, options.threshold)}
    return judged, only_a, only_b


def compare_benchmarks(a, b, options, say):
    """Returns the rows of all benchmarks of two folders."""
    rows = []
    programs_a, programs_b = _programs_in(a), _programs_in(b)
    for name in programs_a:
        if name not in programs_b:
            rows.append({"table": name, "row": "", "verdict": "only before"})
            continue
        judged, only_a, only_b = _judged(a / name, b / name, options, say)
        rows += [{"table": name, "row": row, "column": "cpu_time"} | one
                 for row, one in judged.items()]
        rows += [{"table": name, "row": row, "verdict": "only before"} for row in only_a]
        rows += [{"table": name, "row": row, "verdict": "only after"} for row in only_b]
    rows += [{"table": name, "row": "", "verdict": "only after"}
             for name in programs_b if name not in programs_a]
    return rows
