"""Spoils one line of the sources at a time and runs the tests: do they notice?

    run.py --check                  checks that every mutant of mutants.txt fits its file
    run.py [--all] [--only PATTERN] builds a copy of the sources in build/mutants, spoils and
                                    tests it; writes results/mutants.csv

A mutant is killed when one of its tests fails, crashes or runs out of time. The tests run on the
unspoilt copy first: a test that fails there kills nothing. Results are kept in
build/mutants/found.json, so an interrupted run continues where it was. A killed mutant is tried
again when its file changes or with --all (after tests were removed), a survivor when anything
changes. Exit codes: 0 at least 95 % are killed, 2 a mutant does not fit, 3 too few are killed or
one does not compile."""
import csv
import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COPY = ROOT / "build/mutants"
TREE = COPY / "build/release"
LIST = "tests/mutants/mutants.txt"
WANTED = 0.95
TEST_LIMIT_S = 300
NO_LIMIT_S = 1e6


class Misfit(Exception):
    """What is wrong (where): what to do."""


@dataclass(frozen=True)
class Mutant:
    file: str
    tests: tuple[str, ...]
    before: str
    after: str
    line: int  # from 1

    @property
    def key(self):
        return f"{self.file}: {self.before} -> {self.after}"


def read_lines(path):
    return path.read_text(encoding="utf-8").split("\n")


def line_of(file, text, place):
    found = [number for number, line in enumerate(read_lines(ROOT / file), start=1) if line.strip() == text]
    if len(found) != 1:
        raise Misfit(f'{len(found)} lines of {file} read "{text}" ({place}): give a line that stands there once')
    return found[0]


def read_mutants():
    mutants, file, tests, before = [], None, (), None
    for number, text in enumerate(read_lines(ROOT / LIST), start=1):
        place = f"{LIST}:{number}"
        if not text or text.startswith("#"):
            continue
        mark, rest = text[0], text[2:]
        if mark == "@":
            file, _, names = rest.partition(": ")
            tests = tuple(names.split())
            if not tests:
                raise Misfit(f'no tests ({place}): write "@ file: test test"')
        elif mark == "-" and file:
            before = rest
        elif mark == "+" and before is not None:
            mutants.append(Mutant(file, tests, before, rest, line_of(file, before, place)))
            before = None
        else:
            raise Misfit(f'line out of place ({place}): write "@", then pairs of "-" and "+"')
    return mutants


def hash_of(mutant):
    return hashlib.sha256((ROOT / mutant.file).read_bytes()).hexdigest()


def still_true(kept, mutant, sources):
    """Returns whether what a result was found on is unchanged."""
    if kept["outcome"].startswith("killed"):
        return kept["file"] == hash_of(mutant)
    return kept["sources"] == sources


@contextmanager
def spoilt(mutant):
    lines = read_lines(ROOT / mutant.file)
    line = lines[mutant.line - 1]
    lines[mutant.line - 1] = line[:len(line) - len(line.lstrip())] + mutant.after
    (COPY / mutant.file).write_text("\n".join(lines), encoding="utf-8")
    try:
        yield
    finally:
        shutil.copyfile(ROOT / mutant.file, COPY / mutant.file)


def copy_sources():
    """Writes what differs, so that what is built stays built; returns a hash of all of it."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            cwd=ROOT, check=True, capture_output=True, text=True).stdout
    total = hashlib.sha256()
    for file in listed.split("\0"):
        if not file or file.startswith("results/") or not (ROOT / file).exists():
            continue
        text = (ROOT / file).read_bytes()
        total.update(file.encode() + text)
        if (COPY / file).exists() and (COPY / file).read_bytes() == text:
            continue
        (COPY / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / file, COPY / file)
    return total.hexdigest()


def start(*command, **environment):
    return subprocess.Popen(command, cwd=COPY, env={**os.environ, **environment}, stdin=subprocess.DEVNULL,
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def good(children, limit=NO_LIMIT_S):
    """Returns whether all exit with 0 within `limit` seconds; ends those that do not."""
    end = time.monotonic() + limit
    try:
        return all([child.wait(max(0, end - time.monotonic())) == 0 for child in children])
    except subprocess.TimeoutExpired:
        return False
    finally:
        for child in children:
            child.kill()
            child.wait()


def build(tests):
    return good([start("cmake", "--build", TREE, "--target", *(f"test_{test}" for test in tests))])


def passes(test):
    """Runs one process for each processor, each with its share of the cases."""
    shards = os.cpu_count()
    return good([start(TREE / "tests" / f"test_{test}", "--gtest_brief=1", "--gtest_fail_fast",
                       GTEST_TOTAL_SHARDS=str(shards), GTEST_SHARD_INDEX=str(shard)) for shard in range(shards)],
                TEST_LIMIT_S)


def judge(mutant):
    with spoilt(mutant):
        for test in mutant.tests:
            if not build([test]):
                return "does not compile"
            if not passes(test):
                return f"killed by {test}"
    return "survived"


def prepare(mutants):
    if not good([start("cmake", "--preset", "release", "-DTRESS_WERROR=OFF", "-DTRESS_BENCHMARKS=OFF")]):
        raise Misfit(f"configuring failed ({COPY}): ./tress setup installs what is missing")
    tests = list(dict.fromkeys(test for mutant in mutants for test in mutant.tests))
    print(f"mutants: building {len(tests)} test programs in {TREE}", file=sys.stderr)
    if not build(tests):
        raise Misfit(f"the unspoilt sources do not build ({TREE}): ./tress test shows why")
    for test in tests:
        if not passes(test):
            raise Misfit(f"test_{test} fails on the unspoilt sources ({TREE}): mend it first")


def write_table(mutants, outcomes):
    with open(ROOT / "results/mutants.csv", "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["file", "line", "before", "after", "outcome"])
        for mutant in mutants:
            table.writerow([mutant.file, mutant.line, mutant.before, mutant.after, outcomes[mutant]])


def last_results(file, mutants, sources):
    """Returns the results of an earlier run that are still true, by mutant."""
    try:
        last = json.loads(file.read_text())
    except (OSError, ValueError):  # the first run
        return {}
    return {mutant.key: last[mutant.key] for mutant in mutants
            if mutant.key in last and still_true(last[mutant.key], mutant, sources)}


def try_all(mutants, chosen, fresh):
    """Returns the outcome of each chosen mutant."""
    COPY.mkdir(parents=True, exist_ok=True)
    sources = copy_sources()
    kept = COPY / "found.json"
    found = {} if fresh else last_results(kept, mutants, sources)
    if any(mutant.key not in found for mutant in chosen):
        prepare(chosen)
    for number, mutant in enumerate(chosen, start=1):
        if mutant.key not in found:
            found[mutant.key] = {"outcome": judge(mutant), "file": hash_of(mutant), "sources": sources}
        kept.write_text(json.dumps(found, indent=1, ensure_ascii=False))
        outcome = found[mutant.key]["outcome"]
        print(f"mutants: {number}/{len(chosen)} {mutant.file}:{mutant.line} {outcome}", file=sys.stderr)
    return {mutant: found[mutant.key]["outcome"] for mutant in chosen}


def main(words):
    mutants = read_mutants()
    if words == ["--check"]:
        print(f"{len(mutants)} mutants fit")
        return 0
    fresh = words[:1] == ["--all"]
    words = words[1:] if fresh else words
    if words and (len(words) != 2 or words[0] != "--only"):
        wrong = words[2] if words[0] == "--only" and len(words) > 2 else words[0]
        raise Misfit(f"unknown argument '{wrong}' (command line): give --all, --only PATTERN or none")
    pattern = words[1] if words else ""
    chosen = [mutant for mutant in mutants if pattern in mutant.file or pattern in mutant.after]
    if not chosen:
        raise Misfit(f"no mutant has '{pattern}' (--only): give a part of a file's name or of a spoilt line")
    outcomes = try_all(mutants, chosen, fresh)
    if not pattern:
        write_table(chosen, outcomes)
    for mutant, outcome in outcomes.items():
        if not outcome.startswith("killed"):
            print(f"{outcome}: {mutant.file}:{mutant.line}\n  - {mutant.before}\n  + {mutant.after}")
    killed = sum(outcome.startswith("killed") for outcome in outcomes.values())
    print(f"{killed} of {len(chosen)} mutants are killed")
    return 0 if killed >= WANTED * len(chosen) and "does not compile" not in outcomes.values() else 3


def interrupted(*_):
    sys.exit(130)


if __name__ == "__main__":
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, interrupted)
    try:
        sys.exit(main(sys.argv[1:]))
    except Misfit as misfit:
        print(f"mutants: error: {misfit}", file=sys.stderr)
        sys.exit(2)
