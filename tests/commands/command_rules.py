"""What test_pages.py does with the commands of pages other than running them as they stand."""
from dataclasses import dataclass


def short_scene(name, seconds):
    return f"sed -i 's/^duration_s = .*/duration_s = {seconds}/' scenes/{name}.toml"


SIMULATE = "build/release/experiments/simulate"
MY_SCENE = f"{SIMULATE} --print-defaults | sed 's/^duration_s = .*/duration_s = 0.05/' > my.toml"
PAGE_ALONE = "node experiments/report/dist/report.mjs results --out results/report.html --no-figures"

# What a reader has before the first command of a page, as bash.
BEFORE = {
    "docs/compare.md": ["mkdir ../other", "cp -r results ../other/"],
    "docs/grooms.md": [MY_SCENE],
    "docs/how_to_choose.md": [MY_SCENE],
    "docs/player.md": [
        *(short_scene(name, 0.05) for name in ("crossing_locks", "full_head", "head_shaking", "plectoneme")),
        "sed -i 's/^count = .*/count = 1000/' scenes/full_head.toml",
        "sed -i 's/^frames_per_s = .*/frames_per_s = 300/' scenes/crossing_locks.toml",
        SIMULATE + " scenes/{crossing_locks,full_head,head_shaking,plectoneme}.toml",
    ],
    # The scene of the page.
    "docs/start/gradients.md": [
        "sed -n '/^```toml/,/^```/{//!p;/^```$/q}' docs/start/gradients.md > curl.toml",
    ],
    "experiments/calibrate/data/README.md": [
        "cut -d, -f1,2 experiments/calibrate/data/one_length.csv > measured.csv",
    ],
    "experiments/cost_of_accuracy/README.md": [MY_SCENE],
    "experiments/head_accuracy/README.md": [
        short_scene("full_head", 0.05),
        "sed -i 's/^count = .*/count = 1000/' scenes/full_head.toml",
    ],
    "experiments/heads/README.md": [
        "sed 's/^count = .*/count = 1000/; s/^duration_s = .*/duration_s = 0.02/' "
        "scenes/full_head.toml > my_head.toml",
    ],
    "experiments/matrices/README.md": [MY_SCENE],
    "experiments/report/README.md": [short_scene("cantilever", 0.1), f"{SIMULATE} scenes/cantilever.toml", PAGE_ALONE],
}


@dataclass(frozen=True)
class Rule:
    """Is for the commands of a page that begin with `command`."""
    page: str
    command: str
    more: str = ""  # options that make it quick, put at its end
    instead: str = ""  # what replaces `command`
    exits: tuple[int, ...] = ()  # exit codes besides 0 that are an answer too
    why: str = ""  # the reason for `instead` and `exits`
    left_out: str = ""  # why it is not run here
    by: str = ""  # the test that runs it, where one does

    def fits(self, command):
        return command.page == self.page and command.text.startswith(self.command)


def experiment(name):
    return f"build/release/experiments/{name}"


def of_cluster(command):
    return Rule("docs/cluster.md", command, left_out="needs a cluster: ./tress test --cluster",
                by="tests/cluster/test_slurm.py")


FILM = "./tress film results/report.html "
RULES = (
    Rule("README.md", "./tress", left_out="builds, for which a copy of the sources has no tree",
         by="tests/commands/test_quick_start.py"),
    Rule("docs/other_solvers.md", "", left_out="needs R, Octave and PETSc; tests/report/test_other_solvers.py tries the program"),
    Rule("docs/start/own_scene.md", f"{SIMULATE} --print-defaults > my.toml", instead=MY_SCENE, why="a shorter scene"),
    Rule("docs/start/own_scene.md", f"{experiment('cost_of_accuracy')} --advise",
         more="--models super_helix --integrators tr_bdf2"),
    Rule("docs/start/own_scene.md", f"{experiment('hard_cases')} --scene", more="--models super_helix,der --quick"),
    of_cluster("./tress cluster"),
    of_cluster("mpirun"),
    Rule("docs/compare.md", "./tress compare HEAD~1", left_out="builds two commits"),
    Rule("docs/compare.md", "git commit", left_out="commits the reader's change"),
    Rule("docs/compare.md", "./tress run", left_out="runs a study for minutes"),
    Rule("docs/compare.md", "./tress compare build/bench", left_out="needs two builds of the benchmarks"),
    Rule("docs/reproduce.md", "./tress", left_out="builds, for which a copy of the sources has no tree",
         by="tests/commands/test_reproduce.py"),
    Rule("docs/extending.md", f"{experiment('constraint_drift')} --integrators",
         more="--models inextensible_chain --quick"),
    Rule("docs/extending.md", f"{experiment('stability_limit')} --elements",
         more="--models super_helix --set damping=published"),
    Rule("docs/how_to_choose.md", f"{experiment('cost_of_accuracy')} --advise",
         more="--quick --models super_helix --integrators tr_bdf2"),
    Rule("docs/player.md", "./tress report", instead=PAGE_ALONE,
         why="README.md has it too, and the figures take seconds"),
    Rule("docs/player.md", FILM + "'scene=head_shaking&colour=hair' head_shaking.webm", more="--size 160,120 --rate 5"),
    Rule("docs/player.md", "./tress film results/scenes/plectoneme.json 'view=-60,15,2' plectoneme_pictures "
         "--rate 10 --size 1920,1080", more="--size 160,120"),
    Rule("docs/player.md", FILM + "'scene=full_head&colour=hair' print --size 3840,2160 --scale 2 --from 1 --to 1",
         more="--size 160,120 --from 0 --to 0"),
    Rule("docs/plugins.md", "", left_out="its own test", by="tests/plugin/test_plugin.sh"),
    Rule("docs/start/own_force.md", "", left_out="builds", by="tests/commands/test_new.sh"),
    Rule("docs/python.md", "./tress python", left_out="builds, and runs its own tests"),
    Rule("docs/python.md", "PYTHONPATH=", left_out="its own test", by="python/tests/test_examples.py"),
    Rule("docs/python.md", "/usr/bin/python3 -m venv", left_out="for the next line"),
    Rule("docs/python.md", "my_environment", left_out="compiles for minutes"),
    Rule("docs/start/fit.md", f"{experiment('calibrate')} --scene experiments/calibrate/data/buckling_0.toml",
         left_out="takes a minute; test_calibrate_points.cpp fits a part of its record"),
    Rule("docs/start/statics.md", "./tress statics", instead=f"{experiment('statics')} --scene",
         why="builds first, for which a copy of the sources has no tree"),
    Rule("experiments/calibrate/data/README.md", f"{experiment('calibrate')} --set data=measured.csv", exits=(3,),
         why="a record of another hair, which it says"),
    Rule("experiments/cost_of_accuracy/README.md", f"{experiment('cost_of_accuracy')} --advise",
         more="--quick --integrators tr_bdf2"),
    Rule("experiments/head_accuracy/README.md", f"{experiment('head_accuracy')} --scene", more="--quick"),
    Rule("experiments/heads/README.md", f"{SIMULATE} my_head.toml --as batch --device gpu", exits=(2,),
         why="where there is no GPU"),
    Rule("experiments/heads/README.md", f"{experiment('heads')} --strands 50000,1000000 --elements 5,20",
         instead=f"{experiment('heads')} --strands 32,64 --elements 5", more="--quick", exits=(3,),
         why="minutes and gigabytes; claims are of more hairs than that"),
    Rule("experiments/matrices/README.md", "./tress matrices", instead=f"{experiment('matrices')} --scene",
         why="builds first, for which a copy of the sources has no tree"),
)
