"""For tests of ./tress cluster: small sweeps, and tables that must have the same rows."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "python")]
import tress_test  # noqa: E402

# The programs of the build that is tested.
PROGRAMS = Path(os.environ.get("TRESS_PROGRAMS", ROOT / "build/release/experiments")).resolve()
LIMITS = ("stability_limit", "--quick", "--models", "mass_spring,der",
          "--integrators", "linearly_implicit_euler")
FAMILY = ("family", "--quick", "--set", "study=twist", "--set", "hairs=8")


def lasting(file):
    """Returns the cells of a table, without the columns that its manifest calls timings."""
    timings = json.loads(file.with_suffix(".meta.json").read_text())["timings"]
    with file.open(newline="") as lines:
        header, *rows = csv.reader(lines)
    kept = [i for i, name in enumerate(header) if name not in timings]
    return [[cells[i] for i in kept] for cells in (header, *rows)]


class SweepTest(tress_test.TressTest):
    """A test of sweeps by the programs that are built."""

    def cluster(self, *words, **environment):
        return tress_test.run("cluster", *words,
                         **{"TRESS_PROGRAMS": PROGRAMS, **environment})

    def one_process(self, experiment, *args):
        """Returns the table that one process writes."""
        out = self.work / f"alone_{experiment}.csv"
        done = subprocess.run(
            [PROGRAMS / experiment, *args, "--jobs", "1", "--progress", "none", "--out", out],
            cwd=ROOT, capture_output=True, text=True, check=False)
        self.assertIn(done.returncode, (0, 3), done.stderr)
        return out

    def same(self, one, other):
        """Asserts the same rows in the same order, but for timings."""
        self.assertEqual(lasting(one), lasting(other))
