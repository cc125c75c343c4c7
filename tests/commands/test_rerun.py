"""./tress rerun and ./tress archive, on experiments that are stand-ins."""

import json
import subprocess
import sys
import tarfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from toy_release import COMMIT, IDS, Reproduce, rows  # noqa: E402


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
        self.assertEqual(names, sorted(names))
        subprocess.run(["tar", "-xzf", self.file, "-C", self.work], check=True)
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


if __name__ == "__main__":
    unittest.main()
