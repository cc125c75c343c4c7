"""Tables of results/ as DataFrames, with their manifests and the texts that pages quote."""
import csv
import io
import json
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd

REPORT = Path(__file__).resolve().parents[1]
REPOSITORY = REPORT.parents[1]


class InputError(Exception):
    """One line: what is wrong and what to do."""


def _column(cells):
    """Returns numbers if all cells are numbers or empty (nan), else texts."""
    if not any(cells) or any("_" in cell for cell in cells):
        return cells
    try:
        column = np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        return cells
    whole = np.isfinite(column).all() and (column == np.floor(column)).all() and (np.abs(column) < 2**53).all()
    return column.astype(int) if whole else column


def read_text(path, shown):
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise InputError(f"{shown} is missing; restore it or make it with ./tress run") from None
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{shown} cannot be read ({error}); write it again or remove it") from None


def read_table(path, shown):
    """Returns the rows of a CSV file as a DataFrame. `shown` is its name in messages."""
    lines = csv.reader(io.StringIO(read_text(path, shown)), strict=True)
    remedy = "run the experiment again or remove the file"
    try:
        names = [name.strip() for name in next(lines, [])]
        if not names:
            raise InputError(f"{shown}:1: empty, expected a header row; {remedy}")
        rows = []
        for row in lines:
            if row and len(row) != len(names):
                raise InputError(f"{shown}:{lines.line_num}: {len(row)} fields where the header has {len(names)}; {remedy}")
            if row:
                rows.append(row)
    except csv.Error as error:
        raise InputError(f"{shown}:{lines.line_num}: {error}; {remedy}") from None
    twice = [name for k, name in enumerate(names) if name in names[:k]]
    if twice:
        raise InputError(f"{shown}:1: column '{twice[0]}' appears twice; {remedy}")
    columns = zip(*rows) if rows else ([] for _ in names)
    return pd.DataFrame({name: _column(list(cells)) for name, cells in zip(names, columns)})


def _fits(column, value):
    if isinstance(value, list):
        return np.logical_or.reduce([_fits(column, one) for one in value])
    if isinstance(value, str) or not pd.api.types.is_numeric_dtype(column):
        return column == value
    return (column - value).abs() <= 1e-6 * abs(value)


class Tables:
    """The tables of a repository by name: `Tables(".")["family"]` is a DataFrame.

    `read`  names of the tables that were read so far
    """

    def __init__(self, root=REPOSITORY):
        self.root = Path(root)
        self.read = set()
        self._frames = {}
        self._made = {}

    def __contains__(self, name):
        return (self.root / f"results/{name}.csv").exists()

    def __getitem__(self, name):
        shown = f"results/{name}.csv"
        if name not in self._frames:
            self._frames[name] = read_table(self.root / shown, shown)
        self.read.add(name)
        return self._frames[name]

    def rows(self, name, wanted):
        """Returns the rows whose columns have these values; a list: one of them."""
        frame = self[name]
        chosen = np.ones(len(frame), dtype=bool)
        for column, value in wanted.items():
            chosen &= _fits(frame[column], value)
        return frame[chosen]

    def ok_rows(self, name, wanted):
        return self.rows(name, {**wanted, "status": "ok"})

    def row(self, name, wanted):
        """Returns the one row with these values. More or none are an error of the query or the table."""
        found = self.rows(name, wanted)
        if len(found) != 1:
            raise InputError(f"results/{name}.csv has {len(found)} rows with {json.dumps(wanted)}, expected one")
        return found.iloc[0]

    def text(self, path):
        """Returns the text of a file of the repository."""
        return read_text(self.root / path, path)

    def once(self, make):
        """Returns make(root), which is called once for these tables."""
        if make not in self._made:
            self._made[make] = make(self.root)
        return self._made[make]

    @cached_property
    def manifests(self):
        """Manifests by the name of their table, in alphabetical order."""
        ending = ".meta.json"
        names = sorted(path.name for path in (self.root / "results").glob("*" + ending))
        return {name.removesuffix(ending): self._manifest(f"results/{name}") for name in names}

    def manifest(self, name):
        if name not in self.manifests:
            raise InputError(f"results/{name}.meta.json is missing; run the experiment again")
        return self.manifests[name]

    def check(self, name, key):
        """Returns the check with this key that the program stored with its table: a dict with
        `claim`, `held` and `value`."""
        found = [one for one in self.manifest(name).get("checks", []) if one.get("key") == key]
        if len(found) != 1:
            raise InputError(f"results/{name}.meta.json has {len(found)} checks with the key '{key}', expected one; "
                             "run the experiment again")
        if found[0]["state"] == "not_judged":
            raise InputError(f"results/{name}.meta.json: the check '{key}' was not judged; run the whole experiment again")
        self.read.add(name)
        return found[0]

    def count(self, name, key):
        """Returns the value of such a check, which counts something."""
        return int(self.check(name, key)["value"])

    def _manifest(self, path):
        try:
            return json.loads(self.text(path))
        except ValueError as error:
            raise InputError(f"{path} is no JSON ({error}); run the experiment again") from None


def records(frame):
    """Returns the rows as dictionaries."""
    return frame.to_dict("records")


def known(column):
    """Selects the rows whose column has a number."""
    return pd.Series(np.isfinite(pd.to_numeric(column, errors="coerce")), column.index)


def positive(column):
    """Selects the rows whose column has a number above zero."""
    return known(column) & (pd.to_numeric(column, errors="coerce") > 0)


def first(frame):
    """Returns the first row; None: there is none."""
    return None if frame.empty else frame.iloc[0]


def least(frame, column):
    """Returns the first row with the least value; None: no row has a value."""
    values = pd.to_numeric(frame[column], errors="coerce").dropna()
    return None if values.empty else frame.loc[values.idxmin()]


def groups(frame, columns):
    """Returns (key, rows) in the order in which keys appear."""
    return frame.groupby(columns, sort=False, dropna=False)
