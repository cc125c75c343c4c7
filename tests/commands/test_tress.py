"""What ./tress promises on the command line: help, words, packages, the launcher."""

import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from stand_ins import ROOT, House, StandIns, tress_test  # noqa: E402
from tress_command import command, commands, scripts  # noqa: E402
from tress_command.messages import Ended  # noqa: E402


class Help(StandIns):
    def test_help_lists_all_commands(self):
        for words in ((), ("help",), ("-h",), ("--help",)):
            out = self.ends(0, r"\./tress setup", self.tress(*words))
            for one in commands.COMMANDS:
                self.assertIn(f"  ./tress {one.name}", out)
        (self.there / "linked").symlink_to(ROOT / "tress")
        self.ends(0, r"\./tress setup", tress_test.run("help", program=self.there / "linked"))

    def test_every_command_has_options_an_example_and_a_time(self):
        for one in commands.COMMANDS:
            done = self.tress(one.name, "--help")
            out = self.ends(0, rf"^usage: \./tress {one.name}\b", done)
            self.assertEqual(done.stderr, "")
            self.assertRegex(out, rf"\nExample:\n  \./tress {one.name}\b")
            self.assertRegex(out, r"\nTime: \w")
            for option in re.findall(r"--[a-z-]+", one.usage):
                self.assertRegex(out, rf"\n  {option}\b|\n  .*{option}\b")
        self.assertEqual(self.tress("help", "run").stdout, self.tress("run", "--help").stdout)
        everything = self.tress("help", "all").stdout
        for one in commands.COMMANDS:
            self.assertIn(f"\nusage: ./tress {one.name}", everything)

    def test_help_after_dashes_is_for_the_program(self):
        self.assertTrue(command.wants_help(["a", "-h"]))
        self.assertFalse(command.wants_help(["a", "--", "--help"]))

    def test_help_needs_nothing_installed(self):
        bare = self.work / "bare"
        bare.mkdir()
        for name in ("bash", "dirname", "readlink", "python3"):
            (bare / name).symlink_to(shutil.which(name, path="/usr/bin:/bin"))
        self.ends(0, "usage: ./tress film", self.tress("film", "--help", PATH=bare))


class Words(StandIns):
    def test_bad_words_are_refused_in_one_line(self):
        for words, pattern in (
            (["frobnicate"], "unknown command 'frobnicate'.*tress help"),
            (["help", "frobnicate"], "unknown command 'frobnicate'"),
            (["--no-install"], "--no-install: give a command"),
            (["run", "--fast"], r"run: unknown option '--fast' \(options of the experiments go"),
            (["test", "--fast"], r"test: unknown option '--fast' \(options of ctest go after --"),
            (["test", "all"], "test: unknown option 'all'"),
            (["test", "--packages", "--", "snap"], "--packages has no part 'snap'; parts are debian, image, wheel"),
            (["package", "--fast"], r"package: unknown option '--fast' \(options of reprotest go after --"),
            (["package", "--abi", "one.deb"], "package: --abi takes two packages tress: --abi OLD NEW"),
            (["python", "--fast"], "python: unknown option '--fast'"),
            (["python", "--interpreter", "/none"], "no interpreter '/none'"),
            (["python", "--interpreter"], "--interpreter without a value"),
            (["bench", "--fast"], r"bench: unknown option '--fast' \(options of Google Benchmark"),
            (["build", "--fast"], "build: unknown option '--fast'"),
            (["docs", "--fast"], "docs: unknown option '--fast'; the only one is --check"),
            (["list", "models"], "list: unknown option 'models'; it takes none"),
            (["lint", "--fix"], "lint: unknown option '--fix'"),
            (["setup", "all"], "setup: unknown option 'all'"),
            (["report", "x"], "report: unknown option 'x'"),
            (["check"], "check: give a plug-in"),
            (["check", "none.so"], "check: no file 'none.so'; paths are relative to"),
            (["matrices"], "matrices: give a scene file"),
            (["statics"], "statics: give a scene file"),
            (["matrices", "--time", "1"], "matrices: give a scene file"),
            (["simulate"], "simulate: give one scene file"),
            (["ask", "--quick"], "ask: give one scene file"),
            (["new", "curl", "name"], "unknown kind 'curl'"),
            (["a\nb"], "unknown command 'a.b'"),
        ):
            self.refused(pattern, self.tress(*words))

    def test_words_are_read_into_options_names_and_more(self):
        read = command.read_words("x", ["--a", "n", "--b", "v", "--", "--c"],
                                  flags=("--a",), valued=("--b",), names=True)
        self.assertEqual(read, ({"--a": True, "--b": "v"}, ["n"], ["--c"]))
        with self.assertRaisesRegex(Ended, "x: unknown option 'n'"):
            command.read_words("x", ["n"])

    def test_programs_of_the_repository_exist(self):
        for name, program in vars(scripts).items():
            if name.isupper() and isinstance(program, tuple):
                self.assertTrue((ROOT / program[1]).is_file(), program)


class Packages(StandIns):
    def setUp(self):
        super().setUp()
        self.stand_in("dpkg-query", "exit 1")

    def test_without_rights_the_command_to_type_is_printed(self):
        self.stand_in("id", "echo 1000")
        for words, package in ((["setup"], "ninja-build"), (["other_simulators"], "libode-dev"),
                               (["docs"], "furo")):
            self.refused(f"run: sudo apt-get update && sudo apt-get install .*{package}",
                         self.tress(*words))
        self.assertFalse((self.work / "apt_was_called").exists())

    def test_no_install_lists_what_is_missing(self):
        for words in (["build"], ["setup"], ["list"], ["simulate", "scenes/cantilever.toml"],
                      ["docs"]):
            self.refused(r"--no-install: [0-9]+ packages are missing: .*",
                         self.tress("--no-install", *words))
        self.assertFalse((self.work / "apt_was_called").exists())

    def test_a_failing_apt_ends_with_its_log(self):
        self.ends(1, f"apt-get failed; log: {self.work}/cache/packages.log", self.tress("setup"))
        self.assertTrue((self.work / "apt_was_called").exists())

    def test_packages_are_stated_before_they_are_installed(self):
        self.stand_in("apt-get", f"echo $* >>'{self.work}/apt'; echo 'E: no'; exit 100")
        out = self.ends(1, r"installing [0-9]+ packages by apt as root: .*cmake", self.tress("setup"))
        self.assertRegex(out, "apt-get update reported problems")
        self.assertIn("E: no", out)
        update, install = (self.work / "apt").read_text().splitlines()
        self.assertEqual(update, "update")
        self.assertRegex(install, "^install -y --no-install-recommends .*ninja-build.*--force-confold")

    def test_without_apt_the_way_out_is_named(self):
        bare = self.work / "bare"
        bare.mkdir()
        for name in ("bash", "dirname", "readlink", "python3"):
            (bare / name).symlink_to(shutil.which(name, path="/usr/bin:/bin"))
        self.refused("setup needs Debian's apt; elsewhere install what cmake/build_packages.txt "
                     "and cmake/packages.txt name",
                     self.tress("build", PATH=bare))

    def test_a_cache_that_cannot_be_written(self):
        (self.work / "file").touch()
        self.refused("cannot write .*/file/cache; set TRESS_CACHE",
                     self.tress("setup", TRESS_CACHE=self.work / "file/cache"))

    def test_source_packages_come_from_the_distribution_only(self):
        sources = self.work / "machine.sources"
        sources.write_text("""# a comment
Types: deb
URIs: mirror://one
Suites: bookworm bookworm-updates
 bookworm-backports
Components: main
Signed-By: /usr/share/keyrings/a.gpg

Types: deb
URIs: mirror://other
Suites: nodistro
Components: main

Enabled: no
Types: deb
URIs: mirror://off
Suites: bookworm
Components: main
""")
        done = subprocess.run(
            ["awk", "-v", "codename=bookworm", "-f", ROOT / "cmake/deb_src.awk", "RS=", sources],
            capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout, """Types: deb-src
URIs: mirror://one
Suites: bookworm bookworm-updates
Components: main
Signed-By: /usr/share/keyrings/a.gpg

""")


class Launcher(StandIns):
    """The launcher where there is no Python: in a folder whose PATH has no python3."""

    def setUp(self):
        super().setUp()
        text = (ROOT / "tress").read_text()
        self.program = self.work / "tress"
        # /usr/bin/python3 stands for what this machine has and a new one has not.
        self.program.write_text(text.replace("/usr/bin/python3", f"{self.work}/no/python3"))
        self.program.chmod(0o755)
        for name in ("bash", "dirname", "env", "id", "readlink", "touch"):
            path = self.work / "bin" / name
            if not path.exists():
                path.symlink_to(shutil.which(name, path="/usr/bin:/bin"))

    def tress(self, *words, **environment):
        return super().tress(*words, PATH=self.work / "bin", **environment)

    def test_python_is_installed_or_named(self):
        self.refused("--no-install: 1 packages are missing: python3",
                     self.tress("--no-install", "build"))
        self.assertFalse((self.work / "apt_was_called").exists())
        self.ends(1, "installing 1 packages by apt: python3\n.*apt-get failed", self.tress("list"))
        self.stand_in("id", "echo 1000")
        self.refused("run: sudo apt-get update && sudo apt-get install -y "
                     "--no-install-recommends python3", self.tress("list"))
        (self.work / "bin/apt-get").unlink()
        self.refused("needs Python 3.11 or later", self.tress("list"))

    def test_what_apt_installs_runs_the_command(self):
        self.stand_in("apt-get", '[[ $1 != install ]] || { echo "#!/bin/bash"; echo "echo ran \\$*"; '
                      f"}} >{self.work}/bin/python3; /usr/bin/chmod +x {self.work}/bin/python3")
        self.ends(0, "ran python/tress_command list -a", self.tress("list", "-a"))

    def test_an_old_python_is_named(self):
        entry = (ROOT / "python/tress_command/__main__.py").read_text()
        self.assertLess(len(entry.splitlines()), 20)
        old = entry.replace("(3, 11)", "(9, 0)")
        done = subprocess.run([sys.executable, "-c", old], capture_output=True, text=True,
                              check=False)
        self.assertRegex(done.stderr, r"^tress: needs Python 3\.11 or later; \S+ is 3\.")

    def test_the_launcher_is_small(self):
        self.assertLessEqual(len((ROOT / "tress").read_text().splitlines()), 40)


class Sudo(House):
    def test_without_root_sudo_installs(self):
        self.stand_in("dpkg-query", "exit 1")
        self.stand_in("id", "echo 1000")
        self.stand_in("sudo", f"printf '%s\\n' \"$*\" >>'{self.work}/sudo'")
        out = self.ends(0, "installing [0-9]+ packages by apt with sudo: .*cmake",
                        self.tress("setup"))
        self.assertRegex(out, r"packages of cmake/build_packages.txt, cmake/packages.txt: \d+ s")
        self.assertRegex(out, "SUNDIALS: /usr\n$")
        self.assertFalse((self.work / "apt_was_called").exists())
        said = (self.work / "sudo").read_text().splitlines()
        self.assertEqual(said[:2], ["-n true", "-n apt-get update"])
        self.assertRegex(said[2], "^-n env DEBIAN_FRONTEND=noninteractive apt-get install -y")


if __name__ == "__main__":
    unittest.main()
