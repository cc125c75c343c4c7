"""TOML text of a scene's tables."""

from collections.abc import Mapping
from typing import Any

from .errors import InputError


def _key(key: str) -> str:
    plain = key.replace("_", "").replace("-", "")
    return key if plain.isalnum() and key.isascii() else _string(key)


def _string(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c >= " " else f"\\u{ord(c):04x}" for c in escaped) + '"'


def _value(value: Any, place: str) -> str:
    if hasattr(value, "tolist"):  # numpy's numbers and arrays
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)  # the shortest text that reads back exactly; inf, nan as TOML's
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(x, place) for x in value) + "]"
    raise InputError(
        f"a {type(value).__name__} is no value of a scene ({place}): "
        "give a number, a text, true, false, or a list of them"
    )


def _is_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and value and isinstance(value[0], dict)


def text_of(tables: Mapping[str, Any], path: tuple[str, ...] = ()) -> str:
    """TOML text of nested dicts: a dict is a table, a list of dicts is [[tables]]."""
    lines, nested = [], []
    for key, value in tables.items():
        here = (*path, str(key))
        if isinstance(value, dict):
            nested.append(f"[{'.'.join(map(_key, here))}]\n" + text_of(value, here))
        elif _is_tables(value):
            title = f"[[{'.'.join(map(_key, here))}]]\n"
            nested += [title + text_of(one, here) for one in value]
        else:
            lines.append(f"{_key(str(key))} = {_value(value, '.'.join(here))}\n")
    return "".join(lines) + "".join("\n" + part for part in nested)
