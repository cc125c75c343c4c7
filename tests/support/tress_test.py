"""For tests of ./tress: runs the command of this repository, with nothing but its own words."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def run(*words, program=ROOT / "tress", cwd=None, **environment):
    """Runs the command to its end. Returns exit code, stdout, stderr."""
    return subprocess.run(
        [str(word) for word in (program, *words)], stdin=subprocess.DEVNULL,
        capture_output=True, text=True, errors="replace", cwd=cwd, check=False,
        env=os.environ | {name: str(value) for name, value in environment.items()})


class TressTest(unittest.TestCase):
    """A test with a folder of its own, self.work, that is removed."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tress-test-")
        self.addCleanup(folder.cleanup)
        self.work = Path(folder.name)

    def ends(self, code, pattern, done):
        """Asserts an exit code and, in the output, a pattern. Returns the output."""
        text = done.stdout + done.stderr
        self.assertEqual(done.returncode, code, f"{done.args}\n{text}")
        self.assertRegex(text, pattern, f"{done.args}")
        return text

    def refused(self, pattern, done):
        """Asserts exit code 2 and one line on stderr, with a pattern."""
        self.ends(2, pattern, done)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
