"""Files of results. Every refusal is one line: file, problem, remedy."""

import csv
import io
import json
import re

from .messages import Ended, refuse

MEBIBYTE = 2**20
LIMIT = 256 * MEBIBYTE
REMEDY = "run the experiment again or remove the file"
csv.field_size_limit(LIMIT)


def read_text(path, limit=LIMIT):
    """Returns the text of a regular UTF-8 file of bounded size, without a byte order mark."""
    try:
        if not path.is_file():
            kind = "a folder" if path.is_dir() else "not a regular file"
            if path.exists():
                refuse(f"{path}: {kind}; rename or remove it")
        if (size := path.stat().st_size) > limit:
            refuse(f"{path}: {-(-size // MEBIBYTE)} MiB, more than the {limit // MEBIBYTE} MiB "
                   "that are read; write fewer rows")
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        refuse(f"{path}: cannot be read ({error.strerror}); mend or remove it")
    except UnicodeDecodeError:
        text = "\0"
    if "\0" in text:
        refuse(f"{path}: not UTF-8 text; write it again or remove it")
    return text


def read_json(path, limit=LIMIT):
    """Returns the values of a JSON file."""
    try:
        return json.loads(read_text(path, limit))
    except ValueError as error:
        refuse(f"{path}: not valid JSON ({error}); write it again or remove it")


SPECIAL = {"nan": "nan", "-nan": "nan", "inf": "inf", "+inf": "inf", "-inf": "-inf"}
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


def is_number(text):
    """True for a cell of a numeric column: a number, a special value or nothing."""
    text = text.strip()
    return text == "" or text.lower() in SPECIAL or NUMBER.fullmatch(text) is not None


def number_of(text):
    """Returns a finite number, None for an empty cell, or "nan", "inf", "-inf"."""
    text = text.strip()
    if text == "" or text.lower() in SPECIAL:
        return SPECIAL.get(text.lower())
    value = float(text)
    if value in (float("inf"), -float("inf")):
        return "inf" if value > 0 else "-inf"
    return value


def _records(path):
    """Yields line and cells of every record of a CSV file; blank lines are left out."""
    lines = csv.reader(io.StringIO(read_text(path)), strict=True)
    line = 1
    try:
        for cells in lines:
            if cells:
                yield line, cells
            line = lines.line_num + 1
    except csv.Error as error:
        why = "a quote is opened and never closed" if "unexpected end" in str(error) else error
        raise Ended(2, f"{path}:{line}: {why}; {REMEDY}") from error


def read_csv(path):
    """Returns the names of the columns, and the rows as dictionaries. A column is numeric if
    all its cells are numbers or empty, and one is a number. run_id is text, for a checksum may
    have no letter."""
    records = list(_records(path))
    if not records:
        refuse(f"{path}:1: empty, expected a header row; {REMEDY}")
    (_, header), *body = records
    names = [name.strip() for name in header]
    for name in names:
        if names.count(name) > 1:
            refuse(f"{path}:1: column '{name}' appears twice; {REMEDY}")
    for line, cells in body:
        if len(cells) != len(names):
            refuse(f"{path}:{line}: {len(cells)} fields where the header has {len(names)}; "
                   f"{REMEDY}")
    columns = []
    for name, column in zip(names, zip(*(cells for _, cells in body))):
        numeric = (name != "run_id" and all(map(is_number, column))
                   and any(cell.strip() for cell in column))
        columns.append([number_of(cell) if numeric else cell for cell in column])
    return names, [dict(zip(names, cells)) for cells in zip(*columns)]
