"""Names of the stable surfaces (docs/about/stability.md).

    surface.py           exit code 3 if a name of docs/about/api.txt is no longer there
    surface.py --write   writes docs/about/api.txt, at a release

Names come from pages that tests compare with the sources, and from headers."""

import ast
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RECORD = ROOT / "docs/about/api.txt"
HEADERS = ("contract/*.h", "contract/forms/*.h", "integrators/entry.h", "integrators/catalogue.h",
           "models/entry.h", "models/catalogue.h", "models/effects/catalogue.h",
           "simulation/plugin/plugin.h", "simulation/run/world.h", "simulation/scene/scene.h")  # fmt: skip


def text(name):
    return (ROOT / name).read_text(encoding="utf-8")


def scene_keys():
    """Yields the keys of scenes with their table, and the ids."""
    table, inner = "", ""
    for line in text("scenes/README.md").splitlines():
        if found := re.match(r"## (.*)", line):
            table, inner = found[1].strip(), ""
        elif found := re.match(r'### id = "(\w+)"', line):
            inner = found[1]
            yield f"scene {table} id {inner}"
        elif found := re.match(r"\| `(\w+)` \|", line):
            yield " ".join(f"scene {table} {inner} {found[1]}".split())


def columns():
    """Yields the columns of tables."""
    table = ""
    for line in text("docs/tables.md").splitlines():
        if found := re.match(r"## (.*)|.*\(`(results/[^`]*)`\)", line):
            table = (found[1] or found[2]).strip("`")
        elif found := re.match(r"\| `([^`]+)` \|", line):
            for name in found[1].split(", "):
                yield f"column {table} {name}"


def python_names():
    """Yields the names of tress.__all__, and the public members of its classes."""
    folder = ROOT / "python/tress"
    public = set(re.findall(r'^    "(\w+)",$', text("python/tress/__init__.py"), re.MULTILINE))
    for name in public:
        yield f"python {name}"
    for file in [*folder.glob("*.py")]:
        for node in ast.parse(file.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef) and node.name in public:
                for member in node.body:
                    name = getattr(member, "name", getattr(getattr(member, "target", None), "id", "_"))
                    if not name.startswith("_"):
                        yield f"python {node.name}.{name}"
            if isinstance(node, ast.FunctionDef) and node.name in public:
                for argument in (*node.args.args, *node.args.kwonlyargs):
                    yield f"python {node.name}({argument.arg})"


def commands():
    """Yields the commands and their options."""
    sys.path.insert(0, str(ROOT / "python"))
    from tress_command.commands import COMMANDS

    for command in COMMANDS:
        yield f"command {command.name}"
        for option in re.findall(r"--[a-z-]+", command.usage):
            yield f"command {command.name} {option}"


def cpp_names():
    """Yields types and free functions of the documented headers, and these headers."""
    for pattern in HEADERS:
        for file in ROOT.glob(pattern):
            name = file.relative_to(ROOT).as_posix()
            yield f"c++ {name}"
            source = file.read_text(encoding="utf-8")
            for found in re.findall(r"^(?:class|struct|enum class) (\w+)[ :{]", source, re.MULTILINE):
                yield f"c++ {name} {found}"
            for found in re.findall(r"^(?!return|using|#|//)[\w:<>,&* ]+[ &*](\w+)\(", source, re.MULTILINE):
                yield f"c++ {name} {found}()"


def surface():
    """Returns all names, sorted."""
    return sorted({*scene_keys(), *columns(), *python_names(), *commands(), *cpp_names()})


def main():
    present = surface()
    if sys.argv[1:] == ["--write"]:
        RECORD.write_text("\n".join(present) + "\n", encoding="utf-8")
        return 0
    recorded = RECORD.read_text(encoding="utf-8").splitlines()
    gone = sorted(set(recorded) - set(present))
    for name in gone:
        print(f"{name}: has disappeared since the last release; keep it until the next major version "
              "(docs/about/stability.md)", file=sys.stderr)  # fmt: skip
    kinds = {name.split()[0] for name in recorded}
    if kinds != {"scene", "column", "python", "command", "c++"}:
        print(f"docs/about/api.txt has names of {kinds} only", file=sys.stderr)
        return 3
    print(f"{len(recorded)} names of the last release, {len(set(present) - set(recorded))} new ones")
    return 3 if gone else 0


if __name__ == "__main__":
    sys.exit(main())
