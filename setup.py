"""Builds the module in build/release, which the programs share, and takes it from there."""

import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext


class Build(build_ext):
    def build_extension(self, extension):
        root = Path(__file__).resolve().parent
        interpreter = sys.executable
        # A virtual environment of Debian's interpreter has its headers and packages.
        if sys.prefix != sys.base_prefix and sys._base_executable == "/usr/bin/python3":
            interpreter = "/usr/bin/python3"
        command = [root / "tress", "python", "--build", "--interpreter", interpreter]
        subprocess.run(command, check=True)
        target = Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        (built,) = (root / "build/release/python/tress").glob("_core.*.so")
        shutil.copy2(built, target)


setup(ext_modules=[Extension("tress._core", [])], cmdclass={"build_ext": Build})
