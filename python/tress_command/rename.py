"""./tress rename: converts names of earlier versions, which contract/renamed.h lists."""

import csv
import io
import json
import os
import re
from pathlib import Path

from .command import Command
from .messages import refuse
from .place import shipped

# Former values belong to these keys only: `stiff` may be a title or the name of a file.
VALUES = {"jacobian": ("stiff", "less_implicit"), "damping": ("seed",), "kind": ("bits",)}
IDS = ("semi_implicit_euler",)
# Words of the list that scenes and tables also use for other things.
AMBIGUOUS = ("root", "head", "seed", "stiff", "gravity", "state", "lost", "lanes", "bits")


def _names():
    """Returns former names with their present ones."""
    file = Path(shipped("contract/renamed.h"))
    text = file.read_text(encoding="utf-8") if file.is_file() else ""
    return dict(re.findall(r'^ +\{"([^"]+)", "([^"]+)"\},', text, re.MULTILINE))


def present_name(word):
    """Returns the present name of what was called `word`, or ''."""
    return _names().get(word, "")


def _value(key, value, names):
    former = value in IDS or value in VALUES.get(key, ())
    return names[value] if former else value


def _scene(text, names):
    lines, table = [], ""
    for line in text.split("\n"):
        heading = re.match(r"\s*\[+\s*([^\]\s]+)\s*\]+", line)
        if heading:
            table = heading[1]
        entry = re.match(r"(\s*)([A-Za-z0-9_]+)(\s*=\s*)(.*)$", line)
        if entry and not heading:
            indent, key, equals, rest = entry.groups()
            word = re.match(r"(['\"])([A-Za-z0-9_]+)\1", rest)
            new = names.get(key, key)
            if key == "tangent":
                new = "jacobian" if table.startswith("model") else "root_tangent"
            elif key == "tolerance":
                new = "position_tol_rel" if table == "integrator" else key
            elif key in AMBIGUOUS:
                new = key
            if word:
                value = _value(new, word[2], names)
                rest = word[1] + value + word[1] + rest[word.end():]
            line = indent + new + equals + rest
        lines.append(line)
    return "\n".join(lines)


def _columns(path, header, names):
    known = {old: new for old, new in names.items() if old not in AMBIGUOUS}
    known["tangent"] = "jacobian"
    validation = path.name.startswith("validation")
    known["tolerance"] = "accepted_error_rel" if validation else "position_tol_rel"
    if path.name.startswith(("heads", "divided_heads", "head_accuracy")):
        known |= {word: names[word] for word in ("bits", "lanes", "lost", "state")}
    return [known.get(column, column) for column in header]


def _table(path, text, names):
    rows = list(csv.reader(io.StringIO(text)))
    if not rows:
        return text
    header = _columns(path, rows[0], names)
    for row in rows[1:]:
        for k, column in enumerate(header[: len(row)]):
            row[k] = _value(column, row[k], names)
            if column == "variant":
                row[k] = re.sub(
                    r"\btangent=(\w+)",
                    lambda m: "jacobian=" + _value("jacobian", m[1], names),
                    row[k],
                )
    if header == rows[0] and rows == list(csv.reader(io.StringIO(text))):
        return text
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows([header, *rows[1:]])
    return out.getvalue()


def _manifest(path, text, names):
    try:
        manifest = json.loads(text)
    except json.JSONDecodeError as error:
        refuse(f"rename: {path}:{error.lineno}: is not JSON: {error.msg}")
    columns = manifest.get("columns")
    if not isinstance(columns, dict):
        return text
    new = dict(zip(_columns(path, list(columns), names), columns.values()))
    if new == columns:
        return text
    manifest["columns"] = new
    return json.dumps(manifest, indent=2) + "\n"


def _renamed(path, names):
    """The file's text with present names, and as it is."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        refuse(f"rename: {path}: cannot be read: {error}")
    if path.suffix == ".toml":
        return _scene(text, names), text
    if path.suffix == ".csv":
        return _table(path, text, names), text
    if path.name.endswith(".meta.json"):
        return _manifest(path, text, names), text
    refuse(f"rename: {path}: is neither a scene (.toml), a table (.csv) nor a .meta.json")


def _run(words, _):
    if not words:
        refuse("rename: give scenes, tables or manifests; ./tress rename --help has an example")
    names = _names()
    for path, new, old in [(Path(word), *_renamed(Path(word), names)) for word in words]:
        if new == old:
            print(f"{path}: no former names")
            continue
        beside = path.with_name(path.name + ".new")
        beside.write_text(new, encoding="utf-8")
        os.replace(beside, path)
        changed = sum(a != b for a, b in zip(new.split("\n"), old.split("\n")))
        print(f"{path}: {changed} lines with present names")


COMMAND = Command(
    "rename", "FILE...",
    "converts scenes (.toml), tables (.csv) and manifests (.meta.json) with names of earlier "
    "versions to the present ones, which contract/renamed.h lists. Reads all files before it writes one.",
    _run,
    example="./tress rename my_scene.toml",
    time="less than a second.")
