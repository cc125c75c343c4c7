"""Runs bad inputs of all kinds through every program of the testbed.

FOLDER holds the programs that its list.txt names. Each input must be refused: exit code 2, one
line "what is wrong (where): what to do" on standard error, nothing on standard output, nothing
written, within 10 s of processor time, a minute in all, and 2 GiB of address space. Exit codes:
0 all are refused, 3 some are not."""
import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

from cases import Case, corpus
from texts import ITSELF, SCENE, is_text

ROOT = Path(__file__).resolve().parents[2]
SPOILT = 100  # scenes
PROCESSOR_LIMIT_S = 10
LIMIT_S = 60
LIMIT_KIB = 2 << 20
WATCH_S = 0.02
MESSAGE = re.compile(r"\w+: error: [^\r\n]+ \([^\r\n]+\): [^\r\n]+\n", re.A)
# That a machine is busy or work goes on is not about the input, nor is the size of a head.
ASIDE = (re.compile(r"^\w+: warning: the machine is busy.*\n", re.M), re.compile(r"^\w+: .*, for \d+ s\n", re.M),
         re.compile(r"^simulate: \w+: a batch of .*\n", re.M))
KINDS = ("signal", "hang", "internal error", "accepted", "message", "left something behind")


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="folder of the programs")
    parser.add_argument("--quick", action="store_true", help="some inputs of each kind for each program")
    parser.add_argument("--seed", type=int, default=1, help="seed of the spoilt scenes; default: 1")
    parser.add_argument("--unbounded", action="store_true",
                        help="no limits of time and memory, which sanitizers need")
    options = parser.parse_args()
    options.folder = options.folder.resolve()
    if not (options.folder / "list.txt").is_file():
        parser.error(f"no list.txt in {options.folder}")
    return options


def make(folder, files):
    for name, what in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if is_text(what):
            path.write_bytes(what if isinstance(what, bytes) else what.encode())
        elif what is not None and what.kind == "folder":
            path.mkdir()
        elif what is not None and what.kind == "pipe":
            os.mkfifo(path)
        elif what is not None:
            path.symlink_to(path.name if what == ITSELF else what.to)


def listing(folder):
    return sorted(os.path.join(place, name) for place, folders, files in os.walk(folder) for name in folders + files)


def peak(pid):
    """Returns the largest resident size so far, in KiB; 0 once the process is gone."""
    try:
        found = re.search(r"VmHWM:\s*(\d+)", Path(f"/proc/{pid}/status").read_text())
    except OSError:
        return 0
    return int(found[1]) if found else 0


@dataclass
class Result:
    code: int  # negative: ended by that signal
    out: str
    err: str
    hung: bool
    left: bool  # something was written
    kib: int


def watched(child):
    """Waits for a process; returns its output, errors, whether it hung, and its peak in KiB."""
    end, hung, kib = time.monotonic() + LIMIT_S, False, 0
    while True:
        try:
            return *child.communicate(timeout=WATCH_S), hung, kib
        except subprocess.TimeoutExpired:
            kib = max(kib, peak(child.pid))
            if not hung and time.monotonic() > end:
                hung = True
                os.killpg(child.pid, signal.SIGKILL)


def run(case, options):
    """Runs a program in a folder of its own."""
    work = Path(tempfile.mkdtemp(prefix="tress_corpus_"))
    try:
        make(work, case.files)
        before = listing(work)
        bounds = "" if options.unbounded else f"ulimit -v {LIMIT_KIB} -S -t {PROCESSOR_LIMIT_S}; "
        child = subprocess.Popen(["bash", "-c", f'ulimit -c 0; {bounds}exec "$0" "$@"', options.folder / case.program,
                                  *case.args], cwd=work, start_new_session=True, stdin=subprocess.DEVNULL,
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace")
        out, err, hung, kib = watched(child)
        return Result(child.returncode, out, err, hung, listing(work) != before, kib)
    finally:
        shutil.rmtree(work)


def fault(result, maybe):
    """Returns "" where the input was refused as it should be, "legal" where it may be."""
    if result.hung or result.code == -signal.SIGXCPU:
        return "hang"
    if result.code < 0 or result.code >= 128:
        return "signal"
    if result.code == 1:
        return "internal error"
    if result.code != 2:
        return "legal" if maybe else "accepted"
    err = result.err
    for aside in ASIDE:
        err = aside.sub("", err, count=1)
    if not MESSAGE.fullmatch(err) or result.out:
        return "message"
    return "left something behind" if result.left else ""


def header(program, options):
    """Returns the first line of a program's table, which it writes before it looks for what to merge."""
    made = subprocess.run([options.folder / program, "--merge", "none_such.csv", "--out", "-"],
                          capture_output=True, text=True).stdout
    if not made.endswith(",run_id\n"):
        sys.exit(f"{program} writes no header")
    return made


def few_of(cases):
    """Returns some of each kind for each program, spread over what there is."""
    groups = {}
    for case in cases:
        groups.setdefault((case.program, case.kind), []).append(case)
    return [group[(13 * i + 37 * k) % len(group)] for i, group in enumerate(groups.values())
            for k in range(4 if group[0].kind == "scene" else 1)]


def refused(result):
    return result is not None and result.code == 2 and re.search(r"scene\.toml:\d+:\d+", result.err) is not None


def try_all(cases, options):
    """Tries all; prints each fault as it comes. Returns faults by kind, the numbers of bad and of
    legal inputs, and the largest resident size in KiB."""
    faults, inputs, legal, kib = Counter(), 0, 0, 0
    tried = {}  # by program, kind and name

    def attempt(case):
        # What another program reads may be legal and take its time. That one started earlier.
        other = tried.get((case.after, case.kind, case.name))
        if case.after and not (other and refused(other.result())):
            return None
        return run(case, options)

    workers = len(os.sched_getaffinity(0))
    with ThreadPoolExecutor(workers) as pool:
        futures = {}
        try:
            for case in cases:
                future = pool.submit(attempt, case)
                futures[future] = case
                tried[case.program, case.kind, case.name] = future
            for future in as_completed(futures):
                case, result = futures[future], future.result()
                if result is None:
                    continue
                kib = max(kib, result.kib)
                what = fault(result, case.maybe)
                legal += what == "legal"
                inputs += what != "legal"
                if what not in ("", "legal"):
                    faults[what] += 1
                    print(f"{what}: {case.program} {' '.join(case.args)[:100]} <- {case.kind}: {case.name}: "
                          f"exit {result.code}: {result.err[:300].strip()}", flush=True)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return faults, inputs, legal, kib


def main():
    options = parse()
    programs = (options.folder / "list.txt").read_text().split()
    shipped = [path.read_text(encoding="utf-8") for path in sorted((ROOT / "scenes").glob("*.toml"))]
    whole = Case("effect_audit", "", "", ["--dry-run", "--set", "scenes=scene.toml"], {"scene.toml": SCENE})
    good = run(whole, options)
    if good.code != 0:
        sys.exit(f"the scene that all are made from is refused: {good.err}")
    headers = {program: header(program, options) for program in programs if program != "simulate"}
    cases = corpus(programs, shipped, headers, options.seed, SPOILT)
    faults, inputs, legal, kib = try_all(few_of(cases) if options.quick else cases, options)
    print(f"{inputs} bad inputs of {len(programs)} programs, {inputs - faults.total()} refused as they should be; "
          f"{', '.join(f'{faults[kind]} {kind}' for kind in KINDS)}; largest resident size seen {kib / 1024:.0f} MiB; "
          f"{legal} spoilt inputs were legal")
    return 3 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
