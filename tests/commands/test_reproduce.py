"""./tress reproduce, ./tress rerun and ./tress archive, on experiments that are stand-ins. The
page of these commands is docs/reproduce.md."""

import csv
import json
import signal
import subprocess
import sys
import tarfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from stand_ins import House  # noqa: E402
from tress_command.reproduce import archive, judge, load, recipes  # noqa: E402

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


class Everything(Reproduce):
    def test_the_commands_of_the_manifests_are_repeated_in_a_new_folder(self):
        before = (self.results / "damping.csv").read_bytes()
        (self.results / "damping_summary.csv").write_text("a\n1\n")
        (self.results / "player.csv").write_text("a\n1\n")
        (self.toy / "damping_summary.csv").write_text("a\n1\n")
        out = self.ends(0, "damping: 5 of 5 rows agree\n", self.reproduce())
        # Uncertain where other tests run at the same time.
        self.assertRegex(out, r"scaling: 4 of 4 rows agree; times 1 \(1 to 1\)(, uncertain)?\n")
        self.assertIn("3 tables: 9 of 9 rows agree -> build/reproduce/012345678901/report.md", out)
        self.assertRegex(out, r"not made again, .*report\.md has the reasons: player")
        self.assertEqual(self.log(), ["damping --quick",
                                      "scaling --set a=b --out results/scaling.csv"])
        self.assertEqual((self.out / "results/damping.csv").read_bytes(), before)
        self.assertEqual((self.results / "damping.csv").read_bytes(), before)
        page = (self.out / "report.md").read_text()
        self.assertRegex(page, r"\| player \| made by: node tests/report/picture_times\.mjs \|")
        self.assertIn("# Reproduction of tress 7.8.9 at commit 01234567\n", page)
        self.assertNotIn("## Differences", page)

    def test_words_select_tables_or_experiments(self):
        self.table("wide", ["damping", "--full", "--out", "wide.csv"])
        self.ends(0, "^damping: 4 of 4", self.reproduce("damping"))
        self.assertEqual(self.log(), ["damping --quick", "damping --full --out results/wide.csv"])
        self.ends(0, "1 tables: 4 of 4", self.reproduce("wide"))

    def test_a_second_call_goes_on_after_an_interrupt(self):
        self.ends(0, "damping", self.reproduce("damping"))
        (self.toy / "stop").touch()
        self.ends(130, "interrupted in scaling; to go on: ./tress reproduce --wait 0s",
                  self.reproduce())
        (self.out / "results/scaling.csv.journal").touch()
        out = self.ends(0, "damping: made by an earlier call", self.reproduce())
        self.assertIn("8 of 8 rows agree", out)
        self.assertEqual([line.split()[0] for line in self.log()],
                         ["damping", "scaling", "scaling"])
        self.assertRegex(self.log()[-1], " --resume$")
        # Another commit begins again.
        (self.house / "cmake/commit.txt").write_text("f" * 40)
        self.tress("reproduce", "--wait", "0s", "--folder", self.out, "damping")
        self.assertEqual(len(self.log()), 4)

    def test_tables_are_copied_only_if_asked(self):
        self.found(lines=rows(error=0.5))
        (self.house / "experiments/report/prose").mkdir()
        (self.house / "experiments/report/prose/prose.py").write_text("print('pages')\n")
        self.ends(3, "4 changed value", self.reproduce("damping"))
        self.assertIn("0.25", (self.results / "damping.csv").read_text())
        self.ends(3, "pages", self.reproduce("damping", "--write"))
        self.assertNotIn("0.25", (self.results / "damping.csv").read_text())


class Differences(Reproduce):
    def test_a_changed_row_is_named_with_both_values(self):
        changed = rows()
        changed[1][1], changed[2][4] = 0.500001, "diverged"
        self.found(lines=[*changed[:3], ["new", 1, 1, 1, "ok", "", "f" * 16]])
        out = self.ends(3, "damping: 1 of 4 rows agree, 1 changed outcome, 1 changed value, "
                        "1 missing, 1 new\n", self.reproduce("damping"))
        self.assertRegex(out, "1 tables: 1 of 4 rows agree, 1 changed outcome")
        self.assertEqual([(row["run_id"], row["column"], row["verdict"], row["before"],
                           row["after"]) for row in self.differences()], [
            (IDS[1], "error_rel", "changed value", "0.5", "0.500001"),
            (IDS[2], "status", "changed outcome", "ok", "diverged"),
            (IDS[3], "", "missing", "", ""), ("f" * 16, "", "new", "", "")])
        self.assertRegex((self.out / "report.md").read_text(),
                         r"\| damping \| model_\S+, diverged|\| damping \| model_\S+, ok \|")

    def test_rounding_of_the_last_digits_agrees_and_more_does_not(self):
        for factor, steps, code, pattern in (
                (1 + 5e-10, 60, 0, "4 of 4 rows agree"), (1 + 2e-9, 60, 3, "4 changed value"),
                (1, 61, 3, "4 changed value")):
            self.found(lines=rows(error=0.25 * factor, steps=steps))
            self.ends(code, pattern, self.reproduce("damping", "--folder", self.work / str(factor)
                                                    / str(steps)))

    def test_other_arithmetic_may_round_and_is_named(self):
        other = {"cpu": "one", "cpus": 2, "simd": "avx512f", "kernels": "avx512"}
        for factor, steps, code, pattern in (
                (1 + 5e-6, 61, 0, "0 of 4 rows agree, 4 rounding"),
                (1 + 2e-5, 60, 3, "4 changed value"), (1, 62, 3, "4 changed value")):
            self.found(lines=rows(error=0.25 * factor, steps=steps), machine=other)
            out = self.ends(code, pattern, self.reproduce(
                "damping", "--folder", self.work / str(factor) / str(steps)))
            self.assertRegex(out, "the arithmetic differs, so last digits may: widest "
                             "instructions: avx2 -> avx512f; kernels: avx2 -> avx512")

    def test_a_claim_that_no_longer_holds_counts(self):
        self.found(checks=[{"claim": "it holds", "key": "it", "state": "broken"}])
        self.ends(3, "4 of 4 rows agree, 1 changed claim", self.reproduce("damping"))

    def test_times_are_ratios_without_a_verdict(self):
        lines = [[*row[:3], 2 * row[3] + k, *row[4:]] for k, row in enumerate(rows())]
        self.found("scaling", lines)
        out = self.ends(0, r"scaling: 4 of 4 rows agree; times 2\.58 \(2\.38 to 2\.69\)",
                        self.reproduce("scaling"))
        self.assertRegex(out, "4 of 4 rows agree -> ")

    def test_a_choice_by_time_is_no_change(self):
        before, after = (judge.Table.read(folder, "damping") for folder in
                         (self.results, self.toy))
        after.rows[0]["model"] = "other"
        for name, verdicts in (("damping", ["changed value"]),
                               ("cost_of_accuracy", ["other choice"])):
            judged = judge.judge_table(name, before, after)
            self.assertEqual([one["verdict"] for one in judged.found], verdicts)
            self.assertEqual(judged.bad(), name == "damping")
        # So is the number of the further rows of a search, but not that of searches.
        for key, verdict in ((f"{IDS[0]}.001", "other choice"), (IDS[0], "missing")):
            before.rows[0]["run_id"] = key
            after.rows[:] = before.rows[1:]
            (one,) = judge.judge_table("head_accuracy", before, after).found
            self.assertEqual(one["verdict"], verdict)

    def test_an_experiment_that_fails_is_told(self):
        (self.toy / "fail.damping").touch()
        out = self.ends(3, "NOT DONE: exit code 2 of build/release/experiments/damping",
                        self.reproduce())
        self.assertRegex(out, "damping: 0 of 4 rows agree, 1 missing")
        self.assertIn("scaling: 4 of 4 rows agree", out)
        self.ends(2, "no table was made", self.reproduce("damping", "--folder", self.work / "new"))

    def test_programs_of_another_commit_are_named(self):
        self.found(git={"commit": "e" * 40, "dirty": False})
        self.ends(3, "NOT OF THIS COMMIT: damping", self.reproduce("damping"))

    def test_failed_rows_that_the_release_has_too_are_no_difference(self):
        for folder in (self.results, self.toy):
            self.table("damping", ["damping"], rows(status="diverged"), (folder,))
        (self.toy / "code").write_text("3")
        self.ends(0, "4 of 4 rows agree", self.reproduce("damping"))


class Archives(Reproduce):
    def setUp(self):
        super().setUp()
        self.file = self.work / "release.tar.gz"
        self.ends(0, r"^[0-9a-f]{64}  .*release\.tar\.gz\n$",
                  self.tress("archive", "--out", self.file))

    def test_the_same_files_give_the_same_bytes(self):
        other = self.work / "other.tar.gz"
        (self.results / "damping.csv").touch()
        # What .gitignore leaves out of results/.
        (self.results / "scenes").mkdir()
        for name in ("damping.csv.journal", "report.html", "scenes/a.json", "scenes/a.h5"):
            (self.results / name).touch()
        self.ends(0, "other", self.tress("archive", "--out", other))
        self.assertEqual(self.file.read_bytes(), other.read_bytes())

    def test_it_has_checksums_and_facts(self):
        with tarfile.open(self.file) as tar:
            names = tar.getnames()
            self.assertEqual({(one.mtime, one.uid, one.gid, one.uname) for one in tar},
                             {(0, 0, 0, "")})
            tar.extractall(self.work, filter="data")
        self.assertEqual(names, sorted(names))
        folder = self.work / "tress-7.8.9-results"
        facts = json.loads((folder / "MANIFEST.json").read_text())
        self.assertEqual((facts["version"], facts["commit"]), ("7.8.9", COMMIT))
        self.assertEqual(facts["tables"]["damping"]["commit"], COMMIT)
        subprocess.run(["sha256sum", "--quiet", "--strict", "-c", "SHA256SUMS"], cwd=folder,
                       check=True)
        self.ends(0, "4 of 4 rows agree", self.reproduce("--against", folder, "damping"))
        (folder / "damping.csv").write_text("run_id\n1\n")
        self.refused("damping.csv: has another checksum",
                     self.reproduce("--against", folder, "damping"))

    def test_it_is_the_release_of_a_comparison(self):
        (self.results / "damping.csv").unlink()
        self.ends(0, "8 of 8 rows agree", self.reproduce("--against", self.file))

    def test_tables_of_several_commits_are_told(self):
        self.table("damping", ["damping"], folders=(self.results,),
                   git={"commit": "e" * 40, "dirty": True})
        out = self.ends(0, r"come from 01234567 \(1\), eeeeeeee \(1\)",
                        self.tress("archive", "--out", self.file))
        self.assertIn("made with uncommitted changes: damping", out)

    def packed(self, members):
        path = self.work / f"bad{len(list(self.work.iterdir()))}.tar.gz"
        with tarfile.open(path, "w:gz") as tar:
            for name, data, kind in members:
                (self.work / "data").write_bytes(data)
                member = tar.gettarinfo(self.work / "data", name)
                member.type = kind
                with (self.work / "data").open("rb") as file:
                    tar.addfile(member, file if kind == tarfile.REGTYPE else None)
        return path

    def test_what_is_no_release_is_refused(self):
        one = tarfile.REGTYPE
        sums = b"0" * 64 + b"  t.csv\n"
        cut = self.work / "cut.tar.gz"
        cut.write_bytes(self.file.read_bytes()[:-200])
        for path, pattern in (
                (self.packed([("r/t.csv", b"a\n", one)]), "has no SHA256SUMS"),
                (self.packed([("r/t.csv", b"a\n", one), ("r/SHA256SUMS", sums, one)]),
                 "t.csv: has another checksum"),
                (self.packed([("r/u.csv", b"a\n", one), ("r/SHA256SUMS", sums, one)]),
                 "t.csv: is missing"),
                (self.packed([("r/SHA256SUMS", b"", one), ("r/t.csv", b"a\n", one)]),
                 "t.csv: is not in SHA256SUMS"),
                (self.packed([("r/SHA256SUMS", b"x\n", one)]), "SHA256SUMS:1: no checksum"),
                (self.packed([("r/../../t.csv", b"a\n", one)]), "no file of results"),
                (self.packed([("/t.csv", b"a\n", one)]), "no file of results"),
                (self.packed([("r/t.csv", b"", tarfile.SYMTYPE)]), "no file of results"),
                (cut, "no archive of results"), (self.results / "damping.csv", "no archive"),
                ("none", "--against none: neither a folder nor an archive"),
                (self.toy / "..", "has no tables")):
            done = self.reproduce("--against", path, "damping")
            self.ends(2, pattern, done)
            self.assertNotIn("Traceback", done.stderr)
        self.assertEqual([*self.work.glob("*.csv")], [])


class Refusals(Reproduce):
    def git(self, *words):
        subprocess.run(["git", "-C", self.house, "-c", "user.name=a", "-c", "user.email=a@b",
                        *words], check=True, capture_output=True)

    def test_a_tree_that_differs_from_its_commit_is_refused(self):
        self.git("init", "-q")
        self.git("add", "VERSION", "results")
        self.git("commit", "-q", "-m", "one")
        (self.house / "VERSION").write_text("8.0.0\n")
        self.refused("1 files differ from the commit: VERSION; commit or restore",
                     self.reproduce())
        self.git("checkout", "-q", "VERSION")
        # The stand-ins are not of this commit.
        self.ends(3, "4 of 4 rows agree", self.reproduce("damping"))

    def test_bad_words_are_refused_in_one_line(self):
        for words, pattern in (
                (["reproduce", "--fast"], "unknown option '--fast'"),
                (["reproduce", "--against"], "--against without a value"),
                (["reproduce", "--wait", "soon"], "--wait soon: give a duration"),
                (["reproduce", "--wait", "-1"], "--wait -1: give a duration"),
                (["reproduce", "--folder", "results"], "--folder results has the release"),
                (["rerun"], "give one run_id"), (["rerun", IDS[0], IDS[1]], "give one run_id"),
                (["rerun", "--fast"], "unknown option '--fast'"),
                (["rerun", "xyz"], "'xyz' is no run_id"),
                (["rerun", "../../etc/passwd"], "is no run_id"),
                (["rerun", "f" * 16], "no row of results has the run_id f{16}"),
                (["rerun", "--in", "none", IDS[0]], "--in none: neither a folder nor"),
                (["archive", "a", "b"], "give one folder"),
                (["archive", "none"], "no folder 'none'"),
                (["archive", "cmake"], "cmake: has no tables")):
            self.refused(pattern, self.tress(*words))
        self.ends(2, "no table or experiment 'none' in the release; there are: damping scaling",
                  self.reproduce("none"))

    def test_a_manifest_chooses_programs_of_the_experiments_only(self):
        for argv, why in ((["/bin/rm", "-rf", "x"], "no experiment rm"),
                          (["damping", "--plugin", "x.so"], "needs plug-ins"), ([], "no manifest"),
                          (["divided_heads"], "no MPI")):
            self.table("bad", ["damping"], folders=(self.results,))
            meta = self.results / "bad.meta.json"
            meta.write_text(json.dumps(json.loads(meta.read_text()) | {"argv": argv}))
            self.ends(2, f"bad cannot be made by this command: {why}", self.reproduce("bad"))

    def test_sources_without_a_commit_are_refused(self):
        (self.house / "cmake/commit.txt").write_text("$Format:%H$")
        self.refused("these sources have no commit", self.reproduce())

    def test_a_second_call_in_the_folder_is_refused(self):
        self.out.mkdir(parents=True)
        with subprocess.Popen(["flock", self.out / "running.lock", "sleep", "60"]) as holds:
            try:
                while subprocess.run(["flock", "-n", self.out / "running.lock", "true"],
                                     check=False).returncode == 0:
                    pass
                self.refused("another call works in", self.reproduce("damping"))
            finally:
                subprocess.run(["pkill", "-P", str(holds.pid)], check=False)
                holds.send_signal(signal.SIGTERM)


class Rerun(Reproduce):
    def test_one_row_is_run_and_shown_with_the_old_one(self):
        out = self.ends(0, "the row agrees\n", self.tress("rerun", IDS[1]))
        self.assertRegex(out, r"(?m)^damping +release +here$")
        self.assertRegex(out, r"(?m)^error_rel +0\.5 +0\.5$")
        self.assertEqual(self.log(), [f"damping --quick --run-id {IDS[1]} --progress none"])
        self.assertRegex(out, "also in scaling")

    def test_a_row_that_differs_is_told(self):
        self.found(lines=rows(error=0.25025, steps=61), git={"commit": COMMIT})
        out = self.ends(3, "THE ROW DIFFERS", self.tress("rerun", IDS[0]))
        self.assertRegex(out, r"error_rel +0\.25 +0\.25025 +changed value, 0\.001 of its size")
        self.assertRegex(out, r"steps +60 +61 +changed value, 0\.016 of its size")

    def test_a_column_of_the_whole_table_and_times_do_not_count(self):
        lines = [[*row[:2], "", 3 * row[3], *row[4:]] for row in rows()]
        (self.results / "damping.csv").unlink()
        self.found("scaling", lines)
        out = self.ends(0, "the row agrees", self.tress("rerun", IDS[0]))
        self.assertRegex(out, r"steps +60 +needs the whole table")
        self.assertRegex(out, r"wall_s +1 +3 +time, 3 times")

    def test_another_commit_is_named(self):
        (self.house / "cmake/commit.txt").write_text("e" * 40)
        self.ends(0, "the row is of commit 01234567, this is eeeeeeee", self.tress("rerun", IDS[0]))

    def test_an_archive_may_have_the_row(self):
        file = self.work / "a.tar.gz"
        self.ends(0, "a.tar.gz", self.tress("archive", "--out", file))
        (self.results / "damping.csv").unlink()
        (self.results / "scaling.csv").unlink()
        self.ends(0, "the row agrees", self.tress("rerun", "--in", file, IDS[2]))

    def test_a_program_that_refuses_is_told(self):
        (self.toy / "fail.damping").touch()
        self.ends(2, "exit code 2 of: build/release/experiments/damping --quick --run-id",
                  self.tress("rerun", IDS[0]))


class Parts(unittest.TestCase):
    def test_waiting_ends_when_the_machine_is_idle_or_the_time_is_over(self):
        now, told = [0.0], []

        def wait(loads, limit):
            found = iter(loads)
            now[0] = 0

            def look(seconds):
                now[0] += seconds
                return next(found)

            return load.wait_for_idle(limit, told.append, look, lambda: now[0])

        self.assertEqual(wait([0.1], 60), (0.1, 5))
        self.assertEqual(told, [])
        self.assertEqual(wait([1.5, 0.7, 0.2], 60), (0.2, 15))
        self.assertEqual(wait([1.5] * 9, 10), (1.5, 10))
        self.assertEqual(len(told), 2)
        self.assertRegex(told[0], "use 1.5 processors; waiting up to 60 s")
        self.assertEqual(wait([None], 60), (None, 5))

    def test_a_busy_loop_is_load(self):
        with subprocess.Popen(["bash", "-c", "while :; do :; done"]) as busy:
            try:
                # Of one loop about 1; the clock of /proc/stat ticks a hundred times a second.
                self.assertGreater(load.load_of_others(0.5), 0.2)
            finally:
                busy.kill()
        self.assertIsNone(load.busy_s("/none"))

    def test_times_under_load_are_uncertain(self):
        for machine, pattern in (
                ({"cpus": 2, "load_before": [1.5, 0, 0]}, "^$"),
                ({"cpus": 2, "load_before": [2.5, 0, 0]}, "load average 2.5 on 2 processors"),
                ({"cpus": 2, "load_before": [9, 0, 0],
                  "load_of_others_during": {"rows_above": []}}, "^$"),
                ({"load_of_others_during": {"rows_above": ["a", "b"]}}, "2 rows were timed")):
            self.assertRegex(load.doubt({"machine": machine}), pattern)

    def test_cells_are_judged_by_their_kind(self):
        for name, a, b, whole, same, verdict in (
                ("error_rel", 1.0, 1 + 9e-10, False, True, ""),
                ("error_rel", 1.0, 1 + 2e-9, False, True, "changed value"),
                ("error_rel", 1e-12, 2e-12, False, False, "rounding"),
                ("error_rel", 1e-12, 2e-12, False, True, "changed value"),
                ("error_rel", 1e-15, 9e-15, False, True, ""),
                ("t_s", 1e-12, 2e-12, False, False, "changed value"),
                ("t_s", 1.0, 1 + 9e-6, False, False, "rounding"),
                ("steps", 10, 11, True, True, "changed value"),
                ("steps", 10, 11, True, False, "rounding"),
                ("steps", 10, 12, True, False, "changed value"),
                ("why", "at 0.1 s", "at 0.2 s", False, True, "changed value"),
                ("why", "at 0.1 s", "at 0.2 s", False, False, "rounding"),
                ("status", "ok", "diverged", False, False, "changed outcome"),
                ("passed", 1, 0, True, False, "changed outcome"),
                ("x", 1.0, None, False, False, "changed value"),
                ("x", None, None, False, True, "")):
            self.assertEqual(judge.judge_cell(name, a, b, whole, same), verdict, (name, a, b))

    def test_quartiles(self):
        self.assertEqual(judge.quartiles([2.0]), (2, 2, 2))
        self.assertEqual(judge.quartiles([1.0, 2.0, 3.0, 4.0, 5.0]), (2, 3, 4))

    def test_every_table_of_the_repository_has_a_recipe_or_a_reason(self):
        for table in recipes.OTHER_WAYS:
            self.assertTrue((Path(__file__).parents[2] / f"results/{table}.csv").exists(), table)
        self.assertEqual(archive.commits_of({"a": {"commit": "x"}, "b": {"commit": "y"},
                                             "c": {"commit": "y"}}), [("y", 2), ("x", 1)])


if __name__ == "__main__":
    unittest.main()
