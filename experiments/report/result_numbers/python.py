"""Public names of the Python module, from its sources: signatures and docstrings."""
import ast
import re

from .tables import InputError
from .words import markdown, table

_FOLDER = "python/tress"

# What the compiled part provides has no docstring there.
_COMPILED = {
    "load_plugin": "load_plugin(file): loads the models, integrators and effects of a plug-in; call it first",
    "scene_defaults": "scene_defaults(): a short scene to start from, as text",
    "scene_schema": "scene_schema(): the page scenes/README.md, as text",
    "version_text": "version_text(): version, commit, compiler flags and vector instructions of this build",
}


def _signature(node, source):
    """Returns the signature as the source has it, on one line and without self."""
    head = source.split("\n")[node.lineno - 1:node.body[0].lineno]
    end = next(k for k, line in enumerate(head) if line.rstrip().endswith(":"))
    text = " ".join(line.strip() for line in head[:end + 1])
    text = re.sub(r"^(class|def) |:$", "", text)
    return re.sub(r",? \)( -> .*)?$", r")\1", re.sub(r"\((self|cls)(, )?", "(", text.replace("( ", "(", 1)))


def names_of(source):
    """Returns public classes, functions and methods: [{name, signature, text, owner}], methods after their
    class."""
    found = []

    def add(node, owner):
        if node.name.startswith("_"):
            return
        is_name = isinstance(node, ast.ClassDef) or any(ast.unparse(one) == "property" for one in node.decorator_list)
        found.append({"name": node.name, "signature": node.name if is_name else _signature(node, source),
                      "text": ast.get_docstring(node) or "", "owner": owner})

    for node in ast.parse(source).body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            add(node, None)
        if isinstance(node, ast.ClassDef):
            for method in node.body:
                if isinstance(method, ast.FunctionDef):
                    add(method, node.name)
    return found


def _public_names(tables):
    names = re.search(r"__all__ = \[([^\]]*)\]", tables.text(f"{_FOLDER}/__init__.py"))[1]
    return re.findall(r'"(\w+)"', names)


def _one_line(text):
    return re.sub(r"\s+", " ", text).replace("``", "`")


def example(tables, name):
    """Returns a script of python/examples as a block of code."""
    return f"```python\n{tables.text(f'python/examples/{name}.py').strip()}\n```"


def api(tables):
    """Returns a section for each name of __all__: its docstring, and a table of the methods of a class."""
    files = sorted(path.name for path in (tables.root / _FOLDER).glob("*.py"))
    found = [one for file in files for one in names_of(tables.text(f"{_FOLDER}/{file}"))]
    sections = []
    for name in _public_names(tables):
        own = next((one for one in found if one["name"] == name and one["owner"] is None), None)
        text = own["text"] if own else _COMPILED.get(name)
        if text is None:
            raise InputError(f"{_FOLDER}: nothing defines {name}; remove it from __all__ or define it")
        if not text:
            raise InputError(f"{_FOLDER}: {name} has no docstring; write one")
        methods = [[f"`{one['signature']}`", _one_line(one["text"])] for one in found if one["owner"] == name]
        sections.append("\n\n".join([f"## `{own['signature'] if own else name}`", f"```text\n{text}\n```",
                                     *([markdown(table(["", ""], methods))] if methods else [])]))
    return "\n\n".join(sections)
