"""real_builds.py BUILD [--runs n]: does ./tress compare find a kernel that does a tenth more
work, and nothing in a build beside itself? BUILD has the benchmarks (preset bench). The slowed
program is compiled from the same sources, but for a header in which every tenth element of a
strand is shaped twice; a run with it to four without. Writes results/compare_itself.csv; a row
is a run."""

import argparse
import csv
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support")]
import tress_test  # noqa: E402

PROGRAM = "experiments/benchmarks/bench_strands"
HEADER = "models/reduced/kinematics.h"
WORK = "      shape_segment(i, q);\n"
TWICE = "      if (i % 10 == 0) shape_segment(i, q);\n"
# The slowed one, and five that do none of its work.
SLOWED = "geometry/bend_twist/20"
FILTER = "|".join(f"^{name}$" for name in (
    "(geometry|motion|matrices)/bend_twist/20",
    "residual/recursive/exact/bend_twist/20",
    "(linearize|solve)/recursive/stiff/bend_twist/20"))
COLUMNS = "beside,rows,wrong,verdict,ratio,ratio_low,ratio_high"


def place(scratch, name):
    """Returns where the program of a folder is that ./tress compare takes for a build."""
    path = scratch / name / PROGRAM
    path.parent.mkdir(parents=True)
    return path


def compile_slowed(build, scratch):
    """Compiles with the build's own commands, with the changed header before the others."""
    text = (ROOT / HEADER).read_text()
    if WORK not in text:
        sys.exit(f"{HEADER} has lost '{WORK.strip()}'")
    changed = scratch / HEADER
    changed.parent.mkdir(parents=True)
    changed.write_text(text.replace(WORK, WORK + TWICE, 1))
    target, objects = place(scratch, "slowed"), scratch / "slowed.o"
    commands = subprocess.run(["ninja", "-t", "commands", PROGRAM], cwd=build, check=True,
                              capture_output=True, text=True).stdout.splitlines()
    compiling = next(line for line in commands if re.search(r" -c \S*bench_strands\.cpp$", line))
    linking = next(line for line in commands if f" -o {PROGRAM} " in line)
    own = re.search(r" -o (\S+)", compiling)[1]
    for command in (
        compiling.replace(" -I", f" -I{scratch} -I", 1).replace(f" -o {own}", f" -o {objects}"),
        linking.replace(f" {own}", f" {objects}").replace(f" -o {PROGRAM}", f" -o {target}"),
    ):
        subprocess.run(["bash", "-c", command], cwd=build, check=True)


def compared(scratch, beside):
    """Returns the number of rows and of wrong verdicts, and what the slowed row says."""
    stem = scratch / "out"
    done = tress_test.run("compare", scratch / "own", scratch / beside, "--filter", FILTER,
                     "--out", stem)
    if done.returncode not in (0, 3):
        sys.exit(done.stderr)
    with open(f"{stem}.csv", newline="") as lines:
        rows = list(csv.DictReader(lines))
    kernel = next(row for row in rows if row["row"] == SLOWED)
    right = {row["row"]: "slower" if beside == "slowed" and row is kernel else "same"
             for row in rows}
    wrong = sum(row["verdict"] != right[row["row"]] for row in rows)
    return [len(rows), wrong, *(kernel[name] for name in ("verdict", "ratio", "low", "high"))]


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("build", type=Path)
    options.add_argument("--runs", type=int, default=20)
    options = options.parse_args()
    build = options.build.resolve()
    lines = [COLUMNS]
    with tempfile.TemporaryDirectory(prefix="tress-builds-") as folder:
        scratch = Path(folder)
        for name in ("own", "itself"):
            shutil.copy(build / PROGRAM, place(scratch, name))
        compile_slowed(build, scratch)
        for beside, runs in (("itself", options.runs), ("slowed", options.runs // 4)):
            for _ in range(runs):
                lines.append(",".join(map(str, [beside, *compared(scratch, beside)])))
                print(lines[-1], flush=True)
    (ROOT / "results/compare_itself.csv").write_text("\n".join([*lines, ""]))


if __name__ == "__main__":
    main()
