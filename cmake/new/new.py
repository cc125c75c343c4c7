#!/usr/bin/env python3
"""./tress new model|effect|integrator|study NAME: one source from the skeleton beside this
file, its lines in the catalogue and in CMakeLists.txt; all of it or nothing."""
import os
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
LONGEST = 32  # characters of a name: it is a key in scenes and a column in tables
TAKEN_WORDS = set(
    "alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t"
    " char32_t class compl concept const consteval constexpr constinit const_cast continue"
    " co_await co_return co_yield decltype default delete do double dynamic_cast else enum explicit"
    " export extern false float for friend goto if inline int long mutable namespace new noexcept"
    " not not_eq nullptr operator or or_eq private protected public register reinterpret_cast"
    " requires return short signed sizeof static static_assert static_cast struct switch template"
    " this thread_local throw true try typedef typeid typename union unsigned using virtual void"
    " volatile wchar_t while xor xor_eq"
    " all clean help install test experiments benchmarks tidy skeleton_name".split())


class Refused(Exception):
    """What is wrong (where): what to do."""


def refuse(problem, where, remedy):
    raise Refused(f"{problem} ({where}): {remedy}")


def after_last(text, pattern, line, path):
    """`text` with `line` after the last line that `pattern` matches."""
    found = list(re.finditer(pattern, text, re.M))
    if not found:
        refuse("no place for a new line", path,
               f"restore the line that matches '{pattern}': git diff {path} shows changes")
    end = found[-1].end()
    return text[:end] + "\n" + line + text[end:]


def with_method(text, name, path):
    """The list of methods as clang-format aligns it, with one more at its end."""
    lines = re.findall(r"^  METHOD\(\w+\)", text, re.M)
    start, end = text.find("#define TRESS_METHODS(METHOD)"), text.find("\n\n")
    while start >= 0 and end < start:
        end = text.find("\n\n", end + 1)
    if start < 0 or not lines:
        refuse("no list of methods", path, f"restore it: git diff {path} shows changes")
    lines = ["#define TRESS_METHODS(METHOD)", *lines, f"  METHOD({name})"]
    width = max(map(len, lines[:-1]))
    listing = " \\\n".join([*(line.ljust(width) for line in lines[:-1]), lines[-1]])
    return text[:start] + listing + text[end:]


def in_cmake(line):
    """Sources that are compiled each by itself end the list of a library."""
    return lambda text, path: after_last(text, r"^  ALONE\b.*(\n  \S+\.cpp)*", line, path)


def entry(kind, name, pattern):
    """Declaration and line of an entry that ends a model's or an effect's file."""

    def change(text, path):
        text = after_last(text, pattern, f"{kind}Entry {name}_entry();", path)
        # The list is the only one that ends so.
        end = text.find("\n  };\n}\n// clang-format on")
        if end < 0:
            refuse("no list of entries", path, f"restore it: git diff {path} shows changes")
        return text[:end] + f"\n      {name}_entry()," + text[end:]

    return change


def plan(kind, name):
    """The new file, changes of others, what to build and what to run."""
    tests = "build/release/tests"
    if kind == "model":
        return (f"models/elements/{name}.cpp",
                {"models/catalogue.cpp": entry("Model", name, r"^ModelEntry \w+_entry\(\);"),
                 "models/CMakeLists.txt": in_cmake(f"  elements/{name}.cpp")},
                "test_contracts", f"{tests}/test_contracts --gtest_filter='*/{name}*'")
    if kind == "effect":
        return (f"models/effects/{name}.cpp",
                {"models/effects/catalogue.cpp":
                     entry("Effect", name, r"^// Each is defined .*$|^EffectEntry \w+_entry\(\);"),
                 "models/CMakeLists.txt": in_cmake(f"  effects/{name}.cpp")},
                "test_effects", f"{tests}/test_effects --gtest_filter='*{name}*'")
    if kind == "integrator":
        return (f"integrators/{name}.cpp",
                {"integrators/catalogue.cpp": lambda text, path: with_method(text, name, path),
                 "integrators/CMakeLists.txt": in_cmake(f"  {name}.cpp")},
                "test_integrators", f"{tests}/test_integrators --gtest_filter='*{name}*'")
    return (f"experiments/{name}/main.cpp",
            {"experiments/CMakeLists.txt": lambda text, path: after_last(
                text, r"^tress_study\(damping\)(\ntress_study\(\w+\))*", f"tress_study({name})",
                path)},
            name, f"build/release/experiments/{name} --quick --out {name}.csv")


def names_in_use():
    """Name -> file, of everything that a program or a scene calls by name."""
    used = {}
    for path, patterns in {
            "models/catalogue.cpp": [r"^ModelEntry (\w+)_entry\(\);", r'ModelEntry\{"(\w+)"'],
            "models/effects/catalogue.cpp":
                [r"^EffectEntry (\w+)_entry\(\);", r'EffectEntry\{"(\w+)"'],
            "integrators/catalogue.cpp": [r"METHOD\((\w+)\)"],
            "experiments/CMakeLists.txt":
                [r"^\w*tress_study\((\w+)", r"^add_(?:library|executable)\((?:tress_)?(\w+)"],
            "tests/CMakeLists.txt": [r"^add_(?:library|executable)\((?:tress_)?(\w+)"],
    }.items():
        for pattern in patterns:
            for name in re.findall(pattern, read(path), re.M):
                used.setdefault(name, path)
    return used


def read(path):
    try:
        return (ROOT / path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        refuse("cannot be read", path, f"git checkout -- {path}: {reason(error)}")


def reason(error):
    return getattr(error, "strerror", None) or str(error)


def write(texts):
    """All files of `texts`, or none: first beside their places, then into them."""
    before = {path: (ROOT / path).read_bytes() for path in texts if (ROOT / path).exists()}
    folders, beside, done, path = [], [], [], ""
    try:
        for path, text in texts.items():
            folder = (ROOT / path).parent
            if not folder.exists():
                folder.mkdir()
                folders.append(folder)
            beside.append(folder / f".{Path(path).name}.new")
            beside[-1].write_text(text, encoding="utf-8")
            if path in before:
                os.chmod(beside[-1], (ROOT / path).stat().st_mode)
        for path, new in zip(texts, beside):
            os.replace(new, ROOT / path)
            done.append(path)
    except OSError as error:
        for old in done:
            if old in before:
                (ROOT / old).write_bytes(before[old])
            else:
                (ROOT / old).unlink()
        for new in beside:
            if new.is_file():
                new.unlink()
        for folder in folders:
            folder.rmdir()
        refuse("cannot be written, and nothing was", path,
               f"make it and its folder writable: {reason(error)}")


def new(kind, name):
    if kind not in ("model", "effect", "integrator", "study"):
        refuse(f"unknown kind '{kind}'", "new",
               "use ./tress new model|effect|integrator|study NAME")
    if not re.fullmatch(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", name, re.A) or len(name) > LONGEST:
        refuse(f"'{name}' is no name", f"new {kind}",
               f"use lower case letters, digits and single '_', as in my_{kind}; at most"
               f" {LONGEST} characters, the first a letter")
    if name.startswith(("test_", "bench_")):
        refuse(f"'{name}' begins as the name of a test or a benchmark", f"new {kind}",
               "use a name without test_ and bench_")
    if name in TAKEN_WORDS:
        refuse(f"'{name}' is a word of C++ or of the build", f"new {kind}",
               f"use another name, such as {name}_{kind}")
    source, changes, target, check = plan(kind, name)
    used = names_in_use()
    if name in used:
        refuse(f"the name '{name}' is taken", used[name],
               "use another name; ./tress list shows those in use")
    place = Path(source).parent if kind == "study" else Path(source)
    if (ROOT / place).exists():
        refuse("it exists already", place, "use another name, or remove it")
    skeleton = read(HERE.relative_to(ROOT) / f"{kind}.cpp")
    texts = {source: skeleton.replace("skeleton_name", name)}
    for path, change in changes.items():
        texts[path] = change(read(path), path)
    write(texts)
    print(f"wrote {source}: write what its lines FILL IN ask for")
    for path in changes:
        print(f"changed {path}")
    print("build and test it; the test fails until nothing is left to fill in:")
    print(f"  cmake --build build/release --target {target}")
    print(f"  {check}")


def main(arguments):
    try:
        if len(arguments) != 2:
            refuse("give a kind and a name", "new",
                   "use ./tress new model|effect|integrator|study NAME")
        new(*arguments)
    except Refused as refused:
        line = "".join(c if c.isprintable() else "?" for c in str(refused))
        print(f"tress: {line}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
