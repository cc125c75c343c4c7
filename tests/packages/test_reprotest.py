"""How ./tress package --reprotest builds and ends, with stand-ins for the programs of Debian."""

import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "commands"))
from stand_ins import ROOT, House  # noqa: E402

BUILD = 'echo built >>"{work}/built"; echo bits >../tress_1.0.0_amd64.deb'
# The folder of --store-dir.
REPROTEST = """printf '%s\\n' "$*" >>"{work}/reprotest"
while [[ $1 != --store-dir ]]; do shift; done
"""


class Reprotest(House):
    def setUp(self):
        super().setUp()
        for name in ("VERSION", ".gitattributes"):
            shutil.copy(ROOT / name, self.house)
        (self.house / ".gitignore").write_text("build/\n__pycache__/\n")
        self.stand_in("dpkg-buildpackage", BUILD.format(work=self.work))
        for words in (("init", "-q"), ("add", "-A"), ("commit", "-q", "-m", "one")):
            self.git(*words)

    def git(self, *words):
        subprocess.run(["git", "-C", self.house, "-c", "user.name=a", "-c", "user.email=a@b", *words], check=True)

    def reprotest(self, body):
        self.stand_in("reprotest", REPROTEST.format(work=self.work) + body)
        return self.tress("package", "--reprotest")

    def test_the_packages_of_a_commit_are_built_once(self):
        for _ in range(2):
            self.ends(0, "the bits of 1 packages are the same", self.reprotest("exit 0"))
        self.assertEqual((self.work / "built").read_text(), "built\n")
        first = self.house / "build/packages_again/first"
        self.assertEqual([one.name for one in first.glob("*.deb")], ["tress_1.0.0_amd64.deb"])
        self.assertRegex((self.work / "reprotest").read_text(),
                         f"--variations=.all,-user_group --control-build {first} .*dpkg-buildpackage -b")
        self.git("commit", "-q", "--allow-empty", "-m", "two")
        self.ends(0, "building packages of 1.0.0", self.reprotest("exit 0"))
        self.assertEqual((self.work / "built").read_text(), "built\nbuilt\n")

    def test_packages_that_differ_end_with_code_3(self):
        done = self.reprotest('mkdir "$2"; touch "$2/experiment-1.diffoscope.out"; exit 1')
        self.ends(3, "packages differ; differences: end of build/packages_again/build.log", done)

    def test_a_build_that_fails_ends_with_code_1(self):
        self.ends(1, "reprotest: the build failed; full log", self.reprotest("exit 1"))


if __name__ == "__main__":
    unittest.main()
