"""The pages made from templates and tables: /usr/bin/python3 tests/report/test_prose.py"""
import os
import subprocess
import sys
import unittest
from functools import cache

from repository import REPORT, ROOT, Made
from prose import literals
from prose.account import account
from prose.pages import (STUDIES, environment, fill, is_manual, queries_of, results_in_manual, untraced_literals,
                         written_pages)
from prose.untraced import SLOT, untraced_numbers, without_marks
from result_numbers import catalogue
from result_numbers.tables import InputError, Tables

COMMAND = REPORT / "prose/prose.py"
shipped_pages = cache(lambda: written_pages(ROOT))
shipped_account = cache(lambda: account(ROOT, shipped_pages()))


class Shipped(unittest.TestCase):
    def test_every_page_says_what_templates_and_tables_say(self):
        for page, (text, _) in shipped_pages().items():
            self.assertEqual((ROOT / page).read_text(), text, f"{page}: run ./tress report")

    def test_every_number_and_number_word_has_a_query_or_a_reason(self):
        self.assertEqual([problem for of in shipped_account().values() for problem in of["problems"]], [])
        for page, of in shipped_account().items():
            self.assertTrue(of["slots"] > 0 or not of["tables"], f"{page}: tables without a query")

    def test_every_query_stands_in_a_page_or_serves_another(self):
        def joined(folder, pattern):
            return "".join(path.read_text() for path in folder.glob(pattern))

        templates = joined(ROOT / "docs/templates", "**/*.md")
        sources = joined(REPORT / "result_numbers", "*.py") + joined(REPORT / "prose", "*.py")
        queries = [(study, name) for study in STUDIES for name in queries_of(study)]
        self.assertGreater(len(queries), 150)
        for study, name in queries:
            used = f"{{{{ {study}.{name}" in templates or f"{study}.{name}(" in sources or sources.count(f"{name}(") > 1
            self.assertTrue(used, f"{study}.{name}: nothing uses it")

    def test_no_page_escapes_the_account(self):
        listed = subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, capture_output=True, text=True)
        if listed.returncode != 0:
            self.skipTest("no git checkout")
        missing = [page for page in listed.stdout.split() if page not in shipped_account()
                   and not page.startswith("docs/templates/") and not is_manual(page)]
        # The program prints this one, and a test compares it.
        self.assertEqual(missing, ["scenes/README.md"])

    def test_pages_of_the_manual_state_no_results(self):
        self.assertEqual(results_in_manual("a.md", "An error of 1 %, in 4.2 ms.\n```text\n3 ms\n```\nBy 47 %."), [
            "a.md:1: '4.2 ms' may be a result; compute it on a page made from a template",
            "a.md:5: '47 %' may be a result; compute it on a page made from a template"])
        pages = [page for path in (ROOT / "docs").glob("**/*.md") if is_manual(page := path.relative_to(ROOT).as_posix())]
        self.assertGreater(len(pages), 20)
        for page in [*pages, "CHANGELOG.md"]:
            self.assertEqual(results_in_manual(page, (ROOT / page).read_text()), [])

    def test_a_page_ends_with_the_commits_of_the_tables_that_it_read(self):
        text, tables = shipped_pages()["experiments/hard_cases/README.md"]
        self.assertIn("hard_cases", tables)
        self.assertRegex(text, r"\nTables of this page by commit: .*[0-9a-f]{7}: `hard_cases`.*\.\n$")

    def test_a_page_names_the_tables_of_its_figures(self):
        text, tables = shipped_pages()["README.md"]
        self.assertNotIn("{{ newest.", (ROOT / "docs/templates/README.md").read_text())
        self.assertIn("results/newest_methods.svg", text)
        self.assertLessEqual({"work_precision", "block_descent"}, set(tables))

    def test_the_readme_fits_in_120_lines(self):
        self.assertLessEqual(len((ROOT / "README.md").read_text().split("\n")), 121)

    def test_the_catalogue_page_shows_what_the_program_lists(self):
        program = os.environ.get("TRESS_PROGRAM")
        self.assertTrue(program, "TRESS_PROGRAM names an experiment")
        listed = subprocess.run([program, "--list"], capture_output=True, text=True, check=True).stdout
        self.assertEqual((ROOT / catalogue.SNAPSHOT).read_text(), listed,
                         f"{catalogue.SNAPSHOT}: write it anew with ./tress report")


class Untraced(unittest.TestCase):
    def found(self, text):
        return [found for _, found in untraced_numbers(text)]

    def test_number_words_are_found_and_grammar_is_not(self):
        self.assertEqual(self.found("A step costs some three times that of a helix."), ["some", "three"])
        self.assertEqual(self.found("Rods need a quarter of the elements, less than half the time."), ["a quarter", "half"])
        self.assertEqual(self.found("It is twice as fast; most of the runs fail, nearly all hairs hold."),
                         ["twice", "most of the runs", "nearly"])
        self.assertEqual(self.found("it takes about {{ a.b }} minutes"), ["about"])
        self.assertEqual(self.found("it turns about the axis, at most, at the most, with some friction"), [])
        self.assertEqual(self.found("the default of the third argument in double precision"), [])
        self.assertEqual(self.found("<!-- inputs: the scene -->\n3 m, half\n<!-- end of inputs -->\nthen 4 m"), ["4"])
        self.assertEqual(self.found("<!-- inputs: -->\n3 m\n<!-- end of inputs -->"), ["3"], "a region has a reason")

    def test_marks_of_inputs_go_and_marks_in_code_stay(self):
        self.assertEqual(without_marks("a\n<!-- inputs: b -->\n3 m\n<!-- end of inputs -->\n`<!-- inputs: c -->`\n"),
                         "a\n3 m\n`<!-- inputs: c -->`\n")

    def test_a_number_that_nobody_computed_is_found_with_its_line(self):
        self.assertEqual(untraced_numbers("one step\nholds 19 of 22 cases\n"), [(2, "19"), (2, "22")])

    def test_slots_code_links_and_what_is_allowed_are_no_such_numbers(self):
        template = ("a hair of 10 cm, {{ hard.cases }} cases, {{ a.b('1e-3') }}, `--elements 5`, [page](a1.md)\n"
                    "```\nrun 2\n```\n")
        self.assertEqual(untraced_numbers(template), [])

    def test_what_is_allowed_does_not_hide_a_number_beside_it(self):
        self.assertEqual(self.found("a hair of 10 cm hangs 3 mm\n")[0], "3")
        self.assertEqual(self.found("order 2 takes 258 steps\n")[0], "258")
        self.assertEqual(len(self.found("21 % off\n")), 1)

    def test_a_number_in_braces_is_typed_by_hand_too(self):
        self.assertEqual(self.found("{{ 19 }} cases, {{ '22' }}, {% set n = 7 %}"), ["19", "'22'", "7"])
        self.assertEqual(self.found("{{ hard.cases * 2 }}"), ["2"])

    def test_texts_of_javascript_are_read_with_their_slots_and_code_and_comments_are_not(self):
        source = ("// don't\nconst a = `takes ${b > 2 ? `about ${n} s` : ''} of \\`x2\\` half`;\n"
                  "const r = /['\"`]/; const name = 'wall_1pct_s'; const d = \"Young's modulus\";\n")
        self.assertEqual(literals.of_javascript(source), [
            (2, "takes {{ }} of `x2` half"), (2, "about {{ }} s"), (3, "Young's modulus")])
        self.assertEqual([text.split(" ")[1] for text in untraced_literals("a.mjs", source)], ["'half'", "'about'"])

    def test_texts_of_python_are_read_with_their_slots_and_docstrings_are_not(self):
        source = ('"""Two of them."""\n# half of it\ndef a(n):\n    """ "3 m long" """\n'
                  '    return f"takes {n:.2f} of " f"`x2` half {\'about 4 s\' if n else \'\'}" + b["two_m"]\n')
        self.assertEqual(literals.of_python(source), [(5, "takes {{ }} of `x2` half {{ }}"), (5, "about 4 s")])
        self.assertEqual([text.split(" ")[1] for text in untraced_literals("a.py", source)], ["'half'", "'about'", "'4'"])


class Faults(Made):
    """What a template can get wrong: one line with its place and the remedy."""

    def prose(self, *argv):
        return subprocess.run([sys.executable, COMMAND, *argv, self.root], capture_output=True, text=True)

    def refused(self, template, message):
        self.write("docs/templates/a.md", template)
        with self.assertRaisesRegex(InputError, message) as refusal:
            fill(environment(self.root), "a.md", Tables(self.root))
        self.assertNotIn("\n", str(refusal.exception))

    def test_queries_that_do_not_exist(self):
        self.refused("\n{{ hard.nothing }}", r"^docs/templates/a\.md:2: hard\.nothing: no such query; there are: .*cases")
        self.refused("a\n\n{{ nothing.cases }}", r"^docs/templates/a\.md:3: 'nothing' is undefined; there are: .*hard")
        self.refused("{{ hard.cases('x') }}", r"^docs/templates/a\.md:1: hard\.cases: too many positional arguments; it takes \(\)")
        self.refused("\n{{ hard.cases", r"^docs/templates/a\.md:2: .*; write \{\{ study\.query \}\}")

    def test_missing_tables_and_columns(self):
        self.refused("{{ hard.cases }}", r"a\.md:1: hard\.cases: results/hard_cases\.csv is missing; .*\./tress run")
        self.write("results/hard_cases.csv", "model\nder\n")
        self.refused("x\n{{ hard.cases }}", r"a\.md:2: hard\.cases: no column or row named 'case' in results/hard_cases\.csv; make "
                     r"the table again with \./tress run")
        self.write("results/full_sweeps.csv", "experiment,rows\n")
        self.refused("{{ cluster.full_hours }}", "'core_hours' in results/full_sweeps")
        self.refused("{{ other_simulators.minutes }}", r"results/other_simulators\.meta\.json is missing")
        self.write("results/calibrate.csv", "data,internal_friction_true_kg_m3_s\na,1\nb,2\n")
        self.refused("{{ friction.truth }}", 'friction.truth: no longer true; rewrite the sentence: "all records have the same')

    def test_values_that_a_query_cannot_take(self):
        self.write("results/full_sweeps.csv", "experiment,core_hours\na,many\n")
        self.refused("{{ cluster.full_hours }}", r"a\.md:1: cluster\.full_hours: experiments/report/result_numbers/cluster\.py:\d+: "
                     r"TypeError: .*; make the tables again")

    def test_tables_that_the_report_cannot_read(self):
        self.write("results/t.csv", 'a\n"x')
        self.refused("{{ findings.swing }}", r"findings\.swing: .*/results/t\.csv:2: a quote is opened and never closed")
        self.write("results/t.csv", "a\n1\n")
        self.refused("{{ findings.swing }}", "findings.swing: the tables of results/ hold no rows for it; make them with")

    def test_the_command_writes_pages_checks_them_and_refuses_numbers_typed_by_hand(self):
        self.write("docs/templates/README.md", "# strands\n\n<!-- inputs: the scene -->\n3 m\n<!-- end of inputs -->\n")
        self.assertEqual(self.prose("--check").returncode, 3)
        self.assertEqual(self.prose().returncode, 0)
        self.assertEqual((self.root / "README.md").read_text(), "<!-- Made by ./tress report from docs/templates/README.md and "
                         "results/: edit those. -->\n# strands\n\n3 m\n")
        self.assertEqual(self.prose("--check").returncode, 0)
        self.write("README.md", (self.root / "README.md").read_text() + "more\n")
        changed = self.prose("--check")
        self.assertEqual(changed.returncode, 3)
        self.assertRegex(changed.stderr, r'^README\.md:5: says "more"')
        self.write("docs/templates/README.md", "holds 19 cases\n")
        typed = self.prose()
        self.assertEqual(typed.returncode, 2)
        self.assertRegex(typed.stderr, r"docs/templates/README\.md:1: '19' is typed by hand")
        self.assertIn("more", (self.root / "README.md").read_text())
        self.write("docs/templates/README.md", "{{ hard.cases }}\n")
        missing = self.prose()
        self.assertEqual(missing.returncode, 2)
        self.assertRegex(missing.stderr, r"^prose: docs/templates/README\.md:1: hard\.cases: .*\n$")
        self.assertEqual(self.prose("--chek").returncode, 2)

    def test_a_slot_takes_names(self):
        self.assertEqual(SLOT.findall("{{ a.b }} {{a.b('rods')}} {{ a }} {{ 3 }}"), ["{{ a.b }}", "{{a.b('rods')}}"])


if __name__ == "__main__":
    unittest.main()
