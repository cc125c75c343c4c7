"""./tress cluster and ./tress compare."""

import os

from . import sundials
from .command import Command
from .tree import ALL_PACKS, PROGRAMS, RELEASE, build


def _cluster(words, machine):
    from .cluster.command import BUILT, cluster

    # Programs that are named are built.
    programs = os.environ.get("TRESS_PROGRAMS")
    if not programs and words[:1] and words[0] in BUILT:
        machine.ensure()
        build(RELEASE, "experiments", options=(ALL_PACKS,))
    return cluster(words, programs or PROGRAMS)


def _compare(words, machine):
    from .compare.command import compare

    def root():
        machine.ensure()
        return sundials.root() or ""

    return compare(words, root)


CLUSTER = Command(
    "cluster", "slurm|snakemake [OPTIONS] EXPERIMENT [ARGUMENTS]\n"
    "status|resume|merge FOLDER\nestimate [--out FILE] [--timeout TIME] [EXPERIMENT...]",
    "runs an experiment in parts, as a job array of Slurm or by Snakemake, and joins their "
    "tables. docs/cluster.md describes it. status prints the finished parts, resume submits the "
    "missing ones, merge joins all parts; estimate times some rows of experiments and writes the "
    "estimated time of all rows.",
    _cluster,
    example="./tress cluster slurm --parts 3 --folder results/cluster/springs stability_limit "
            "--quick --models mass_spring",
    time="the time of some rows of the experiment, then that of the cluster.",
    options=(("--parts N", "number of parts (default: parts of about 15 minutes)"),
             ("--folder FOLDER", "place of scripts, logs and tables (default: "
              "results/cluster/EXPERIMENT)"),
             ("--profile FILE", "settings of the cluster: lines of key = value"),
             ("--cores N", "processors for snakemake (default: all)"),
             ("--sbatch", "with snakemake: a job of Slurm for each part"),
             ("--write-only", "writes the scripts and submits nothing"),
             ("--out FILE", "table of the estimates (default: results/full_sweeps.csv)"),
             ("--timeout TIME", "limit for a row that is timed (default: 60s)")))

COMPARE = Command(
    "compare", "A B [OPTIONS]",
    "compares two folders of results row by row, or two commits or builds by benchmarks that "
    "run in turns. Writes a table and a page to results/compare/. Exit code 3 if something is "
    "slower, changed or missing. docs/compare.md describes it.",
    _compare,
    example="./tress compare HEAD~1 HEAD --filter step",
    time="seconds for results; two builds and about half an hour of timing for commits.",
    options=(("--threshold X", "smallest ratio of times that is a verdict (default: 1.05)"),
             ("--rounds N", "rounds of timing, 8 or more (default: 10)"),
             ("--filter REGEX", "benchmarks to run (default: all)"),
             ("--min-time S", "shortest timing of a benchmark (s) (default: 0.01)"),
             ("--out NAME", "table NAME.csv and page NAME.html (default: "
              "results/compare/A--B)")))
