"""A sweep as a Snakefile: a rule that makes a part, a rule that joins them."""

import shlex
import subprocess
from pathlib import Path

from ..messages import refuse
from ..processes import run
from .slurm import MERGE_MINUTES, flags


def write(sweep):
    """Writes the Snakefile. Returns its path."""
    name, parts, needs = sweep["experiment"], sweep["parts"], sweep["needs"]
    file = Path(sweep["folder"]) / "Snakefile"
    file.write_text(f"""# Made by ./tress cluster.
rule merged:
    input: expand("{name}.{{i}}-of-{parts}.csv", i=range(1, {parts + 1}))
    output: "{name}.csv"
    log: "logs/merge.log"
    resources: mem_mb={needs["memory_mb"]}, runtime={MERGE_MINUTES}
    shell: "./merge.sh > {{log}} 2>&1"

rule part:
    output: "{name}.{{i}}-of-{parts}.csv"
    log: "logs/{{i}}.log"
    resources: mem_mb={needs["memory_mb"]}, runtime={needs["minutes"]}
    shell: "./part.sh {{wildcards.i}} >> {{log}} 2>&1"
""", encoding="utf-8")
    return file


def command(sweep, cores, sbatch):
    """Returns the command that makes the table, here or with a job of Slurm for each part."""
    folder = Path(sweep["folder"])
    words = ["snakemake", "--snakefile", str(folder / "Snakefile"), "--directory", str(folder),
             "--keep-going", "--rerun-incomplete", "--rerun-triggers", "mtime"]
    if not sbatch:
        return [*words, "--cores", str(cores)]
    # A shell reads this; the scheduler fills in what stands in braces.
    job = ["sbatch", "--parsable", "--ntasks=1", "--cpus-per-task=1",
           f"--output={folder / 'logs' / 'sbatch-%j.log'}", "--time={resources.runtime}",
           "--mem={resources.mem_mb}M", *map(shlex.quote, flags(sweep["profile"]))]
    return [*words, "--jobs", str(sweep["parts"]), "--cluster", " ".join(job)]


def make(words):
    """Runs Snakemake to its end. Returns true if every part was made."""
    try:
        return run(*words, stdin=subprocess.DEVNULL) == 0
    except FileNotFoundError:
        return refuse(
            "snakemake: not found; apt-get install snakemake, or: ./tress cluster slurm")
