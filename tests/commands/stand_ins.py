"""For tests of ./tress: programs that would change the machine, or take long, are replaced by
stand-ins first on the PATH."""

import os
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "python")]
import tress_test  # noqa: E402

INSTALLED = 'for name in "$@"; do [[ $name == -* ]] || printf "installed %s\\n" "$name"; done'


def write_program(path, body):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/usr/bin/env bash\n{body}\n")
    path.chmod(0o755)


class StandIns(tress_test.TressTest):
    """Runs ./tress with stand-ins, in a folder with a space in its name."""

    program = ROOT / "tress"

    def setUp(self):
        super().setUp()
        self.there = self.work / "a b"
        self.there.mkdir()
        self.stand_in("apt-get", f"touch '{self.work}/apt_was_called'; exit 1")
        self.stand_in("sudo", "exit 1")
        self.stand_in("dpkg-query", INSTALLED)
        self.stand_in("id", "echo 0")

    def stand_in(self, name, body):
        write_program(self.work / "bin" / name, body)

    def tress(self, *words, **environment):
        environment = {"PATH": f"{self.work}/bin:{os.environ['PATH']}",
                       "TRESS_CACHE": self.work / "cache", **environment}
        return tress_test.run(*words, program=self.program, cwd=self.there, **environment)


class House(StandIns):
    """A clone whose programs are stand-ins."""

    def setUp(self):
        super().setUp()
        self.house = self.work / "house"
        self.program = self.house / "tress"
        self.studies = self.house / "build/release/experiments"
        self.studies.mkdir(parents=True)
        for name in ("cmake", "experiments/report/dist", "python"):
            (self.house / name).mkdir(parents=True)
        shutil.copy(ROOT / "tress", self.house)
        shutil.copytree(ROOT / "python/tress_command", self.house / "python/tress_command")
        for path in (ROOT / "cmake").glob("*.txt"):
            shutil.copy(path, self.house / "cmake")
        (self.house / "experiments/report/dist/report.mjs").touch()
        write_program(self.house / "cmake/sundials.sh", "echo /usr")
        self.stand_in("cmake", "exit 0")
        self.stand_in("node", "[[ $1 != --version ]] || echo v18.1.0")
        self.stand_in("npm", "exit 0")
        (self.studies / "left_out.txt").write_text("divided_heads: no MPI\n")
        self.experiments("heads")

    def experiments(self, *names):
        (self.studies / "list.txt").write_text("".join(f"{name}\n" for name in names))

    def study(self, name, body):
        write_program(self.studies / name, body)
