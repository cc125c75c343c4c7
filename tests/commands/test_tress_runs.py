"""What ./tress promises when its commands run programs: exit codes, refusals, signals, folders."""

import os
import re
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from stand_ins import House, write_program  # noqa: E402
from tress_command.counting import severity  # noqa: E402

# Of an experiment: what follows is not done with --check.
CHECKED = '[[ " $* " == *" --check "* ]] || '


class Runs(House):
    def setUp(self):
        super().setUp()
        self.study("heads", f"{CHECKED}echo heads ran")

    def test_one_that_cannot_run_keeps_no_other_from_running(self):
        self.ends(0, "heads ran", self.tress("run"))
        out = self.ends(0, "heads ran", self.tress("run", "heads"))
        self.assertRegex(out, "left out, its table stays as it is: divided_heads: no MPI")
        self.refused_after_build("divided_heads cannot run here", "run", "divided_heads")
        self.refused_after_build(r"no experiment '\.\*_heads'; there are: heads", "run", ".*_heads")

    def refused_after_build(self, pattern, *words):
        out = self.ends(2, pattern, self.tress(*words))
        self.assertNotIn("heads ran", out)

    def test_what_can_refuse_does_so_before_anything_runs(self):
        self.experiments("heads", "full", "rubs")
        self.study("full", f"{CHECKED}{{ echo no space; exit 2; }}")
        self.study("rubs", "echo an earlier run did not finish; exit 2")
        out = self.ends(2, "nothing was run.*--resume heads full rubs", self.tress("run"))
        self.assertIn("did not finish", out)
        self.assertNotIn("heads ran", out)

    def test_what_is_not_done_is_told_at_the_end(self):
        self.experiments("heads", "full", "rubs")
        self.study("full", f"{CHECKED}{{ echo no space; exit 2; }}")
        self.study("rubs", f"{CHECKED}exit 3")
        done = self.tress("run")
        self.ends(2, r"NOT DONE, its table is that of an earlier run: full \(exit code 2\)", done)
        self.assertIn("heads ran", done.stdout)
        self.assertRegex(done.stderr, "worst exit code 2\n$")
        self.ends(2, "(?m)to go on: ./tress run --resume --full full -- --jobs 1$",
                  self.tress("run", "--full", "--", "--jobs", "1"))
        self.study("full", f"{CHECKED}exit 3")
        self.ends(3, "some experiments did not pass; worst exit code 3", self.tress("run"))
        self.study("full", f"{CHECKED}kill -9 $$")
        self.ends(1, "full was ended by signal 9", self.tress("run"))

    def test_options_reach_the_experiments(self):
        self.study("heads", f"{CHECKED}echo heads \"$@\"")
        self.ends(0, "heads --quick\n", self.tress("run"))
        self.ends(0, "heads --full --resume --jobs 1\n",
                  self.tress("run", "--resume", "--full", "--", "--jobs", "1"))

    def test_long_tests_run_with_all(self):
        self.stand_in("ctest", 'echo "ctest $*"')
        self.stand_in("cmake", 'echo "cmake $*" >>asked')
        self.ends(0, r"ctest --preset release -j \d+ --label-exclude \^long\$ -R head\n",
                  self.tress("test", "--", "-R", "head"))
        self.ends(0, r"ctest --preset debug -j \d+\n", self.tress("test", "--sanitize", "--all"))
        # Long packs are compiled with --all, and stay.
        cache = self.house / "build/release/CMakeCache.txt"
        cache.write_text(f"CMAKE_HOME_DIRECTORY:INTERNAL={self.house}\n")
        self.tress("test")
        asked = re.findall("(?m)^cmake --preset (.*)$", (self.house / "asked").read_text())
        self.assertEqual([re.findall(r"TRESS_PACKS=(\w+)", words) for words in asked],
                         [["short"], ["all"], []], asked)

    def test_an_interrupted_experiment_names_what_is_left(self):
        self.experiments("heads", "full", "rubs")
        self.study("rubs", CHECKED + "true")
        self.study("full", f"{CHECKED}exit 130")
        self.ends(130, "interrupted in full; not finished: full rubs; to go on: "
                  "./tress run --resume heads full rubs", self.tress("run"))

    def test_pages_that_cannot_be_made_are_told(self):
        pages = self.house / "experiments/report/prose/prose.py"
        pages.parent.mkdir()
        pages.write_text("print('why')\nraise SystemExit(2)\n")
        out = self.ends(0, r"README.md and docs/ were left as they are", self.tress("run"))
        self.assertIn("why", out)
        self.ends(2, "why", self.tress("report"))

    def test_a_build_that_fails_shows_its_complaints(self):
        self.stand_in("cmake", "echo before; echo 'a.cpp:1: error: bad'; echo after; exit 1")
        out = self.ends(1, "the build failed; full log: build/release/build.log",
                        self.tress("build", "heads"))
        self.assertIn("a.cpp:1: error: bad", out)
        self.assertNotIn("before", out)


class Signals(House):
    """Signals that end the command end its programs first."""

    def start(self, *words):
        """Starts the command in a group of its own."""
        environment = os.environ | {"PATH": f"{self.work}/bin:{os.environ['PATH']}",
                                    "TRESS_CACHE": str(self.work / "cache")}
        return subprocess.Popen([self.program, *words], env=environment, cwd=self.there,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                process_group=0)

    def when_there(self, path):
        for _ in range(600):
            if path.exists():
                return
            time.sleep(0.05)
        self.fail(f"{path} did not appear")

    def test_a_program_ends_and_the_command_says_how_to_go_on(self):
        for stop, whole_group in ((signal.SIGINT, True), (signal.SIGINT, False),
                                  (signal.SIGTERM, False)):
            with self.subTest(stop=stop, whole_group=whole_group):
                running, ended = self.work / "running", self.work / "ended"
                for path in (running, ended):
                    path.unlink(missing_ok=True)
                self.study("heads", f"{CHECKED}{{ trap 'touch {ended}; exit 130' INT TERM; "
                           f"touch {running}; while :; do sleep 0.05; done; }}")
                with self.start("run") as process:
                    self.when_there(running)
                    if whole_group:  # as a terminal does for Ctrl-C
                        os.killpg(process.pid, stop)
                    else:
                        process.send_signal(stop)
                    out, _ = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 130, out)
                self.assertRegex(out, "interrupted in heads; not finished: heads; "
                                 "to go on: ./tress run --resume heads")
                self.assertTrue(ended.exists())

    def test_a_build_ends(self):
        running, ended = self.work / "running", self.work / "ended"
        self.stand_in("cmake", f"trap 'touch {ended}; exit 1' INT; touch {running}; "
                      "while :; do sleep 0.05; done")
        with self.start("build") as process:
            self.when_there(running)
            process.send_signal(signal.SIGINT)
            out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, out)
        self.assertRegex(out, "tress: interrupted\n$")
        self.assertTrue(ended.exists())


class Scenes(House):
    """Each scene has a folder of its own, whatever it is called, and none is another's."""

    def setUp(self):
        super().setUp()
        self.own = self.work / "own"
        for name in ("a", "b"):
            (self.own / name).mkdir(parents=True)
        self.study("simulate", 'echo "ran $*"')

    def scene(self, name):
        path = self.own / name
        path.touch()
        return path

    def test_ask_has_a_folder_for_each_scene(self):
        (self.house / "results").mkdir()
        kept = self.house / "results/hard_cases.csv"
        kept.write_text("x\n")
        for name in ("stability_limit", "hard_cases", "effect_audit", "cost_of_accuracy"):
            self.study(name, 'while [[ $1 != --out ]]; do [[ $1 != references=* ]] || '
                       'mkdir -p "${1#*=}"; shift; done; echo table >"$2"')
        names = ("...toml", ".toml", "a/s.toml", "b/s.toml", "a/$(touch x).toml", "a/x y.toml")
        for name in names:
            out = self.ends(0, "the answers: ", self.tress("ask", self.scene(name)))
            self.assertRegex(out, r"cost_of_accuracy: [0-9]+ s")
        self.assertEqual(sorted(path.name for path in kept.parent.iterdir()),
                         ["ask", "hard_cases.csv"])
        self.assertEqual(kept.read_text(), "x\n")
        asked = self.house / "results/ask"
        for name in ("hard_cases.csv", "reference"):
            self.assertEqual(len(list(asked.rglob(name))), len(names), name)

    def test_ask_ends_where_a_program_refuses(self):
        self.study("stability_limit", "echo no such key; exit 2")
        out = self.ends(2, "no such key", self.tress("ask", self.scene("a/s.toml")))
        self.assertNotIn("hard_cases", out)
        self.assertEqual(list((self.house / "results/ask").iterdir()), [])

    def test_simulate_writes_its_own_folder(self):
        out = self.ends(0, "build: [0-9]+ s",
                        self.tress("simulate", self.scene("a/s.toml"), "--error-bars"))
        folder = re.search("results/simulate/s-[0-9]+", out)[0]
        self.assertIn(f"ran {self.own}/a/s.toml --out {folder}/scenes --error-bars\n", out)
        self.assertRegex(out, rf"open in a browser: file://{self.house}/{folder}/report.html#tab-")
        # The name is that of cksum over the path.
        done = subprocess.run(["cksum"], input=f"{self.own}/a/s.toml\n", capture_output=True,
                              text=True, check=True)
        self.assertEqual(folder.rpartition("-")[2], done.stdout.split()[0])
        left = self.house / folder / "scenes/old.csv"
        left.parent.mkdir(parents=True)
        left.touch()
        self.tress("simulate", self.own / "a/s.toml")
        self.assertFalse(left.exists())
        # A run that fails has a page.
        self.study("simulate", "exit 3")
        self.ends(3, "open in a browser: ", self.tress("simulate", self.scene("a/s.toml")))

    def test_simulate_keeps_what_a_user_may_still_need(self):
        scene = self.scene("a/s.toml")
        self.study("simulate", 'mkdir -p "$3"; touch "$3/state"')
        self.tress("simulate", scene)
        self.study("simulate", 'ls "$3"; exit 0')
        self.assertIn("state\n", self.tress("simulate", scene, "--resume").stdout)
        # Nor does a refusal take the results of the run before.
        self.study("simulate", "exit 2")
        self.ends(2, "build: ", self.tress("simulate", scene, "--such"))
        self.study("simulate", 'ls "$3"')
        self.assertIn("state\n", self.tress("simulate", scene, "--resume").stdout)
        folders = list((self.house / "results/simulate").iterdir())
        self.assertEqual(len(folders), 1, folders)

    def in_a_new_clone(self):
        """Only build/first has the program then. What cmake is asked goes into the file `asked`."""
        (self.studies / "simulate").unlink()
        write_program(self.house / "build/first/experiments/simulate", 'echo "first $*"')
        self.stand_in("cmake", f"echo \"$*\" >>'{self.work}/asked'")

    def test_a_new_clone_builds_what_compiles_soonest(self):
        self.in_a_new_clone()
        out = self.ends(0, "build: [0-9]+ s", self.tress("simulate", self.scene("a/s.toml")))
        self.assertIn(f"first {self.own}/a/s.toml --out results/simulate/s-", out)
        self.assertRegex(out, r"building build/first .*\n(.*\n)*.*simulation: [0-9]+ s\n.*page: [0-9]+ s\n")
        self.assertRegex((self.work / "asked").read_text(),
                         r"^--preset first .*\n--build --preset first --target simulate\n$")
        self.assertEqual(self.tress("simulate", "--print-defaults").stdout, "first --print-defaults\n")
        (self.work / "asked").unlink()
        self.study("simulate", 'echo "full $*"')  # ./tress build simulate
        self.ends(0, "full ", self.tress("simulate", self.scene("a/s.toml")))
        self.assertNotIn("first", (self.work / "asked").read_text())

    def test_a_new_clone_needs_no_packages_of_tests_and_tools(self):
        self.in_a_new_clone()
        self.stand_in("dpkg-query", "exit 1")
        done = self.tress("--no-install", "simulate", self.scene("a/s.toml"))
        self.refused(r"packages are missing: .*\bg\+\+.*\blibhdf5-dev\b", done)
        self.assertNotRegex(done.stderr, "chromium|gtest|clang|pandas")

    def test_refusals(self):
        scene = self.scene("a/s.toml")
        for words, pattern in (
            (["none.toml"], f"simulate: no file 'none.toml'; paths are relative to {self.house}"),
            ([self.own / "a"], "is a folder; give a scene file"),
            ([scene, self.scene("b/s.toml")], "after the scene file; give one scene"),
            ([scene, "--out", "here"], "simulate: --out is results/simulate/s-"),
            ([scene, "--out=here"], "simulate: --out is results/simulate/s-"),
            ([self.scene("a,b.toml")], "has a comma"),
        ):
            self.refused(pattern, self.tress("simulate", *words))
        self.refused("has a comma", self.tress("ask", self.own / "a,b.toml"))


class Severity(unittest.TestCase):
    def test_failed_rows_are_less_than_bad_input_and_that_less_than_errors(self):
        self.assertEqual(max((3, 2, 0, 3), key=severity), 2)
        self.assertEqual(max((3, 2, 1), key=severity), 1)
        self.assertEqual(max((0, 3), key=severity), 3)


if __name__ == "__main__":
    unittest.main()
