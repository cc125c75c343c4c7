"""abi.py OLD NEW: compares the interfaces of two builds, each a package tress or its libtress.so:
symbols of tress with abidiff, types too where both have debug information, and the stamps by
which programs accept plug-ins. Exit code 3 if a symbol was removed or a type changed, 0 if
symbols were only added or nothing changed."""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

ERROR = 1  # a bit of the exit code of abidiff
OF_TRESS = re.compile(r"_Z(G[RV]|T[VTISW])?Z?N?[KVR]*5tress")


def refuse(text):
    """Ends the program because of what its user gave it."""
    print(f"abi: {text}", file=sys.stderr)
    sys.exit(2)


def library(build, folder):
    """Returns the shared library of a build, unpacked in a folder if it is a package."""
    if not Path(build).is_file():
        refuse(f"no file '{build}'; give a package tress or its libtress.so")
    if not build.endswith(".deb"):
        return Path(build)
    subprocess.run(["dpkg-deb", "-x", build, folder], check=True)
    found = [one for one in Path(folder).rglob("libtress.so.*") if not one.is_symlink()]
    return found[0] if found else refuse(f"{build} has no libtress.so; give a package tress")


def stamp(file):
    """Returns the fields of the stamp that plug-ins must have."""
    found = re.search(rb"tress plug-in\|([ -~]+)", file.read_bytes())
    if not found:
        refuse(f"{file} has no stamp of plug-ins; give a package tress or its libtress.so")
    return dict(field.split("=", 1) for field in found[1].decode().rstrip("|").split("|"))


def compare_stamps(old, new):
    """Prints whether plug-ins of the old build run with the new one, and the fields that differ."""
    different = [f"{name}: {old.get(name, 'none')} before, {new.get(name, 'none')} now"
                 for name in {**old, **new} if old.get(name) != new.get(name)]  # fmt: skip
    print("plug-ins: those of OLD run with NEW" if not different else
          "plug-ins: those of OLD are refused by NEW and must be compiled again")  # fmt: skip
    for line in different:
        print(f"  {line}")


def strong(file):
    """Returns the symbols of tress that the library alone defines. Weak ones are inline functions
    and instances of templates, of which each program has its own."""
    done = subprocess.run(["nm", "-D", "--defined-only", file], stdout=subprocess.PIPE, text=True, check=True)
    listed = (line.split() for line in done.stdout.splitlines())
    return {name for _, kind, name in listed if kind in "TDBR" and OF_TRESS.match(name)}


def read_symbols(text, mark):
    """Returns the symbols that abidiff lists with a mark, D or A."""
    return set(re.findall(rf"^\s+\[{mark}\] .*?\b(_Z\w+)", text, re.MULTILINE))


def readable(names):
    """Returns the names of symbols as C++ declarations."""
    done = subprocess.run(["c++filt"], input="\n".join(names), stdout=subprocess.PIPE, text=True, check=True)
    return done.stdout.split("\n")


def changed_types(text):
    """Returns the number of removed and changed interfaces that abidiff found by debug information."""
    counts = re.findall(r"^(?:Functions|Variables) changes summary: (\d+) Removed, (\d+) Changed", text,
                        re.MULTILINE)  # fmt: skip
    return sum(int(number) for pair in counts for number in pair)


def compare_symbols(old, new):
    """Prints counts of symbols and those that were removed. Returns the exit code."""
    done = subprocess.run(["abidiff", "--no-show-locs", old, new], stdout=subprocess.PIPE, text=True,
                          check=False)  # fmt: skip
    if done.returncode & ERROR:
        return 1
    print("\n".join(line for line in done.stdout.splitlines() if "summary" in line))
    removed = sorted(read_symbols(done.stdout, "D") & strong(old))
    added = read_symbols(done.stdout, "A") & strong(new)
    print("functions and variables of tress, without inline ones and instances of templates: "
          f"{len(removed)} removed, {len(added)} added")  # fmt: skip
    for line in readable(removed) if removed else ():
        print(f"  removed: {line}")
    types = changed_types(done.stdout)
    if types:
        print(done.stdout)
    return 3 if removed or types else 0


def main():
    if len(sys.argv) != 3:
        refuse("give two packages tress: OLD NEW")
    with tempfile.TemporaryDirectory() as folder:
        old, new = (library(build, f"{folder}/{k}") for k, build in enumerate(sys.argv[1:]))
        compare_stamps(stamp(old), stamp(new))
        return compare_symbols(old, new)


if __name__ == "__main__":
    sys.exit(main())
