"""Runs the commands that the pages have their readers type.

    test_pages.py ROOT BUILD --run PAGE...    runs every command of these pages
    test_pages.py ROOT BUILD --check PAGE...  checks the rules of command_rules.py

Commands run in a copy of the repository, which they may change; build/release there is BUILD.
Output that a page shows must be printed, apart from its numbers and units of time. --check: each
command has at most one rule, each rule a command, and these are the pages with something to run.
Exit codes: 0 no complaints, 1 otherwise."""
import re
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from command_rules import BEFORE, RULES, Rule
from page_commands import BadPage, page_commands, pages

# Left out of the copy, by path or at any place.
LEFT_OUT = ("build", ".git", "results/scenes", "results/compare")
LEFT_OUT_ANYWHERE = "node_modules"


def rules_of(command):
    return [rule for rule in RULES if rule.fits(command)]


@dataclass
class Run:
    command: str
    exits: tuple[int, ...] = (0,)
    output: tuple[str, ...] = ()


def as_run(command):
    """Returns what is run for a command of a page, or None."""
    rule = next(iter(rules_of(command)), Rule(command.page, ""))
    if rule.left_out:
        return None
    text = rule.instead + command.text[len(rule.command):] if rule.instead else command.text
    return Run(f"{text} {rule.more}".rstrip(), (0, *rule.exits), tuple(command.output))


def masked(text):
    """Returns the text with every number as '#' and every unit of time as 's'."""
    return re.sub(r"# ([mµun]?s)\b", "# s", re.sub(r"[0-9][0-9.]*(e[-+]?[0-9]+)?", "#", text))


def not_printed(output, printed):
    """Returns the lines of `output` that a command did not print; "..." there is any text."""
    lines = masked(printed).split("\n")

    def pattern(line):
        return re.compile(".*".join(map(re.escape, masked(line).split("..."))))

    return [line for line in output if not any(map(pattern(line).fullmatch, lines))]


def check_rule(root, rule, commands):
    place = f"command_rules.py: {rule.page}: '{rule.command}'"
    complaints = []
    if not any(rule.fits(command) for command in commands):
        complaints.append(f"{place} begins no command there")
    if not (rule.more or rule.instead or rule.exits or rule.left_out):
        complaints.append(f"{place} says nothing")
    if (rule.instead or rule.exits) and not rule.why:
        complaints.append(f"{place} does not say why")
    if rule.by and rule.page not in (root / rule.by).read_text(encoding="utf-8"):
        complaints.append(f"{place}: {rule.by} does not read that page")
    return complaints


def check(root, tested):
    every_page = pages(root)
    commands = [command for page in every_page for command in page_commands(root, page)]
    complaints = [f"{command.place}: two rules for one command" for command in commands if len(rules_of(command)) > 1]
    for rule in RULES:
        complaints += check_rule(root, rule, commands)
    run = sorted({command.page for command in commands if as_run(command)})
    complaints += [f"command_rules.py: BEFORE: {page} runs nothing" for page in BEFORE if page not in run]
    if run != sorted(tested):
        complaints.append(f"CMakeLists.txt: pages {', '.join(tested)} are run, of {', '.join(run)}")
    left_out = sum(as_run(command) is None for command in commands)
    print(f"{len(commands)} commands on {len(every_page)} pages, {left_out} left out")
    return complaints


def copy_of_repository(root, build, copy):
    def left_out(folder, names):
        place = Path(folder).relative_to(root)
        return [name for name in names if name == LEFT_OUT_ANYWHERE or (place / name).as_posix() in LEFT_OUT]

    shutil.copytree(root, copy, symlinks=True, ignore=left_out)
    (copy / "build").mkdir()
    (copy / "build/release").symlink_to(build)


def run_page(root, build, page):
    """Returns the complaints about the commands of a page, none after the first."""
    runs = [Run(command) for command in BEFORE.get(page, [])]
    runs += [run for run in map(as_run, page_commands(root, page)) if run]
    with tempfile.TemporaryDirectory(prefix="tress-pages-", ignore_cleanup_errors=True) as work:
        copy = Path(work) / "tress"
        copy_of_repository(root, build, copy)
        for run in runs:
            since = time.monotonic()
            done = subprocess.run(["bash", "-o", "pipefail", "-c", run.command], cwd=copy, stdin=subprocess.DEVNULL,
                                  capture_output=True, text=True, errors="replace")
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
    if how not in ("--run", "--check") or not named:
        sys.exit(__doc__)
    try:
        if how == "--check":
            complaints = check(root, named)
        else:
            complaints = [complaint for page in named for complaint in run_page(root, build, page)]
    except BadPage as problem:
        complaints = [str(problem)]
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
