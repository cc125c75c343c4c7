"""./tress test: the tests, and the long ones by name."""

import os
import re
import time
from pathlib import Path

from . import sundials
from .command import Command, read_words
from .counting import must
from .messages import refuse, say
from .package import LISTS, build_packages, packages
from .packages import npm_packages
from .scripts import (TEST_ADVICE, TEST_CLUSTER, TEST_CORPUS, TEST_IMAGE, TEST_LIMITS, TEST_MUTANTS,
                      TEST_PACKAGES, TEST_READERS, TEST_WHEEL)
from .tree import ALL_PACKS, PROGRAMS, RELEASE, SHORT_PACKS, build

PAIRED = ("experiments/simulate", "20")  # strands of a batch


def _given(words, *defaults):
    """Returns the words, or defaults where they end, and the words that are left."""
    return [*words[:len(defaults)], *defaults[len(words):]], words[len(defaults):]


def _fuzz(_, words, __):
    (seconds, seed), readers = _given(words, "60", "1")
    build("debug", "fuzz_scene", "fuzz_groom")
    must("tests/fuzz_scene", seconds, seed, f"{os.getcwd()}/scenes", cwd="build/debug")
    must("tests/fuzz_groom", seconds, seed, *readers, cwd="build/debug")


def _mutants(_, words, __):
    must(*TEST_MUTANTS, *words,
         env=os.environ | {"TRESS_SUNDIALS_ROOT": sundials.root() or ""})


def _corpus(preset, words, _):
    build(preset, "experiments")
    must(*TEST_CORPUS, f"build/{preset}/experiments", *words)


def _extremes(preset, words, _):
    (count, seed), _ = _given(words, "1000", "1")
    build(preset, "simulate", "extreme_scenes", "paired_scenes", "test_scene_fit")
    folder = f"build/{preset}"
    must("tests/test_scene_fit", "--gtest_filter=*IntervalsHold*:*FifthOfASecond", cwd=folder,
         env=os.environ | {"TRESS_FIT_RECORDS": count})
    must("tests/extreme_scenes", count, seed, PAIRED[0], cwd=folder)
    must("tests/paired_scenes", count, seed, *PAIRED, f"{os.getcwd()}/tests/fuzz/heads", cwd=folder)


def _advice(preset, words, _):
    build(preset, "cost_of_accuracy", "advice_judge", "stability_limit", "simulate")
    must(*TEST_ADVICE, f"build/{preset}", *words)
    must(*TEST_LIMITS, f"build/{preset}", *words[:2])


def _installs(machine, *lists):
    packages = machine.missing(*lists)
    if machine.tries(packages):
        return True
    say(f"left out: {' '.join(packages)} cannot be installed here")
    return False


def _cluster(_, __, machine):
    if _installs(machine, "cmake/cluster_packages.txt", "cmake/mpi_packages.txt"):
        build(RELEASE, "experiments")
        must(*TEST_CLUSTER, env=os.environ | {"TRESS_PROGRAMS": os.path.abspath(PROGRAMS)})


def _readers(_, __, machine):
    if not _installs(machine, "cmake/readers_packages.txt"):
        return
    if not npm_packages("tests/readers"):
        say("left out: npm cannot install the packages of tests/readers here")
        return
    build(RELEASE, "simulate")
    must(*TEST_READERS, f"{PROGRAMS}/simulate")


def _debs(machine):
    if not packages():
        build_packages(machine)
    return packages()


def _debian(machine):
    must(*TEST_PACKAGES, *_debs(machine))


def _image(machine):
    if _installs(machine, "cmake/image_packages.txt"):
        must(*TEST_IMAGE, *_debs(machine))


def _wheel(_):
    must(*TEST_WHEEL)


INSTALLED = {"debian": _debian, "image": _image, "wheel": _wheel}


def _check_parts(words):
    for word in words:
        if word not in INSTALLED:
            refuse(f"test: --packages has no part '{word}'; parts are {', '.join(INSTALLED)}")


def _packages(_, words, machine):
    if _installs(machine, *LISTS, "cmake/clean_system_packages.txt"):
        for word in words or INSTALLED:
            INSTALLED[word](machine)


def _ctest(preset, options, *words):
    build(preset, options=options)
    began = time.time()
    # One more than processors: a test that waits for a disk or a browser leaves one free.
    must("ctest", "--preset", preset, "-j", str(len(os.sched_getaffinity(0)) + 1), *words)
    cases = 0
    for report in Path(f"build/{preset}/tests").rglob("*.xml"):
        if report.stat().st_mtime > began:
            suites = re.search(r'(?m)^<testsuites tests="(\d+)"', report.read_text(errors="replace"))
            cases += int(suites[1]) if suites else 0
    say(f"cases of GoogleTest in these tests: {cases}")


def _usual(preset, words, _):
    there = os.path.exists(f"build/{preset}/CMakeCache.txt")
    _ctest(preset, () if there else (SHORT_PACKS,), "--label-exclude", "^long$", *words)


def _all(preset, words, _):
    _ctest(preset, (ALL_PACKS,), *words)


TESTS = {"all": _all, "fuzz": _fuzz, "mutants": _mutants, "corpus": _corpus, "extremes": _extremes,
         "advice": _advice, "cluster": _cluster, "readers": _readers,
         "packages": _packages}


def _run(words, machine):
    flags = ("--sanitize", *(f"--{kind}" for kind in TESTS))
    read = read_words("test", words, flags=flags, hint=" (options of ctest go after --)")
    if "--packages" in read.options:
        _check_parts(read.more)
    preset = "debug" if read.options.pop("--sanitize", False) else RELEASE
    machine.ensure()
    kinds = [TESTS[option.removeprefix("--")] for option in read.options]
    (kinds[-1] if kinds else _usual)(preset, read.more, machine)


COMMAND = Command(
    "test", "[--sanitize] [KIND] [-- ARGUMENTS]",
    "builds and runs the tests, all of them with --all, or one of the long tests. Arguments "
    "after -- go to ctest.",
    _run,
    example="./tress test -- -R contracts",
    time="about 10 minutes on two cores after the build, 20 with --all; --fuzz seven minutes, "
         "--corpus 7000 short runs, --advice 20 minutes and more, --mutants half an hour and more.",
    options=(
        ("--sanitize", "build with sanitizers (preset debug)"),
        ("--all", "in addition the tests of label `long`, which repeat the others on more models, "
         "methods, scenes and strands, and SIMD packs of 512 bits, which a new build without "
         "--all leaves out"),
        ("--fuzz [-- SECONDS SEED [READER...]]", "corrupted files for the reader of scenes, each "
         "reader of grooms (hair, data, bin, ply, usda, vtp) and of meshes (mesh.obj, mesh.ply, "
         "mesh.stl), under sanitizers (default: 60 s of processor time each, seed 1)"),
        ("--corpus [-- --seed N]", "7000 bad inputs of all kinds through every program: is each "
         "refused in one line, with exit code 2?"),
        ("--extremes [-- COUNT SEED]", "random legal scenes of extreme numbers: does one crash, "
         "hang or end ok with what physics rules out? Are batches what single strands are? "
         "Do intervals of fits hold the truth? (default: 1000 of each, seed 1)"),
        ("--advice [-- COUNT SEED SECONDS]", "random scenes with references of their own: is what "
         "--advise promises true, and what stability_limit --scene prints, in runs at 0.9 and 1.5 "
         "times its steps? (default: 12, seed 1, 100 s a scene)"),
        ("--mutants [-- --all] [--only PATTERN]", "one line of the sources changed at a time: "
         "do the tests detect it? Writes results/mutants.csv"),
        ("--cluster", "sweeps on a Slurm that the test starts and ends; installs "
         "cmake/cluster_packages.txt and cmake/mpi_packages.txt, or prints why it is left out"),
        ("--readers", "exported files: do VTK, TinyUSDZ, three.js and h5py find in them what was "
         "simulated? Installs cmake/readers_packages.txt and two packages of npm, or prints why "
         "it is left out"),
        ("--packages [-- PART...]", "new Debian systems without the clone and without a network: do "
         "a scene, the module, a consumer and a plug-in run from the Debian packages (part debian), "
         "a scene and the module from the container image (image) and from the wheel (wheel)? "
         "Builds the packages first if there are none")))
