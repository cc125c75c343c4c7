"""What --help of each experiment says of --quick and --full, against --dry-run and the manifests.

test_sizes.py PROGRAMS: the folder with the compiled experiments."""

import json
import re
import subprocess
import sys
import unittest
from datetime import datetime
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = Path(sys.argv.pop()) if len(sys.argv) > 1 else ROOT / "build/release/experiments"
SECONDS = {"s": 1, "min": 60}
OTHER_MACHINES = 4  # a shipped table may be of a faster or slower one
# Studies with rows for each pack of SIMD lanes, of which `./tress test` compiles some.
OF_PACKS = ["heads"]


def has_all_packs():
    cache = PROGRAMS.parent / "CMakeCache.txt"
    return "TRESS_PACKS:STRING=all\n" in cache.read_text(encoding="utf-8")


def output(name, *options):
    return subprocess.run([PROGRAMS / name, *options], capture_output=True, text=True, cwd=ROOT,
                          check=True, timeout=120).stdout


def rows(name, size):
    return len(output(name, size, "--dry-run", "--out", "-").splitlines())


def text_of(help_text, size):
    """The words behind an option, on as many lines as they take."""
    found = re.search(rf"(?m)^  {size} +([^\n]*(?:\n {{20,}}[^\n]*)*)", help_text)
    return " ".join(found[1].split())


def measured_s(name):
    """Wall time of the shipped table; None where it is not of --quick."""
    path = ROOT / f"results/{name}.meta.json"
    manifest = json.loads(path.read_text(encoding="utf-8"))
    ends = [datetime.fromisoformat(manifest[key]) for key in ("start", "end")]
    return (ends[1] - ends[0]).total_seconds() if manifest["quick"] else None


class Sizes(unittest.TestCase):
    def test_rows_and_times_are_those_of_the_program(self):
        names = (PROGRAMS / "list.txt").read_text(encoding="utf-8").split()
        studies = [name for name in names if name != "simulate"]
        self.assertGreater(len(studies), 15)
        for name in studies:
            help_text = output(name, "--help")
            quick, full = text_of(help_text, "--quick"), text_of(help_text, "--full")
            with self.subTest(name):
                count = rows(name, "--quick")
                self.assertRegex(quick, r"^as \./tress run: \d+ rows\b")
                rows_told = int(re.search(r"\d+", quick)[0])
                if name in OF_PACKS and not has_all_packs():
                    self.assertIn(count, range(1, rows_told))
                else:
                    self.assertEqual(count, rows_told)
                if rows(name, "--full") == count:
                    self.assertRegex(full, rf"^(the same rows|{count} rows,)")
                else:
                    self.assertRegex(full, rf"^{rows(name, '--full')} rows\b")
                told = re.search(r"([\d.]+) (s|min)$", quick)
                taken = measured_s(name)
                if taken is not None:
                    self.assertIsNotNone(told, quick)
                    seconds = float(told[1]) * SECONDS[told[2]]
                    self.assertLess(max(taken, 1), OTHER_MACHINES * max(seconds, 1))
                    self.assertLess(max(seconds, 1), OTHER_MACHINES * max(taken, 1))


if __name__ == "__main__":
    unittest.main()
