"""A release of two tables, and experiments that are stand-ins, for tests of ./tress reproduce."""

import csv
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from stand_ins import House  # noqa: E402

COMMIT = "0123456789" * 4
IDS = [f"{i:016x}" for i in range(4)]
# Copies its table from toy/, as an experiment would measure it; --run-id leaves one row.
TOY = r"""
name=$(basename "$0") out=
for ((i = 1; i <= $#; ++i)); do
  case ${!i} in
    --out) k=$((i + 1)) out=${!k} ;;
    --run-id) k=$((i + 1)) id=${!k} ;;
  esac
done
out=${out:-results/$name.csv}
echo "$name $*" >>toy/log
[[ ! -e toy/stop ]] || { rm toy/stop; exit 130; }
[[ ! -e toy/fail.$name ]] || exit 2
table=$(basename "$out" .csv)
sed "1p;${id:+/$id/!}d" toy/"$table".csv >"$out.part"
[[ -n $id ]] || cp toy/"$table".csv "$out.part"
mv "$out.part" "$out"
cp toy/"$table".meta.json "${out%.csv}.meta.json"
[[ ! -e toy/"$table"_summary.csv ]] || cp toy/"$table"_summary.csv results/
exit "$(<toy/code)"
"""


def rows(error=0.25, time=1.0, steps=60, status="ok", ids=IDS):
    return [[f"model_{i}", error * (k + 1), steps + k, time * (k + 1), status, "", i]
            for k, i in enumerate(ids)]


class Reproduce(House):
    def setUp(self):
        super().setUp()
        (self.house / "cmake/commit.txt").write_text(COMMIT)
        (self.house / "VERSION").write_text("7.8.9\n")
        self.results, self.toy = self.house / "results", self.house / "toy"
        for folder in (self.results, self.toy):
            folder.mkdir()
        (self.toy / "code").write_text("0")
        self.experiments("damping", "scaling")
        self.table("damping", ["build/release/experiments/damping", "--quick"])
        self.table("scaling", ["./scaling", "--progress", "none", "--set", "a=b", "--out=x.csv"])
        self.out = self.house / f"build/reproduce/{COMMIT[:12]}"

    def table(self, name, argv, lines=None, folders=None, **facts):
        """Writes a table of the release, and what the experiment will find."""
        self.study(argv[0].rpartition("/")[2], TOY)
        for folder in folders or (self.results, self.toy):
            with (folder / f"{name}.csv").open("w", newline="") as file:
                csv.writer(file, lineterminator="\n").writerows(
                    [["model", "error_rel", "steps", "wall_s", "status", "reason", "run_id"],
                     *(lines or rows())])
            meta = {"argv": argv, "timings": ["wall_s"] if name == "scaling" else [],
                    "git": {"commit": COMMIT, "dirty": False},
                    "build": {"compiler": "GNU 1", "flags": "-O3"},
                    "machine": {"cpu": "one", "cpus": 2, "simd": "avx2", "kernels": "avx2"},
                    "checks": [{"claim": "it holds", "key": "it", "state": "held"}]} | facts
            (folder / f"{name}.meta.json").write_text(json.dumps(meta))

    def found(self, name="damping", lines=None, **facts):
        """Writes what the experiment will find."""
        self.table(name, [f"build/release/experiments/{name}", "--quick"], lines, (self.toy,),
                   **facts)

    def log(self):
        """Returns what the experiments were called with."""
        return (self.toy / "log").read_text().splitlines()

    def reproduce(self, *words):
        return self.tress("reproduce", "--wait", "0s", *words)

    def differences(self):
        with (self.out / "comparison.csv").open(newline="") as lines:
            return [row for row in csv.DictReader(lines) if row["verdict"] != "time"]
