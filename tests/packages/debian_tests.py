"""The tests of debian/tests and the packages that each needs."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TESTS = ROOT / "debian/tests"


def stanzas():
    """Returns the tests of debian/tests/control with the packages that each needs."""
    text = (TESTS / "control").read_text(encoding="utf-8")
    found = re.findall(r"^Tests: (\S+)\nDepends: (.+)$", text, re.MULTILINE)
    return [(test, [one.strip() for one in depends.split(",")]) for test, depends in found]


def report(what, names, failed):
    """Prints how many tests passed. Returns the exit code."""
    print(f"{what}: {len(names) - len(failed)} of {len(names)} tests passed"
          + (f"; failed: {', '.join(failed)}" if failed else ""), flush=True)  # fmt: skip
    return 3 if failed else 0
