"""Code of the notebooks, cell after cell, with their assertions. It needs no Jupyter."""

import contextlib
import io
import json
import os
import tempfile
import unittest

from common import BUILD, ROOT

NOTEBOOKS = sorted((ROOT / "python/notebooks").glob("*.ipynb"))


def code_of(notebook):
    """Returns the sources of the cells of code."""
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    return ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]


class Notebooks(unittest.TestCase):
    def test_they_run(self):
        self.assertEqual(len(NOTEBOOKS), 3)
        try:
            import matplotlib
        except ImportError:
            self.skipTest("python3-matplotlib is not installed")
        matplotlib.use("Agg")
        for notebook in NOTEBOOKS:
            with self.subTest(notebook=notebook.name), tempfile.TemporaryDirectory() as folder:
                if notebook.stem == "accuracy" and not (BUILD / "experiments/stability_limit").exists():
                    continue
                names = {"__name__": "notebook"}
                quiet = contextlib.redirect_stderr(io.StringIO())
                with contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()), quiet:
                    for cell in code_of(notebook):
                        exec(compile(cell, notebook.name, "exec"), names)  # noqa: S102

    def test_they_store_no_outputs(self):
        for notebook in NOTEBOOKS:
            cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
            self.assertFalse(any(cell.get("outputs") for cell in cells), notebook.name)


if __name__ == "__main__":
    os.environ.setdefault("MPLBACKEND", "Agg")
    unittest.main()
