"""The command of an installed tree: programs of that tree, results in the working folder."""

import json
import shutil
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from stand_ins import ROOT, StandIns, tress_test, write_program  # noqa: E402

SIMULATE = """if [[ $* == --version ]]; then printf 'simulate 9.8.7 (abc)\\nbuild: Release\\n'; exit; fi
while (($#)); do [[ $1 != --out ]] || mkdir -p "$2"; echo "word $1"; shift; done"""


class Installed(StandIns):
    def setUp(self):
        super().setUp()
        share, programs = self.work / "usr/share/tress", self.work / "usr/libexec/tress"
        (self.work / "usr/bin").mkdir(parents=True)
        shutil.copytree(ROOT / "python/tress_command", share / "python/tress_command")
        (share / "scenes").mkdir()
        (share / "scenes/cantilever.toml").touch()
        (share / "installed.json").write_text(
            json.dumps({"version": "9.8.7", "programs": "../../libexec/tress"}))
        write_program(programs / "simulate", SIMULATE)
        write_program(programs / "damping", 'echo "damping $*"; exit 3')
        (programs / "list.txt").write_text("damping\nsimulate\n")
        (programs / "left_out.txt").touch()
        launcher = (ROOT / "cmake/installed_tress.in").read_text()
        self.program = self.work / "usr/bin/tress"
        self.program.write_text(launcher.replace("@tress_command@", "../share/tress/python/tress_command"))
        self.program.chmod(0o755)
        self.stand_in("node", "echo page $*")

    def test_version_is_that_of_the_tree(self):
        out = self.ends(0, r"^tress 9\.8\.7\n", self.tress("--version"))
        self.assertIn("programs: simulate 9.8.7 (abc)\n  build: Release", out)

    def test_a_link_to_the_command_finds_the_tree(self):
        (self.there / "linked").symlink_to(self.program)
        self.ends(0, r"tress 9\.8\.7", tress_test.run("--version", program=self.there / "linked"))

    def test_shipped_scenes_run_and_results_are_in_the_working_folder(self):
        done = self.tress("simulate", "scenes/cantilever.toml", "--vtk")
        out = self.ends(0, "word --vtk", done)
        self.assertIn(f"word {self.work}/usr/share/tress/scenes/cantilever.toml", out)
        self.assertRegex(done.stderr, f"file://{self.there}/results/simulate/cantilever-")
        self.assertEqual(len(list((self.there / "results/simulate").glob("cantilever-*/scenes"))), 1)
        self.assertFalse((self.work / "apt_was_called").exists())

    def test_a_file_of_the_working_folder_comes_first(self):
        (self.there / "scenes").mkdir()
        (self.there / "scenes/cantilever.toml").touch()
        self.ends(0, r"word scenes/cantilever\.toml", self.tress("simulate", "scenes/cantilever.toml"))
        self.refused("no file 'scenes/none.toml'; paths are relative", self.tress("simulate", "scenes/none.toml"))

    def test_programs_run_by_name_with_their_exit_code(self):
        self.ends(3, "damping --quick --out -", self.tress("damping", "--quick", "--out", "-"))

    def test_commands_of_the_sources_are_refused(self):
        for word in ("build", "test", "lint", "docs", "package"):
            self.refused(f"{word}: needs the sources of tress", self.tress(word))

    def test_help_has_the_name_of_the_command(self):
        out = self.ends(0, "usage: tress simulate", self.tress("simulate", "--help"))
        self.assertNotIn("./tress", out)


if __name__ == "__main__":
    unittest.main()
