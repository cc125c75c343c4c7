"""Tables of experiments: results/*.csv with their manifests, and programs that write them."""

import csv
import json
import os
import re
import signal
import subprocess
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import _core, display
from .errors import InputError, ProgramError

# Ends of column names that are units (results/README.md); docs/tables.md is made from the
# same file.
_UNITS = json.loads((Path(__file__).parent / "units.json").read_text())


def unit_of(column: str) -> str:
    """The unit at the end of a column's name ("dt_s": "s"); "": it has none."""
    words = column.split("_")
    for k in range(1, len(words)):
        if (end := "_".join(words[k:])) in _UNITS:
            return _UNITS[end]
    return ""


class Table(Mapping[str, np.ndarray]):
    """A table by columns: ``table["dt_s"]`` is an array.

    Its type is float64 with nan for empty cells, bool if all cells are true or false, else
    str.

    ``units``     {column: unit}
    ``help``      {column: description}, from the manifest
    ``manifest``  record of how the table was made; {} if there is none
    ``complete``  False if rows failed or a check did not hold
    """

    def __init__(
        self,
        columns: dict[str, np.ndarray],
        manifest: dict[str, Any] | None = None,
        file: str | Path = "",
        complete: bool = True,
    ) -> None:
        self._columns = columns
        self.manifest = manifest or {}
        self.file = str(file)
        self.complete = complete

    def __getitem__(self, column: str) -> np.ndarray:
        try:
            return self._columns[column]
        except KeyError:
            raise KeyError(f"{column}; there are: {', '.join(self._columns)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self._columns.values()), ()))

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column: {column: unit}."""
        return {column: unit_of(column) for column in self._columns}

    @property
    def help(self) -> dict[str, str]:
        """Description of each column: {column: description}."""
        return dict(self.manifest.get("columns", {}))

    def where(self, **values: Any) -> "Table":
        """Returns the rows in which these columns have these values."""
        chosen = np.ones(self.rows, dtype=bool)
        for column, value in values.items():
            chosen &= self[column] == value
        columns = {name: column[chosen] for name, column in self._columns.items()}
        return Table(columns, self.manifest, self.file, self.complete)

    def _repr_html_(self) -> str:
        """What a notebook shows: the first rows."""
        return display.table_html(self._columns, self.rows)

    def pandas(self) -> Any:
        """Returns the table as a pandas.DataFrame (package python3-pandas)."""
        import pandas

        return pandas.DataFrame(self._columns)


def _column(cells: Sequence[str]) -> np.ndarray:
    if all(cell in ("true", "false") for cell in cells) and cells:
        return np.array([cell == "true" for cell in cells])
    if any(re.search(r"[^0-9eEinfa.+-]", cell) for cell in cells):
        return np.array(cells, dtype=str)
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        return np.array(cells, dtype=str)


def read_table(file: str | Path) -> Table:
    """Reads a CSV file and its manifest: Table. Raises InputError if it is not a table."""
    path = Path(file)
    try:
        with path.open(newline="") as lines:
            header, *rows = csv.reader(lines)
    except (OSError, UnicodeDecodeError, ValueError, csv.Error) as error:
        raise InputError(f"cannot be read as a table ({file}): {error}") from error
    for number, row in enumerate(rows, 2):
        if len(row) != len(header):
            raise InputError(
                f"{len(row)} cells instead of {len(header)} ({file}:{number}): "
                "give every row a cell for each column"
            )
    cells = zip(*rows) if rows else ([] for _ in header)
    sidecar = path.with_suffix(".meta.json")
    manifest = json.loads(sidecar.read_text()) if sidecar.exists() else {}
    return Table({name: _column(c) for name, c in zip(header, cells)}, manifest, path)


def programs_folder() -> Path:
    """Returns the folder with the programs of the experiments.

    It belongs to the build that the environment variable TRESS_BUILD names, else to the build
    of this module or the packages of Debian, else to the clone that holds the working folder."""
    if "TRESS_BUILD" not in os.environ:
        for prefix in Path(_core.__file__).resolve().parents:
            if (prefix / "libexec/tress/list.txt").exists():
                return prefix / "libexec/tress"
    folders = [Path(_core.__file__).resolve().parents[2]]
    if "TRESS_BUILD" in os.environ:
        folders = [Path(os.environ["TRESS_BUILD"])]
    here = Path.cwd()
    folders += [folder / "build" / "release" for folder in (here, *here.parents)]
    for folder in folders:
        if (folder / "experiments" / "list.txt").exists():
            return folder / "experiments"
    raise InputError(
        "the experiments are not built (TRESS_BUILD): run ./tress list in a clone, and set "
        "TRESS_BUILD to its build/release, or work in that clone"
    )


def experiment(name: str, *words: Any, out: str | Path | None = None) -> Table:
    """Runs an experiment's program with these arguments and reads its table.

    Example: ``experiment("stability_limit", "--quick", "--models", "der")``.

    out: the CSV file to keep; by default a temporary one. Raises InputError with the message
    of the program on bad input, and ProgramError if the program fails. If rows failed or a
    check did not hold, ``complete`` of the table is False. Ctrl-C ends the program.
    """
    folder = programs_folder()
    there = (folder / "list.txt").read_text().split()
    if name not in there or not (folder / name).exists():
        raise InputError(f"no experiment '{name}' (experiment): there are {' '.join(there)}")
    with tempfile.TemporaryDirectory(prefix="tress-") as scratch:
        file = Path(out) if out is not None else Path(scratch) / f"{name}.csv"
        command = [str(folder / name), *map(str, words), "--out", str(file)]
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as program:
            try:
                _, said = program.communicate()
            except KeyboardInterrupt:
                program.send_signal(signal.SIGINT)
                program.wait()
                raise
        last = said.strip().splitlines()[-1] if said.strip() else ""
        if program.returncode == 2:
            raise InputError(last.removeprefix(f"{name}: "))
        if program.returncode not in (0, 3):
            error = ProgramError(last or f"{name} ended with {program.returncode}")
            error.code = program.returncode
            raise error
        table = read_table(file)
        table.complete = program.returncode == 0
        return table
