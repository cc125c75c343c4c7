"""Programs in the repository that commands run: what runs them, and where they are."""

import sys

from .place import shipped

DEBIAN_PYTHON = "/usr/bin/python3"  # has Debian's packages

REPORT = ("node", shipped("experiments/report/dist/report.mjs"))
FILM = ("node", shipped("experiments/report/dist/film.mjs"))
ANSWERS = ("node", shipped("experiments/report/answers.mjs"))
PAGES = (DEBIAN_PYTHON, "experiments/report/prose/prose.py")
SITE = (DEBIAN_PYTHON, "docs/site/build.py")
NEW = (sys.executable, "cmake/new/new.py")
TEST_MUTANTS = (sys.executable, "tests/mutants/run.py")
TEST_CORPUS = (sys.executable, "tests/corpus/run.py")
TEST_ADVICE = (sys.executable, "tests/advice/run.py")
TEST_LIMITS = (sys.executable, "tests/advice/limits.py")
TEST_READERS = (DEBIAN_PYTHON, "tests/readers/run.py")
TEST_PACKAGES = (sys.executable, "tests/packages/run.py")
TEST_IMAGE = (sys.executable, "tests/packages/image.py")
TEST_WHEEL = (DEBIAN_PYTHON, "tests/packages/wheel.py")
COMPARE_ABI = (sys.executable, "tests/packages/abi.py")
TEST_CLUSTER = (sys.executable, "tests/cluster/test_slurm.py")
