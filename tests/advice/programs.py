"""What run.py and limits.py share: their arguments, and the programs they run on random scenes."""
import argparse
import subprocess
import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path

from scenes import random_scene


def arguments(about, **numbers):
    """Reads FOLDER and positive whole numbers; `numbers`: those used where none is given."""

    def positive(word):
        if int(word) <= 0:
            raise ValueError
        return int(word)

    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="build folder")
    for name, usual in numbers.items():
        parser.add_argument(name, type=positive, nargs="?", default=usual, help=f"default: {usual}")
    return parser.parse_args()


class Programs:
    """The programs of a build folder, run in a folder of scenes."""

    def __init__(self, folder, work):
        self.folder, self.work = folder.resolve(), work

    def run(self, program, *words, timeout=None):
        command = [self.folder / program, *map(str, words)]
        return subprocess.run(command, cwd=self.work, capture_output=True, text=True, timeout=timeout)

    def scene(self, seed):
        """Writes a random scene: its stem and text."""
        name, text = random_scene(seed)
        stem = f"{name}_{seed}"
        (self.work / f"{stem}.toml").write_text(text)
        return stem, text


@contextmanager
def programs(folder):
    sys.stdout.reconfigure(line_buffering=True)
    with tempfile.TemporaryDirectory(prefix="tress_advice_") as work:
        yield Programs(folder, Path(work))
