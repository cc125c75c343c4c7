#!/usr/bin/env python3
"""README.md, results/README.md and docs/ from docs/templates/ and results/*.csv."""
import argparse
import sys
from pathlib import Path

sys.path[0] = str(Path(__file__).resolve().parents[1])

from prose.pages import written_pages  # noqa: E402
from result_numbers.tables import REPOSITORY, InputError  # noqa: E402


def difference(page, is_text, should):
    """The first line in which two texts differ, as a message."""
    there, made = is_text.split("\n"), should.split("\n")
    at = next((k for k, (a, b) in enumerate(zip(there, made)) if a != b), min(len(there), len(made)))
    says, should_say = (lines[at] if at < len(lines) else "" for lines in (there, made))
    return f'{page}:{at + 1}: says "{says}", tables and template say "{should_say}"; run: ./tress report'


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root", metavar="ROOT", nargs="?", type=Path, default=REPOSITORY,
                        help="repository (default: the one that holds this program)")
    parser.add_argument("--check", action="store_true",
                        help="writes nothing; exit code 3 when a page differs from templates and tables")
    options = parser.parse_args()
    pages = written_pages(options.root)
    there = {page: path.read_text() if (path := options.root / page).exists() else None for page in pages}
    stale = [page for page, (text, _) in pages.items() if there[page] != text]
    if options.check:
        for page in stale:
            print(difference(page, there[page] or "", pages[page][0]), file=sys.stderr)
        return 3 if stale else 0
    for page in stale:
        (options.root / page).parent.mkdir(parents=True, exist_ok=True)
        (options.root / page).write_text(pages[page][0])
    print(f"prose: {len(pages)} pages, {len(stale)} of them changed", file=sys.stderr)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except InputError as error:
        print(f"prose: {error}", file=sys.stderr)
        sys.exit(2)
