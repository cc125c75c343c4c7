"""Runs the commands that the pages have their readers type.

    test_pages.py ROOT BUILD --run PAGE...   runs the commands of these pages, without long ones
    test_pages.py ROOT BUILD --long PAGE...  runs all of them
    test_pages.py ROOT BUILD --check PAGE... --long PAGE...  checks the rules of command_rules.py

The page `sentences` has the commands within the sentences of all pages.
Commands run in a copy of the repository, which they may change; build/release there is BUILD, and
page_stand_ins.py has the programs that would build, or need root or a cluster.
Output that a page shows must be printed, apart from its numbers and units of time. --check: each
command has at most one rule, each rule a command, and these are the pages with something to run.
Exit codes: 0 no complaints, 1 otherwise."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import page_stand_ins
from command_rules import BEFORE, RULES, Rule
from inline_commands import misspelt, sentence_commands
from page_commands import SENTENCES, BadPage, blocks_of, page_commands, pages

# Left out of the copy, by path or at any place.
LEFT_OUT = ("build", ".git", "results/scenes", "results/compare")
LEFT_OUT_ANYWHERE = "node_modules"


def rules_of(command):
    return [rule for rule in RULES if rule.fits(command)]


def commands_of(root, page):
    return sentence_commands(root, pages(root)) if page == SENTENCES else page_commands(root, page)


@dataclass
class Run:
    command: str
    exits: tuple[int, ...] = (0,)
    output: tuple[str, ...] = ()
    long: bool = False


def rule_of(command):
    return next(iter(rules_of(command)), Rule(command.page, ""))


def as_run(command):
    """Returns what is run for a command of a page, or None where another test runs it."""
    rule = rule_of(command)
    if rule.by:
        return None
    text = rule.instead + command.text[len(rule.command):] if rule.instead else command.text
    return Run(f"{text} {rule.more}".rstrip(), (0, *rule.exits), tuple(command.output), rule.long)


def masked(text):
    """Returns the text with every number as '#' and every unit of time as 's'."""
    numbers = re.sub(r"[0-9][0-9.]*(e[-+]?[0-9]+)?", "#", text)
    return re.sub(r"(#|\.\.\.) [mµun]?s\b", r"\1 s", numbers)


def not_printed(output, printed):
    """Returns the lines of `output` that a command did not print; "..." there is any text."""
    lines = masked(printed).split("\n")

    def pattern(line):
        return re.compile(".*".join(map(re.escape, masked(line).split("..."))))

    return [line for line in output if not any(map(pattern(line).fullmatch, lines))]


def check_rule(root, rule, commands):
    place = f"command_rules.py: {rule.page}: '{rule.command}'"
    complaints = []
    fitting = [command for command in commands if rule.fits(command)]
    if not fitting:
        complaints.append(f"{place} begins no command there")
    if not (rule.more or rule.instead or rule.exits or rule.spelling or rule.long or rule.by):
        complaints.append(f"{place} says nothing")
    if (rule.instead or rule.exits) and not rule.why:
        complaints.append(f"{place} does not say why")
    if rule.by and not (rule.takes and rule.takes in (root / rule.by).read_text(encoding="utf-8")):
        complaints.append(f"{place}: {rule.by} does not take commands by {rule.takes}")
    if rule.by:
        complaints += [f"{command.place}: {rule.by} does not run this command" for command in fitting
                       if not re.search(rule.pattern, command.text)]
    return complaints


def tell(commands):
    """Prints how the commands are tested, and why some are not run."""
    rules = list(map(rule_of, commands))
    elsewhere, spelt = (sum(bool(getattr(rule, name)) for rule in rules) for name in ("by", "spelling"))
    print(f"{len(commands)} commands on {len({command.page for command in commands})} pages: "
          f"{len(commands) - elsewhere - spelt} run, {elsewhere} run by another test, {spelt} of verified spelling:")
    for command, rule in zip(commands, rules):
        if rule.spelling:
            print(f"  {command.place}: {command.text}: {rule.spelling}")


PYTHON_TEST = "python/tests/test_pages.py"


def check_python(root, every_page):
    """Checks the Python of the pages against the names of the module, which a build may lack.
    PYTHON_TEST runs it."""
    known = (root / "python/tress/__init__.py").read_text(encoding="utf-8")
    complaints, count = [], 0
    for page in every_page:
        for block in blocks_of((root / page).read_text(encoding="utf-8"), "python"):
            count += 1
            try:
                compile(block, page, "exec")
            except SyntaxError as problem:
                complaints.append(f"{page}: Python: {problem}: {problem.text}")
            complaints += [f"{page}: Python: no tress.{name}" for name in re.findall(r"\btress\.(\w+)", block)
                           if not re.search(rf"\b{name}\b", known)]
    if "pages(ROOT)" not in (root / PYTHON_TEST).read_text(encoding="utf-8"):
        complaints.append(f"{PYTHON_TEST} does not read all pages")
    print(f"{count} blocks of Python, run by {PYTHON_TEST}")
    return complaints


def check(root, build, tested):
    every_page = pages(root)
    commands = [command for page in (*every_page, SENTENCES) for command in commands_of(root, page)]
    complaints = [f"{command.place}: two rules for one command" for command in commands if len(rules_of(command)) > 1]
    for rule in RULES:
        complaints += check_rule(root, rule, commands)
    runs = [(command.page, as_run(command)) for command in commands if as_run(command)]
    run = sorted({page for page, _ in runs})
    quick, long = (sorted({page for page, run in runs if run.long == kind}) for kind in (False, True))
    complaints += [f"command_rules.py: BEFORE: {page} runs nothing" for page in BEFORE if page not in run]
    between = tested.index("--long") if "--long" in tested else len(tested)
    for these, those in ((tested[:between], quick), (tested[between + 1:], long)):
        if sorted(these) != those:
            complaints.append(f"CMakeLists.txt: pages {', '.join(these)} are run, of {', '.join(those)}")
    tell(commands)
    return complaints + check_python(root, every_page) + misspelt(root, build, every_page)


def copy_of_repository(root, build, copy):
    def left_out(folder, names):
        place = Path(folder).relative_to(root)
        return [name for name in names if name == LEFT_OUT_ANYWHERE or (place / name).as_posix() in LEFT_OUT]

    shutil.copytree(root, copy, symlinks=True, ignore=left_out)
    # Links, so that the log of a build is written there.
    (copy / "build/release").mkdir(parents=True)
    for entry in build.iterdir():
        if entry.name != "build.log":
            (copy / "build/release" / entry.name).symlink_to(entry)


def run_page(root, build, page, long):
    """Returns the complaints about the commands of a page, long ones or not, none after the first."""
    runs = [Run(command) for command in BEFORE.get(page, [])]
    runs += [run for run in map(as_run, commands_of(root, page)) if run and run.long <= long]
    with tempfile.TemporaryDirectory(prefix="tress-pages-", ignore_cleanup_errors=True) as work:
        copy = Path(work) / "tress"
        copy_of_repository(root, build, copy)
        page_stand_ins.write_all(Path(work) / "bin")
        environment = {"TRESS_SUNDIALS_ROOT": "/usr", **os.environ, **page_stand_ins.ENVIRONMENT,
                       "TRESS_CACHE": f"{work}/cache", "PATH": f"{work}/bin:{os.environ['PATH']}"}
        for run in runs:
            since = time.monotonic()
            done = subprocess.run(["bash", "-o", "pipefail", "-c", run.command], cwd=copy, stdin=subprocess.DEVNULL,
                                  env=environment, capture_output=True, text=True, errors="replace")
            print(f"{time.monotonic() - since:.1f} s  {run.command}", flush=True)
            printed = done.stdout + done.stderr
            if done.returncode not in run.exits:
                return [f"{page}: exit code {done.returncode} of: {run.command}\n{printed}"]
            missing = not_printed(run.output, printed)
            if missing:
                return [f"{page}: '{missing[0]}' is not printed by: {run.command}\n{printed}"]
    return []


def main(root, build, how, *named):
    root, build = Path(root).resolve(), Path(build).resolve()
    if how not in ("--run", "--long", "--check") or not named:
        sys.exit(__doc__)
    try:
        if how == "--check":
            complaints = check(root, build, named)
        else:
            complaints = [complaint for page in named for complaint in run_page(root, build, page, how == "--long")]
    except BadPage as problem:
        complaints = [str(problem)]
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
