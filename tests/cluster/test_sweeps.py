"""./tress cluster without a scheduler: scripts and parts of small sweeps by real programs, what
joins them, what a folder remembers, and refusals."""

import json
import os
import socket
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from sweeps import LIMITS, SweepTest  # noqa: E402
from tress_command.cluster.slurm import ranges  # noqa: E402
from tress_command.cluster.sweep import core_hours, needs, usual_parts  # noqa: E402


class Parts(SweepTest):
    """One sweep of two parts, from its first command to the joined table."""

    def setUp(self):
        super().setUp()
        self.folder = self.work / "sweep"
        self.profile = self.work / "profile"
        self.profile.write_text('# of the test\npartition = "short"\nmemory_mb = 300\n'
                                'options = "--exclude=n7  --nice"\nsetup = "export TRESS_TEST=1"\n')

    def begin(self, *more):
        return self.cluster("slurm", "--folder", self.folder, "--parts", "2", "--write-only",
                            "--profile", self.profile, *more, *LIMITS)

    def part(self, i, **options):
        return subprocess.run([self.folder / "part.sh", str(i)], capture_output=True, text=True,
                              check=False, **options)

    def test_scripts_parts_status_and_merge(self):
        out = self.ends(0, r"wrote .*/array\.sbatch and .*/merge\.sbatch", self.begin())
        self.assertRegex(out, r"12 rows of about \S+ s \(\d+ were timed\): \S+ core hours in 2 "
                         r"parts; each asks for \d+ min and 300 MB")
        array = (self.folder / "array.sbatch").read_text()
        for line in ("--array=1-2", "--partition=short", "--exclude=n7", "--nice",
                     "--job-name=tress-stability_limit"):
            self.assertIn(f"#SBATCH {line}\n", array)
        self.assertRegex(array, r"#SBATCH --time=\d+ --mem=300M\n")
        self.assertIn("\nexport TRESS_TEST=1\n", (self.folder / "part.sh").read_text())
        self.ends(0, r"parts: 0 of 2 complete; rows: 0 finished", self.status())

        self.assertIn(self.part(1).returncode, (0, 3))
        out = self.ends(0, r"parts: 1 of 2 complete; rows: 6 finished", self.status())
        self.assertIn(f"next: ./tress cluster resume {self.folder}\n", out)
        self.refused(r"parts 2 of 2 are missing; ./tress cluster resume",
                     self.cluster("merge", self.folder))
        self.ends(0, "1 of 2 parts are there", self.begin())
        self.assertIn("#SBATCH --array=2\n", (self.folder / "array.sbatch").read_text())

        self.assertIn(self.part(2).returncode, (0, 3))
        out = self.ends(0, r"parts: 2 of 2 complete; rows: 12 finished", self.status())
        self.assertIn(f"next: ./tress cluster merge {self.folder}\n", out)
        table = self.folder / "stability_limit.csv"
        self.ends(0, f"the table: {table}", self.cluster("merge", self.folder))
        self.same(self.one_process(*LIMITS), table)
        self.ends(0, f"table: {table}", self.status())
        self.assertFalse((self.folder / "lock").exists())
        self.resumed_when_whole(table)
        self.other_code()

    def status(self):
        return self.cluster("status", self.folder)

    def resumed_when_whole(self, table):
        table.unlink()
        self.ends(0, f"2 of 2 parts are there\n.*the table: {table}",
                  self.cluster("resume", self.folder))

    def other_code(self):
        file = self.folder / "sweep.json"
        sweep = json.loads(file.read_text())
        file.write_text(json.dumps(sweep | {"version": "another"}))
        self.refused("begun by 'another', but the program is '.*stability_limit",
                     self.cluster("resume", self.folder))

    def test_a_part_without_disk_or_time_continues(self):
        self.ends(0, "wrote", self.begin())
        limited = ["bash", "-c", 'ulimit -f 0; exec "$0" 1', self.folder / "part.sh"]
        done = subprocess.run(limited, capture_output=True, text=True, check=False)
        self.assertNotIn(done.returncode, (0, 3))
        self.ends(0, "parts: 0 of 2 complete", self.status())
        subprocess.run(["timeout", "-s", "TERM", "0.2", self.folder / "part.sh", "1"],
                       capture_output=True, check=False)
        for i in (1, 2):
            self.assertIn(self.part(i).returncode, (0, 3))
        self.ends(0, "the table", self.cluster("merge", self.folder))
        self.same(self.one_process(*LIMITS), self.folder / "stability_limit.csv")

    def test_the_merge_refuses_parts_of_another_commit(self):
        self.ends(0, "wrote", self.begin())
        for i in (1, 2):
            self.part(i)
        meta = self.folder / "stability_limit.1-of-2.meta.json"
        meta.write_text(meta.read_text().replace('"commit": "', '"commit": "other', 1))
        self.refused("made by commit", self.cluster("merge", self.folder))

    def test_a_folder_remembers_its_sweep(self):
        # An interrupted pilot leaves its journal.
        self.folder.mkdir()
        (self.folder / "pilot.csv.journal").touch()
        self.ends(0, "wrote", self.begin())
        self.refused("holds another sweep: .*give another --folder",
                     self.cluster("slurm", "--folder", self.folder, "damping", "--quick"))
        self.refused("the sweep has 2 parts; leave --parts out",
                     self.cluster("slurm", "--folder", self.folder, "--parts", "3", *LIMITS))
        lock = self.folder / "lock"
        lock.write_text(f"{os.getpid()} {socket.gethostname()}")
        self.refused(f"process {os.getpid()} on .* works on this sweep; wait for it",
                     self.cluster("resume", self.folder))
        lock.write_text(f"99999999 {socket.gethostname()}")
        self.ends(0, "wrote", self.begin())
        (self.folder / "sweep.json").write_text("[]")
        self.refused("sweep.json: not of a sweep", self.cluster("status", self.folder))

    def test_snakemake_has_a_rule_for_parts_and_one_that_joins(self):
        out = self.ends(0, r"start it: snakemake --snakefile \S+/Snakefile", self.cluster(
            "snakemake", "--folder", self.folder, "--parts", "3", "--cores", "2", "--write-only",
            *LIMITS))
        self.assertRegex(out, r"--rerun-triggers mtime --cores 2\n$")
        text = (self.folder / "Snakefile").read_text()
        self.assertIn('expand("stability_limit.{i}-of-3.csv", i=range(1, 4))', text)
        self.assertIn('shell: "./part.sh {wildcards.i} >> {log} 2>&1"', text)
        out = self.ends(0, "start it", self.cluster(
            "snakemake", "--folder", self.folder, "--sbatch", "--write-only",
            "--profile", self.profile, *LIMITS))
        self.assertIn("--time={resources.runtime} --mem={resources.mem_mb}M --partition=short", out)

    def test_schedulers_that_are_missing_are_named(self):
        self.ends(0, "wrote", self.begin())
        bare = self.work / "bin"
        bare.mkdir()
        for name in ("bash", "env", "dirname", "readlink", "python3"):
            (bare / name).symlink_to(f"/usr/bin/{name}")
        self.refused("sbatch: not found; install Slurm's commands",
                     self.cluster("resume", self.folder, PATH=bare))
        self.ends(2, "snakemake: not found; apt-get install snakemake", self.cluster(
            "snakemake", "--folder", self.folder, *LIMITS, PATH=bare))


class Estimates(SweepTest):
    def test_an_estimate_keeps_the_lines_of_other_experiments(self):
        file = self.work / "sweeps.csv"
        header = "experiment,rows,timed_rows,cut_off_rows,row_s,plan_s,parts,core_hours,memory_mb"
        file.write_text(f"{header}\nother,1,1,0,1,1,2,1,1\ndamping,1,1,0,1,1,2,1,1\n")
        self.ends(0, r"damping: \d+ rows, \S+ core hours",
                  self.cluster("estimate", "--out", file, "damping"))
        first, other, damping = file.read_text().splitlines()
        self.assertEqual((first, other), (header, "other,1,1,0,1,1,2,1,1"))
        cells = dict(zip(header.split(","), damping.split(",")))
        hours = (int(cells["rows"]) * float(cells["row_s"])
                 + int(cells["parts"]) * float(cells["plan_s"])) / 3600
        # Three digits of each.
        self.assertLess(abs(hours - float(cells["core_hours"])), 0.015 * hours)
        self.refused("no experiment 'nope'", self.cluster("estimate", "nope"))


class Refusals(SweepTest):
    def test_bad_words(self):
        for words, pattern in (
            ((), "no command ''; there are slurm, snakemake, status, resume, merge, estimate"),
            (("nope",), "no command 'nope'"),
            (("slurm",), "no experiment ''; there are .*stability_limit"),
            (("slurm", "nope"), "no experiment 'nope'"),
            (("slurm", "--fast", "family"), "unknown option '--fast'; there are --parts"),
            (("slurm", "--parts"), "--parts without a value"),
            (("slurm", "--parts", "0", "family"), "--parts 0 is not a whole number above 0"),
            (("snakemake", "--cores", "two", "family"), "--cores two is not a whole number"),
            (("slurm", "family", "--shard", "1/2"), "--shard: the sweep gives this itself"),
            (("slurm", "family", "--out=x"), "--out: the sweep gives this itself"),
            (("status",), "cluster status: give the folder of a sweep"),
            (("merge", "a", "b"), "cluster merge: give the folder of a sweep"),
            (("status", self.work), "no sweep there; begin one"),
            (("estimate", "--fast"), "unknown option '--fast'; there are --out, --timeout"),
            (("estimate", "--out"), "--out without a value"),
        ):
            self.refused(pattern, self.cluster(*words))

    def test_profiles(self):
        profile = self.work / "profile"
        for text, pattern in (
            ('partition = "short"\nacount = "hair"\n', r"profile:2: no key 'acount'; there are "
             "partition, account"),
            ("partition = short\n", "profile:1: short is not a text in quotes"),
            ("minutes = 1.5\n", r"profile:1: 1\.5 is not a whole number above 0"),
            ("\nminutes 5\n", "profile:2: not 'key = value'"),
            ("minutes = 5\nminutes = 6\n", "profile:2: 'minutes' is set twice"),
        ):
            profile.write_text(text)
            self.refused(pattern, self.cluster("slurm", "--folder", self.work / "none",
                                               "--profile", profile, "family"))
        self.refused("nowhere: cannot be read", self.cluster(
            "slurm", "--folder", self.work / "none", "--profile", self.work / "nowhere", "family"))
        self.assertFalse((self.work / "none").exists())

    def test_a_refused_sweep_leaves_no_folder(self):
        self.refused("unknown model 'nope'", self.cluster(
            "slurm", "--folder", self.work / "none", "family", "--models", "nope"))
        self.ends(2, "13 parts of 12 rows; give fewer", self.cluster(
            "slurm", "--folder", self.work / "none", "--parts", "13", *LIMITS))
        self.assertFalse((self.work / "none").exists())
        strange = self.work / "strange"
        strange.mkdir()
        (strange / "mine").touch()
        self.refused("holds 'mine' and no sweep", self.cluster(
            "slurm", "--folder", strange, "--parts", "2", *LIMITS))
        self.assertEqual([path.name for path in strange.iterdir()], ["mine"])

    def test_schedulers_read_paths_in_ways_of_their_own(self):
        for name in ("a b", "$(touch x)", "a%b", "a{b}", "a\nb"):
            self.refused("in its path, which Slurm and Snakemake may take for something else",
                         self.cluster("slurm", "--folder", self.work / name, "damping"))
        self.assertEqual(list(self.work.iterdir()), [])

    def test_an_interrupted_pilot_ends_with_130(self):
        programs = self.work / "programs"
        programs.mkdir()
        (programs / "list.txt").write_text("slow\n")
        (programs / "slow").write_text("#!/bin/bash\n[[ $* == --version ]] || exit 130\n")
        (programs / "slow").chmod(0o755)
        self.ends(130, "interrupted; give the same command again", self.cluster(
            "slurm", "--folder", self.work / "none", "slow", TRESS_PROGRAMS=programs))
        self.assertFalse((self.work / "none").exists())


class Numbers(unittest.TestCase):
    KNOWN = {"rows": 100, "row_s": 36, "plan_s": 18, "largest_mb": 50, "timeout_s": 60}

    def test_needs_of_a_part(self):
        # 25 rows: 2 (25 36 s + 18 s) + 60 s = 1896 s; 3 50 MB in steps of 64 MB, at least 256.
        self.assertEqual(needs(self.KNOWN, 4, {}), {"minutes": 32, "memory_mb": 256})
        self.assertEqual(needs(self.KNOWN | {"largest_mb": 100}, 4, {"minutes": 7}),
                         {"minutes": 7, "memory_mb": 320})

    def test_parts_take_a_quarter_of_an_hour(self):
        self.assertEqual(usual_parts(self.KNOWN, 1000), 4)
        self.assertEqual(usual_parts(self.KNOWN, 3), 3)
        self.assertEqual(usual_parts(self.KNOWN | {"row_s": 0.01}, 1000), 2)
        self.assertEqual(core_hours(self.KNOWN, 4), (3600 + 72) / 3600)

    def test_ranges(self):
        self.assertEqual(ranges([1, 2, 3, 7]), "1-3,7")
        self.assertEqual(ranges([4]), "4")


if __name__ == "__main__":
    unittest.main()
