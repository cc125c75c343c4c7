"""The commands of the quick start of README.md, in the tree that is tested: they rebuild nothing,
and print what the page shows."""

import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "support")]
import tress_test  # noqa: E402
from page_commands import page_commands  # noqa: E402
from test_pages import not_printed  # noqa: E402

ROOT = HERE.parents[1]


def without_settings(text):
    """Returns the text without the settings of the answer: some runs are nearly equally cheap,
    and the load of the machine decides between them."""
    return re.sub(r"(?m)^take [^:]*:", "take these settings:", text)


class QuickStart(tress_test.TressTest):
    def test_commands_print_what_the_page_shows(self):
        query = self.work / "dpkg-query"
        query.write_text('#!/bin/bash\nprintf "installed %s\\n" "${@:3}"\n')
        query.chmod(0o755)
        commands = page_commands(ROOT, "README.md")
        self.assertEqual(len(commands), 3)
        self.assertRegex(commands[0].text, r"^\./tress simulate scenes/")
        for command in commands:
            with self.subTest(command=command.text):
                text = command.text.replace("my.toml", f"{self.work}/my.toml")
                done = subprocess.run(
                    ["bash", "-c", text], cwd=ROOT, stdin=subprocess.DEVNULL, check=False,
                    capture_output=True, text=True, errors="replace",
                    env=os.environ | {"PATH": f"{self.work}:{os.environ['PATH']}"})
                printed = done.stdout + done.stderr
                self.assertEqual(done.returncode, 0, printed)
                for folder in re.findall(rf"{ROOT}/(results/\w+/[^/]+)/", printed):
                    shutil.rmtree(ROOT / folder, ignore_errors=True)
                self.assertEqual(
                    not_printed(list(map(without_settings, command.output)), without_settings(printed)),
                    [], printed)


if __name__ == "__main__":
    unittest.main()
