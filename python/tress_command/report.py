"""./tress report and ./tress film: the report page, pages made from templates, films."""

import os
from pathlib import Path

from .command import Command, no_words
from .counting import must
from .messages import INTERNAL_ERROR, Ended, say
from .place import INSTALLED
from .processes import read, run
from .scripts import FILM as FILM_PROGRAM
from .scripts import PAGES, REPORT
from .tree import PROGRAMS


def _there(program):
    if not os.path.isfile(program[-1]):
        raise Ended(INTERNAL_ERROR, f"{program[-1]} is missing; "
                    "git checkout -- experiments/report/dist")
    return program


def make_report(folder="results"):
    """Writes report.html and figures of a folder of results."""
    must(*_there(REPORT), folder, "--out", f"{folder}/report.html")
    say(f"tables: {folder}/*.csv; figures: {folder}/*.svg; "
        f"page: {os.path.abspath(folder)}/report.html")


def write_pages():
    """Writes README.md, results/README.md and docs/ from docs/templates/ and results/*.csv.
    Returns the exit code. An installed tree has no such pages."""
    if INSTALLED:
        return 0
    program = f"{PROGRAMS}/constraint_drift"
    if os.access(program, os.X_OK):
        listed = read(program, "--list")
        if listed.code != 0:
            return listed.code
        Path("docs/templates/catalogue.txt").write_text(listed.stdout, encoding="utf-8")
    return run(*PAGES)


def _report(words, machine):
    no_words("report", words)
    machine.ensure()
    make_report()
    return write_pages()


def _film(words, machine):
    machine.ensure()
    return run(*_there(FILM_PROGRAM), *words)


COMMAND = Command(
    "report", "",
    "writes results/report.html, one SVG per figure, README.md and docs/ from results/*.csv.",
    _report,
    example="./tress report",
    time="less than a minute.")

FILM = Command(
    "film", "PAGE-OR-RUN ADDRESS OUT [OPTIONS]",
    "writes a film or pictures of a scene, drawn by headless Chromium. OUT is film.webm, or a "
    "folder of PNG; docs/player.md describes addresses.",
    _film,
    example="./tress film results/report.html 'scene=head_shaking&colour=hair' head_shaking.webm",
    time="a fraction of a second for each picture.",
    program=FILM_PROGRAM)
