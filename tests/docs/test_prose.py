"""The words of the repository, and that docs/site/prose_check.py finds a fault of each kind:
python3 tests/docs/test_prose.py"""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "docs/site/prose_check.py"
sys.path.insert(0, str(PROGRAM.parent))
import prose_check  # noqa: E402

LONG = " ".join(["word"] * 36) + "."
PAGE = "# Title\n\nA strand hangs from its root.\n"
HEADER = """#pragma once
/// Returns the length of a strand along its elements, m.
double length(const Strand& strand);
"""


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write("docs/index.md", PAGE)
        self.write("models/strand.h", HEADER)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def kinds(self):
        return dict(prose_check.check(self.root).counts())

    def caught(self, name, text, **kinds):
        self.write(name, text)
        self.assertEqual(self.kinds(), kinds)


class Faults(Folder):
    def test_none_in_good_text(self):
        self.assertEqual(self.kinds(), {})

    def test_long_sentence_of_a_page(self):
        self.caught("docs/index.md", f"# Title\n\n{LONG}\n", page_long=1)

    def test_code_is_no_sentence(self):
        self.caught("docs/index.md", f"```\n{LONG}\n| {LONG} |\n```\n")

    def test_a_cell_of_a_table_is_a_text_of_its_own(self):
        half = "word " * 18
        self.caught("docs/index.md", f"| {half} | {half} |\n|---|---|\n| {half}<br>{half} | |\n")
        self.caught("docs/index.md", f"| {half} |\n|---|\n| {half}{half} |\n", page_long=1)

    def test_pages_made_from_templates_are_checked_as_they_are_read(self):
        filled = "Stable is " + "1 ms and " * 12 + "2 ms.\n"
        for name in ("README.md", "results/README.md", "experiments/hard_cases/README.md"):
            with self.subTest(name):
                self.caught(name, filled, page_long=1)
                (self.root / name).unlink()
        self.caught("docs/templates/README.md", filled)

    def test_long_mean_sentence_of_a_page(self):
        lines = "\n".join(f"- {'word ' * 21}" for _ in range(prose_check.FEWEST))
        self.caught("docs/index.md", lines, page_mean=1)
        self.caught("docs/index.md", "\n".join(lines.split("\n")[1:]))

    def test_list_items_are_texts_of_their_own(self):
        self.caught("docs/index.md", "".join(f"- {'word ' * 20}\n" for _ in range(3)))

    def test_banned_phrase_of_a_page(self):
        self.caught("docs/index.md", "The mesh is built anew.\n", ban=1)

    def test_banned_phrase_of_a_comment(self):
        self.caught("models/strand.h", "/// Returns so many strands of a batch.\n", ban=1)

    def test_banned_phrase_of_an_error(self):
        self.caught("models/a.cpp", 'throw InputError("the strands look alike");\n', ban=1)

    def test_banned_phrase_of_a_help_text(self):
        self.caught("models/a.cpp", '{.help = "strand beside "\n "the head"}\n', ban=1)

    def test_code_spans_are_no_words(self):
        self.caught("docs/index.md", "The option `anew` rebuilds the mesh.\n")

    def test_long_help_text(self):
        self.caught("models/a.cpp", f'{{.help = "{"word " * 26}"}}\n', help_long=1)

    def test_long_error(self):
        self.caught("models/a.cpp", f'refuse_if(x, "{"word " * 26}");\n', help_long=1)

    def test_start_of_a_help_text(self):
        self.caught("models/a.cpp", '{.help = "of the intervals"}\n', help_start=1)

    def test_start_of_a_column_text(self):
        self.caught("models/a.cpp", '{"confidence", "the same of the intervals"}\n',
                    help_start=1)

    def test_long_sentence_of_a_comment(self):
        self.caught("models/strand.h", "/// Returns " + "a word " * 15 + "here.\n", long=1)

    def test_formulas_and_citations_are_no_words(self):
        self.caught("models/strand.h", f"/// Returns the work [{'Name ' * 30}1991].\n///\n"
                                       f"///     {'x + ' * 40}\n///\n/// and its slope.\n")

    def test_start_of_a_comment(self):
        self.caught("models/strand.h", "/// Of the last step.\ndouble h();\n", comment_start=1)

    def test_comment_without_object(self):
        self.caught("models/strand.h", "/// Cofactors only.\ndouble h();\n", comment_start=1)

    def test_unit_as_whole_description(self):
        self.caught("models/strand.h", "void forces(Out f) const;  // N\n", thin=1)

    def test_excused_line(self):
        self.caught("models/strand.h", "/// Of the step. (prose: ok)\ndouble h();\n")


class Limits(Folder):
    def run_program(self):
        return subprocess.run([sys.executable, PROGRAM, self.root], capture_output=True,
                              text=True)

    def test_good_text_passes(self):
        self.assertEqual(self.run_program().returncode, 0)

    def test_more_faults_than_allowed_fail(self):
        for kind, most in prose_check.LIMITS.items():
            report = prose_check.Report()
            for _ in range(most):
                report.add(kind, "a:1", "text", "advice")
            self.assertEqual(report.excesses(), [])
            report.add(kind, "a:1", "text", "advice")
            self.assertIn(kind, " ".join(report.excesses()))

    def test_program_names_the_excess(self):
        self.write("docs/index.md", f"# Title\n\n{LONG}\n")
        ended = self.run_program()
        self.assertEqual(ended.returncode, 1)
        self.assertIn("page_long: 1 faults", ended.stderr)


class Repository(unittest.TestCase):
    def test_every_program_is_on_the_page_of_the_command_line(self):
        built = (ROOT / "experiments/CMakeLists.txt").read_text()
        programs = set(re.findall(r"^(?:tress_study|add_executable)\((\w+)", built, re.M))
        page = (ROOT / "docs/reference/command_line.md").read_text()
        listed = set(re.findall(r"^\| `(\w+)` \|", page, re.M))
        self.assertGreater(len(programs), 15)
        self.assertEqual(programs - listed, set())

    def test_is_within_the_limits(self):
        report = prose_check.check(ROOT)
        # Enough of every surface is read for the limits to mean something.
        for surface, least in {"pages": 2000, "cells": 1000, "comments": 5000, "errors": 200,
                               "help": 500}.items():
            self.assertGreater(len(report.lengths[surface]), least, surface)
        self.assertEqual(report.excesses(), [])


if __name__ == "__main__":
    unittest.main()
