"""Python of the pages: every block runs, after those before it on its page."""

import contextlib
import io
import os
import sys
import tempfile
import unittest
from importlib.util import find_spec
from pathlib import Path

import tress
from common import ROOT, SCENES

sys.path.append(str(ROOT / "tests/commands"))
from page_commands import blocks_of, pages  # noqa: E402

# Optional packages of the blocks that have a word.
NEEDS = {"matplotlib": "matplotlib", "result_numbers": "pandas"}


def can_run(block):
    return all(find_spec(package) for word, package in NEEDS.items() if word in block)


def write_files(folder):
    """Writes the files that the pages let the reader have: a scene, the scene of
    docs/start/gradients.md, a record of its tip, and pixels of a video."""
    (folder / "my.toml").write_text(tress.scene_defaults())
    page = (ROOT / "docs/start/gradients.md").read_text(encoding="utf-8")
    (folder / "curl.toml").write_text(blocks_of(page, "toml")[0])
    frames = tress.Scene.read(folder / "curl.toml").run()
    rows = [
        f"{t:.17g},{x:.17g},{y:.17g},{z:.17g}"
        for t, (x, y, z) in zip(frames.times[1:], frames.positions[1:, -1])
    ]
    (folder / "tip.csv").write_text("\n".join(["time_s,x_m,y_m,z_m", *rows, ""]))
    (folder / "tracked.csv").write_text("frame,u,v\n37,512,88\n38,514,90\n39,518,95\n")
    # docs/extending.md reads the tables of the working folder.
    for name in ("experiments", "results"):
        (folder / name).symlink_to(ROOT / name)


class Pages(unittest.TestCase):
    def test_every_block_runs(self):
        ran = 0
        for page in pages(ROOT):
            blocks = blocks_of((ROOT / page).read_text(encoding="utf-8"), "python")
            if not blocks:
                continue
            with self.subTest(page=page), tempfile.TemporaryDirectory() as folder:
                self.run_blocks(page, filter(can_run, blocks), Path(folder))
            ran += len(blocks)
        self.assertGreaterEqual(ran, 9)

    def run_blocks(self, page, blocks, folder):
        write_files(folder)
        os.environ["MPLBACKEND"] = "Agg"
        names = {"__name__": "page"}
        with contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()):
            for block in blocks:
                exec(compile(block, page, "exec"), names)  # noqa: S102


if __name__ == "__main__":
    unittest.main()
