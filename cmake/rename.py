"""Rename what scenes and tables call by a former name: rename.py FILE...

Reads the names from contract/renamed.h. A scene (.toml) is changed where a key, an id or a
value is a former name; a table (.csv) in its header and in the values of renamed options; a
manifest (.meta.json) in its column names. Files without former names stay as they are.
Writes each file at once and prints what changed. Exit codes: 0 done, 2 usage or input."""

import csv
import io
import json
import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Former values belong to these keys only: `stiff` may be a title or the name of a file.
VALUES = {
    "jacobian": {"stiff": "elastic", "less_implicit": "elastic_local"},
    "damping": {"seed": "published"},
    "kind": {"bits": "precision"},
}
# Words of the list that scenes and tables also use for other things.
AMBIGUOUS = ("root", "head", "seed", "stiff", "gravity", "state", "lost", "lanes", "bits")


class Refused(Exception):
    """What is wrong with a file, and where."""


def renames():
    text = (ROOT / "contract" / "renamed.h").read_text(encoding="utf-8")
    return re.findall(r'^    \{"([^"]+)", "([^"]+)"\},', text, re.MULTILINE)


IDS = {"semi_implicit_euler": "linearly_implicit_euler"}


def value_of(key, value):
    return IDS.get(value, VALUES.get(key, {}).get(value, value))


def scene_text(text, names):
    known = dict(names)
    lines, table = [], ""
    for line in text.split("\n"):
        heading = re.match(r"\s*\[+\s*([^\]\s]+)\s*\]+", line)
        if heading:
            table = heading[1]
        entry = re.match(r"(\s*)([A-Za-z0-9_]+)(\s*=\s*)(.*)$", line)
        if entry and not heading:
            indent, key, equals, rest = entry.groups()
            word = re.match(r"(['\"])([A-Za-z0-9_]+)\1", rest)
            new = known.get(key, key)
            if key == "tangent":
                new = "jacobian" if table.startswith("model") else "root_tangent"
            elif key == "tolerance":
                new = "position_tol_rel" if table == "integrator" else key
            elif key in AMBIGUOUS:
                new = key
            if word:
                value = value_of(new, word[2])
                rest = word[1] + value + word[1] + rest[word.end():]
            line = indent + new + equals + rest
        lines.append(line)
    return "\n".join(lines)


def table_columns(path, header, names):
    known = {old: new for old, new in names if old not in AMBIGUOUS}
    known["tangent"] = "jacobian"
    validation = path.name.startswith("validation")
    known["tolerance"] = "accepted_error_rel" if validation else "position_tol_rel"
    if path.name.startswith(("heads", "divided_heads", "head_accuracy")):
        known |= {"bits": "precision", "lanes": "simd_width", "lost": "failed"}
        known["state"] = "state_hash"
    return [known.get(column, column) for column in header]


def table_text(path, text, names):
    rows = list(csv.reader(io.StringIO(text)))
    if not rows:
        return text
    header = table_columns(path, rows[0], names)
    for row in rows[1:]:
        for k, column in enumerate(header[: len(row)]):
            row[k] = value_of(column, row[k])
            if column == "variant":
                row[k] = re.sub(
                    r"\btangent=(\w+)",
                    lambda m: "jacobian=" + value_of("jacobian", m[1]),
                    row[k],
                )
    if header == rows[0] and rows == list(csv.reader(io.StringIO(text))):
        return text
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows([header, *rows[1:]])
    return out.getvalue()


def manifest_text(path, text, names):
    try:
        manifest = json.loads(text)
    except json.JSONDecodeError as error:
        raise Refused(f"{path}:{error.lineno}: is not JSON: {error.msg}") from error
    columns = manifest.get("columns")
    if not isinstance(columns, dict):
        return text
    new = dict(zip(table_columns(path, list(columns), names), columns.values()))
    if new == columns:
        return text
    manifest["columns"] = new
    return json.dumps(manifest, indent=2) + "\n"


def renamed(path, names):
    """The file's text with present names, and as it is."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise Refused(f"{path}: cannot be read: {error}") from error
    if path.suffix == ".toml":
        return scene_text(text, names), text
    if path.suffix == ".csv":
        return table_text(path, text, names), text
    if path.name.endswith(".meta.json"):
        return manifest_text(path, text, names), text
    raise Refused(f"{path}: is neither a scene (.toml), a table (.csv) nor a .meta.json")


def main(arguments):
    if not arguments or arguments[0] in ("-h", "--help"):
        print(__doc__.strip())
        return 0 if arguments else 2
    names = renames()
    try:
        files = [(Path(name), *renamed(Path(name), names)) for name in arguments]
    except Refused as refused:
        print(f"tress: rename: {refused}", file=sys.stderr)
        return 2
    for path, new, old in files:
        if new == old:
            print(f"{path}: no former names")
            continue
        beside = path.with_name(path.name + ".new")
        beside.write_text(new, encoding="utf-8")
        os.replace(beside, path)
        changed = sum(a != b for a, b in zip(new.split("\n"), old.split("\n")))
        print(f"{path}: {changed} lines with present names")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
