"""Sweeps by ./tress cluster on a Slurm that this test starts and ends, and by Snakemake, each
merged and compared with the table of one process. Run by ./tress test --cluster."""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from slurm import Slurm, said  # noqa: E402
from sweeps import FAMILY, LIMITS, PROGRAMS, ROOT, SweepTest  # noqa: E402

PAGE = "docs/cluster.md"
PAGE_COMMANDS = (sys.executable, "tests/commands/page_commands.py")
SNAKEMAKE = shutil.which("snakemake")
# Ends the first task of part 2 once it has finished a row.
KILLER = """if [[ ${{1:-}} == 2 && ! -e {work}/killed ]]; then
  touch {work}/killed
  (
    until [[ -s {folder}/family.2-of-4.csv.journal ]]; do sleep 0.02; done
    pkill -9 -f -- "--shard 2/4 --out {folder}/family.csv"
  ) &
fi
"""
MPI = """#!/bin/sh
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none
"""
slurm = None


def setUpModule():
    global slurm
    folder = tempfile.mkdtemp(prefix="tress-slurm-", dir="/tmp")
    unittest.addModuleCleanup(shutil.rmtree, folder)
    slurm = Slurm(folder)
    unittest.addModuleCleanup(slurm.stop)
    if not slurm.start():
        raise unittest.SkipTest(f"Slurm's daemons do not start on this machine:\n{slurm.logs()}")


def tearDownModule():
    slurm.stop()
    slurm.daemons.clear()
    left = said("pgrep", "-f", str(slurm.folder))
    if left:
        raise AssertionError(f"daemons are left behind: {left}")


def commands_of_page(pattern):
    """Returns the commands of the page that match."""
    return subprocess.run([*PAGE_COMMANDS, ".", PAGE, pattern], cwd=ROOT, check=True,
                          capture_output=True, text=True).stdout.splitlines()


class Sweeps(SweepTest):
    def setUp(self):
        super().setUp()
        self.folder = self.work / "sweep"
        self.profile = self.work / "profile"

    def idle(self):
        self.assertTrue(slurm.idle(), "jobs do not end")

    def test_an_array_of_four(self):
        self.profile.write_text('partition = "short"\nsetup = "export TRESS_TEST=1"\n')
        self.ends(0, r"submitted job [0-9]+ \(4 parts\)", self.cluster(
            "slurm", "--folder", self.folder, "--parts", "4", "--profile", self.profile, *LIMITS))
        self.ends(0, "parts: [0-4] of 4", self.cluster("status", self.folder))
        self.idle()
        self.ends(0, "parts: 4 of 4 complete", self.cluster("status", self.folder))
        self.same(self.one_process(*LIMITS), self.folder / "stability_limit.csv")

    def test_a_task_that_is_killed_is_resumed(self):
        killer = self.work / "killer"
        killer.write_text(KILLER.format(work=self.work, folder=self.folder))
        self.profile.write_text(f'setup = ". {killer}"\n')
        self.ends(0, "submitted job", self.cluster(
            "slurm", "--folder", self.folder, "--parts", "4", "--profile", self.profile, *FAMILY))
        self.refused("is still at work", self.cluster("resume", self.folder))
        self.idle()
        out = self.ends(0, "parts: 3 of 4 complete", self.cluster("status", self.folder))
        self.assertRegex(out, "next: ./tress cluster resume")
        self.refused("parts 2 of 4 are missing", self.cluster("merge", self.folder))
        self.ends(0, r"submitted job [0-9]+ \(1 parts\)", self.cluster("resume", self.folder))
        self.idle()
        self.same(self.one_process(*FAMILY), self.folder / "family.csv")

    def test_a_task_that_ran_out_of_time_is_resumed(self):
        self.ends(0, "wrote", self.cluster(
            "slurm", "--folder", self.folder, "--parts", "2", "--write-only", *LIMITS))
        subprocess.run(["timeout", "-s", "TERM", "0.2", self.folder / "part.sh", "1"],
                       capture_output=True, check=False)
        self.ends(0, r"submitted job [0-9]+ \([12] parts\)", self.cluster("resume", self.folder))
        self.idle()
        self.same(self.one_process(*LIMITS), self.folder / "stability_limit.csv")

    @unittest.skipUnless(SNAKEMAKE, "Snakemake is not installed")
    def test_snakemake_here_and_by_sbatch(self):
        alone = self.one_process(*LIMITS)
        for i, how in enumerate((("--cores", "2"), ("--sbatch",))):
            folder = self.work / f"snake{i}"
            self.ends(0, "the table", self.cluster(
                "snakemake", "--folder", folder, "--parts", "3", *how, *LIMITS))
            self.same(alone, folder / "stability_limit.csv")


class Page(SweepTest):
    def test_the_commands_of_the_page(self):
        made = ROOT / "results/cluster"
        for name in ("springs", "snake"):
            shutil.rmtree(made / name, ignore_errors=True)
        estimates = self.work / "full_sweeps.csv"
        for line in commands_of_page("^./tress cluster"):
            words = shlex.split(line)[2:]
            if words[0] == "snakemake" and not SNAKEMAKE:
                continue
            if words[0] == "estimate":  # not over the published table
                words[1:1] = ["--out", estimates]
            self.ends(0, ".", self.cluster(*words))
            self.assertTrue(slurm.idle(), "jobs do not end")
        lines = estimates.read_text().splitlines()
        self.assertEqual([line.partition(",")[0] for line in lines[1:]],
                         ["damping", "force_transport"])
        for name in ("springs", *(["snake"] if SNAKEMAKE else [])):
            self.assertGreater((made / name / "stability_limit.csv").stat().st_size, 0)
            shutil.rmtree(made / name)
        if not any(made.iterdir()):
            made.rmdir()

    def test_a_groom_by_mpirun_inside_a_job(self):
        scene, job = self.work / "head.toml", self.work / "mpi.sh"
        text = (ROOT / "scenes/full_head.toml").read_text()
        text = re.sub("(?m)^duration_s.*", "duration_s = 0.1", text)
        scene.write_text(re.sub("(?m)^count.*", "count = 300", text))
        # The line of the page, with a smaller scene and the programs that are tested.
        (line,) = commands_of_page("^mpirun")
        line = line.replace("scenes/full_head.toml", str(scene)).replace(
            "build/release/experiments", str(PROGRAMS))
        job.write_text(f"{MPI}{line} --progress none --out {self.work}/mpi\n")
        subprocess.run([PROGRAMS / "simulate", scene, "--as", "batch", "--progress", "none",
                        "--out", self.work / "whole"], cwd=ROOT, check=True, capture_output=True)
        cpus = len(os.sched_getaffinity(0))
        done = subprocess.run(["sbatch", "-W", "-n", str(cpus), "-o", self.work / "mpi.log", job],
                              cwd=ROOT, capture_output=True, text=True, check=False)
        log = self.work / "mpi.log"
        self.assertEqual(done.returncode, 0, done.stderr + (log.read_text() if log.exists() else ""))
        self.assertEqual((self.work / "whole/head.csv").read_bytes(),
                         (self.work / "mpi/head.csv").read_bytes())


if __name__ == "__main__":
    unittest.main()
