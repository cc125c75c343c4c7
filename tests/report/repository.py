"""A repository of a test's own tables, shared by the tests of the pages and of their numbers."""
import csv
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
REPORT = ROOT / "experiments/report"
sys.path.insert(0, str(REPORT))
from prose.pages import Study  # noqa: E402
from result_numbers.tables import Tables  # noqa: E402
from result_numbers.words import markdown  # noqa: E402


class Made(unittest.TestCase):
    """A repository of a test's own tables, with the columns of those in results/."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text)

    def say(self, query, *words, **tables):
        """What `study.query` says of these tables: lists of rows, whose other columns are empty."""
        for name, rows in tables.items():
            with (ROOT / f"results/{name}.csv").open(newline="") as shipped:
                header = next(csv.reader(shipped))
            header += sorted({column for row in rows for column in row} - set(header))
            path = self.root / f"results/{name}.csv"
            path.parent.mkdir(exist_ok=True)
            with path.open("w", newline="") as out:
                lines = csv.DictWriter(out, header, lineterminator="\n")
                lines.writeheader()
                lines.writerows(rows)
        study, name = query.split(".")
        answer = getattr(Study(study, Tables(self.root)), name)(*words)
        return answer if isinstance(answer, str) else markdown(answer)
