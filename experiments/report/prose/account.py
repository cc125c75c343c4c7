#!/usr/bin/env python3
"""Every number and number word of every page by its origin: queries, regions of inputs, the list
of definitions. A number that none of these accounts for, or a page that differs from templates
and tables, is exit code 3."""
import argparse
import sys
from pathlib import Path

sys.path[0] = str(Path(__file__).resolve().parents[1])

from prose.pages import (TEMPLATES, WRITTEN_BY_HAND, page_files, text_sources, untraced, untraced_literals,  # noqa: E402
                         written_pages)
from prose.untraced import counted  # noqa: E402
from result_numbers.tables import REPOSITORY, InputError  # noqa: E402


def account(root, made):
    """{page: {slots, inputs, allowed, tables, problems}} of all pages and sources of texts; `made`:
    written_pages(root)."""
    def read(path):
        return (root / path).read_text()

    pages = {}
    for name, page in page_files(root):
        text, tables = made[page]
        stale = (root / page).exists() and read(page) != text
        problems = [f"{page}: differs from templates and tables; run: ./tress report"] if stale else []
        pages[page] = {**counted(read(f"{TEMPLATES}/{name}")), "tables": tables, "problems": problems}
    for page in WRITTEN_BY_HAND:
        pages[page] = {**counted(read(page)), "tables": [], "problems": untraced(page, read(page))}
    for source in text_sources(root):
        pages[source] = {"slots": 0, "inputs": 0, "allowed": 0, "tables": [],
                         "problems": untraced_literals(source, read(source))}
    return pages


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root", metavar="ROOT", nargs="?", type=Path, default=REPOSITORY,
                        help="repository (default: the one that holds this program)")
    root = parser.parse_args().root
    pages = account(root, written_pages(root))
    print("page: queries, inputs, definitions, unaccounted; tables")
    for page, of in pages.items():
        print(f"{page}: {of['slots']}, {of['inputs']}, {of['allowed']}, {len(of['problems'])}; {' '.join(of['tables'])}")
    problems = [problem for of in pages.values() for problem in of["problems"]]
    print(*problems, sep="\n", end="\n" if problems else "", file=sys.stderr)
    print(f"{len(problems)} unaccounted on {len(pages)} pages and sources of texts")
    return 3 if problems else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except InputError as error:
        print(f"account: {error}", file=sys.stderr)
        sys.exit(2)
