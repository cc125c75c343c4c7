"""abi.py OLD.deb NEW.deb: compares libtress.so of two packages tress with abidiff. Exit code 3
if a change is incompatible (bit 8 of abidiff), 0 if symbols were only added or nothing changed."""

import subprocess
import sys
import tempfile
from pathlib import Path

INCOMPATIBLE, ERROR = 8, 1


def library(package, folder):
    """Returns the shared library of a package, unpacked in a folder."""
    subprocess.run(["dpkg-deb", "-x", package, folder], check=True)
    (found,) = (one for one in Path(folder).rglob("libtress.so.*") if not one.is_symlink())
    return found


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        two = [library(package, f"{folder}/{k}") for k, package in enumerate(sys.argv[1:])]
        code = subprocess.run(["abidiff", "--no-show-locs", *two], check=False).returncode
    if code & ERROR:
        return 1
    return 3 if code & INCOMPATIBLE else 0


if __name__ == "__main__":
    sys.exit(main())
