"""./tress reproduce: all tables of a release again, of one commit in one run, and what differs."""

import contextlib
import fcntl
import json
import os
import re
import shutil
import time
from pathlib import Path

from .. import place
from ..command import Command, read_words
from ..compare.tables import manifest_of
from ..files import read_json
from ..messages import BAD_INPUT, DONE, INTERRUPTED, ROWS_FAILED, Ended, refuse, say
from ..processes import read, run
from ..report import make_report, write_pages
from ..tree import RELEASE, configure
from ..version import commit_of
from .archive import check_folder, unpack
from .judge import arithmetic, judge, other_arithmetic
from .load import MOST_LOAD, doubt, wait_for_idle
from .page import counts, csv_of, line_of, page_of
from .recipes import chosen, compile_programs, recipes_of, tables_of, workplace

FOLDER = "build/reproduce"
WAIT = "10m"
UNITS = {"s": 1, "m": 60, "h": 3600}
MOST_SHOWN = 5  # files that differ from the commit


def seconds_of(text):
    """Returns a duration such as 30s, 10m or 2h in seconds."""
    found = re.fullmatch(r"(\d{1,6})(s|m|h)?", text)
    if not found:
        refuse(f"reproduce: --wait {text}: give a duration such as 30s, 10m or 2h")
    return int(found[1]) * UNITS[found[2] or "s"]


def clean_commit():
    """Returns the commit that is checked out. Refuses a tree that differs from it."""
    if Path(".git").exists():
        changed = read("git", "status", "--porcelain", "-uno").stdout.splitlines()
        if changed:
            names = " ".join(line[3:] for line in changed[:MOST_SHOWN])
            more = f" and {len(changed) - MOST_SHOWN} more" if len(changed) > MOST_SHOWN else ""
            refuse(f"reproduce: {len(changed)} files differ from the commit: {names}{more}; "
                   "commit or restore them (git stash keeps them)")
    commit = commit_of(os.getcwd())
    if not re.fullmatch("[0-9a-f]{40}", commit):
        refuse("reproduce: these sources have no commit; work in a clone or an archive of git")
    return commit


def release_of(text, folder, option="reproduce: --against"):
    """Returns the folder with the tables of a release: of an archive, which it unpacks, or a
    folder, whose checksums it checks where there are any."""
    path = Path(text)
    if path.is_file():
        shutil.rmtree(folder, ignore_errors=True)
        say(f"checking {text}")
        return unpack(path, folder)
    if not path.is_dir():
        refuse(f"{option} {text}: neither a folder nor an archive of results")
    check_folder(path)
    if not tables_of(path):
        refuse(f"{option} {text}: has no tables")
    return path.resolve()


class Runs:
    """Runs of recipes of one reproduction, kept in a file so that it can be continued."""

    def __init__(self, folder, commit):
        self.file, self.commit, self.done = folder / "runs.json", commit, {}
        kept = read_json(self.file) if self.file.exists() else {}
        if isinstance(kept, dict) and kept.get("commit") == commit:
            self.done = kept["runs"]

    def finished(self, recipe, results):
        """True if an earlier call has made the tables of a recipe, of this commit."""
        run_ = self.done.get(recipe.name)
        return bool(run_) and run_["words"] == list(recipe.words) and all(
            (results / f"{table}.csv").exists() for table in recipe.tables)

    def keep(self, recipe, facts):
        """Records a finished run."""
        self.done[recipe.name] = {"words": list(recipe.words)} | facts
        part = self.file.with_suffix(".part")
        kept = {"commit": self.commit, "runs": self.done}
        part.write_text(json.dumps(kept, indent=2) + "\n", encoding="utf-8")
        os.replace(part, self.file)

    def doubts(self, recipe, release, here):
        """Returns why the times of a recipe are uncertain, "" if they are not. release, here:
        manifests."""
        load = self.done.get(recipe.name, {}).get("load_before")
        busy = (f"others used {load:.1f} processors at the start"
                if load is not None and load > MOST_LOAD else doubt(here))
        return "; ".join(f"{whose}: {why}" for whose, why in (
            ("release", doubt(release)), ("here", busy)) if why and recipe.timed)


def make(recipe, runs, work, results, wait_s):
    """Runs a recipe. Returns its exit code."""
    load, waited = None, 0.0
    if recipe.timed:
        load, waited = wait_for_idle(wait_s, say)
        if load is not None and load > MOST_LOAD:
            say(f"{recipe.name}: other programs still use {load:.1f} processors: its times are "
                "uncertain")
    # A journal belongs to an interrupted run.
    going_on = [table for table in recipe.tables if (results / f"{table}.csv.journal").exists()]
    words = [*recipe.words, *(["--resume"] if going_on else [])]
    say(" ".join([recipe.name, *words]))
    since = time.time()
    code = run(recipe.program, *words, cwd=work)
    if code in (DONE, ROWS_FAILED):
        runs.keep(recipe, {"code": code, "seconds": round(time.time() - since, 1),
                           "load_before": load, "waited_s": round(waited, 1)})
    return code


def make_all(recipes, runs, work, results, wait_s, command):
    """Runs what is not done. Returns the recipes that failed, with the reason."""
    failed = {}
    for recipe in recipes:
        if runs.finished(recipe, results):
            say(f"{recipe.name}: made by an earlier call of this command")
            continue
        try:
            code = make(recipe, runs, work, results, wait_s)
        except KeyboardInterrupt:
            code = INTERRUPTED
        if code == INTERRUPTED:
            raise Ended(INTERRUPTED, f"interrupted in {recipe.name}; to go on: {command}")
        if code not in (DONE, ROWS_FAILED):
            failed[recipe.name] = f"NOT DONE: exit code {code} of {recipe.program}"
            say(f"{recipe.name}: {failed[recipe.name]}")
    return failed


def _facts(pairs, commit):
    """Returns lines of the page: what made the two sides. pairs: manifests of a table."""
    def line(name, of):
        return (name, *(", ".join(sorted({str(value) for pair in pairs if (
            value := of(pair[side]))})) for side in (0, 1)))

    def machine(key):
        return lambda one: (one.get("machine") or {}).get(key)

    lines = [line("commit", lambda one: (one.get("git") or {}).get("commit", "")[:8])[:2]
             + (commit[:8],), line("processor", machine("cpu")),
             line("processors", machine("cpus"))]
    for name in {name: None for pair in pairs for one in pair for name in arithmetic(one)}:
        found = line(name, lambda one, name=name: arithmetic(one).get(name))
        if found[1] != found[2] or not name.startswith("library"):
            lines.append(found)
    return lines


def compare(recipes, runs, release, results, commit, without, folder):
    """Compares all tables, writes the page and prints a line for each recipe. Returns true if
    all of the release was reproduced."""
    groups, pairs = [], []
    for recipe in recipes:
        judged = [judge(table, release, results) for table in recipe.tables]
        both = [manifest_of(side, recipe.tables[0]) for side in (release, results)]
        groups.append((recipe.name, judged, runs.doubts(recipe, *both)))
        pairs.append(both)
        print(line_of(*groups[-1]))
    judged = [table for _, tables, _ in groups for table in tables]
    (folder / "comparison.csv").write_text(csv_of(judged), encoding="utf-8")
    title = f"Reproduction of tress {place.version()[0]} at commit {commit[:8]}"
    (folder / "report.md").write_text(page_of(title, _facts(pairs, commit), groups, without),
                                      encoding="utf-8")
    older = {there[:8]: None for a, _ in pairs if (
        there := (a.get("git") or {}).get("commit", commit)) != commit}
    if older:
        say(f"tables of the release are of commit {', '.join(older)}, this is {commit[:8]}: a "
            "change of the code counts as a change")
    differs = {text: None for a, b in pairs if b for text in other_arithmetic(a, b)}
    if differs:
        say(f"the arithmetic differs, so last digits may: {'; '.join(differs)}")
    others = [table.table for table in judged if (git := manifest_of(results, table.table).get(
        "git")) and git.get("commit") != commit]
    if others:
        say(f"NOT OF THIS COMMIT: {' '.join(others)}; build their programs again")
    rows, agree = (sum(getattr(table, of) for table in judged) for of in ("rows", "agree"))
    print(f"{len(judged)} table{'' if len(judged) == 1 else 's'}: {agree} of {rows} rows agree"
          f"{', ' if counts(judged) else ''}{counts(judged)} -> {folder}/report.md")
    return not others and not any(table.bad() for table in judged)


@contextlib.contextmanager
def alone(folder):
    """Refuses a second call that works in a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "running.lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            refuse(f"another call works in {folder}; wait for it")
        yield


def _run(words, machine):
    given = read_words("reproduce", words, flags=("--write",),
                       valued=("--against", "--folder", "--wait"), names=True)
    wait_s = seconds_of(given.options.get("--wait", WAIT))
    commit = clean_commit()
    folder = Path(given.options.get("--folder", f"{FOLDER}/{commit[:12]}"))
    if folder.resolve() == Path("results").resolve():
        refuse("reproduce: --folder results has the release; --write copies the tables there")
    with alone(folder):
        release = release_of(given.options.get("--against", "results"), folder / "release")
        machine.ensure()
        configure(RELEASE)
        recipes, without = recipes_of(release)
        recipes = chosen(recipes, without, given.names)
        compile_programs(recipes)
        work, results = workplace(folder)
        runs = Runs(folder, commit)
        command = " ".join(["./tress reproduce", *words])
        failed = make_all(recipes, runs, work, results, wait_s, command)
        if not any((results / f"{table}.csv").exists() for one in recipes for table in one.tables):
            raise Ended(BAD_INPUT, "reproduce: no table was made, for the reasons above")
        whole = compare(recipes, runs, release, results, commit,
                        {**failed, **({} if given.names else without)}, folder)
        try:
            make_report(str(results))
        except Ended as end:
            say(f"the figures were not made (exit code {end.code})")
        if without and not given.names:
            say(f"not made again, {folder}/report.md has the reasons: {' '.join(without)}")
        if "--write" in given.options:
            shutil.copytree(results, "results", dirs_exist_ok=True)
            say("copied to results/")
            if write_pages() != 0:
                say("README.md and docs/ were left as they are (the reason stands above)")
    return DONE if whole and not failed else ROWS_FAILED


REPRODUCE = Command(
    "reproduce", "[--against RELEASE] [--folder FOLDER] [--wait TIME] [--write] [EXPERIMENT...]",
    "makes all tables and figures of a release again, from the commit that is checked out, and "
    "compares them row by row with those of the release. Repeats the command of each "
    ".meta.json in a new folder. Waits for an idle machine before timings. Called again after an "
    "interrupt, it goes on. Exit code 3 if a row of the release is changed or missing. "
    "docs/reproduce.md describes it.",
    _run,
    example="./tress reproduce damping matrices",
    time="about an hour on two cores for all tables, after the build.",
    options=(("--against RELEASE", "archive of ./tress archive, or folder with tables (default: "
              "results)"),
             ("--folder FOLDER", f"place of tables, figures and page (default: {FOLDER}/COMMIT)"),
             ("--wait TIME", "longest wait for an idle machine before each timed experiment, as "
              f"30s, 10m or 2h (default: {WAIT}). Later, times are marked as uncertain"),
             ("--write", "copies tables and figures to results/ at the end, and writes the pages"),
             ("EXPERIMENT", "tables or experiments to make (default: all)")))
