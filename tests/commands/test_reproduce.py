"""./tress reproduce, on experiments that are stand-ins. Its page is docs/reproduce.md."""

import json
import os
import signal
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from page_commands import page_commands  # noqa: E402
from stand_ins import ROOT  # noqa: E402
from toy_release import COMMIT, IDS, Reproduce, rows  # noqa: E402


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
        self.ends(0, "1 table: 4 of 4", self.reproduce("wide"))

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


class Page(Reproduce):
    def test_commands_of_the_pages_as_they_stand(self):
        self.experiments("damping", "scaling", "matrices")
        self.table("matrices", ["matrices"], rows(ids=["d7ff59fbcddbcdc9", *IDS[1:]]))
        commands = page_commands(ROOT, "docs/reproduce.md")
        cited = page_commands(ROOT, "docs/about/citing.md")
        commands += [command for command in cited if command.text.startswith("./tress")]
        self.assertEqual(len(commands), 6)
        for command in commands:
            # A machine at work would be waited for.
            wait = " --wait 0s" if command.text.startswith("./tress reproduce") else ""
            done = subprocess.run(
                ["bash", "-c", command.text + wait], cwd=self.house, stdin=subprocess.DEVNULL,
                capture_output=True, text=True, check=False,
                env=os.environ | {"PATH": f"{self.work}/bin:{os.environ['PATH']}",
                                  "TRESS_CACHE": f"{self.work}/cache"})
            self.ends(0, "rows? agrees?|release.tar.gz", done)


class Differences(Reproduce):
    def test_a_changed_row_is_named_with_both_values(self):
        changed = rows()
        changed[1][1], changed[2][4] = 0.500001, "diverged"
        self.found(lines=[*changed[:3], ["new", 1, 1, 1, "ok", "", "f" * 16]])
        out = self.ends(3, "damping: 1 of 4 rows agree, 1 changed outcome, 1 changed value, "
                        "1 missing, 1 new\n", self.reproduce("damping"))
        self.assertRegex(out, "1 table: 1 of 4 rows agree, 1 changed outcome")
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

    def test_an_experiment_that_fails_is_told(self):
        (self.toy / "fail.damping").touch()
        out = self.ends(3, "NOT DONE: exit code 2 of build/release/experiments/damping",
                        self.reproduce())
        self.assertRegex(out, "damping: 0 of 4 rows agree, 1 missing")
        self.assertIn("scaling: 4 of 4 rows agree", out)
        self.ends(2, "no table was made", self.reproduce("damping", "--folder", self.work / "new"))

    def test_tables_of_another_commit_are_named(self):
        other = {"commit": "e" * 40, "dirty": False}
        self.found(git=other)
        self.ends(3, "NOT OF THIS COMMIT: damping", self.reproduce("damping"))
        self.table("scaling", ["scaling"], folders=(self.results,), git=other)
        self.ends(0, "of commit eeeeeeee, this is 01234567: a change of the code",
                  self.reproduce("scaling"))

    def test_failed_rows_that_the_release_has_too_are_no_difference(self):
        for folder in (self.results, self.toy):
            self.table("damping", ["damping"], rows(status="diverged"), (folder,))
        (self.toy / "code").write_text("3")
        self.ends(0, "4 of 4 rows agree", self.reproduce("damping"))


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


if __name__ == "__main__":
    unittest.main()
