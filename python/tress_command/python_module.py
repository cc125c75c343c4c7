"""./tress python: the Python module. It belongs to build/release, whose libraries it shares."""

import os
import shutil

from .command import Command, read_words
from .messages import refuse, say
from .processes import run
from .scripts import DEBIAN_PYTHON
from .tree import RELEASE, compile_targets, configure

LIST = "cmake/python_packages.txt"
FOLDER = "build/release/python"


def _installs(machine):
    """Installs what Debian's interpreter needs. Returns false if that is not possible."""
    packages = machine.missing(LIST)
    if not machine.tries(packages):
        say(f"python: left out: {' '.join(packages)} cannot be installed here")
        return False
    optional = machine.missing_optional(LIST)
    if not machine.tries(optional):
        say(f"goes on without {' '.join(optional)}")
    return True


def _run(words, machine):
    read = read_words("python", words, flags=("--build",), valued=("--interpreter",),
                      hint=" (options of unittest go after --)")
    name = read.options.get("--interpreter", DEBIAN_PYTHON)
    interpreter = shutil.which(name) or refuse(
        f"python: no interpreter '{name}'; give one with --interpreter")
    machine.ensure()
    if interpreter == DEBIAN_PYTHON and not _installs(machine):
        return 0
    configure(RELEASE, "-DTRESS_PYTHON=ON", f"-DTRESS_PYTHON_EXECUTABLE={interpreter}")
    compile_targets(RELEASE, "tress_python")
    say(f"module: {os.getcwd()}/{FOLDER}")
    if "--build" in read.options:
        return 0
    compile_targets(RELEASE, "python_reference", "constraint_drift")
    return run(interpreter, "-m", "unittest", *(read.more or ["discover", "-s", "python/tests"]),
               env=os.environ | {"PYTHONPATH": os.path.abspath(FOLDER)})


COMMAND = Command(
    "python", "[--build] [--interpreter FILE] [-- ARGUMENTS]",
    "builds the Python module in build/release/python and runs its tests. Installs "
    "cmake/python_packages.txt; docs/python.md describes the module.",
    _run,
    example="./tress python --build",
    time="about a minute to compile the module once the programs are built, then its tests.",
    options=(("--build", "builds only, without tests"),
             ("--interpreter FILE", f"interpreter of the module (default: {DEBIAN_PYTHON})"),
             ("-- ARGUMENTS", "arguments of unittest (default: discover -s python/tests)")))
