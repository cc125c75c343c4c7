"""What test_pages.py does with the commands of pages other than running them as they stand."""
from dataclasses import dataclass

from page_commands import SENTENCES


def short_scene(name, seconds):
    return f"sed -i 's/^duration_s = .*/duration_s = {seconds}/' scenes/{name}.toml"


SIMULATE = "build/release/experiments/simulate"
MY_SCENE = f"{SIMULATE} --print-defaults | sed 's/^duration_s = .*/duration_s = 0.05/' > my.toml"
PAGE_ALONE = "node experiments/report/dist/report.mjs results --out results/report.html --no-figures"

# What a reader has before the first command of a page, as bash.
BEFORE = {
    "docs/cluster.md": [
        short_scene("full_head", 0.02),
        "sed -i 's/^count = .*/count = 64/' scenes/full_head.toml",
    ],
    # Two commits, a change and two builds.
    "docs/compare.md": [
        "mkdir ../other", "cp -r results ../other/", "make_toy build/bench", "make_toy ../other/build/bench",
        "git init -q", "git add CMakePresets.json README.md", "git commit -q -m one",
        "echo >>README.md", "git commit -q -a -m two", "echo >>README.md",
    ],
    # The groom of the page, of another model and smaller.
    "docs/extending.md": [
        "sed -n '/^```toml/,/^```/{//!p;/^```$/q}' docs/extending.md | sed 's/my_rod/mass_spring/; "
        "s/^count = .*/count = 20/; s/^duration_s = .*/duration_s = 0.02/' > rods.toml",
    ],
    "docs/grooms.md": [MY_SCENE],
    "docs/how_to_choose.md": [MY_SCENE],
    "docs/start/fit.md": [
        "cp experiments/calibrate/data/swinging_curl.toml filmed.toml",
        "cp experiments/calibrate/data/swinging_curl.csv video.csv",
    ],
    "docs/about/packages.md": [
        short_scene("hair_under_wind", 0.05), "mkdir -p build/packages", "touch build/packages/tress.deb",
    ],
    "docs/player.md": [
        *(short_scene(name, 0.05) for name in ("crossing_locks", "full_head", "head_shaking", "plectoneme")),
        "sed -i 's/^count = .*/count = 1000/' scenes/full_head.toml",
        "sed -i 's/^frames_per_s = .*/frames_per_s = 300/' scenes/crossing_locks.toml",
        SIMULATE + " scenes/{crossing_locks,full_head,head_shaking,plectoneme}.toml",
    ],
    "docs/plugins.md": ["mkdir -p build/plugin", "touch build/plugin/libexample.so"],
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
    SENTENCES: [MY_SCENE],
    "experiments/report/README.md": [short_scene("cantilever", 0.1), f"{SIMULATE} scenes/cantilever.toml", PAGE_ALONE],
}


@dataclass(frozen=True)
class Rule:
    """Is for the commands of a page that begin with `command`."""
    page: str
    command: str
    whole: bool = False  # fits only the command itself
    more: str = ""  # options that make it quick, put at its end
    instead: str = ""  # what replaces `command`
    exits: tuple[int, ...] = ()  # exit codes besides 0 that are an answer too
    why: str = ""  # the reason for `instead` and `exits`
    spelling: str = ""  # why the command that is run only checks the spelling of this one
    long: bool = False  # runs with ./tress test --all only
    by: str = ""  # the test that runs it instead
    takes: str = ""  # the words with which that test takes commands from the page
    pattern: str = ""  # of the commands that it takes

    def fits(self, command):
        fits = command.text == self.command if self.whole else command.text.startswith(self.command)
        return command.page == self.page and fits


def experiment(name):
    return f"build/release/experiments/{name}"


def of_reproduce(page, command):
    return Rule(page, command, by="tests/commands/test_reproduce.py", takes=f'page_commands(ROOT, "{page}")')


FIRST_ID = f"{experiment('hard_cases')} --quick --dry-run | grep -om 1 'run_id=[0-9a-f]*' | cut -d = -f 2"
PLUGIN = "^(build/|cmake -S|cmake --build)"
FILM = "./tress film results/report.html "
RULES = (
    Rule("README.md", "./tress", by="tests/commands/test_quick_start.py", takes='page_commands(ROOT, "README.md")'),
    of_reproduce("docs/about/citing.md", "./tress rerun"),
    Rule("docs/about/citing.md", f"{experiment('hard_cases')} --quick --run-id RUN_ID",
         instead=f"{experiment('hard_cases')} --quick --run-id $({FIRST_ID})", why="the id of a row"),
    Rule("docs/about/packages.md", "./tress package", more="--help", spelling="builds for half an hour"),
    Rule("docs/about/packages.md", "sudo apt install", spelling="needs root"),
    Rule("docs/about/packages.md", "buildah", spelling="needs the packages; ./tress test --packages builds the image"),
    Rule("docs/about/packages.md", "podman", spelling="needs the image; ./tress test --packages runs it"),
    Rule("docs/about/packages.md", "cmake", spelling="builds; tests/install installs the build"),
    Rule("docs/about/packages.md", "/opt/tress/bin/tress", instead="./tress", why="nothing is installed in /opt",
         spelling="tests/install runs the installed command"),
    Rule("docs/other_solvers.md", "sudo apt-get", spelling="needs root"),
    Rule("docs/other_solvers.md", "python3 experiments/other_solvers/run.py beam", exits=(2,),
         why="where R is missing", spelling="needs R"),
    Rule("docs/other_solvers.md", "python3 experiments/other_solvers/run.py", whole=True, more="--help",
         spelling="needs R, Octave and PETSc, and minutes"),
    Rule("docs/start/own_scene.md", f"{SIMULATE} --print-defaults > my.toml", instead=MY_SCENE, why="a shorter scene"),
    Rule("docs/start/own_scene.md", f"{experiment('cost_of_accuracy')} --advise",
         more="--models super_helix --integrators tr_bdf2"),
    Rule("docs/start/own_scene.md", f"{experiment('hard_cases')} --scene", more="--models super_helix,der --quick"),
    Rule("docs/cluster.md", "", long=True),
    Rule("docs/compare.md", "./tress run", long=True, more="-- --models super_helix --integrators tr_bdf2 --set case=violent_shake"),
    Rule("docs/compare.md", "./tress compare ../before results", long=True, exits=(3,), why="the new table has fewer rows"),
    of_reproduce("docs/reproduce.md", "./tress"),
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
    Rule("docs/player.md", "./tress play", by="tests/commands/test_play.py", takes='page_commands(ROOT, "docs/player.md")',
         pattern="^./tress play "),
    *(Rule("docs/plugins.md", command, by="tests/plugin/test_plugin.sh", takes=f"docs/plugins.md '{PLUGIN}'",
           pattern=PLUGIN) for command in ("build/", "cmake -S", "cmake --build")),
    Rule("docs/plugins.md", "cmake --install", spelling="tests/install installs the build"),
    Rule("docs/plugins.md", "./tress check", exits=(2,), why="the library is empty",
         spelling="tests/plugin/test_plugin.sh runs the contract suites on a library"),
    Rule("docs/plugins.md", "./tress report", long=True, instead=PAGE_ALONE, why="the figures take seconds"),
    Rule("docs/start/own_force.md", "build/release/tests/test_effects",
         spelling="the effect is not compiled; tests/commands/test_new.sh compiles its source"),
    Rule("docs/python.md", "PYTHONPATH=", by="python/tests/test_examples.py", takes='self.run_example("first_run")',
         pattern=r"python/examples/first_run\.py$"),
    Rule("docs/python.md", "/usr/bin/python3 -m venv", long=True),
    Rule("docs/python.md", "my_environment", long=True, more="--dry-run", spelling="compiles for minutes"),
    Rule("docs/start/fit.md", f"{experiment('calibrate')} --scene experiments/calibrate/data/buckling_0.toml", long=True, exits=(3,),
         why="the status space_error, which the page explains"),
    Rule("docs/start/fit.md", f"{experiment('calibrate')} --scene filmed.toml", long=True),
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
    *(Rule(SENTENCES, f"./tress {command}", more="--help", spelling=why) for command, why in (
        ("package ", "builds for half an hour"),
        ("docs --check", ".ci/run runs it"),
        ("run --full", "core hours"),
        ("ask my.toml --plugin", "needs a plug-in; tests/plugin/test_plugin.sh loads one"),
        ("play my.toml", "tests/commands/test_play.py runs that of docs/player.md"),
        ("other_simulators ", "needs other simulators"),
    )),
    Rule(SENTENCES, "./tress test ", instead="./tress test --help #", why="runs the tests", spelling="runs the tests"),
    Rule(SENTENCES, "./tress run -- --plugin", instead="./tress run --help #", why="a plug-in of the reader",
         spelling="minutes; docs/plugins.md has a program that loads one"),
    Rule(SENTENCES, "node experiments/report/dist/report.mjs results/", more="--no-figures"),
    Rule(SENTENCES, "./tress reproduce --write", by="tests/commands/test_reproduce.py", takes='"--write"',
         pattern="--write$"),
    *(Rule(SENTENCES, f"{language} {script}", instead=f"test -f {script} #", why=why, spelling=why)
      for language, script, why in (
        ("python3", "tests/compare/real_builds.py", "measures times for minutes"),
        ("python3", "tests/contracts/skips.py", "needs the reports of the contract suites"),
        ("python3", "experiments/report/pictures.py", "runs scenes and a browser for minutes"),
        ("python3", "tests/commands/question_times.py", "measures times for minutes"),
        ("node", "tests/report/picture_times.mjs", "measures times for minutes"),
    )),
    Rule(SENTENCES, f"{experiment('cost_of_accuracy')} --models my_rod", more="--help",
         spelling="a model of the reader; references take minutes"),
    *(Rule(SENTENCES, f"{experiment('family')} --set {key}", more="--dry-run") for key in ("study", "hairs")),
)
