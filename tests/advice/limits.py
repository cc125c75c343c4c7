"""Is what stability_limit --scene answers true? Tested on random scenes, none of them shipped.

Each of COUNT scenes from SEED on gets its stability limits. Every integrator with a stable step
at every frame is then run by simulate over five times the duration of the scene. At 0.9 times
the answer the run must end "ok" by whole steps. At 1.5 times it must end as unstable, or by
shorter steps where the answer says so. Limits that are the longest step tried are left out.
Prints a line per scene, and the shares at the end. Exit codes: 0 at least 90 % of the limits are
true, 3 otherwise."""
import re
import sys

from programs import arguments, programs

SECONDS = {"s": 1, "ms": 1e-3, "us": 1e-6}
TIMES = 5  # the duration of the scene
MOST_STEPS = 2e5  # a limit with this many steps in all runs within a minute


# "X: backward_euler (jacobian exact): stable at every one of 9 steps tried from 0.41 ms to 4.1 ms,
# unstable at 1.5 times that ...", or
# "..., at 1.5 times that some step has no solution ..."
LIMIT = re.compile(r": (?P<integrator>\w+) \(jacobian (?P<jacobian>\w+)\): stable at every one of \d+ steps "
                   r"tried from \S+ \w+ to (?P<length>[\d.e+-]+) "
                   r"(?P<unit>s|ms|us), (?P<unstable>unstable )?at 1\.5 times")


def limits_of(answer, duration):
    found = [match.groupdict() for match in map(LIMIT.search, answer.split("\n")) if match]
    for limit in found:
        limit["step"] = float(limit["length"]) * SECONDS[limit["unit"]]
    return [limit for limit in found if duration / limit["step"] <= MOST_STEPS]


def run(tress, file, text, duration, limit, factor):
    """Returns whether the scene ends "ok", with a frame per step, by whole steps, and why not."""
    dt = factor * limit["step"]
    for pattern, by in (("duration_s = .*", f"duration_s = {duration}\nframes_per_s = {1 / dt}"),
                        (r"\[model\]", f'[model]\njacobian = "{limit["jacobian"]}"'),
                        (r"\[integrator\][^[]*", f'[integrator]\nid = "{limit["integrator"]}"\ndt_s = {dt}\n')):
        text = re.sub(pattern, by, text, count=1)
    (tress.work / file).write_text(text)
    made = tress.run("experiments/simulate", file, "--out", "run.csv", "--progress", "none")
    if made.returncode == 2:
        sys.exit(f"{file}: {made.stderr.strip()}")
    ok = made.returncode == 0
    whole = ok and "tried again with shorter ones" not in made.stderr
    return ok, whole, "shorter steps" if ok else made.stderr.strip().split("\n")[-1]


def judged(tress, seed):
    """Returns the number of limits of one scene and a line for each that is not true."""
    stem, text = tress.scene(seed)
    answer = tress.run("experiments/stability_limit", "--scene", f"{stem}.toml", "--out", f"{stem}.csv",
                       "--progress", "none")
    if answer.returncode == 2:
        sys.exit(f"{stem}.toml: {answer.stderr.strip()}")
    duration = TIMES * float(re.search(r"duration_s = ([\d.]+)", text)[1])
    limits, faults = limits_of(answer.stdout, duration), []
    for limit in limits:
        file = f"{stem}_{limit['integrator']}.toml"
        _, below, why = run(tress, file, text, duration, limit, 0.9)
        above_ok, above_whole, _ = run(tress, file, text, duration, limit, 1.5)
        wrong = [f"at 0.9 of {limit['step']:.6g} s: {why}"] if not below else []
        if above_ok if limit["unstable"] else above_whole:
            wrong.append(f"stable at 1.5 of {limit['step']:.6g} s")
        if wrong:
            faults.append(f"{limit['integrator']} {' and '.join(wrong)}")
    print(f"{stem}.toml: {len(limits)} limits, {'; '.join(faults) or 'all are true'}")
    return len(limits), faults


def main():
    given = arguments(__doc__, count=12, seed=101)
    with programs(given.folder) as tress:
        scenes = [judged(tress, seed) for seed in range(given.seed, given.seed + given.count)]
    limits = sum(count for count, _ in scenes)
    true = limits - sum(len(faults) for _, faults in scenes)
    print(f"{true} of {limits} limits are true over {TIMES} times the duration")
    return 0 if limits > 0 and true >= 0.9 * limits else 3


if __name__ == "__main__":
    sys.exit(main())
