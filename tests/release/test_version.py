"""The version stands in VERSION; copies that other programs read must be the same."""

import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
VERSION = (ROOT / "VERSION").read_text(encoding="utf-8").strip()
MAJOR_MINOR = VERSION.rpartition(".")[0]


def text(name):
    return (ROOT / name).read_text(encoding="utf-8")


class Copies(unittest.TestCase):
    def test_it_is_semantic(self):
        self.assertRegex(VERSION, r"^\d+\.\d+\.\d+$")

    def test_copies_are_the_same(self):
        copies = {
            "CITATION.cff": r"^version: (.+)$",
            ".zenodo.json": r'"version": "(.+)"',
            "docs/about/citing.md": r"version = \{(.+)\}",
            "debian/changelog": r"\Atress \((.+)\) ",
            "packaging/conda/meta.yaml": r"^  version: (.+)$",
            "packaging/spack/package.py": r'^    version\("(.+)"\)$',
        }
        for name, pattern in copies.items():
            found = re.findall(pattern, text(name), re.MULTILINE)
            self.assertTrue(found, name)
            self.assertEqual(set(found), {VERSION}, name)

    def test_pages_and_examples_ask_for_a_version_that_accepts_this_one(self):
        listed = subprocess.run(["git", "grep", "-hoE", r"find_package\(tress [0-9.]+", "--", "."],
                                cwd=ROOT, capture_output=True, text=True, check=True)  # fmt: skip
        wanted = {line.split()[-1] for line in listed.stdout.splitlines()}
        for one in wanted:
            self.assertEqual(one.split(".")[0], VERSION.split(".")[0])
            self.assertLessEqual(tuple(map(int, one.split("."))), tuple(map(int, MAJOR_MINOR.split("."))))

    def test_the_changelog_has_it(self):
        self.assertRegex(text("CHANGELOG.md"), rf"(?m)^## {re.escape(VERSION)}\b")

    def test_no_other_source_has_a_version(self):
        self.assertNotRegex(text("CMakeLists.txt"), r"project\(tress VERSION \d")
        self.assertIn('dynamic = ["version"]', text("pyproject.toml"))

    def test_the_command_prints_it(self):
        done = subprocess.run([ROOT / "tress", "--version"], capture_output=True, text=True, check=True)
        self.assertRegex(done.stdout, rf"^tress {re.escape(VERSION)} \(")

    def test_metadata_is_json_with_what_archives_need(self):
        record = json.loads(text(".zenodo.json"))
        for key in ("title", "description", "upload_type", "license", "creators"):
            self.assertTrue(record[key], key)

    def test_jobs_of_the_forge_run_commands_of_this_clone(self):
        sys.path.insert(0, str(ROOT / "python"))
        from tress_command.commands import COMMANDS

        known = {command.name for command in COMMANDS}
        jobs = re.findall(r"command: (.+)\}", text(".github/workflows/ci.yml"))
        self.assertGreaterEqual(len(jobs), 5)
        for job in jobs:
            program, *words = job.split()
            self.assertTrue((ROOT / program).is_file(), job)
            self.assertTrue(program == ".ci/run" or words[0] in known, job)


if __name__ == "__main__":
    unittest.main()
