"""Every page made from a template, and the answers to its slots."""
import importlib
import inspect
import re
import traceback
from pathlib import Path

import jinja2
import pandas as pd
from result_numbers import machine, report
from result_numbers.tables import InputError, Tables
from result_numbers.words import markdown, plain

from . import literals
from .allowed import ALLOWED
from .untraced import untraced_numbers, without_marks

TEMPLATES = "docs/templates"
NUMBERS = "experiments/report/result_numbers"
_PACKAGE = Path(machine.__file__).parent
_NO_STUDIES = {"report", "tables", "words"}
STUDIES = sorted(path.stem for path in _PACKAGE.glob("[a-z]*.py") if path.stem not in _NO_STUDIES)


def page_of(name):
    """The page of a template: that of a study lies in the study's folder."""
    if name == "README.md":
        return name
    if name == "results.md":
        return "results/README.md"
    study = re.fullmatch(r"studies/(.*)\.md", name)
    return f"experiments/{study[1]}/README.md" if study else f"docs/{name}"


def page_files(root):
    """(name of the template, page) by name, those of studies last."""
    folder = Path(root) / TEMPLATES
    names = [path.relative_to(folder).as_posix()
             for place in (folder, folder / "studies") for path in sorted(place.glob("*.md"))]
    return [(name, page_of(name)) for name in names]


# Pages that somebody wrote by hand. What a page is made of elsewhere has a check of its own: the
# program prints scenes/README.md and the list of the catalogue, and a test compares them.
WRITTEN_BY_HAND = [
    "CONTRIBUTING.md",
    "experiments/benchmarks/README.md",
    "experiments/calibrate/data/README.md",
    "experiments/report/README.md",
]


def is_manual(page):
    """Pages of the manual: definitions, formulas, commands and what these print. They have no
    result of a table; a page with results is made from a template."""
    return page in ("CHANGELOG.md", "CODE_OF_CONDUCT.md", "SECURITY.md", "docs/index.md",
                    "docs/reproduce.md") or re.match(
        r"docs/(theory|start|reference|about)/|paper/|\.github/", page) is not None


def results_in_manual(page, text):
    """Where a page of the manual states a share or a time, as results do."""
    text = re.sub(r"^```.*?^```", lambda fence: re.sub(r"[^\n]", "", fence[0]), text, flags=re.M | re.S)
    for pattern in ALLOWED:
        text = pattern.sub("", text)
    return [f"{page}:{number}: '{found}' may be a result; compute it on a page made from a template"
            for number, line in enumerate(text.split("\n"), 1) for found in re.findall(r"[0-9.]+ ?(?:%|[mµn]s\b)", line)]


def untraced(file, template):
    """Where a text names a number or a number word that no query computed."""
    return [f"{file}:{line}: '{text}' is typed by hand; compute it with {{{{ study.query }}}}, or add the definition or input "
            "that it is to experiments/report/prose/allowed.py" for line, text in untraced_numbers(template)]


# These print texts of other sources, and what columns mean.
_QUOTING = {"columns", "python", "references"}


def text_sources(root):
    """Sources whose texts fill slots."""
    findings = (Path(root) / "experiments/report/src/findings").glob("*.mjs")
    return [*(f"{NUMBERS}/{study}.py" for study in STUDIES if study not in _QUOTING),
            *(path.relative_to(root).as_posix() for path in sorted(findings))]


def untraced_literals(file, source):
    found = literals.of_python(source) if file.endswith(".py") else literals.of_javascript(source)
    return [f"{file}:{line + offset - 1}: '{number}' in a text that is printed; compute it"
            for line, text in found for offset, number in untraced_numbers(text)]


def _failure(error):
    """What went wrong in a query, and where."""
    frame = traceback.extract_tb(error.__traceback__)
    own = [one for one in frame if Path(one.filename).parent == _PACKAGE][-1]
    return f"{NUMBERS}/{Path(own.filename).name}:{own.lineno}: {type(error).__name__}: {error}".replace("\n", " ")


def queries_of(study):
    """The public functions of a module of result_numbers by name."""
    module = importlib.import_module(f"result_numbers.{study}")
    return {name: query for name, query in vars(module).items()
            if inspect.isfunction(query) and not name.startswith("_") and query.__module__ == module.__name__}


class Study:
    """The queries of a study, with the tables as their first argument: what templates see."""

    def __init__(self, name, tables):
        self._name, self._tables = name, tables

    def __getattr__(self, name):
        queries = queries_of(self._name)
        if name not in queries:
            raise InputError(f"{self._name}.{name}: no such query; there are: {', '.join(queries)}")
        return lambda *words: self._ask(f"{self._name}.{name}", queries[name], words)

    def _ask(self, name, query, words):
        try:
            inspect.signature(query).bind(self._tables, *words)
        except TypeError as error:
            _, *takes = inspect.signature(query).parameters
            raise InputError(f"{name}: {error}; it takes ({', '.join(takes)})") from error
        before, self._tables.read = self._tables.read, set()
        try:
            return query(self._tables, *words)
        except InputError as error:
            raise InputError(f"{name}: {error}") from error
        except KeyError as error:
            there = ", ".join(f"results/{table}.csv" for table in sorted(self._tables.read))
            raise InputError(f"{name}: no column or row named {error} in {there or 'a manifest'}; make the table again with "
                             f"./tress run, or correct {NUMBERS}/{self._name}.py") from error
        except Exception as error:
            raise InputError(f"{name}: {_failure(error)}; make the tables again with ./tress run, or correct the query") from error
        finally:
            self._tables.read |= before


def _text(value):
    """What a slot prints: the answer of a query, whose tables are Markdown."""
    if callable(value):
        value = value()
    if isinstance(value, pd.DataFrame):
        return markdown(value)
    return value if isinstance(value, str) else plain(value)


def environment(root):
    return jinja2.Environment(loader=jinja2.FileSystemLoader(Path(root) / TEMPLATES), undefined=jinja2.StrictUndefined,
                              finalize=_text, keep_trailing_newline=True)


def _line(error, file):
    """The line of a template on which an error arose."""
    if isinstance(error, jinja2.TemplateSyntaxError):
        return error.lineno
    return [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file][-1]


def fill(templates, name, tables):
    """The template with every slot filled; what is wrong comes with file and line."""
    try:
        template = templates.get_template(name)
        return template.render({study: Study(study, tables) for study in STUDIES})
    except (InputError, jinja2.TemplateError) as error:
        file = str(Path(templates.loader.searchpath[0]) / name)
        remedy = ""
        if isinstance(error, jinja2.UndefinedError):
            remedy = f"; there are: {', '.join(STUDIES)}"
        elif isinstance(error, jinja2.TemplateSyntaxError):
            remedy = "; write {{ study.query }}"
        raise InputError(f"{TEMPLATES}/{name}:{_line(error, file)}: {error}{remedy}") from error


def written_pages(root):
    """{page: (text, tables)} of every page as it must be, and the tables that it was made from."""
    templates = environment(root)
    tables = Tables(root)
    problems, pages = [], {}
    for name, page in page_files(root):
        source = tables.text(f"{TEMPLATES}/{name}")
        problems += untraced(f"{TEMPLATES}/{name}", source)
        tables.read = set()
        filled = without_marks(fill(templates, name, tables)).rstrip()
        for figure in re.findall(r"results/(\w+)\.svg\)", filled):
            tables.read.update(report.figure_tables(tables, figure))
        made = machine.provenance(tables, tables.read)
        head = f"<!-- Made by ./tress report from {TEMPLATES}/{name} and results/: edit those. -->\n"
        pages[page] = (f"{head}{filled}\n" + (f"\n{made}\n" if made else ""), sorted(tables.read))
    if problems:
        raise InputError("\n".join(problems))
    return pages
