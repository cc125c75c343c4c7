"""Is what cost_of_accuracy --advise promises true? Tested on random scenes, none of them shipped.

Each of COUNT scenes from SEED on is advised within SECONDS. The judge runs the file as it is
written over the whole scene and compares it with a reference of its own. Prints a line per
scene, and at the end the shares of scenes with an answer and of answers that keep their promise.
Exit codes: 0 at least 80 % have an answer, 95 % of these are kept and all files say what the
text says; 3 otherwise."""
import math
import re
import subprocess
import sys
import time
from dataclasses import dataclass

from programs import arguments, programs

TARGET = 0.01
STRANDS = 3
GRACE = 1.2  # times the seconds given
JUDGE_S = 200


@dataclass
class Answer:
    scene: str
    took: float
    line: str
    verdict: str = "no promise"
    files: bool = True


def number(pattern, text):
    found = re.search(pattern, text)
    return float(found[1]) if found else math.nan


def same(line, file):
    """Returns whether the advised file has the elements and the step or tolerance of the text."""
    integrator = file[file.index("[integrator]"):]
    if number(r"(\d+) elements", line) != number(r"\nelements = (\d+)", file):
        return False
    if ", tolerance" in line:
        return number(r"tolerance ([\d.e-]+)", line) == number(r"\nposition_tol_rel = ([\d.e-]+)", integrator)
    said, written = 1e-3 * number(r"dt ([\d.e-]+) ms", line), number(r"\ndt_s = ([\d.e-]+)", integrator)
    return abs(said - written) <= 1e-4 * written


def judged(tress, seed, seconds):
    """Returns what was said about one scene, and whether it is true."""
    stem, _ = tress.scene(seed)
    start = time.monotonic()
    advice = tress.run("experiments/cost_of_accuracy", "--advise", f"{stem}.toml", "--out", f"{stem}.csv",
                       "--progress", "none", "--set", f"answer_s={seconds}")
    took = time.monotonic() - start
    answer = Answer(f"{stem}.toml", took, advice.stdout.split("\n")[0] or advice.stderr.strip())
    if took > GRACE * seconds:
        answer.verdict = "late"
    if answer.verdict == "late" or not answer.line.startswith("take "):
        return answer
    file = f"{stem}.advised.toml"
    answer.files = same(answer.line, (tress.work / file).read_text())
    try:
        judge = tress.run("tests/advice_judge", answer.scene, file, STRANDS, timeout=JUDGE_S)
    except subprocess.TimeoutExpired:
        answer.verdict = "not judged: takes too long"
        return answer
    if judge.returncode:
        answer.verdict = f"not judged: {judge.stderr.strip() or f'exit code {judge.returncode}'}"
        return answer
    error, doubt = map(float, judge.stdout.split())
    answer.line = f"{100 * error:.2g} % (doubt {100 * doubt:.1g} %): {answer.line}"
    if error <= TARGET:
        answer.verdict = "kept"
    else:
        answer.verdict = "BROKEN" if error > TARGET + doubt else "not judged: reference"
    return answer


def main():
    given = arguments(__doc__, count=12, seed=1, seconds=100)
    answers = []
    with programs(given.folder) as tress:
        for seed in range(given.seed, given.seed + given.count):
            one = judged(tress, seed, given.seconds)
            answers.append(one)
            differs = "" if one.files else ", FILE DIFFERS"
            print(f"{one.scene}: {one.took:.0f} s, {one.verdict}{differs}: {one.line}")

    def count(verdict):
        return sum(one.verdict.startswith(verdict) for one in answers)

    kept, broken, open_ = count("kept"), count("BROKEN"), count("not judged")
    answered = kept + broken + open_
    differ = sum(not one.files for one in answers)
    median = sorted(one.took for one in answers)[given.count // 2]
    print(f"{answered} of {given.count} scenes have an answer; {kept} promises kept, {broken} broken, "
          f"{open_} not judged; {differ} files differ from the text; median {median:.0f} s")
    good = kept > 0 and answered >= 0.8 * given.count and kept >= 0.95 * (kept + broken) and differ == 0
    return 0 if good else 3


if __name__ == "__main__":
    sys.exit(main())
