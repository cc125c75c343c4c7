"""./tress compare: what is equal, changed, missing, slower; and that noise alone is nothing."""

import csv
import json
import math
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "python")]
import tress_test  # noqa: E402
from tress_command.compare.intervals import fewest, spread  # noqa: E402
from tress_command.number_text import precise, rounded, shortest  # noqa: E402

MODELS = ("der", "corde", "super_helix", "mass_spring", "a", "b", "c", "d")


def rows(error=lambda i: 0.25, time=lambda i: i + 1):
    return [f"{model},5,{error(i)},{time(i)}" for i, model in enumerate(MODELS)]


def table(lines, cpu="one"):
    machine = {"cpu": cpu, "simd": "avx2"}
    return {"swing.csv": "\n".join(["model,elements,error,wall_s", *lines, ""]),
            "swing.meta.json": json.dumps({"timings": ["wall_s"], "machine": machine})}


class Compared:
    """A comparison's exit code and output, rows and page."""

    def __init__(self, done, stem):
        self.done, self.code, self.stdout = done, done.returncode, done.stdout
        self.file = Path(f"{stem}.csv")
        self.page = Path(f"{stem}.html")

    def rows(self):
        with self.file.open(newline="") as lines:
            return list(csv.DictReader(lines))

    def of(self, verdict):
        return [row for row in self.rows() if row["verdict"] == verdict]


class CompareTest(tress_test.TressTest):
    def setUp(self):
        super().setUp()
        self.made = 0
        self.before = self.folder(table(rows()))

    def folder(self, files):
        self.made += 1
        path = self.work / f"folder{self.made}"
        path.mkdir()
        for name, text in files.items():
            (path / name).write_text(text)
        return path

    def compare(self, *words):
        self.made += 1
        stem = self.work / f"out{self.made}"
        return Compared(tress_test.run("compare", *words, "--out", stem), stem)


class Tables(CompareTest):
    def test_timings_and_the_sixth_digit_do_not_count(self):
        other = self.folder(table(rows(lambda i: 0.2500001, lambda i: (i + 1) * 1.01)))
        equal = self.compare(self.before, other)
        self.assertRegex(equal.stdout, "swing: 8 of 8 rows agree")
        self.assertEqual(equal.code, 0)
        self.assertEqual([row["verdict"] for row in equal.rows()], ["same"])

    def test_another_value_counts(self):
        other = self.folder(table(rows(lambda i: 0.251 if i == 1 else 0.25, lambda i: 1)))
        changed = self.compare(self.before, other)
        self.assertRegex(changed.stdout, "swing: 7 of 8 rows agree")
        (row,) = changed.of("changed value")
        self.assertEqual((row["row"], row["column"], row["change"]),
                         ("corde", "error", "error: 0.25 -> 0.251"))
        self.assertEqual(changed.code, 3)
        self.assertIn("error: 0.25 -&gt; 0.251", changed.page.read_text())

    def test_a_new_column_does_not_count(self):
        with_more = table([f"{line},1" for line in rows()])
        with_more["swing.csv"] = with_more["swing.csv"].replace("wall_s", "wall_s,more", 1)
        self.assertEqual(self.compare(self.before, self.folder(with_more)).code, 0)

    def test_fewer_rows_or_tables_count_and_more_do_not(self):
        fewer = self.compare(self.before, self.folder(table(rows()[1:])))
        self.assertEqual([row["row"] for row in fewer.of("only before")], ["der"])
        self.assertEqual(fewer.code, 3)
        more = self.compare(self.before, self.folder(table([*rows(), "new,5,1,1"])))
        self.assertEqual([row["row"] for row in more.of("only after")], ["new"])
        self.assertEqual(more.code, 0)
        other = self.compare(self.before, self.folder({"other.csv": "x\n1\n"}))
        self.assertRegex(other.stdout, "swing: no such table after")
        self.assertEqual(other.code, 3)

    def test_a_slower_table_is_a_verdict_on_one_kind_of_machine_only(self):
        slow = rows(time=lambda i: (i + 1) * 1.3)
        slower = self.compare(self.before, self.folder(table(slow)))
        self.assertRegex(slower.stdout, r"slower: swing median of 8 rows wall_s: 1\.300 times")
        self.assertEqual(slower.code, 3)
        self.assertEqual(
            self.compare(self.before, self.folder(table(slow)), "--threshold", "1.4").code, 0)
        elsewhere = self.compare(self.before, self.folder(table(slow, "two")))
        self.assertEqual(elsewhere.rows()[0]["verdict"], "other machine")
        self.assertEqual(elsewhere.code, 0)

    def test_rows_with_an_id_match_in_any_order(self):
        one = "run_id,model,error\nx1,der,0.5\nx2,der,0.25\n"
        other = "run_id,model,error\nx2,der,0.25\nx1,der,0.5\n"
        same = self.compare(self.folder({"t.csv": one}), self.folder({"t.csv": other}))
        self.assertRegex(same.stdout, "t: 2 of 2 rows agree")
        # Without the id the rows have one key, and their order tells them apart.
        one, other = (text.replace("x1,", "").replace("x2,", "").replace("run_id,", "")
                      for text in (one, other))
        changed = self.compare(self.folder({"t.csv": one}), self.folder({"t.csv": other}))
        self.assertRegex(changed.stdout, "t: 0 of 2 rows agree")

    def test_a_slower_stored_benchmark_needs_every_pairing(self):
        def stored(times, cpu="one"):
            benchmarks = [{"run_type": "iteration", "run_name": "solve", "cpu_time": time}
                          for time in times]
            benchmarks.append({"run_type": "aggregate", "run_name": "solve", "cpu_time": 99})
            text = json.dumps({"context": {"cpu": cpu, "simd": "avx2"}, "benchmarks": benchmarks})
            return self.folder({"bench_toy.json": text})

        before = stored([10, 11])
        for times, verdict, code in (([12, 13], "slower", 3), ([11, 13], "same", 0),
                                     ([8, 9], "faster", 0)):
            found = self.compare(before, stored(times))
            self.assertEqual(([row["verdict"] for row in found.rows()], found.code),
                             ([verdict], code), times)
        (row,) = self.compare(before, stored([20, 21], "two")).rows()
        self.assertEqual(row["verdict"], "other machine")

    def test_bad_tables_are_refused_with_their_line(self):
        for text, pattern in (
            ("", r"t\.csv:1: empty, expected a header row"),
            ("a,a\n1,2\n", r"t\.csv:1: column 'a' appears twice"),
            ("a,b\n1,2\n\n1\n", r"t\.csv:4: 1 fields where the header has 2"),
            ('a,b\n1,2\n"1,2\n', r"t\.csv:3: a quote is opened and never closed"),
            ("a\0,b\n", r"t\.csv: not UTF-8 text"),
        ):
            bad = self.folder({"t.csv": text})
            self.refused(pattern, self.compare(bad, bad).done)
        bad = self.folder(table(rows()) | {"swing.meta.json": "{"})
        self.refused(r"swing\.meta\.json: not valid JSON", self.compare(bad, bad).done)
        bad = self.folder(table(rows()) | {"swing.meta.json": "[]"})
        self.refused(r"swing\.meta\.json: not a JSON object", self.compare(bad, bad).done)
        bad = self.folder({})
        (bad / "t.csv").mkdir()
        self.refused(r"t\.csv: a folder", self.compare(bad, bad).done)


# Google Benchmark's options and file; times with the noise of a shared machine: 3 % either
# way, and one in ten is half as long again. Every run has other noise, every test the same.
TOY = r"""#!/bin/bash
runs=$(<RUNS)
echo $((runs + 1)) >RUNS
RANDOM=$((7919 * runs + SEED))
for word in "$@"; do
  case $word in
    --benchmark_out=*) out=${word#*=} ;;
    --benchmark_filter=*) filter=${word#*=} ;;
  esac
done
comma=
{
  echo '{"context": {}, "benchmarks": ['
  for name in solve/{1..6}{,,} step/{1..6}{,,}; do
    [[ $name =~ $filter ]] || continue
    time=$((9700 + RANDOM % 600))
    ((RANDOM % 10)) || time=$((time * 3 / 2))
    [[ $name != 'SLOWED' ]] || time=$((time * 11 / 10))
    printf '%s{"name": "%s", "run_type": "iteration", "cpu_time": %d}\n' "$comma" "$name" "$time"
    comma=,
  done
  echo ']}'
} >"$out"
"""


class Builds(CompareTest):
    def build(self, slowed="", name="bench_toy", text=TOY):
        self.made += 1
        path = self.work / f"build{self.made}"
        program = path / "experiments/benchmarks" / name
        program.parent.mkdir(parents=True)
        (path / "runs").write_text("0")
        for word, value in (("RUNS", path / "runs"), ("SEED", self.made), ("SLOWED", slowed)):
            text = text.replace(word, str(value))
        program.write_text(text)
        program.chmod(0o755)
        return path

    def test_noise_is_no_verdict(self):
        for _ in range(4):
            same = self.compare(self.build(), self.build())
            self.assertEqual(same.code, 0, same.stdout)
            self.assertEqual(len(same.rows()), 12)

    def test_a_kernel_that_is_a_tenth_slower_is_found_and_no_other(self):
        slower = self.compare(self.build(), self.build("step/3"))
        self.assertEqual([(row["row"], row["verdict"]) for row in slower.rows()
                          if row["verdict"] != "same"], [("step/3", "slower")])
        self.assertEqual(slower.code, 3)
        self.assertRegex(slower.done.stderr, r"bench_toy, \d+ again: round 1 of 30")
        faster = self.compare(self.build("step/3"), self.build())
        self.assertEqual([row["row"] for row in faster.of("faster")], ["step/3"])
        self.assertEqual(faster.code, 0)

    def test_a_filter_selects_and_may_select_nothing(self):
        some = self.compare(self.build(), self.build(), "--filter", "^step", "--rounds", "8")
        self.assertEqual({row["row"] for row in some.rows()}, {f"step/{i}" for i in range(1, 7)})
        none = self.compare(self.build(), self.build(), "--filter", "nothing", "--rounds", "8")
        self.assertRegex(none.stdout, "^nothing to compare -> ")
        self.assertEqual(none.code, 0)

    def test_a_program_that_one_build_lacks(self):
        found = self.compare(self.build(), self.build(name="bench_other"))
        self.assertEqual([(row["table"], row["verdict"]) for row in found.rows()],
                         [("bench_toy", "only before"), ("bench_other", "only after")])
        self.assertEqual(found.code, 3)

    def test_a_program_without_timings_is_refused(self):
        silent = self.build(text="#!/bin/bash\nexit 4\n")
        self.ends(2, "bench_toy: wrote no timings .exit code 4.; run it by hand",
                  self.compare(silent, silent).done)

    def test_what_cannot_be_compared_is_refused(self):
        for words, pattern in (
            ([self.before, "/nowhere"], "/nowhere: neither a folder nor a commit"),
            ([self.before, "--upload-pack=x"], "unknown option '--upload-pack=x'"),
            ([self.before], "give two"),
            ([self.before, self.before, self.before], "give two"),
            ([self.before, self.before, "--threshold", "x"], "--threshold x: give a number"),
            ([self.before, self.before, "--rounds", "7"], "--rounds 7: give a number from 8"),
            ([self.before, self.before, "--fast", "1"], "unknown option '--fast'"),
            ([self.before, self.build()], "give two of one kind"),
            ([self.before, self.folder({})], "holds neither tables nor experiments/benchmarks"),
        ):
            self.refused(pattern, self.compare(*words).done)
        self.refused("--out without a value", tress_test.run("compare", "a", "b", "--out"))


class Commits(tress_test.TressTest):
    def test_a_commit_that_cannot_be_built_names_its_log(self):
        """In a repository of its own, whose only commit has no build."""
        house = self.work / "house"
        (house / "cmake").mkdir(parents=True)
        for name in ("tress", "cmake", "python"):
            subprocess.run(["cp", "-r", ROOT / name, house], check=True)
        git = ["git", "-C", house, "-c", "user.name=a", "-c", "user.email=a@b"]
        for words in (["init", "-q"], ["commit", "-q", "--allow-empty", "-m", "empty"]):
            subprocess.run([*git, *words], check=True)
        done = tress_test.run("compare", "HEAD", "HEAD", program=house / "tress",
                         TRESS_SUNDIALS_ROOT="/usr")
        self.ends(2, "HEAD: cmake --preset failed; log: .*/build/compare/[0-9a-f]{12}.log", done)
        (log,) = (house / "build/compare").glob("*.log")
        self.assertRegex(log.read_text(), "(?i)preset")


class Numbers(unittest.TestCase):
    def test_intervals_of_the_median_are_those_of_the_sign_test(self):
        # 2/2^7 > 1 % > 2/2^8; of 10 values the outermost, of 12 the next ones: 2 (1 + 12)/2^12.
        self.assertEqual(fewest(0.99), 8)

        def count(n):
            return tuple(spread(range(n), 0.99).values())

        self.assertEqual(count(7), (3, 0, math.inf))
        self.assertEqual(count(10), (4.5, 0, 9))
        self.assertEqual(count(12), (5.5, 1, 10))
        # 2.576 sqrt(n)/2 about the middle, where there are many.
        _, low, high = count(10000)
        self.assertLess(abs(low - (4999.5 - 128.8)), 2)
        self.assertEqual(low + high, 9999)

    def test_numbers_of_tables_have_an_exponent_only_far_from_1(self):
        for value, text in ((0, "0"), (5, "5"), (5.0, "5"), (0.1, "0.1"), (1e-6, "0.000001"),
                            (1.25e-5, "0.0000125"), (1e-7, "1e-7"), (-2.5e-6, "-0.0000025"),
                            (1e16, "10000000000000000"), (1.5e300, "1.5e+300")):
            self.assertEqual(shortest(value), text)
            self.assertEqual(float(text), value)
        self.assertEqual(rounded(123456.7, 5), "123460")
        self.assertEqual(rounded(2.5e-8 / 3, 5), "8.3333e-9")
        for value, digits, text in ((0.1, 2, "0.10"), (12, 2, "12"), (120, 2, "1.2e+2"),
                                    (0.0000123, 3, "0.0000123"), (9.996, 3, "10.0"),
                                    (1.23e-7, 2, "1.2e-7")):
            self.assertEqual(precise(value, digits), text)


if __name__ == "__main__":
    unittest.main()
