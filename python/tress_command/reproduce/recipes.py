"""How the tables of a release were made: the command of each manifest, to be repeated."""

import os
from pathlib import Path
from typing import NamedTuple

from ..compare.tables import manifest_of
from ..messages import refuse
from ..tree import PROGRAMS, RELEASE, compile_targets, names_in

OTHER_SIMULATORS = "build/other_simulators/experiments/other_simulators"
# Tables that no experiment writes, and the command that does; "": values are published ones.
OTHER_WAYS = {
    "compare_itself": "python3 tests/compare/real_builds.py build/bench",
    "full_sweeps": "./tress cluster estimate",
    "mutants": "./tress test --mutants",
    "other_simulators_published": "",
    "other_simulators_swing": "",
    "other_solvers": "python3 experiments/other_solvers/run.py",
    "player": "node tests/report/picture_times.mjs",
    "question_times": "python3 tests/commands/question_times.py",
    "solve_ivp": "python3 python/examples/solve_ivp.py",
}
SERIES = "scenes"  # folder of the tables of simulate
# Options of a run that say nothing about its rows.
FLAGS, VALUED = ("--resume", "--retry-failed"), ("--progress", "--out")


class Recipe(NamedTuple):
    """A command that makes tables. name: its table, or "scenes"."""

    name: str
    program: str
    words: tuple
    timed: bool
    tables: tuple  # relative to the folder of results, without ending

    def fits(self, word):
        """True if a word names the table or its experiment."""
        return word in (self.name, os.path.basename(self.program))


def tables_of(folder):
    """Returns the tables of a folder of results: names with their folder, without ending."""
    found = [path.stem for path in sorted(folder.glob("*.csv"))]
    return found + [f"{SERIES}/{path.stem}" for path in sorted((folder / SERIES).glob("*.csv"))]


def _words(argv, table):
    """Returns the options of a command, with the table as its output."""
    kept, words = [], [str(word) for word in argv[1:]]
    named = False
    while words:
        word = words.pop(0)
        name, equals, _ = word.partition("=")
        if name in VALUED:
            named |= name == "--out"
            if not equals and words:
                words.pop(0)
        elif word not in FLAGS:
            kept.append(word)
    return (*kept, *(("--out", f"results/{table}.csv") if named else ()))


def _program(argv):
    """Returns the program that a manifest names, or None, and why it cannot run here."""
    name = os.path.basename(str(argv[0]))
    if name in names_in(f"{PROGRAMS}/list.txt"):
        return f"{PROGRAMS}/{name}", ""
    for line in names_in(f"{PROGRAMS}/left_out.txt"):
        if line.startswith(f"{name}: "):
            return None, line.partition(": ")[2]
    if name in ("other_simulators", "rubbing"):
        there = os.access(f"{OTHER_SIMULATORS}/{name}", os.X_OK)
        return (f"{OTHER_SIMULATORS}/{name}" if there else None,
                "build it first: ./tress other_simulators --help")
    return None, f"no experiment {name}"


def recipe_of(folder, table):
    """Returns the recipe of a table, or None, and why it has none."""
    if table in OTHER_WAYS:
        way = OTHER_WAYS[table]
        return None, f"made by: {way}" if way else "published values, which nothing here measures"
    manifest = manifest_of(folder, table)
    argv = manifest.get("argv")
    if not argv or not isinstance(argv, list):
        return None, "no manifest names its command"
    if manifest.get("plugins") or any(str(word).startswith("--plugin") for word in argv):
        return None, "needs plug-ins"
    program, why = _program(argv)
    if program is None:
        return None, why
    series = table.startswith(f"{SERIES}/")
    return Recipe(name=SERIES if series else table, program=program,
                  words=_words(argv, table), timed=not series and bool(manifest.get("timings")),
                  tables=(table,)), ""


def recipes_of(folder):
    """Returns the recipes of all tables of a folder, and the tables without, with the reason."""
    found, without = {}, {}
    for table in tables_of(folder):
        recipe, why = recipe_of(folder, table)
        if recipe is None:
            without[table] = why
        elif recipe.name in found:
            first = found[recipe.name]
            found[recipe.name] = first._replace(tables=(*first.tables, table))
        else:
            found[recipe.name] = recipe
    for path in sorted(folder.glob("bench_*.json")):
        without[path.name] = "made by: ./tress bench"
    # Tables without a manifest that come with another: summaries, fits of a scene.
    for table in [table for table in without if not manifest_of(folder, table)]:
        first = found.get(SERIES if table.startswith(f"{SERIES}/") else
                          table.removesuffix("_summary"))
        if first:
            found[first.name] = first._replace(tables=(*first.tables, table))
            del without[table]
    return list(found.values()), without


def compile_programs(recipes):
    """Compiles the programs of recipes; those of other simulators have a tree of their own."""
    programs = {recipe.program for recipe in recipes}
    if own := sorted(os.path.basename(path) for path in programs if path.startswith(PROGRAMS)):
        compile_targets(RELEASE, *own)


def chosen(recipes, without, words):
    """Returns the recipes that words name, all if there are none. Refuses other words."""
    for word in words:
        if any(recipe.fits(word) for recipe in recipes):
            continue
        if word in without:
            refuse(f"reproduce: {word} cannot be made by this command: {without[word]}")
        names = " ".join(recipe.name for recipe in recipes)
        refuse(f"reproduce: no table or experiment '{word}' in the release; there are: {names}")
    return [one for one in recipes if not words or any(map(one.fits, words))]


def workplace(folder):
    """Makes a folder with links to everything in the clone, except to results/: the commands of
    manifests write into results/ of that folder instead. Returns the folder and its results."""
    folder, results = Path(folder), Path(folder) / "results"
    work = folder / "work"
    for path in (work, results):
        path.mkdir(parents=True, exist_ok=True)
    for link in work.iterdir():
        if link.is_symlink():
            link.unlink()
    for entry in Path.cwd().iterdir():
        if entry.name not in (".git", "results"):
            (work / entry.name).symlink_to(entry)
    (work / "results").symlink_to(results.resolve())
    return work, results
