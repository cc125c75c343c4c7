"""What ./tress package --abi reports: toy libraries, of which one loses a function or changes a
type."""

import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import tress_test  # noqa: E402

STAMP = 'extern "C" const char stamp[] = "tress plug-in|version={version}|sizes=8|";'
OLD = """namespace tress { struct Point { double x; }; double place(const Point& p) { return p.x; }
double gone() { return 1; } }"""


@unittest.skipUnless(shutil.which("abidiff"), "abidiff is missing: cmake/package_packages.txt")
class Abi(tress_test.TressTest):
    def library(self, name, text, version="1.0.0"):
        source, library = self.work / f"{name}.cpp", self.work / f"{name}.so"
        source.write_text(f"{text}\n{STAMP.format(version=version)}\n")
        subprocess.run(["c++", "-g", "-shared", "-fPIC", source, "-o", library], check=True)
        return library

    def compare(self, old, new):
        return tress_test.run(Path(__file__).with_name("abi.py"), old, new, program=sys.executable)

    def test_additions_are_compatible(self):
        old = self.library("old", OLD)
        new = self.library("new", OLD.replace("double gone", "double more() { return 2; } double gone"))
        self.ends(0, "plug-ins: those of OLD run with NEW(.|\n)*0 removed, 1 added", self.compare(old, new))

    def test_a_removed_function_is_named(self):
        old = self.library("old", OLD)
        new = self.library("new", OLD.replace("double gone() { return 1; }", ""), "1.1.0")
        out = self.ends(3, r"removed: tress::gone\(\)", self.compare(old, new))
        self.assertIn("refused by NEW", out)
        self.assertIn("version: 1.0.0 before, 1.1.0 now", out)

    def test_a_type_that_grows_is_found_by_debug_information(self):
        old = self.library("old", OLD)
        new = self.library("new", OLD.replace("double x;", "double y, x;"))
        self.ends(3, "type size changed from 64 to 128", self.compare(old, new))

    def test_a_file_without_a_stamp_is_refused(self):
        self.refused("has no stamp of plug-ins; give", self.compare("/bin/true", "/bin/true"))
        self.refused("no file 'none.deb'; give", self.compare("none.deb", "/bin/true"))


if __name__ == "__main__":
    unittest.main()
