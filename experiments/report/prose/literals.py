"""The texts that a source prints: its string literals of more than one word, where what is
computed stands as {{ }}."""
import ast
import re


def _of_several_words(literals):
    return [(line, text) for line, text in literals if re.search(r"\S\s+\S", text.replace("{{ }}", "x"))]


def _docstrings(tree):
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list) and body and isinstance(body[0], ast.Expr):
            yield body[0].value


def of_python(source):
    """[(line, text)] of a Python source; docstrings are not printed."""
    tree = ast.parse(source)
    seen = set(_docstrings(tree))
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            seen.update(node.values)
            text = "".join(part.value if isinstance(part, ast.Constant) else "{{ }}" for part in node.values)
            found.append((node.lineno, text))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node not in seen:
            found.append((node.lineno, node.value))
    return _of_several_words(sorted(found, key=lambda literal: literal[0]))


def _after_regex(source, start):
    in_class, i = False, start + 1
    while source[i] != "/" or in_class:
        if source[i] == "\\":
            i += 1
        elif source[i] in "[]":
            in_class = source[i] == "["
        i += 1
    return i + 1


def _read_code(source, at, end, found):
    """Reads source[at:] up to `end` (a brace that closes a slot), and returns the place after it; every
    literal on the way goes into `found`."""
    i = at
    while i < len(source) and source[i] != end:
        if source.startswith("//", i):
            i = source.find("\n", i) + 1 or len(source)
        elif source.startswith("/*", i):
            i = source.index("*/", i) + 2
        elif source[i] in "'\"`":
            i = _read_literal(source, i, found)
        elif source[i] == "/" and re.search(r"(^|[(,=:[!&|?{};>])\s*$", source[at:i]):
            i = _after_regex(source, i)
        elif source[i] == "{":
            i = _read_code(source, i + 1, "}", found)
        else:
            i += 1
    return i + 1


def _read_literal(source, start, found):
    quote, text, i = source[start], "", start + 1
    while i < len(source) and source[i] != quote:
        if source[i] == "\\":
            text += "`" if source[i + 1] == "`" else " "
            i += 2
        elif quote == "`" and source.startswith("${", i):
            text += "{{ }}"
            i = _read_code(source, i + 2, "}", found)
        else:
            text += source[i]
            i += 1
    found.append((start, text))
    return i + 1


def of_javascript(source):
    """[(line, text)] of a JavaScript source."""
    found = []
    _read_code(source, 0, None, found)
    return _of_several_words((source.count("\n", 0, start) + 1, text) for start, text in sorted(found))
