#!/usr/bin/env python3
"""Times the programs that answer the README's questions on the scene of its quick start, and keeps a
line of each answer:

    python3 tests/commands/question_times.py [BUILD] [--out FILE]

Writes results/question_times.csv: a row per command, run once. Processor times depend little on
the load of the machine, wall times do."""
import argparse
import csv
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
GROOM = ROOT / "scenes/full_head.toml"

# By program: options after the scene.
QUESTIONS = {
    "simulate": ["my.toml"],
    "error_bars": ["my.toml", "--error-bars"],
    "gradient": ["gradient.toml", "--gradient"],
    "cost_of_accuracy": ["--advise", "my.toml", "--quick"],
    "stability_limit": ["--scene", "my.toml", "--quick"],
    "hard_cases": ["--scene", "my.toml", "--quick"],
    "work_precision": ["--scene", "my.toml", "--quick"],
    "scaling": ["--scene", "my.toml", "--quick"],
    "effect_audit": ["--scene", "my.toml", "--quick"],
    "head_accuracy": ["--scene", str(GROOM), "--set", "accuracy=0.01", "--quick"],
}
PROGRAMS = {"error_bars": "simulate", "gradient": "simulate"}
# By question: the parts of the output that are its answer, in their order on a line.
ANSWERS = {
    "simulate": [r"\d+ frames, \S+ s simulated"],
    "error_bars": [r"space error \S+ of the length"],
    "gradient": [r"1 % of \w+ moves the tip by \S+ mm"],
    "cost_of_accuracy": [r"take \w+", r"\d+ elements, \w+", r"\S+ % of the length"],
    "stability_limit": [r"backward_euler", r"stable at every one of \d+ steps tried from .+? to \S+ ms"],
    "hard_cases": [r"\w+: \d+ of \d+ runs are stable"],
    "work_precision": [r"within 1 %", r"\w+, \w+, [^:]+: \S+ % in \S+ \w+ per simulated second"],
    "scaling": [r"der", r"160 elements takes \S+ us", r"grows with the power \S+"],
    "effect_audit": [r"gravity: \w+ ", r"without it the tips move by \S+ % of the length"],
    "head_accuracy": [r"take [^,]+, \d+ elements", r"95 % of hairs within \S+ % of their length"],
}
GRADIENT = '\n[gradient]\nby = ["youngs_modulus_pa", "radius_m", "density_kg_m3"]\n'
ANSWERED = {0, 3}  # done; some rows failed, which is an answer


def processor_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def answer(question, output):
    """Returns the first line of the output that has all parts of the answer, with "..." for the rest."""
    for line in output.split("\n"):
        parts = re.search(".*?".join(f"({part})" for part in ANSWERS[question]), line)
        if parts:
            return " ... ".join(part.strip(" :") for part in parts.groups())
    sys.exit(f"question_times: the output of {question} has no answer:\n{output}")


def measured(question, options, programs, folder):
    program = PROGRAMS.get(question, question)
    out = ["--out", "out" if program == "simulate" else f"out/{question}.csv"]
    begin, used = time.monotonic(), processor_s()
    done = subprocess.run([programs / program, *options, *out], cwd=folder, capture_output=True, text=True)
    if done.returncode not in ANSWERED:
        sys.exit(f"question_times: {program} ended with {done.returncode}: {done.stderr.strip()}")
    return {"question": question, "options": " ".join(option.replace(f"{ROOT}/", "") for option in options),
            "processor_s": round(processor_s() - used, 2), "wall_s": round(time.monotonic() - begin, 2), "answer": answer(question, done.stdout + done.stderr)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=Path, default=ROOT / "build/release", metavar="BUILD",
                        help="folder of the build (default: build/release)")
    parser.add_argument("--out", type=Path, default=ROOT / "results/question_times.csv", metavar="FILE",
                        help="table (default: results/question_times.csv)")
    arguments = parser.parse_args()
    programs = arguments.build.resolve() / "experiments"
    with tempfile.TemporaryDirectory() as folder:
        scene = subprocess.run([programs / "simulate", "--print-defaults"], capture_output=True, text=True, check=True).stdout
        (Path(folder) / "my.toml").write_text(scene)
        (Path(folder) / "gradient.toml").write_text(scene + GRADIENT)
        os.mkdir(f"{folder}/out")
        rows = []
        for question, options in QUESTIONS.items():
            rows.append(measured(question, options, programs, folder))
            print(rows[-1], flush=True)
    with open(arguments.out, "w", newline="") as file:
        table = csv.DictWriter(file, rows[0], lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


if __name__ == "__main__":
    main()
