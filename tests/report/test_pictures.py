"""Pictures of scenes on the pages: what experiments/report/pictures.py runs for them."""

import contextlib
import io
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "experiments/report"))
import pictures  # noqa: E402


class Pictures(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        (self.root / "results").mkdir()
        self.program = self.root / "simulate"
        self.program.touch()
        self.commands = []
        for name, value in (("ROOT", self.root), ("PROGRAMS", [self.root / "none", self.program])):
            self.enterContext(mock.patch.object(pictures, name, value))

    def run_program(self, command, check):
        self.assertTrue(check)
        self.commands.append([str(word) for word in command])
        if command[0] == "node":
            Path(command[4]).mkdir()
            (Path(command[4]) / "00000.png").write_bytes(b"drawn")

    def main(self, *words, run=None):
        with mock.patch.object(subprocess, "run", run or self.run_program), \
                mock.patch.object(sys, "argv", ["pictures.py", *words]), \
                contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as said:
            try:
                pictures.main()
            except SystemExit as end:
                return end.code, said.getvalue()
        return 0, said.getvalue()

    def test_the_picture_of_the_readme_is_one_command(self):
        self.assertIn("results/hair_under_wind.png", (ROOT / "docs/templates/README.md").read_text())
        self.assertEqual(self.main(), (0, ""))
        simulate, film = self.commands
        self.assertEqual(simulate[:2], [str(self.program), f"{self.root}/scenes/hair_under_wind.toml"])
        self.assertEqual(simulate[4:], ["--hairs", "400"])
        self.assertEqual(film[2], f"{simulate[3]}/hair_under_wind.json")
        self.assertEqual(film[-4:], ["--from", "2.4", "--to", "2.4"])
        self.assertEqual((self.root / "results/hair_under_wind.png").read_bytes(), b"drawn")
        for name in pictures.PICTURES:
            self.assertTrue((ROOT / f"scenes/{name}.toml").is_file(), name)

    def test_what_is_wrong_is_one_line(self):
        code, said = self.main("none")
        self.assertEqual(code, 2)
        self.assertRegex(said, "no picture of 'none'; there are hair_under_wind")
        with mock.patch.object(pictures, "PROGRAMS", []):
            self.assertRegex(self.main()[1], "simulate is not built; run: ./tress build simulate")

        def fails(command, check):
            raise subprocess.CalledProcessError(3, command)

        self.assertEqual(self.main(run=fails)[0], "pictures: hair_under_wind: simulate ended with exit code 3")
        self.assertEqual(list((self.root / "results").iterdir()), [])


if __name__ == "__main__":
    unittest.main()
