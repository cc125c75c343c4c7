"""Builds the module tress._core.

In a clone, ./tress python builds it in build/release, which the programs share. In an sdist,
CMake builds it from the sources there. Environment: TRESS_SUNDIALS_ROOT names a build of
SUNDIALS, TRESS_CMAKE_OPTIONS has further options of CMake, separated by blanks."""

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.command.sdist import sdist

ROOT = Path(__file__).resolve().parent
COMMIT = "cmake/commit.txt"  # read by cmake/built_from.cmake where there is no .git


def build_in_clone():
    """Builds the module with ./tress python. Returns the folder of the module."""
    interpreter = sys.executable
    # A virtual environment of Debian's interpreter has its headers and packages.
    if sys.prefix != sys.base_prefix and sys._base_executable == "/usr/bin/python3":
        interpreter = "/usr/bin/python3"
    command = [ROOT / "tress", "python", "--build", "--interpreter", interpreter]
    subprocess.run(command, check=True)
    return ROOT / "build/release/python/tress"


def build_from_sdist(folder):
    """Builds the module with CMake alone. Returns the folder of the module."""
    sundials = subprocess.run([ROOT / "cmake/sundials.sh", "root"], stdout=subprocess.PIPE, text=True)
    options = {
        "CMAKE_BUILD_TYPE": "Release", "CMAKE_CXX_FLAGS_RELEASE": "-O3 -DNDEBUG",
        "TRESS_MARCH": "auto", "TRESS_BATCHES": "ON", "TRESS_EXPERIMENTS": "OFF",
        "TRESS_TESTS": "OFF", "TRESS_RECORD_FOLDERS": "OFF", "TRESS_PYTHON": "ON",
        "TRESS_PYTHON_EXECUTABLE": sys.executable,
        "TRESS_SUNDIALS_ROOT": sundials.stdout.strip(),
    }  # fmt: skip
    try:
        import pybind11

        options["pybind11_DIR"] = pybind11.get_cmake_dir()
    except ImportError:
        pass  # Debian's is where CMake looks
    further = shlex.split(os.environ.get("TRESS_CMAKE_OPTIONS", ""))
    definitions = [f"-D{name}={value}" for name, value in options.items()]
    subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", *definitions, *further], check=True)
    subprocess.run(["cmake", "--build", folder, "--target", "tress_python"], check=True)
    return folder / "python/tress"


class Build(build_ext):
    def build_extension(self, extension):
        in_clone = (ROOT / ".git").exists() and (ROOT / "tests").is_dir()
        built = build_in_clone() if in_clone else build_from_sdist(ROOT / "build/wheel")
        (module,) = built.glob("_core.*.so")
        target = Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(module, target)


class Archive(sdist):
    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        found = subprocess.run(["git", "-C", ROOT, "rev-parse", "HEAD"], capture_output=True, text=True)
        if found.returncode == 0:
            target = Path(base_dir) / COMMIT
            target.unlink(missing_ok=True)  # a link to the file of the clone
            target.write_text(found.stdout)


setup(ext_modules=[Extension("tress._core", [])], cmdclass={"build_ext": Build, "sdist": Archive})
