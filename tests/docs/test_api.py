"""docs/site/api_check.py on headers whose described names are known: python3 tests/docs/test_api.py"""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs/site"))
import api_check  # noqa: E402

HEADER = """#pragma once
/// A base.
class Base {
 public:
  virtual ~Base() = default;
  Base(const Base&) = delete;
  /// Returns it.
  virtual int described() = 0;
  virtual int undescribed() = 0;
 private:
  int hidden;
};
class Heir : public Base {
 public:
  int described() override;
  int undescribed() override;
  friend int named(const Heir&) { return 1; }
  friend bool operator==(const Heir&, const Heir&) { return true; }
};
/// Choices: `first` of all.
enum class Choice { first, second };
/// Numbers.
struct Numbers {
  double a, b = 0, c;  // m
  std::string_view word = "x";  // of several
                                // lines
  using Vector __attribute__((vector_size(32))) = double;
  double bare;
};
"""
# Without a description: those of HEADER.
BARE = {"Base::undescribed", "Heir", "Heir::undescribed", "Heir::named", "Choice::second",
        "Numbers::Vector", "Numbers::bare"}


class Api(unittest.TestCase):
    def names(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for name in ("contract/a.h", "docs/site/trailing_comments.sed"):
                (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / "contract/a.h").write_text("namespace space {\n" + HEADER + "}\n")
            shutil.copy(ROOT / "docs/site/trailing_comments.sed", root / "docs/site")
            settings = (ROOT / "docs/site/Doxyfile").read_text() + f"INPUT = {root}/contract\nSTRIP_FROM_PATH = {root}\n"
            subprocess.run(["doxygen", "-"], input=settings, text=True, cwd=root, check=True, capture_output=True)
            return api_check.Names(root / "xml")

    def test_the_names_without_a_description_are_those(self):
        found = self.names().found
        self.assertEqual({name.removeprefix("space::") for *_, name, good in found if not good}, BARE)
        described = {name.removeprefix("space::") for *_, name, good in found if good}
        self.assertLessEqual({"Base", "Base::described", "Heir::described", "Choice", "Choice::first", "Numbers::a",
                              "Numbers::b", "Numbers::c", "Numbers::word"}, described)
        self.assertEqual(len(described) + len(BARE), len(found), "names that are private, deleted or operators")


if __name__ == "__main__":
    if not shutil.which("doxygen"):
        print("no doxygen: ./tress docs installs it", file=sys.stderr)
        sys.exit(77)
    unittest.main()
