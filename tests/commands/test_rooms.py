"""test_rooms.py REPOSITORY: dependencies between folders run one way, no folder is full, and
JavaScript is where it must be."""
import re
import subprocess
import sys
from collections import Counter, defaultdict
from pathlib import Path, PurePosixPath

# What each room at the top level may include, besides itself.
MAY_SEE = {
    "math": [],
    "contract": ["math"],
    "linear": ["contract", "math"],
    "models": ["math", "contract", "linear"],
    "integrators": ["contract", "linear"],
    "simulation": ["math", "contract", "linear", "models", "integrators"],
    "experiments": ["math", "contract", "linear", "models", "integrators", "simulation"],
    "python": ["math", "contract", "linear", "models", "integrators", "simulation", "experiments"],
}
# Below experiments/: everything else is a study, which sees no other study.
SHARED = ("experiments/run", "experiments/problems", "experiments/numerics")
MOST_FILES = 40  # in one folder
# JavaScript besides the report and its player, and the npm package that each file needs: Debian
# 12 has MuJoCo 2 alone, and none of the others in any language.
REPORT = ("experiments/report/", "tests/report/")
BY_NPM = {
    "experiments/other_simulators/jolt.mjs": "jolt-physics",
    "experiments/other_simulators/mujoco_3.mjs": "@mujoco/mujoco",
    "experiments/other_simulators/strand_in_node.mjs": "that of the two before",
    "tests/readers/read_gltf.mjs": "gltf-validator, three, @gltf-transform/core",
    "tests/readers/read_in_node.mjs": "those of the readers",
    "tests/readers/read_usd.mjs": "tinyusdz, three",
}
MOST_LINES_BY_NPM = 377  # may only fall
FEWEST_INCLUDES = 1000  # in a whole repository


def folder_of(path):
    return str(PurePosixPath(path).parent)


def study_of(path):
    return "/".join(path.split("/")[:2])


def sources(folder):
    for entry in sorted(folder.iterdir()):
        if entry.is_dir() and entry.name != "node_modules":
            yield from sources(entry)
        elif entry.suffix in (".h", ".cpp"):
            yield entry


def check_include(file, target):
    room, other = file.split("/")[0], target.split("/")[0]
    if room != other and other not in MAY_SEE[room]:
        return [f"{file} includes {target}: {room} must not see {other}"]
    others_study = study_of(file) != study_of(target) and study_of(target) not in SHARED
    if room == other == "experiments" and others_study:
        return [f"{file} includes {target}: of another study"]
    return []


def cycles(below):
    """Returns a complaint for each cycle. `below`: folder -> folder it includes -> a line that
    does. Depth first; a folder on the path that is met again closes a cycle."""
    found, done = [], set()

    def visit(folder, path):
        if folder in path:
            cycle = [*path[path.index(folder):], folder]
            why = [below[one][next_one] for one, next_one in zip(cycle, cycle[1:])]
            found.append(f"folders in a cycle: {' -> '.join(cycle)}\n  " + "\n  ".join(why))
            return
        if folder in done:
            return
        for next_one in below.get(folder, ()):
            visit(next_one, [*path, folder])
        done.add(folder)

    for folder in below:
        visit(folder, [])
    return found


def javascript(root):
    """Returns complaints about JavaScript that could be Python."""
    listed = subprocess.run(["git", "-C", root, "ls-files", "*.js", "*.mjs", "*.cjs", "*.ts"],
                            capture_output=True, text=True, check=False)
    if listed.returncode:  # a copy of the sources without its history
        return []
    files = [file for file in listed.stdout.split("\n") if file and not file.startswith(REPORT)]
    lines = sum(len((root / file).read_text(encoding="utf-8").splitlines()) for file in files)
    found = [f"{file} is JavaScript without a package of npm: write it in Python"
             for file in files if file not in BY_NPM]
    found += [f"{file} is listed and does not exist" for file in BY_NPM if file not in files]
    if lines > MOST_LINES_BY_NPM:
        found.append(f"{lines} lines of JavaScript besides the report, more than {MOST_LINES_BY_NPM}")
    return found


def main(repository):
    root = Path(repository)
    complaints, below, count, lines = [], defaultdict(dict), Counter(), 0
    for path in (path for room in MAY_SEE for path in sources(root / room)):
        file = path.relative_to(root).as_posix()
        count[folder_of(file)] += 1
        for target in re.findall(r'^#include "(.+)"$', path.read_text(encoding="utf-8"), re.M):
            lines += 1
            complaints += check_include(file, target)
            if folder_of(target) != folder_of(file):
                below[folder_of(file)][folder_of(target)] = f"{file} includes {target}"
    complaints += cycles(below) + javascript(root)
    complaints += [f"{folder} has {files} files, more than {MOST_FILES}"
                   for folder, files in count.items() if files > MOST_FILES]
    if lines < FEWEST_INCLUDES:
        complaints.append("hardly any include was found: is this the repository?")
    print(f"{len(count)} folders, {lines} includes")
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
