"""./tress bench: Google Benchmark programs, and their tables."""

import os
import re
from pathlib import Path

from .command import Command, read_words
from .counting import Worst
from .messages import say
from .tree import build

BRIEF = ("--benchmark_min_time=0.05", "--benchmark_repetitions=3",
         "--benchmark_enable_random_interleaving=true")


def _run(words, machine):
    more = read_words("bench", words, hint=" (options of Google Benchmark go after --)").more
    machine.ensure()
    build("bench", "benchmarks")
    os.makedirs("results", exist_ok=True)
    say("Google Benchmark's 'library was built as DEBUG' means its own assertions; the timed "
        "code is Release")
    worst = Worst()
    for program in sorted(Path("build/bench/experiments/benchmarks").iterdir()):
        if not (program.is_file() and os.access(program, os.X_OK)):
            continue
        name = Path(f"results/bench_{program.name.removeprefix('bench_')}.json")
        part = Path(f"{name}.part")
        worst.run(str(program), program, *BRIEF, f"--benchmark_out={part}",
                  "--benchmark_out_format=json", *more)
        if part.exists() and part.stat().st_size:
            # Google Benchmark writes the computer's name into the table.
            name.write_text(re.sub(r'(?m)^ *"host_name":.*\n', "", part.read_text()))
            part.unlink()
            say(f"wrote {name}")
    if worst.code:
        say(f"a benchmark failed or a requirement is not met; worst exit code {worst.code}")
    return worst.code


COMMAND = Command(
    "bench", "[-- ARGUMENTS]",
    "builds and runs the Google Benchmark programs and writes results/bench_*.json.",
    _run,
    example="./tress bench -- --benchmark_filter=solve",
    time="about five minutes after the build.",
    options=(("-- ARGUMENTS", f"options of Google Benchmark (default: {' '.join(BRIEF)})"),))
